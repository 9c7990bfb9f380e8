"""The first screen's findings, the cases as causes, assumptions, and numbers that follow the reader's choices."""

import math
import re
import statistics

import pages
from number_checks import parsed


class FindingChecks:
    def test_findings_of_a_set_that_lacks_runs_are_so_far(self):
        self.open(pages.made_up("loads"))
        texts = lambda: [item.text for item in self.all(".findings:not(.assumed) > li")]
        self.assertTrue(texts())
        self.assertFalse([text for text in texts() if "so far" in text])
        self.run_script("W.sets.forEach(set => Object.assign(set, { planned: 2 * set.runs })); W.outcomes()")
        self.assertTrue(texts())
        self.assertEqual([text[:200] for text in texts() if "so far" not in text], [])

    def test_each_failed_requirement_has_its_finding(self):
        """Where, how many runs of how many allowed, the observed quantile and the worst run, against the data."""
        self.open(pages.made_up("loads"))
        self.run_script("W.sets.forEach((set, at) => set.requirements.forEach(one => one.allowed = at ? 7 : 0)); W.outcomes()")
        judged = self.run_script("return W.verdicts.judged().map(row => ({ ...row.requirement, set: row.set.label, runs: row.set.runs }))")
        worst = {}
        for one in judged:
            if one["verdict"] == "failed" and one["limit"] is not None and one["beyond"]:
                worst.setdefault(one["text"], one)
        self.assertTrue(worst)
        found = [item.text for item in self.all(".findings li")]
        self.assertEqual(len(found), min(4, len(worst)))
        for text, one in zip(found, worst.values()):
            self.assertIn(f"in {one['set']} {one['broken']:,} of {one['runs']:,} runs", text)
            self.assertIn("above" if one["upper"] else "below", text)
            self.check(re.search(r"runs \(([\d.]+) %\)", text)[1], one["broken"] / one["runs"], share=True, about=one["text"])
            allowed = one.get("allowed")
            self.assertEqual(re.findall(r"where (?:at most )?(\S+) may", text), [] if allowed is None else [str(allowed or "none")], one["text"])
            if one["observed_value"] is not None:
                level, value = re.search(r"The ([\d.]+) % quantile is ([\d.,−]+) ", text).groups()
                self.assertAlmostEqual(float(level), 100 * (one["probability"] if one["upper"] else 1 - one["probability"]))
                factor = self.run_script("return W.format.shown(W.verdicts.unitOf(arguments[0], W.set())).factor", one)
                self.assertAlmostEqual(parsed(value)[0][0], one["observed_value"] * factor, delta=2 * parsed(value)[0][1])
                bound = re.search(rf"its one-sided {100 * one['confidence']:g} % bound ([\d.,−]+) ", text)
                self.assertEqual(bound is None, one["guaranteed_value"] is None)
                if bound:
                    self.assertAlmostEqual(parsed(bound[1])[0][0], one["guaranteed_value"] * factor, delta=2 * parsed(bound[1])[0][1])
            also = [other["set"] for other in judged if other["text"] == one["text"] and other["verdict"] == "failed" and other["set"] != one["set"]]
            self.assertEqual("Also fails in" in text, bool(also))
            for label in also:
                self.assertRegex(text, rf"Also fails in .*{label}")
            if one["beyond_runs"]:
                self.assertIn(f"The worst run is {one['beyond_runs'][0]['run']}.", text)

    def test_each_requirement_stands_once_by_its_worst_case_and_every_verdict_in_the_fold(self):
        words, rank = {"failed": "fail", "open": "undecided", "passed": "pass"}, ["passed", "open", "failed"]
        for kind in ("cases", "loads"):
            self.open(pages.made_up(kind))
            stated = self.run_script("return W.data.sets.flatMap(set => set.requirements.map(one => ({ ...one, label: set.label })))")
            badness = lambda one: (rank.index(one["verdict"]), one["broken"])
            worst = {text: max(badness(one) for one in stated if one["text"] == text) for text in {one["text"] for one in stated}}
            shown, folded = self.run_script("""return [...document.querySelectorAll('#verdicts table.requirements')].map(table =>
                [...table.tBodies[0].rows].map(row => [...row.cells].map(cell => cell.textContent)))""")

            def stated_by(row):
                (one,) = [one for one in stated if one["label"] == row[2] and f"{one['name']}:" in row[0] and one["evidence"] in row[0]]
                self.assertTrue(row[1].endswith(words[one["verdict"]]), row)
                for count, runs in ((one["not_deployed"], one["not_deployed_runs"]), (one["beyond"], one["beyond_runs"])):
                    if count:  # at most three, as a list
                        self.assertIn(f": {', '.join(str(each['run']) for each in runs[:3])} ", row[-1])
                return one

            self.assertEqual(sorted((one["text"], badness(one)) for one in map(stated_by, shown)), sorted(worst.items()))
            self.assertEqual(sorted((one["text"], one["label"]) for one in map(stated_by, folded)), sorted((one["text"], one["label"]) for one in stated))

    def test_why_fewer_runs_may_break_a_requirement_than_its_share(self):
        """Said where the confidence takes some of them, and not where all of the share may."""
        self.open(pages.made_up("loads"))
        told = lambda allowed: self.run_script("""W.sets.forEach(set => { set.runs = 1000; set.requirements.forEach(one => Object.assign(one, { allowed: arguments[0], probability: 0.99, confidence: 0.9, broken: one.beyond })); }); W.outcomes();
            return document.querySelector('.findings li').textContent""", allowed)
        self.assertIn("where at most 5 may (1 % of the runs is 10; to be 90 % sure, only 5 may). ", told(5))
        self.assertIn("where none may (1 % of the runs is 10; to be 90 % sure, none may). ", told(0))
        self.assertIn("where at most 10 may. ", told(10))

    def test_a_share_that_cannot_be_shown_better_is_told(self):
        """No run breaks it, so that the distance is as large as this number of runs can show; else nothing."""
        self.open(pages.made_up("cases"))
        told = lambda broken: self.run_script("""W.sets.forEach(set => set.requirements = [{ ...set.requirements[0], name: "DEP-1", id: "", output: "deployed", kind: "status", limit: null, text: "DEP-1: deployed", verdict: "passed", static_margin: false,
            probability: 0.997, confidence: 0.9, observed: 1, guaranteed: 0.9977, margin: null, broken: arguments[0], runs: set.runs, not_deployed: 0, changes: [] }]); W.outcomes();
            return [...document.querySelectorAll('.matrix')].map(one => one.closest('.scroll').nextElementSibling?.textContent ?? '')""", broken)
        runs = self.run_script("return W.sets[0].runs")
        self.assertEqual(told(0), [f"DEP-1: no run breaks it. Its distance is small because {runs:,} runs can show no more than 99.77 % at 90 % confidence."])
        self.assertNotIn("can show no more", told(1)[0])

    def test_the_mechanism_of_a_case_is_named(self):
        """The parameters that the cases change through a draw's tables, the largest factor first; without small ones; or the inputs that they set."""
        self.open(pages.made_up("cases"))
        clear = """W.sets.forEach((set, at) => { set.inputs.scene.forEach(one => one.case_value = null); set.inputs.dispersions.forEach(one => Object.assign(one, { median: 1, tables: [] })); """
        told = lambda script: self.run_script(clear + script + " }); W.why(); return W.caseMechanism(W.set(), W.chosen.output)").replace("\u00a0", " ")
        table = """const table = (words, values) => ({ words, paths: [], apply: "scale", unit: "", at: [0, 1], value: [1, 1], of_median: values[at] });"""
        labels = self.run_script("return W.sets.map(set => set.label)")
        self.assertEqual(told(table + """set.inputs.dispersions.push({ draw: "temperature", words: "temperature", paths: [], apply: "by a table", law: "normal", low: 0, high: 1, median: 20 * at,
            tables: [table("friction of all hinges", [2, 1, 0.905]), table("harness of all hinges", [2.34, 1, 0.9]), table("damper peak torque", [0.994, 1, 0.993])] })"""),
            f"Through temperature: harness of all hinges × 2.34 in {labels[0]}, × 0.900 in {labels[2]}; friction of all hinges × 2.00 in {labels[0]}, × 0.905 in {labels[2]}.")
        self.run_script("W.sets.forEach(set => set.inputs.dispersions.pop())")
        self.assertEqual(told(""), "")
        label, unit = self.run_script("const one = W.sets[0].inputs.scene.find(one => typeof one.value === 'number' && one.unit); return [one.label, W.format.unit(one.unit)]")
        self.assertEqual(told("""if (at === 1) Object.assign(set.inputs.scene.find(one => typeof one.value === 'number' && one.unit), { case_value: 12.5 })"""),
                         f"The cases change: {label} 12.5 {unit} in {labels[1]}.")
        # a scene lists no zeros: only the case that sets another value has the parameter
        self.assertEqual(told("""if (at === 1) set.inputs.scene.push({ path: "hinges.root.harness.offset", label: "root harness offset", value: 0, unit: "N m", case_value: 0.25 })"""),
                         f"The cases change: root harness offset 0.250 N·m in {labels[1]}.")
        self.run_script("W.sets[1].inputs.scene.pop()")
        # what changes nothing is not named: a factor of 1, 0 that is added, the nominal value that is set
        neutral = {"scale": (1, "× "), "add": (0, "+ "), "set": (5, "")}
        for apply, (still, sign) in neutral.items():
            for moved in range(3):
                draw = f"""set.inputs.dispersions.push({{ draw: "d", words: "d", paths: [], apply: "{apply}", law: "normal", unit: "", low: 0, high: 1, tables: [],
                    median: at === 0 ? {still} : at === {moved} ? 2.5 : {still} }})""" if moved else \
                    f"""set.inputs.dispersions.push({{ draw: "d", words: "d", paths: [], apply: "{apply}", law: "normal", unit: "", low: 0, high: 1, tables: [], median: {still} }})"""
                text = told(draw)
                self.run_script("W.sets.forEach(set => set.inputs.dispersions.pop())")
                self.assertEqual(text, f"The cases change: d {sign}2.50 in {labels[moved]}." if moved else "", (apply, moved))

    def test_the_limits_of_an_output_and_of_its_magnitude_are_on_the_sides_that_they_allow(self):
        """A value is allowed if it keeps every limit of |x| ≤ 3, and one of both limits of |x| ≥ 3."""
        self.open(pages.made_up("plain"))
        for upper in (True, False):
            for magnitude in (True, False):
                limits = self.run_script("""const set = W.set(), output = set.outputs[0]; set.requirements = [{ ...set.requirements[0], limit: 3, upper: arguments[0], abs: arguments[1] }]; output.limits = [0];
                    return W.limits.of(set, output)""", upper, magnitude)
                self.assertEqual(len(limits), 1 + magnitude)
                for value in (-5, -3, -1, 0, 1, 3, 5):
                    size = abs(value) if magnitude else value
                    kept = [value <= one["value"] if one["upper"] else value >= one["value"] for one in limits]
                    self.assertEqual(all(kept) if upper else any(kept), size <= 3 if upper else size >= 3, (upper, magnitude, value))

    def test_a_nominal_base_that_does_not_turn_is_explained_by_mirror_images(self):
        """Only where the nominal rate is 0 up to rounding and every parameter of the two wings agrees but for its sign."""
        self.open(pages.made_up("plain"))
        told = lambda script: self.run_script("""const set = W.set(), [one, other] = set.wing.hinges, body = hinge => set.wing.bodies.find(each => set.wing.hinges[each.hinge] === hinge).name;
            set.wing_orders = [one, other].map(hinge => ({ wing: hinge.name, hinges: [hinge.name], orders: [], order_kinds: 0, without_latch: 0 }));
            set.inputs.scene = [1, -1].flatMap((sign, at) => [{ path: `hinges.${[one, other][at].name}.spring.scale`, label: '', unit: '', value: sign * 1.2, case_value: null }, { path: `bodies.${body([one, other][at])}.mass`, label: '', unit: 'kg', value: 3, case_value: null }]);
            Object.assign(set.outputs[0], { name: 'base.peak_rate', nominal: 2e-14, min: 0, max: 0.12 }); """ + script + """ W.outputs();
            return [...document.querySelectorAll('#outputs .note')].map(one => one.textContent).filter(text => text.includes('mirror'))""")
        self.assertEqual(len(told("")), 1)
        self.assertEqual(told("set.outputs[0].nominal = 1e-3;"), [])
        self.assertEqual(told("set.inputs.scene[1].value = 3.1;"), [])
        self.assertEqual(told("set.inputs.scene[2].case_value = 1.1;"), [])

    def test_the_selected_case_gives_the_numbers_of_a_warning(self):
        self.open(pages.made_up("cases"))
        self.run_script("W.sets.forEach((set, at) => set.warnings = [`jump of ${at + 5} %`]); W.choose('set', 1)")
        label = self.run_script("return W.set().label")
        self.assertIn(f"jump of 6 % (every case; numbers of {label})", self.one("#verdicts .warnings").text)

    def test_the_worst_run_of_a_case_names_its_case(self):
        self.open(pages.made_up("cases"))
        for label, names in self.run_script("return W.sets.map(set => [set.label, set.motions.map(one => one.label)])"):
            worst = [name for name in names if name.startswith("worst")]
            self.assertTrue(worst)
            for name in worst:
                self.assertEqual(name, f"worst in {label}: root peak moment")

    def test_static_margins_that_are_too_low_are_in_the_first_screen(self):
        """The lowest of all cases, in which cases, and that no requirement asks for them; nothing where all are high enough."""
        self.open(pages.made_up("cases"))
        level = lambda low: self.run_script("""W.sets.forEach(set => set.static_margins.hinges.forEach(one => Object.assign(one, { least: 0.5, lower: 0.25, required: 0 })));
            for (const [at, hinge, least, lower] of arguments[0]) Object.assign(W.sets[at].static_margins.hinges[hinge], { least, lower });
            W.outcomes(); W.why(); return [...document.querySelectorAll('#verdicts .static-shortfall')].map(one => one.textContent)""", low)
        self.assertEqual(level([]), [])
        (text,) = level([(0, 1, -0.48, -0.616), (1, 1, 0.1, -0.16), (1, 2, 0.1, -0.05)])
        self.assertIn("of 2 hinges are below the required 0 in cold and ambient (each in at least one of them); in cold also those of the nominal wing", text)
        self.assertIn("Lowest: −0.62 in cold (1 % quantile over 1,000 draws)", text)
        self.assertIn("They are no requirement", text)
        self.assertIn("ECSS-E-ST-33-01C", text)
        part = self.one("#" + self.one(".static-shortfall a").get_attribute("href").partition("#")[2]).text
        self.assertIn("Lowest in cold: −0.62; then ambient −0.16, hot 0.25.", part)
        self.assertIn("ECSS-E-ST-33-01C (6 March 2009)", part)
        self.run_script("W.sets[0].requirements[0].static_margin = true; W.outcomes()")
        self.assertNotIn("They are no requirement", self.one(".static-shortfall").text)
        among = lambda count: self.run_script("W.sets.length = arguments[0]; W.why(); return document.querySelector('#why').textContent.match(/Lowest in [^:]+: .+? The picture/g)", count)
        self.assertEqual((among(2), among(1)), (["Lowest in cold: −0.62; then ambient −0.16. The picture"], None))

    def test_angles_follow_the_choice_everywhere(self):
        """Units of the accuracy table, the glossary and the modes; their numbers differ by the factor."""
        self.open(pages.made_up("plain"))
        found = {}
        for unit in ("deg", "rad"):
            self.run_script("""W.set().modes = { wing: W.set().wing, rest: W.set().wing.hinges.map(() => 0), modes: [{ frequency: 1, damping_ratio: 0.01, shape: W.set().wing.hinges.map(() => 1), base: null }] };
                const select = document.getElementById('angles'); select.value = arguments[0]; select.dispatchEvent(new Event('change'))""", unit)
            (row,) = [row for row in self.table("Numerical and statistical error of each output") if row[0] == "root latch rate"]
            self.assertEqual(row[1], f"{unit}/s")
            units = {row[1] for row in self.table("Meaning, unit and sign of every name")}
            self.assertFalse(units & {"rad": {"deg", "deg/s"}, "deg": {"rad", "rad/s"}}[unit], units)
            note = self.run_script("return document.querySelector('figure.mode > .note').textContent")
            self.assertTrue(note.endswith(f" {unit}."), note)
            found[unit] = (parsed(row[2])[0], parsed(note)[-1])
        for (degrees, near), (radians, _) in zip(found["deg"], found["rad"]):
            self.assertAlmostEqual(degrees / math.degrees(radians), 1, delta=0.1)

    def test_dispersions_by_chance_and_rounding_noise(self):
        self.open(pages.made_up("plain"))
        tested = self.run_script("return W.set().inputs.dispersions.length")
        note = self.run_script("return document.querySelector('figure.tornado > .note').textContent")
        self.assertRegex(note, rf"95 % .* none of the {tested} dispersions had an effect, about ")
        self.assertAlmostEqual(parsed(note)[2][0], 0.05 * tested, delta=0.01 * tested)
        self.run_script("W.set().outputs[0].nominal = 1e-13 * W.set().outputs[0].max; W.set().outputs[1].nominal = 1e-6 * W.set().outputs[1].min; W.outputs()")
        rows = self.table("Outputs of mock_wing")
        self.assertEqual(rows[0][4], "0")
        self.assertNotEqual(parsed(rows[1][4])[0][0], 0)

    def test_what_a_bound_bounds_is_said(self):
        """The column of bounds, the dispersions without a visible effect, the share of runs with a larger error."""
        self.open(pages.made_up("plain"))
        heads = lambda: self.run_script("return [...document.querySelectorAll('table.requirements thead th')].map(one => one.textContent)")
        self.assertIn("One-sided 90 % bound", heads())
        self.run_script("""const set = W.set(); set.requirements[0].confidence = 0.8; set.sensitivity.idle = ['tip.harness'];
            set.accuracy.beyond_largest = { runs: 0, share_at_most: 0.259 }; W.outcomes(); W.why()""")
        self.assertIn("One-sided bound", heads())
        repeated = self.run_script("return W.set().accuracy.runs")
        self.assertIn(f"As only {repeated} runs were repeated, up to 25.9 % of all runs may have a larger error than the largest of these (95 % confidence);", self.one("#verdicts").text)
        self.assertRegex(self.one("#why").text, r"tip\.harness\. .*95 % confidence for all outputs together \(Bonferroni\)")

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

    def test_the_case_as_a_cause(self):
        """The shift between the cases against the spread inside them: the sentence, the table and the finding."""
        self.open(pages.made_up("cases"))
        sets = self.run_script("return W.sets")
        for name in ("deployment_time", "root.latch_time"):
            self.run_script("W.choose('output', arguments[0])", name)
            outputs = [next(one for one in each["outputs"] if one["name"] == name) for each in sets]
            between = statistics.pvariance([one["mean"] for one in outputs])
            inside = statistics.mean(one["std"] ** 2 for one in outputs)
            low, high = (pick(outputs, key=lambda one: one["mean"]) for pick in (min, max))
            sentence = self.all("#why .effects")[0].text
            self.check(sentence, low["mean"], high["mean"], 100 * between / (between + inside), math.sqrt(inside), about=name)
            self.assertRegex(sentence, "between the cases; .*pooled over the cases")
            for one in (low, high):
                self.assertIn(f"in {sets[outputs.index(one)]['label']}", sentence)
            rows = self.table(f"Between the cases and inside them: {self.run_script('return W.format.nameOf(arguments[0])', name)}")
            quantiles = [one["quantiles"][-1]["value"] for one in outputs]
            for row, each, one, quantile in zip(rows, sets, outputs, quantiles, strict=True):
                self.assertEqual(row[0], each["label"])
                first = one is outputs[0]
                for cell, value in zip(row[1:], (one["mean"], None if first else one["mean"] - outputs[0]["mean"], one["std"], quantile, None if first else quantile - quantiles[0]), strict=True):
                    self.check(cell.replace("+", ""), value, about=f"{name} of {row[0]}")
            self.assertEqual(len({text.partition(".")[2].__len__() for row in rows for text in row[1:] if text != "–"}), 1)  # as many decimals everywhere
        self.open(pages.made_up("loads"))
        for item in self.all(".findings li"):
            self.assertRegex(item.text, r"Mean by case: cold \S+, hot \S+ ")
        self.open(pages.made_up("plain"))
        self.assertNotIn("The case", self.page_text("#why"))

    def test_cases_of_another_folder_are_no_cause(self):
        self.open(pages.made_up("cases"))
        for folder, others in ((1, 2), (0, 3)):
            labels = self.run_script("""W.sets[2].campaign_folder = arguments[0];
                return [...W.caseTable(W.sets[0], 'root.latch_time').querySelectorAll('tbody tr')].map(row => row.cells[0].textContent)""", folder)
            self.assertEqual(labels, ["cold", "ambient", "hot"][:others], folder)
            self.assertEqual(self.run_script("return !!W.caseEffect(W.sets[2], 'root.latch_time')"), others == 3, folder)

    def test_assumptions_are_those_of_the_scene(self):
        self.open(pages.made_up("plain"))
        text = self.one(".assumptions").text
        for words in ("parallel", "one plane", "Bodies are rigid.", "No hinge has a stop", "have no mass"):
            self.assertIn(words, text)
        self.run_script("""W.set().inputs.scene.push({ path: 'bodies.panel_1.flexible.stiffness', label: '', value: 1, unit: '' }, { path: 'hinges.mid.stop.stiffness', label: '', value: 1, unit: '' });
            W.outcomes()""")
        self.assertRegex(self.one(".assumptions").text, r"rigid, but for panel_1, which bend.*the stops of mid")
        self.assertIn("Assumptions of the model", self.run_script("return document.querySelector('.contents').textContent"))
