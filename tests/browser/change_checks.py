"""What would make a failed requirement pass, loads that no requirement limits, inputs in plain words, tables and gaps: as the data have them."""

import math
import re

import pages
from number_checks import parsed

LEVERS = """const lever = more => ({ words: "tip latch damping", draws: ["tip_latch"], scaled: true, unit: "", now: 1.04, change: 0.4137, lower: 0.3912, upper: 0.4406,
        least: 0.29, most: 2.67, known: true, beyond_runs: 21, beyond_undeployed: 0, of_broken: 1.31, of_others: 0.97, command: "wingspread margin results/mock/campaign.json --scale hinges.tip.latch.damping --range 0.05 1.3 --out results/margin", ...more }),
    far = lever({ words: "root spring", draws: ["root.spring"], change: 1.7312, lower: 1.62, upper: 1.84, least: 0.88, most: 1.12, known: false, upper: null, beyond_runs: 3, beyond_undeployed: 2, command: null }),
    warm = lever({ words: "temperature", draws: ["temperature"], scaled: false, now: 20, change: -7.5, lower: -9, upper: -6, least: -15, most: 15, command: null });
"""


class ChangeChecks:
    def opened_with(self, script, kind="loads"):
        self.open(pages.made_up(kind))
        self.run_script("window.sets = JSON.stringify(W.sets)")
        self.run_script(LEVERS + script + "W.outcomes();")

    def again_with(self, script):
        """The page that `opened_with` opened, with the data that it had, changed by another script."""
        self.run_script("JSON.parse(window.sets).forEach((set, at) => { Object.keys(W.sets[at]).forEach(key => delete W.sets[at][key]); Object.assign(W.sets[at], set); });" +
                        LEVERS + script + "W.outcomes();")

    def test_a_failed_requirement_says_what_would_make_it_pass(self):
        """Each change with its bounds and the values drawn; beyond them it says so; the distance that is lacking, and the command."""
        self.opened_with("""W.sets.forEach(set => set.requirements.forEach(one => one.changes = one.verdict === "failed" && one.beyond ?
            [{ for: "limit", runs: 1234, explained: 0.8567, levers: [lever(), warm, far] }] : []));""")
        item = self.one(".findings li")
        rows = self.run_script("return [...arguments[0].querySelectorAll('.needed-table tbody tr')].map(row => [...row.cells].map(cell => cell.textContent))", item)
        self.assertEqual(rows, [["tip latch damping", "× 0.41", "× 0.39 – 0.44", "× 0.29 – 2.67", "21 runs, deployed"],
                                ["temperature", "20.0 → 12.5", "11.0 – 14.0", "5.00 – 35.0", "21 runs, deployed"],
                                ["root spring", "not known", "beyond × 1.62", "× 0.88 – 1.12", "3 runs, 2 not deployed"]])
        self.assertEqual(self.run_script("return arguments[0].querySelector('.needed-table th span').title", item), "tip_latch")
        for words in ("Estimated changes, each alone, not yet run: confirm them first.", "An estimate from 1,234 runs", "86 % of the spread", "Not known: the runs are too few"):
            self.assertIn(words, item.text)
        self.assertEqual(self.run_script("return arguments[0].querySelector('.needed details').open", item), True)
        folded = self.run_script("return arguments[0].querySelector('.needed details').textContent", item)
        self.assertIn("--scale hinges.tip.latch.damping --range 0.05 1.3", folded)
        self.assertIn("Static margins are not among them", folded)
        one = self.run_script("return W.verdicts.judged().find(row => row.requirement.verdict === 'failed' && row.requirement.beyond).requirement")
        if one["margin"] is not None:
            by = parsed(re.search(r"must (?:fall|rise) by ([\d.,]+)", item.text)[1])[0]
            factor = self.run_script("return W.format.shown(W.verdicts.unitOf(arguments[0], W.set())).factor", one)
            self.assertAlmostEqual(by[0], -one["margin"] * factor, delta=by[1])
            self.assertIn("must fall by" if one["upper"] else "must rise by", item.text)

    def test_bounds_that_lie_close_show_their_distance(self):
        """As many decimals as one digit of the distance needs, of factors and of means; equal bounds need none more."""
        self.opened_with("""const close = [lever({ lower: 0.8381, upper: 0.8419 }), lever({ lower: 0.8381, upper: 0.8381 }),
            lever({ ...warm, lower: -7.52, upper: -7.48 })];
            W.sets.forEach(set => set.requirements.forEach(one => one.changes = one.verdict === "failed" && one.beyond ?
            [{ for: "limit", runs: 1234, explained: 0.8567, levers: close }] : []));""")
        bounds = self.run_script("return [...arguments[0].querySelectorAll('.needed-table tbody tr')].map(row => row.cells[2].textContent)",
                                 self.one(".findings li"))
        self.assertEqual(bounds, ["× 0.838 – 0.842", "× 0.84 – 0.84", "12.48 – 12.52"])

    def test_where_margin_can_make_no_change_there_is_no_command(self):
        self.opened_with("""W.sets.forEach(set => set.requirements.forEach(one => one.changes = one.verdict === "failed" && one.beyond ?
            [{ for: "limit", runs: 1234, explained: 0.8567, levers: [warm] }] : []));""")
        item = self.one(".findings li")
        self.assertEqual(self.run_script("return [...arguments[0].querySelectorAll('.needed-table tbody tr')].map(row => row.cells[1].textContent)", item), ["20.0 → 12.5"])
        self.assertIn("An estimated change, not yet run: confirm it first.", item.text)
        self.assertNotIn("wingspread margin", self.run_script("return arguments[0].textContent", item))

    def test_means_by_case_in_both_units_of_angles(self):
        self.open(pages.made_up("loads"))
        for unit, factor in (("rad", 1), ("deg", 180 / math.pi)):
            self.run_script("W.choose('angles', arguments[0])", unit)
            for name, (of_unit, times) in {"root.latch_rate": (f"{unit}/s", factor), "root.peak_moment": ("N·m", 1)}.items():
                said, means = self.run_script("return [W.caseMeans(W.set(), arguments[0]), W.sets.map(set => set.outputs.find(one => one.name === arguments[0]).mean)]", name)
                self.assertTrue(said.endswith(f" {of_unit}. "), said)
                self.check(said.partition(":")[2], *(mean * times for mean in means), about=said)

    def test_without_an_estimate_it_says_why(self):
        """Too few runs; no input that is enough; no run that deploys."""
        self.opened_with("")
        given = lambda block, more="": self.again_with(
            "W.sets.forEach(set => set.requirements.forEach(one => one.changes = one.verdict === 'failed' && one.beyond ? [" + block + "] : []));" + more)
        given('{ for: "limit", runs: 0, explained: null, levers: [] }')
        draws = self.run_script("return W.set().inputs.dispersions.length")
        self.assertIn(f"Too few runs to estimate what would change it: {draws} dispersions, so at least {draws + 11} runs", self.one(".findings .needed").text)
        given('{ for: "limit", runs: 500, explained: 0.1, levers: [] }')
        self.assertIn("a linear fit explains 10 % of the spread. Ask wingspread margin.", self.one(".findings .needed").text)
        given('{ for: "limit", runs: 500, explained: -0.0054, levers: [] }')
        self.assertIn("a linear fit explains nothing of the spread. Ask wingspread margin.", self.one(".findings .needed").text)
        given('{ for: "limit", runs: 500, explained: 0.5, levers: [] }')
        self.assertIn("No change of a dispersed input within the values drawn is seen to be enough", self.one(".findings .needed").text)
        given('{ for: "limit", runs: 500, explained: 0.9, levers: [far] }')
        self.assertIn("An estimated change, not yet run: confirm it first.", self.one(".findings .needed").text)

    def test_wings_that_do_not_deploy_have_a_finding_too(self):
        """Once for each set: what the runs that did not deploy differ in."""
        self.opened_with("""W.sets.forEach(set => set.requirements.forEach(one => { if (one.not_deployed) Object.assign(one, { verdict: "failed", allowed: 3,
            changes: [{ for: "deployment", runs: 900, explained: 0.2, levers: [lever()] }] }); }));""", "stalls")
        items = self.all(".findings.stalls li")
        sets = self.run_script("return W.sets.filter(set => set.requirements.some(one => one.not_deployed)).map(set => [set.runs, set.requirements.find(one => one.not_deployed).not_deployed])")
        self.assertTrue(sets)
        self.assertEqual(len(items), len(sets))
        for item, (runs, count) in zip(items, sets):
            self.assertIn(f"{count:,} of {runs:,} runs", item.text)
            self.assertIn("did not deploy, where at most 3 may", item.text)
            self.assertIn("× 1.31 / × 0.97", item.text)

    def test_a_margin_study_of_the_page_answers_in_its_place(self):
        """Only if it judged every requirement of the set, with its limit and in its case, and runs of another seed confirm it."""
        of_margin = lambda more: """W.sets.forEach(set => set.requirements.forEach(one => one.changes = [{ for: "limit", runs: 900, explained: 0.9, levers: [lever()] }]));
            W.studySets.splice(0, 9, { label: "results/margin", campaign: W.set().campaign, margin: { window: [1.096, 1.58], why_none: null, not_confirmed: null,
                requirements: W.sets.flatMap(set => set.requirements.map(one => ({ text: `${one.text} · ${set.case}` }))) } });
            const margin = W.studySets[0].margin;""" + more
        self.opened_with("")
        shown = lambda more: (self.again_with(of_margin(more)), self.one(".findings .needed").text, len(self.all(".needed-table")))[1:]
        answer = "All requirements pass with the inputs of results/margin scaled "
        for window, words in (("[1.096, 1.58]", "from 1.096 to 1.580"), ("[1.096, null]", "by 1.096 and more"), ("[null, 1.146]", "by 1.146 and less")):
            text, tables = shown(f"margin.window = {window};")
            self.assertIn(answer + words + ":", text)
            self.assertEqual(tables, 0)
        for more in ("margin.requirements.forEach(one => one.text = one.text.replace('≤ 1', '≤ 2'));", "margin.requirements = margin.requirements.filter(one => !one.text.startsWith('D-1'));", "margin.not_confirmed = 'not met: L-1';",
                     "margin.why_none = 'it is too narrow';", "margin.requirements.forEach(one => one.text = one.text.split(' · ')[0]);", "W.studySets[0].campaign = 'another';"):
            text, tables = shown(more)
            self.assertNotIn("All requirements pass", text, more)
            self.assertGreater(tables, 0, more)

    def test_a_change_of_a_latch_that_makes_the_peak_says_so(self):
        """Where the damping's jump is most of the hinge's nominal peak; not for a hinge whose latch has none."""
        self.opened_with("")
        given = lambda jumps: (self.again_with("""W.sets.forEach(set => { set.latch_jumps = """ + jumps + """; set.inputs.dispersions.push({ draw: "tip_latch", words: "tip latch damping", paths: ["hinges.tip.latch.damping"], apply: "scale", law: "", low: 0, high: 1, median: 1 });
            set.requirements.forEach(one => one.changes = [{ for: "limit", runs: 900, explained: 0.9, levers: [lever()] }]); });"""), [one.text for one in self.all(".findings .caution")])[1]
        (text, *_) = given('[{ hinge: "tip", moment: 9.9, peak: 10 }]')
        self.assertEqual(text, "May be an artefact of the latch law: the jump of damping times rate as the latch engages makes 99 % of the nominal peak moment of tip. Measure the damping, or give “dissipation”.")
        self.assertEqual(given('[{ hinge: "root", moment: 9.9, peak: 10 }]'), [])

    def test_a_change_that_takes_torque_warns_of_static_margins_and_deployment(self):
        """Weaker springs, more friction, stiffer harness, stronger dampers; not the other way."""
        self.opened_with("")
        told = lambda path, change: (self.again_with(f"""W.sets.forEach(set => {{ (set.static_margins.hinges || []).forEach(one => Object.assign(one, {{ least: 0.2, lower: 0.1, required: 0 }}));
            set.inputs.dispersions.push({{ draw: "tip_latch", words: "", paths: ["hinges.tip.{path}"], apply: "scale", law: "", low: 0, high: 1, median: 1 }});
            set.requirements.forEach(one => one.changes = [{{ for: "limit", runs: 900, explained: 0.9, levers: [lever({{ change: {change} }})] }}]); }}); W.sets[0].static_margins.hinges[0].lower = -0.61; """), self.all(".findings .caution"))[1]
        first = lambda path, change: next((one.text for one in told(path, change)), None)
        label = lambda: self.run_script("return W.sets[0].label")
        self.assertEqual(first("spring.scale", 0.63), f"Weaker springs lower the static margins (lowest now: −0.61 in {label()}) and can keep the wing from deploying.")
        self.assertIsNone(first("spring.scale", 1.3))
        self.assertRegex(first("friction.scale", 2), "^More friction would lower the static margins .* and can keep the wing from deploying")
        self.assertIsNone(first("friction.scale", 0.5))
        self.assertRegex(first("harness.scale", 2), "^A stiffer harness would lower the static margins")
        self.assertEqual(first("damper.peak_torque", 1.4), "A stronger damper slows the deployment. Static margins count it only at a stated rate.")
        self.assertIsNone(first("damper.peak_torque", 0.7))
        self.assertRegex(first("motor.torque_limit", 0.5), "^A slower or weaker motor can lower the static margins .* and keep the wing from deploying")
        self.assertIsNone(first("motor.torque_limit", 1.5))

    def test_a_value_that_draws_replace_starts_from_their_median(self):
        """The scene's value is in no run where draws set it; where they scale it, it is the value before the change."""
        start = lambda apply: (self.opened_with(f"""W.sets.forEach(set => {{ set.inputs.dispersions = [{{ draw: "tip_latch", words: "tip latch damping", paths: ["hinges.tip.latch.damping"], apply: "{apply}", law: "", low: 0, high: 1, median: 0.11, nominal: 0.1, nominal_unit: "N·m" }}];
            set.requirements.forEach(one => one.changes = [{{ for: "limit", runs: 900, explained: 0.9, levers: [lever()] }}]); }});"""), self.one(".needed-table th small.faint").text)[1]
        self.assertEqual(start("set").strip(), "0.11 → 0.046 N·m")
        self.assertEqual(start("scale").strip(), "0.1 → 0.041 N·m")

    def test_other_cases_that_fail_say_whether_the_change_is_enough(self):
        self.open(pages.made_up("cases"))
        cells = self.run_script(LEVERS + """const failed = W.sets[0].requirements.find(one => one.limit !== null && !one.static_margin);
            W.sets.forEach((set, at) => set.requirements = [{ ...failed, verdict: "failed", beyond: 100, broken: 100, not_deployed: 0, margin: -1 - (at === 0), changes: [{ for: "limit", runs: 900, explained: 0.9,
                levers: [lever(), warm, far], needs: [{ draws: ["tip_latch"], change: [0, 0.6, 0.3][at] }, { draws: ["temperature"], change: [0, -9, 3][at] }, ...(at === 1 ? [{ draws: ["root.spring"], change: 1.7 }] : [])] }] }]);
            W.outcomes(); return [...document.querySelectorAll('.findings .needed-table tbody tr')].map(row => row.lastChild.textContent.replace(/\u00a0/g, " "))""")
        b, c = self.run_script("return W.sets.slice(1).map(set => set.label)")
        self.assertEqual(cells, [f"enough for {b} too (needs × 0.60); {c} needs × 0.30", f"{b} needs 11.0; {c} needs 23.0", f"{b} needs × 1.70; {c}: not estimated"])

    def test_loads_that_no_requirement_limits_are_told_in_one_line(self):
        """The largest values are named as reached, not as limits; a mirror image too, if it reaches nearly as much."""
        self.opened_with("""W.sets.forEach((set, at) => set.unjudged = [{ output: "tip.peak_moment", largest: 3000 + at, judged: "root.peak_moment", judged_largest: 12.25 }]);""", "cases")
        (text,) = [one.text for one in self.all(".unjudged")]
        sets = self.run_script("return W.sets.map(set => set.label)")
        self.assertEqual(text, f"Without a requirement: tip peak moment reaches {2999 + len(sets)} N·m in {sets[-1]}; the largest of its kind with one, root peak moment, reaches 12.3 N·m.")
        mirror = lambda largest: self.run_script("""W.sets.forEach((set, at) => { set.unjudged = []; set.wing_orders = ["root", "tip"].map(name => ({ wing: name, hinges: [name], orders: [], order_kinds: 0, without_latch: 0 }));
            const [judged, other] = ["root", "tip"].map(name => set.outputs.find(one => one.name === name + ".peak_moment"));
            Object.assign(judged, { min: 0, max: 10, limits: [0] }); Object.assign(other, { min: 0, max: at ? 0 : arguments[0], limits: [] }); });
            W.outcomes(); return [...document.querySelectorAll('.unjudged')].map(one => one.textContent)""", largest)
        self.assertEqual(mirror(9.5), [f"Without a requirement: tip peak moment reaches 9.50 N·m in {sets[0]}; its mirror image root peak moment, which has one, reaches 10.0 N·m."])
        self.assertEqual(mirror(8.5), [])

    def test_a_hinge_and_its_mirror_image_are_each_other_s(self):
        """Of two wings with as many hinges, in any order; of other wings no hinge has one."""
        self.open(pages.made_up("plain"))
        mirrored = lambda wings, hinges: self.run_script("""const set = { wing_orders: arguments[0].map(hinges => ({ wing: hinges[0], hinges })) };
            return arguments[1].map(hinge => W.mirrored(set, `${hinge}.peak_force`))""", wings, hinges)
        for one, other in ((["a"], ["b"]), (["a", "b"], ["c", "d"]), (["d.x", "b", "a"], ["c", "a.x", "b.x"])):
            self.assertEqual(mirrored([one, other], [*one, *other, "none"]), [*(f"{hinge}.peak_force" for hinge in [*other, *one]), None])
            for wings in ([one], [one, [*other, "more"]], [[*one, "more"], other], [one, other, ["third"]]):
                self.assertEqual(mirrored(wings, [*one, *other]), [None] * (len(one) + len(other)), wings)

    def test_of_mirror_images_each_is_told_where_the_other_is_judged(self):
        self.open(pages.made_up("cases"))
        for judged, other in (("root", "tip"), ("tip", "root")):
            (text,) = self.run_script("""W.sets.forEach(set => { set.unjudged = []; set.wing_orders = ["root", "tip"].map(name => ({ wing: name, hinges: [name], orders: [], order_kinds: 0, without_latch: 0 }));
                const [judged, other] = [...arguments].map(name => set.outputs.find(one => one.name === name + ".peak_moment"));
                Object.assign(judged, { min: 0, max: 10, limits: [0] }); Object.assign(other, { min: -9.5, max: 0, limits: [] }); });
                W.outcomes(); return [...document.querySelectorAll('.unjudged')].map(one => one.textContent)""", judged, other)
            self.assertIn(f"{other} peak moment reaches 9.50 N·m", text)
            self.assertIn(f"its mirror image {judged} peak moment, which has one, reaches 10.0 N·m", text)

    def test_dispersions_are_named_in_words(self):
        """In the tornado and the inputs; two with the same words keep their names; the name stays in the inputs."""
        self.open(pages.made_up("plain"))
        effects = self.run_script("const set = W.set(); return set.sensitivity.effects.filter(one => one.output === W.chosen.output).map(one => one.draw)")
        self.run_script("""W.set().inputs.dispersions.forEach((one, at) => one.words = at < 2 ? "the same" : `words ${at}`); W.why(); W.inputs()""")
        words = self.run_script("return arguments[0].map(draw => W.wordsOfDraw(W.set(), draw))", effects)
        labels = self.run_script("return [...document.querySelectorAll('figure.tornado svg text title')].map(one => one.textContent)")
        for each in words:
            self.assertIn(each, labels)
        same = self.run_script("return W.set().inputs.dispersions.slice(0, 2).map(one => [one.draw, W.wordsOfDraw(W.set(), one.draw)])")
        for draw, text in same:
            self.assertEqual(text, f"the same ({draw})")
        for row, draw in zip(self.table(f"Dispersions of {self.run_script('return W.set().label')}"), self.run_script("return W.set().inputs.dispersions.map(one => one.draw)")):
            self.assertTrue(row[0].endswith(draw), row[0])

    def test_what_a_case_does_through_tables(self):
        self.open(pages.made_up("cases"))
        self.run_script("""W.sets.forEach((set, at) => set.inputs.dispersions.push({ draw: "temperature", words: "temperature", paths: [], law: "normal", low: 0, high: 1, median: [-60, 20, 60][at],
            tables: [{ words: "friction of all hinges", paths: ["hinges.*.friction.scale"], apply: "scale", unit: "", at: [-70, 20, 70], value: [2.2, 1, 0.9], of_median: [2.05, 1, 0.92][at] }] })); W.inputs()""")
        self.assertEqual(self.table("What temperature changes, at its median"), [["friction of all hinges", "× 2.05", "× 1.00", "× 0.920", "−70: 2.2 · 20: 1 · 70: 0.9"]])

    def test_tables_of_a_draw_are_found_by_what_they_act_on(self):
        """A folder's draw may have fewer tables, in another order, and other values."""
        self.open(pages.made_up("cases"))
        self.run_script("""const table = (hinge, value, of_median, apply = "scale") => ({ words: `friction of ${hinge}`, paths: [`hinges.${hinge}.friction.scale`], apply, unit: "", at: [-70, 20], value, of_median });
            W.sets.forEach((set, at) => set.inputs.dispersions.push({ draw: "temperature", words: "temperature", paths: [], law: "normal", low: 0, high: 1, median: 20,
                tables: [[table("root", [2, 1], 1), table("tip", [3, 1], 1.5)], [table("tip", [4, 1], 2)], [table("tip", [3, 1], 1.5), table("root", [2, 1], 1, "set")]][at] })); W.inputs()""")
        self.assertEqual(self.table("What temperature changes, at its median"), [
            ["friction of root", "× 1.00", "–", "–", "cold: −70: 2 · 20: 1ambient and hot: –"],
            ["friction of tip", "× 1.50", "× 2.00", "× 1.50", "cold and hot: −70: 3 · 20: 1ambient: −70: 4 · 20: 1"],
            ["friction of root", "–", "–", "1.00", "cold and ambient: –hot: −70: 2 · 20: 1"]])
        self.assertNotIn("could not be drawn", self.one("#inputs").text)

    def test_folders_with_other_nominal_values_show_their_own(self):
        """A scene lists no zeros: a set that lacks the parameter has 0, or no such parameter."""
        self.open(pages.made_up("cases"))
        shown = lambda *nominals, same="hinges.root.latch.stiffness": (self.run_script("""W.sets.forEach((set, at) => set.inputs.scene = [{ path: arguments[1], label: "same", value: 1, unit: "", case_value: null },
            ...(arguments[0][at] === null ? [] : [{ path: "hinges.root.latch.damping", label: "damping", value: arguments[0][at], unit: "", case_value: at ? null : 50 }])]); W.inputs()""", nominals, same),
            self.table("Changes of the nominal scene by case"))[1]
        self.assertEqual(shown(100, 500, 100), [["damping", "", "by folder", "50", "500", "100"]])
        self.assertEqual(shown(100, None, 100), [["damping", "", "by folder", "50", "0 or none", "100"]])
        self.assertEqual(shown(100, None, 100, same="bodies.root.mass"), [["damping", "", "by folder", "50", "–", "100"]])  # no such hinge
        differing = lambda path: (self.run_script("""W.sets[1].inputs.scene = [{ path: "bodies.yoke.mass", label: "yoke mass", value: 10, unit: "kg", case_value: null }]; W.sets[0].inputs.scene = [{ ...W.sets[1].inputs.scene[0], path: arguments[0], label: "other", value: 2 }];
            document.body.append(W.h("div.own", W.designs([{ sets: [0, 1] }])))""", path), dict((row[0], row[2:4]) for row in self.run_script("const own = document.querySelector('.own'), rows = [...[...own.querySelectorAll('table')].pop().tBodies[0].rows].map(row => [...row.cells].map(cell => cell.textContent)); own.remove(); return rows")))[1]
        self.assertEqual(differing("bodies.yoke.inertia")["yoke mass"], ["0 or none", "10"])
        self.assertEqual(differing("bodies.panel.mass")["yoke mass"], ["–", "10"])
        self.assertEqual(shown(0, None, 0), [["damping", "", "0", "50", "as nominal", "as nominal"]])

    def test_an_order_has_its_gaps(self):
        self.open(pages.made_up("plain"))
        self.run_script("""W.set().orders.forEach((one, at) => one.gaps = at ? [] : [{ before: "root", after: "mid", least: 0.0312, median: 0.41 }, { before: "mid", after: "tip", least: 0.2, median: 1.25 }]); W.outcomes()""")
        rows = self.table("Latch orders")
        self.assertTrue(rows[0][0].endswith("gaps 0.41 s · 1.3 s (median), at least 31 ms · 0.20 s"), rows[0][0])
        self.assertNotIn("gaps", rows[1][0])
        self.run_script("W.set().orders[0].gaps.forEach(gap => gap.least /= 2000); W.outcomes()")
        self.assertIn("at least 16 µs · 0.10 ms", self.table("Latch orders")[0][0])
