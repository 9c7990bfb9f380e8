"""The page of runs without rows (`run --no-rows`): its numbers against summary.json, and which parts it says it lacks."""

import csv
import json

import pages

RUNS = 2000


def rowless():
    """The page of such runs of the seed campaign."""
    return pages.reported("rowless", pages.made("seed", RUNS, "rowless", "--no-rows"))


class RowlessChecks:
    def test_a_page_without_rows(self):
        self.open(rowless())
        summary = json.loads((pages.SCRATCH / "rowless" / "summary.json").read_text())
        self.assertNotRegex(self.page_text(), r"NaN|undefined|Infinity|could not be drawn")
        for part in ("histogram", "distribution", "stage", "history", "strobe", "envelopes", "strips", "tornado"):
            self.assertTrue(self.all(f"figure.{part} svg"), part)
        for part in ("settling", "scatter"):
            self.assertFalse(self.all(f"figure.{part}"), part)
        self.assertIn("run with --no-rows", self.one("#verdicts").text)
        for section, words in (("outputs", "A histogram by latch order needs the rows"), ("convergence", "Convergence needs the rows"),
                               ("why", "linear correlations (Pearson)")):
            self.assertIn(words, self.one(f"#{section}").text)
        for row, (status, one) in zip(self.table("Outcomes of the runs"), summary["status"].items(), strict=True):
            self.check(row[1], one["count"], about=status)
        for output in self.run_script("return W.set().outputs"):
            self.run_script("W.choose('output', arguments[0])", output["name"])
            pages.settle(self.driver)
            one = summary["outputs"][output["name"]]
            factor = self.factor(output, "deg")
            name = self.run_script("return W.format.name(W.output())")
            for row, quantile in zip(self.table(f"Quantiles of {name}"), one["quantiles"], strict=True):
                self.check(row[1], quantile["value"] * factor, about=output["name"])
                self.check(row[2], quantile["lower"] * factor, quantile["upper"] * factor, about=output["name"])
            bars = self.run_script("return [...document.querySelectorAll('figure.histogram .bin')].length")
            self.assertEqual(bars, sum(count > 0 for count in output["histogram"]["counts"]))
            self.assertEqual(sum(output["histogram"]["counts"]), one["count"])
            legend = self.run_script("return [...document.querySelectorAll('figure.histogram .legend text')].map(text => text.textContent)")
            self.assertEqual(legend, ["all runs"])
            known = [pair for pair in self.pearson(output["name"]) if pair[1] is not None]
            if known:
                self.same_rows("tornado", sorted(known, key=lambda pair: -abs(pair[1]))[:12])
            else:
                self.assertIn("No effects on", self.one("#why").text)

    def test_a_motion_has_its_peak_forces(self):
        """Of the worst runs of a requirement on a force, in the rows of the campaign."""
        self.open(pages.real("seed", 300))
        rows = list(csv.DictReader((pages.SCRATCH / "seed" / "runs.csv").read_text().splitlines()))
        hinges = self.run_script("return W.set().wing.hinges.map(one => one.name)")
        for place, motion in enumerate(self.run_script("return W.set().motions")):
            self.run_script("W.choose('motion', arguments[0])", place)
            shown = self.table("Hinges at the cursor's time")
            for hinge, row, peak in zip(hinges, shown, motion["force_peaks"], strict=True):
                self.check(row[5], peak["value"], peak["time"], about=hinge)
                if motion["run"] is not None:
                    self.assertAlmostEqual(peak["value"], float(rows[motion["run"]][f"{hinge}.peak_force"]), delta=1e-6 * peak["value"])
        events = self.run_script("return [...document.querySelectorAll('select[aria-label=\"Go to an event\"] option')].map(one => one.textContent)")
        self.assertIn(f"peak force of {hinges[0]}", events)

    def pearson(self, output):
        """[draw, coefficient] of each draw."""
        return self.run_script("const t = W.set().correlations; return t.draws.map((draw, at) => [draw, t.pearson[at][t.outputs.indexOf(arguments[0])]])", output)
