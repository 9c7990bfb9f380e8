"""The section of a made-up fit, and the comparison of two made-up folders: every table, mark and exported number, against the data."""

import json
import random

import assemble
import mock
import pages
from number_checks import DEGREES


def trace(rng, test, column, unit, **more):
    t = [0.1 * k for k in range(20)]
    fitted = [0.05 * k * k + rng.gauss(0, 0.01) for k in range(20)]
    return {"test": test, "column": column, "unit": unit, "t": t, "measured": [None if k == 7 else value + rng.gauss(0, 0.3) for k, value in enumerate(fitted)], "fitted": fitted,
            "lower": [value - 0.2 for value in fitted], "upper": [value + 0.4 for value in fitted], "rms": 0.31, "chi_squared": 21.5, "n": 1234, "n_effective": 17.25, "p_value": 0.37, **more}


def fit():
    rng = random.Random(3)
    parameter = lambda name, mean, std, after, left, **more: {"name": name, "prior": {"mean": mean, "std": std, "lower": mean - 1.25 * std, "upper": mean + 2.75 * std}, "mode": after + 0.1 * std, "mean": after, "std": std * left, "lower": after - 1.5 * std * left,
                                                             "upper": after + 2.5 * std * left, "std_ratio": left, **more}
    parameters = [parameter("root_spring", 1, 0.05, 1.043, 0.31), parameter("coulomb.mid", 0.4, 0.1, 0.27, 0.82, unit="N m"), parameter("tip_spring", 1, 0.05, 0.91, 0.055),
                  parameter("harness", 3, 1, 2.5, 0.5, unit="rad"), parameter("fifth", -2, 0.5, -2.25, 0.125)]
    return {"finished": True, "findings": ["the worst first", "then another"], "parameters": parameters, "unseen": [{"text": "no test tells harness from fifth", "direction": {}, "std_ratio": 0.9}],
            "values": [{"test": "ground", "name": "root.latch_rate", "unit": "rad/s", "measured": -1.25, "fitted": -1.2134, "sigmas": 1.37, "p_value": 0.17},
                       {"test": "flight", "name": "hinges.root.friction.coulomb", "unit": "N m", "measured": 0.21, "fitted": 0.2345, "sigmas": -2.44, "p_value": 0.015}],
            "traces": [trace(rng, "ground", "root.angle", "rad"), trace(rng, "flight", "tip.moment", "N m", chi_squared=None)],
            "samples": {"names": [one["name"] for one in parameters], "rows": [[rng.gauss(one["mean"], one["std"]) for one in parameters] for _ in range(30)]},
            "candidates": [{"name": "slower start", "information": 1.234, "std_ratio": {"root_spring": 0.7, "harness": 0.456, "fifth": 0.9}}],
            "deployed": {"before": 0.747, "after": 0.9125},
            "prediction": {"root.latch_rate": {"unit": "rad/s", "before": [-1.5, -1.25, -1.125], "after": [-1.31, -1.3, -1.2999]}, "tip.held": {"unit": "", "before": [1, 1, 1], "after": [1, 1, 1]},
                           "tip.peak_moment": {"unit": "N m", "before": [100, 100, 100], "after": [100.5, 101.25, 104]},
                           "tip.latch_time": {"unit": "s", "before": [3.5, 4.125, None], "after": [None, None, None]}}}


class FitPageChecks:
    """For a Page with MarkChecks."""

    def opened_block(self, name, make):
        path = pages.SCRATCH / f"{name}.html"
        if not path.exists():
            path.write_text(assemble.page(json.dumps(make())), "utf-8")
        self.open(path)

    def heads(self, caption):
        return self.run_script("return [...[...document.querySelectorAll('table')].find(t => t.caption.textContent === arguments[0]).tHead.rows[0].cells].map(c => c.textContent)", caption)

    def copied_from(self, figure, nth):
        return self.run_script("""let text; navigator.clipboard.writeText = t => { text = t; return Promise.resolve(); };
            [...document.querySelectorAll(`figure.${arguments[0]}`)[arguments[1]].querySelectorAll('.tools button')].pop().click(); return text.trim().split('\\n').map(line => line.split('\\t'))""", figure, nth)

    def numbers_of(self, cells, values, about):
        for cell, value in zip(cells, values, strict=True):
            self.assertEqual(cell == "", value is None, about)
            if isinstance(value, str):
                self.assertEqual(cell, value, about)
            elif value is not None:
                self.assertAlmostEqual(float(cell), value, delta=1e-9 * max(1, abs(value)), msg=about)

    def test_pictures_of_a_fit(self):
        one = fit()
        self.opened_block("fit_page", lambda: mock.block([mock.study("fit", fit=one)]))
        for unit, factor in (("rad", 1), ("deg", DEGREES)):
            self.angles(unit)
            pages.settle(self.driver)
            for nth, (each, text, scale) in enumerate(zip(one["traces"], (unit, "N·m"), (factor, 1), strict=True)):
                heads, *rows = self.copied_from("fit-trace", nth)
                self.assertEqual(heads, ["t s", *(f"{key} {text}" for key in ("measured", "fitted", "lower", "upper"))])
                for at, row in enumerate(rows):
                    self.numbers_of(row, [each["t"][at], *(None if each[key][at] is None else each[key][at] * scale for key in ("measured", "fitted", "lower", "upper"))], each["column"])
                note = self.run_script("return document.querySelectorAll('figure.fit-trace > .note')[arguments[0]].textContent", nth)
                known = [each["chi_squared"], each["n"], each["p_value"]] if each["chi_squared"] is not None else []
                self.check(note.replace("χ²", "χ"), each["rms"] * scale, *known, each["n_effective"], about=each["column"])
                self.assertIn(f" {text}. ", note)
                self.assertEqual(self.run_script("return [...document.querySelectorAll('figure.fit-trace')[arguments[0]].querySelectorAll('.axis-text')].map(e => e.textContent)", nth),
                                 [f"{each['column']} ({text})", "time (s)", f"measured − fitted ({text})"])
                x, y, below = self.scale("fit-trace", "x", nth=nth, at=1), self.scale("fit-trace", "y", nth=nth), self.scale("fit-trace", "y", nth=nth, at=1)
                self.line(self.paths("fit-trace", ".trace", nth)[0], x, y, zip(each["t"], (value * scale for value in each["fitted"])), "fitted")
                self.band(self.paths("fit-trace", ".curve-band", nth)[0], x, y, zip(each["t"], *([value * scale for value in each[key]] for key in ("lower", "upper"))), "band")
                marks = self.run_script("return [...document.querySelectorAll('figure.fit-trace')[arguments[0]].querySelectorAll('circle.sample')].map(e => [Number(e.getAttribute('cx')), Number(e.getAttribute('cy'))])", nth)
                known = [(t, value, value - other) for t, value, other in zip(each["t"], each["measured"], each["fitted"]) if value is not None]
                residuals = [(x(t), below(rest * scale)) for t, _, rest in known]  # none of a missing number
                self.near(marks, [(x(t), y(value * scale)) for t, value, _ in known] + residuals, each["column"])
        self.assertEqual(self.run_script("return [...document.querySelectorAll('figure.fit-trace .caption')].map(e => e.textContent)"), ["Measured and fitted: root.angle, ground", "Measured and fitted: tip.moment, flight"])
        self.assertEqual(self.run_script("return [...document.querySelector('figure.fit-trace .legend').children].map(e => [e.textContent, e.firstChild.tagName])"), [["measured", "path"], ["fitted", "line"], ["95 % band", "rect"]])
        self.bars_and_pairs(one)

    def bars_and_pairs(self, one):
        parameters = one["parameters"]
        x = self.scale("fit-parameters", "x")
        wanted = []
        for each in parameters:
            low, high = ((each[key] - each["prior"]["mean"]) / each["prior"]["std"] for key in ("lower", "upper"))
            wanted += [(x(-1.25), x(2.75) - x(-1.25), 14), (x(low), max(2, x(high) - x(low)), 8)]  # quantiles, whatever the law
        self.near(self.places("fit-parameters", "rect.interval", "x", "width", "height"), wanted, "bars")
        self.assertEqual(self.run_script("return [...document.querySelectorAll('figure.fit-parameters text > title')].map(e => e.textContent)"), [each["name"] for each in parameters])
        opacity = self.run_script("return [...document.querySelectorAll('figure.fit-parameters rect.interval')].map(e => Number(e.style.fillOpacity))")
        self.assertTrue(all(pale < 0.5 < dark for pale, dark in zip(opacity[::2], opacity[1::2])))
        heads, *rows = self.copied_from("fit-parameters", 0)
        self.assertEqual(heads, ["parameter", "prior mean", "prior sd", "prior lower", "prior upper", "mode", "mean", "sd", "lower", "upper", "sd left"])
        for row, each in zip(rows, parameters, strict=True):
            self.numbers_of(row, [each["name"], *(each["prior"][key] for key in ("mean", "std", "lower", "upper")), *(each[key] for key in ("mode", "mean", "std", "lower", "upper", "std_ratio"))], each["name"])
        words = self.run_script("return document.querySelector('figure.fit-parameters desc').textContent").split("; ")
        for text, each in zip(words, parameters, strict=True):
            self.check(text.removeprefix(each["name"] + ":"), each["mean"], each["std"], about=text)
        heads, *rows = self.copied_from("fit-pairs", 0)
        self.assertEqual(heads, one["samples"]["names"])
        for row, values in zip(rows, one["samples"]["rows"], strict=True):
            self.numbers_of(row, values, "samples")
        titles = self.run_script("return [...document.querySelectorAll('figure.fit-pairs .axis-text')].map(e => e.textContent)")
        names, marks, count, axes = one["samples"]["names"], self.places("fit-pairs", "circle.sample", "cx", "cy"), len(one["samples"]["rows"]), {}
        at, places, labels = 0, [], []
        for i in range(1, 4):  # the first four parameters, pair by pair
            axes[i] = self.scale("fit-pairs", "y", at=i - 1)
            for j in range(i):
                places += [(self.scale("fit-pairs", "x", at=at)(row[j]), axes[i](row[i])) for row in one["samples"]["rows"]]
                labels += [names[j]] + ([names[i]] if j == 0 else [])
                at += 1
        self.assertEqual(titles, labels)
        self.near(marks, places, "pairs")
        self.assertEqual(len(marks), 6 * count)
        note = self.run_script("return document.querySelector('figure.fit-pairs > .note').textContent")
        self.check(note, 4, 5, about=note)

    def test_a_fit_says_its_confidence_and_how_many_samples_are_drawn(self):
        one = fit()
        one["traces"][0]["samples"], one["samples"]["samples"] = 1150, 2000
        one["prior_decides"] = ["harness", "fifth"]
        for each in one["parameters"]:  # of an older version
            del each["prior"]["lower"], each["prior"]["upper"]
        self.opened_block("fit_thinned", lambda: mock.block([mock.study("fit", fit=one, confidence=0.8)]))
        notes = {name: self.run_script("return [...document.querySelectorAll(`figure.${arguments[0]} > .note`)].map(e => e.textContent)", name) for name in ("fit-trace", "fit-pairs", "fit-parameters")}
        self.assertIn("20 of 1,150 samples", notes["fit-trace"][0])
        self.assertNotIn("samples", notes["fit-trace"][1])
        self.assertIn("30 of 2,000 samples", notes["fit-pairs"][0])
        self.assertTrue("Light" not in notes["fit-parameters"][0] and "80 % interval" in notes["fit-parameters"][0], notes)
        self.assertEqual(len(self.all("figure.fit-parameters rect.interval")), len(one["parameters"]))
        self.assertIn("80 % interval", self.heads("Parameters before and after the tests"))
        self.assertIn("80 % band", self.run_script("return document.querySelector('figure.fit-trace .legend').textContent"))
        text = self.one("#why").text
        self.assertIn("The prior decides, not the tests: harness, fifth.", text)
        self.assertIn("too many of them lack the output", text)

    def test_tables_of_a_fit(self):
        one = fit()
        self.opened_block("fit_page", lambda: mock.block([mock.study("fit", fit=one)]))
        text = self.one("#why").text
        places = [text.index(words) for words in (*one["findings"], one["unseen"][0]["text"], "Parameters before")]
        self.assertEqual(places, sorted(places))
        caption = "Parameters before and after the tests"
        self.assertEqual(self.heads(caption), ["Parameter", "Before: mean ± sd", "After", "95 % interval", "Share of the sd left"])
        for row, each in zip(self.table(caption), one["parameters"], strict=True):
            unit, factor = {None: ("", 1), "N m": (" (N·m)", 1), "rad": (" (deg)", DEGREES)}[each.get("unit")]
            self.assertEqual(row[0], each["name"] + unit)
            for cell, values in zip(row[1:4], ((each["prior"]["mean"], each["prior"]["std"]), (each["mean"], each["std"]), (each["lower"], each["upper"])), strict=True):
                self.check(cell, *(factor * value for value in values), about=each["name"])
            self.check(row[4], each["std_ratio"], share=True, about=each["name"])
        self.assertEqual(self.heads("Measured values"), ["Test", "Value", "Unit", "Measured", "Fitted", "Difference σ", "p"])
        names = [("ground", "root latch rate", "deg/s"), ("flight", "hinges.root.friction.coulomb", "N·m")]
        for row, name, each, factor in zip(self.table("Measured values"), names, one["values"], (DEGREES, 1), strict=True):
            self.assertEqual(tuple(row[:3]), name)
            for cell, value in zip(row[3:], (each["measured"] * factor, each["fitted"] * factor, each["sigmas"], each["p_value"]), strict=True):
                self.check(cell, value, about=each["name"])
        self.assertEqual(self.heads("What further tests would tell"), ["Test", "Information nats", "Interval that shrinks most"])
        self.assertEqual(self.table("What further tests would tell"), [["slower start", "1.23", "harness: to 45.6 %"]])
        caption = "Prediction: median (5 % … 95 %)"
        self.assertEqual(self.heads(caption), ["Output", "Unit", "Before the tests", "After"])
        deployed, *outputs = self.table(caption)
        self.assertEqual(deployed, ["deployed", "", "74.7 %", "91.3 %"])
        self.assertEqual([row[:2] for row in outputs], [["root latch rate", "deg/s"], ["tip peak moment", "N·m"], ["tip latch time", "s"]])  # what never varies is left out
        self.assertEqual(outputs[2][2:], ["4.125 (3.500 … none)", "none (none … none)"])  # too many runs lack it
        for row, name, factor in zip(outputs, ("root.latch_rate", "tip.peak_moment"), (DEGREES, 1)):
            for cell, when in zip(row[2:], ("before", "after"), strict=True):
                low, middle, high = (value * factor for value in one["prediction"][name][when])
                self.check(cell, middle, low, high, about=name)
                self.assertEqual(len(set(cell.replace("(", " ").replace(")", " ").replace("…", " ").split())), len({low, middle, high}), cell)  # different values read differently
        for kind, part in (("margin", "permissible spring strength"), ("rare", "rare events"), ("static margins", "static margins")):
            self.assertIn(part, text.split("Not in this report: ")[1], kind)
        self.assertNotIn("a fit to", text.split("Not in this report: ")[1])

    def folders(self):
        """Two folders whose scenes, laws and settings differ."""
        sets = [mock.make_set(label, seed, count=300) for label, seed in (("old", 1), ("new", 2))]
        sets[1] |= {"folder": "results/new", "campaign": "new_wing", "runs": 1400, "hash": "0123456789abcdef"}
        parameter = lambda path, value, unit="N m", case_value=None: {"path": path, "label": path.replace(".", " "), "value": value, "unit": unit, "case_value": case_value}
        sets[0]["inputs"] = {"scene": [parameter(f"hinges.{hinge}.latch.peak_torque", 250) for hinge in ("a", "b", "c")] + [parameter("bodies.yoke.mass", 4, "kg", 5), parameter("hinges.a.end", -2), parameter("hinges.a.gone", 3, "s"), parameter("same", 1)],
                             "dispersions": [{"draw": draw, "law": law, "apply": apply, "paths": []} for draw, law, apply in (("k", "normal", "scale"), ("m", "normal", "scale"), ("n", "normal", None))],
                             "settings": [{"label": "method", "value": "auto"}, {"label": "rtol", "value": 1e-8}]}
        sets[1]["inputs"] = {"scene": [*(parameter(f"hinges.{hinge}.latch.peak_torque", 260) for hinge in ("a", "b")), parameter("hinges.c.latch.peak_torque", 200), parameter("bodies.yoke.mass", 4, "kg", 4.5),
                                       parameter("hinges.a.end", -1), parameter("hinges.b.new", 7, "rad"), parameter("same", 1)],
                             "dispersions": [{"draw": draw, "law": law, "apply": apply, "paths": []} for draw, law, apply in (("k", "uniform", "scale"), ("m", "normal", "scale"), ("o", "normal", None))],
                             "settings": [{"label": "method", "value": "dop853"}, {"label": "rtol", "value": 1e-8}]}
        block = mock.block(sets)
        block["comparisons"][0] |= {"folders": True, "paired": False}
        block["unpaired"] = ["one", "two"]
        return block

    def test_tables_targets_and_correlations_are_compared_too(self):
        """Each by its own name: what a draw acts on, the knots of its tables, the scene's tables by column, each correlation."""
        self.opened_block("folders", self.folders)
        change = lambda script: (self.run_script("""window.original = window.original || JSON.stringify({ ...W.sets[0].inputs,
                tables: ["a", "b", "c"].map(hinge => ({ path: `hinges.${hinge}.spring.measured`, columns: [{ name: "angle", unit: "rad", values: [0, 1] }, { name: "torque", unit: "N·m", values: [2, 1.7] }] })),
                dispersions: [{ draw: "k", words: "friction of a", law: "normal", apply: "scale", paths: ["hinges.a.friction.coulomb"], tables: [] },
                              { draw: "t", words: "temperature", law: "normal", apply: "by a table", paths: [], tables: ["a", "b"].map(hinge => ({ words: `friction of ${hinge}`, paths: [`hinges.${hinge}.friction.scale`], apply: "scale", unit: "", at: [-70, 20], value: [2.2, 1] })) }],
                settings: ["a, b", "b, c"].map(pair => ({ label: `rank correlation ${pair}`, value: 0.5 })) });
            W.sets.forEach(set => set.inputs = JSON.parse(window.original)); const own = W.sets[1].inputs; """ + script + " W.comparison()"),
            self.table("Inputs that differ: new against old"))[1]
        self.assertEqual(change("own.tables.slice(0, 2).forEach(one => one.columns[1].values = [3, 2.7]);"), [["spring measured torque: a, b", "N·m", "2 · 1.7", "3 · 2.7", ""]])
        self.assertEqual(change("own.dispersions[0].paths = ['hinges.a.friction.viscous'];"), [["dispersion k acts on", "", "hinges.a.friction.coulomb", "hinges.a.friction.viscous", ""]])
        self.assertEqual(change("own.dispersions[1].tables.shift(); own.dispersions[1].tables[0].value[0] = 2.5;"),
                         [["dispersion t: friction of a (scale)", "", "−70: 2.2 · 20: 1", "–", ""], ["dispersion t: friction of b (scale)", "", "−70: 2.2 · 20: 1", "−70: 2.5 · 20: 1", ""]])
        self.assertEqual(change("own.settings[0].value = -0.5;"), [["rank correlation a, b", "", "0.5", "−0.5", "−200 %"]])

    def test_every_pair_of_folders_says_which_inputs_differ(self):
        """Of three folders each pair; pairs with equal differences share a table; several tables are folded."""
        self.opened_block("folders", self.folders)
        differ = lambda: self.run_script("return [...document.querySelectorAll('#comparison details.inputs-that-differ')].map(one => [one.open, one.firstChild.textContent, one.lastChild.textContent])")
        self.run_script("""const more = (label, inputs) => W.sets.push({ ...W.sets[1], label, inputs }); more("third", { ...W.sets[0].inputs, settings: [] }); more("fourth", W.sets[1].inputs);
            W.data.comparisons = [[0, 1], [0, 2], [0, 3], [1, 3]].map(sets => ({ ...W.data.comparisons[0], sets })); W.comparison()""")
        self.assertEqual([row[0] for row in self.table("What is compared")], ["old", "new", "third", "fourth"])
        found = differ()
        self.assertEqual([one[:2] for one in found], [[False, "new against old: 10 listed inputs differ"], [False, "third against old: 2 listed inputs differ"], [False, "fourth against new: no listed input differs"]])
        self.assertEqual(len(self.table("Inputs that differ: new against old; the same for fourth against old")), 10)
        self.assertEqual([row[0] for row in self.table("Inputs that differ: third against old")], ["method", "rtol"])
        self.assertEqual(found[2][2], "No input of fourth differs from new.")

    def test_what_two_folders_compare(self):
        self.opened_block("folders", self.folders)
        sets = self.run_script("return W.data.sets")
        self.assertEqual(self.heads("What is compared"), ["Set", "Wing", "Folder", "Runs", "Seed", "Campaign hash"])
        self.assertEqual(self.table("What is compared"), [[one["label"], one["campaign"], one["folder"], f"{one['runs']:,}", one["seed"], one["hash"][:12]] for one in sets])
        caption = "Inputs that differ: new against old"
        self.assertEqual(self.heads(caption), ["Input", "Unit", "old", "new", "Change"])
        self.assertEqual(self.table(caption), [
            ["latch peak torque: a, b", "N·m", "250", "260", "+4.00 %"], ["hinges c latch peak_torque", "N·m", "250", "200", "−20.0 %"], ["bodies yoke mass", "kg", "5", "4.5", "−10.0 %"], ["hinges a end", "N·m", "−2", "−1", "+50.0 %"],
            ["hinges a gone", "s", "3", "0 or none", ""], ["hinges b new", "rad", "0 or none", "7", ""], ["dispersion k", "", "normal, scale", "uniform, scale", ""], ["dispersion n", "", "normal", "–", ""],
            ["dispersion o", "", "–", "normal", ""], ["method", "", "auto", "dop853", ""]])
        self.run_script("W.sets[1].inputs = W.sets[0].inputs; W.comparison()")
        self.assertIn("No listed input of new differs from old. Their campaigns' hashes differ: compare their files campaign.json.", self.one("#comparison").text)
        self.run_script("W.sets[1].hash = W.sets[0].hash; W.comparison()")
        self.assertIn("No input of new differs from old.", self.one("#comparison").text)
        self.assertIn("Without a partner: one; two.", self.one("#comparison").text)
        comparison = self.run_script("return W.data.comparisons[0]")
        self.same_rows("forest", [[one[key] for key in ("output", "difference", "lower", "upper", "relative", "runs")] for one in comparison["outputs"]])
        self.assertEqual(self.exported("forest")[0], ["output", "difference", "lower", "upper", "relative", "runs"])
        self.assertTrue(self.run_script("return document.querySelector('figure.forest > .note').textContent").startswith("Not paired"))
        described = self.run_script("return document.querySelector('figure.forest desc').textContent").split("; ")
        largest = sorted((one for one in comparison["outputs"] if one["relative"] is not None), key=lambda one: -abs(one["relative"]))
        for text, one in zip(described, largest[:12], strict=True):
            self.check(text, one["relative"], share=True, about=text)
        self.assertEqual(self.run_script("return [...document.querySelectorAll('figure.forest text > title')].map(e => e.textContent)"), [one["output"].replace(".", " ").replace("_", " ") for one in largest])
        self.run_script("Object.assign(W.data.comparisons[0].outputs[0], { difference: 123.4567, lower: null, upper: null }); Object.assign(W.data.comparisons[0].outputs[1], { difference: 0, lower: null, upper: null }); W.comparison()")
        unbounded = self.table(f"Differences of the means: {comparison['text']}")[:2]
        self.assertEqual([row[2:4] for row in unbounded], [["+123.5", "no bounds"], ["0", "no bounds"]])  # a twentieth of the difference is its grain
        self.run_script("Object.assign(W.data.comparisons[0].outputs[0], { difference: 1, lower: 0.88, upper: 1.12 }); W.comparison()")
        bounded = self.table(f"Differences of the means: {comparison['text']}")[0]
        self.assertEqual(bounded[2:4], ["+1.00", "0.88 … 1.12"])  # half of the interval is its grain
        folds = lambda: self.run_script("return [...document.querySelectorAll('#comparison details.later')].map(one => one.open)")
        self.run_script("W.data.comparisons = [true, false, false, false].map(folders => ({ ...W.data.comparisons[0], folders })); W.comparison()")
        self.assertEqual(folds(), [True, False, False, False])
        self.run_script("W.data.comparisons.forEach(one => one.folders = false); W.comparison()")
        self.assertEqual(folds(), [True, True, False, False])
        self.run_script("W.data.comparisons.length = 0; W.comparison()")
        self.assertIn("No set has a partner to compare with.", self.one("#comparison").text)
