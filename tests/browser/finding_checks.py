"""The first screen's findings, the slider's end, labels of lines, and the page numbers of a printed table of contents."""

import pathlib
import re
import sys

import pages
from number_checks import parsed

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "studies" / "plots"))
import print_report  # noqa: E402


class FindingChecks:
    def test_each_failed_requirement_has_its_finding(self):
        """Where, how many runs, the guaranteed value, its distance from the limit and the worst run, against the data."""
        self.open(pages.made_up("loads"))
        judged = self.run_script("return W.verdicts.judged().map(row => ({ ...row.requirement, set: row.set.label, runs: row.set.runs }))")
        worst = {}
        for one in judged:
            if one["verdict"] == "failed" and one["limit"] is not None and one["beyond"]:
                worst.setdefault(one["text"], one)
        self.assertTrue(worst)
        found = [item.text for item in self.all(".findings li")]
        self.assertEqual(len(found), min(4, len(worst)))
        for text, one in zip(found, worst.values()):
            self.assertIn(f"in {one['set']} {one['beyond']:,} of {one['runs']:,} runs", text)
            self.assertIn("above" if one["upper"] else "below", text)
            if one["guaranteed_value"] is not None and one["margin"] is not None and one["margin"] < 0:
                bound, distance = re.search(r"of all deployments stay \w+ ([\d.,−]+) .*?, which is ([\d.,]+) .*? \w+ the limit", text).groups()
                factor = self.run_script("return W.format.shown(W.verdicts.unitOf(arguments[0], W.set())).factor", one)
                self.assertAlmostEqual(parsed(bound)[0][0], one["guaranteed_value"] * factor, delta=2 * parsed(bound)[0][1])
                self.assertAlmostEqual(parsed(distance)[0][0], abs(one["margin"]) * factor, delta=2 * parsed(distance)[0][1])
            also = [other["set"] for other in judged if other["text"] == one["text"] and other["verdict"] == "failed" and other["set"] != one["set"]]
            self.assertEqual("Also fails in" in text, bool(also))
            for label in also:
                self.assertRegex(text, rf"Also fails in .*{label}")
            if one["beyond_runs"]:
                self.assertIn(f"The worst run is {one['beyond_runs'][0]['run']}.", text)

    def test_the_sentence_names_the_dispersions_of_largest_effect(self):
        """Of each sign the one of largest correlation whose bounds leave out 0; and of none where there is none."""
        self.open(pages.made_up("plain"))
        effects, outputs = self.run_script("const set = W.set(); return [set.sensitivity.effects, W.effectOutputs(set)]")
        told = 0
        for output in outputs[::3]:
            self.run_script("W.choose('output', arguments[0])", output)
            pages.settle(self.driver)
            text = "".join(one.text for one in self.all("p.effects"))
            shown = [one for one in effects if one["output"] == output and any(one[f"{key}_lower"] * one[f"{key}_upper"] > 0 for key in ("spearman", "prcc"))]
            for sign, words in ((1, "increases most with "), (-1, "decreases most with ")):
                most = max((one for one in shown if sign * one["spearman"] > 0), key=lambda one: abs(one["spearman"]), default=None)
                self.assertEqual(most is not None, words in text, f"{output}: {text}")
                if most:
                    told += 1
                    self.assertRegex(text, re.escape(words + most["draw"]) + r"\b", output)
        self.assertGreater(told, len(outputs) / 6)

    def test_the_slider_ends_with_the_displayed_interval(self):
        self.open(pages.made_up("plain"))
        whole, last, shown = self.run_script("const m = W.player.motion; return [m.t[m.t.length - 1], Math.max(...m.latches.map(l => l.time)), W.player.interval()]")
        self.assertTrue(last < shown[1] <= whole)
        stop = lambda: float(self.one(".scrub").get_attribute("max"))
        self.assertAlmostEqual(stop(), shown[1])
        self.assertIn(f"of {shown[1]:.2f} s", self.one(".time").text)
        [one for one in self.all(".buttons button") if one.text == "whole run"][0].click()
        self.assertAlmostEqual(stop(), whole)

    def test_the_label_of_an_upright_line_crosses_no_other_line(self):
        self.open(pages.made_up("plain"))
        crossed = self.run_script("""const svg = document.querySelector('figure.histogram svg'), group = d3.create('svg:svg');
            svg.append(group.node());
            W.marks.uprights(group, { left: 0, right: 400, top: 0, bottom: 100 }, [{ x: 200, text: 'nominal', kind: 'nominal' }, { x: 210, text: '≤ 70', kind: 'limit' }]);
            const [first, second] = [...group.node().querySelectorAll('text')].map(text => text.getBBox());
            return [first.x + first.width, second.x, second.x + second.width]""")
        self.assertLess(crossed[0], 200)  # left of its line
        self.assertGreater(crossed[1], 210)
        self.assertLess(crossed[2], 400)

    def test_contents_have_the_numbers_of_their_pages_where_they_are_given(self):
        """print_report.py prints twice: the second time the page's address has the numbers."""
        told = 'Page  Destination                 Name\n   1 [ XYZ    0  627 null      ] "verdicts"\n  37 [ XYZ    0  830 null      ] "outputs"\n'
        numbers = print_report.destinations(told)  # as pdfinfo prints them
        self.driver.get("about:blank")
        self.driver.get(print_report.address(pages.made_up("cases"), numbers))
        pages.settle(self.driver)
        self.driver.execute_script("dispatchEvent(new Event('beforeprint'))")
        entries = self.run_script("return [...document.querySelectorAll('.contents li')].map(li => [li.querySelector('a').hash, li.querySelector('.page')?.textContent ?? null])")
        self.assertEqual(dict(entries)["#outputs"], "37")
        self.assertEqual(dict(entries)["#verdicts"], "1")
        self.assertIsNone(dict(entries)["#inputs"])
        self.driver.execute_script("dispatchEvent(new Event('afterprint'))")
