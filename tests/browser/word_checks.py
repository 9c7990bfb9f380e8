"""Words and small tables that depend on what a set has: runs without rows, stalled hinges, orders of each wing, warnings, errors, titles, modes, correlations."""

import math
import re

import pages
from number_checks import DEGREES, parsed


class WordChecks:
    """For a Page with MarkChecks and FitPageChecks."""

    def verdicts(self, script, *arguments):
        """The first screen's text after a change of the data."""
        self.run_script(script + "; W.outcomes()", *arguments)
        return self.one("#verdicts").text

    def test_stalled_hinges_and_the_orders_of_each_wing(self):
        self.open(pages.made_up("stalls"))
        stalled = [{"hinge": "tip", "count": 1234, "median": 0.5, "least": -0.25, "largest": 1.75}, {"hinge": "root", "count": 2, "median": 0.125, "least": 0.0625, "largest": 0.1875}]
        self.run_script("W.set().stalled_at = arguments[0]; W.outcomes()", stalled)
        for unit, factor in (("deg", DEGREES), ("rad", 1)):
            self.angles(unit)
            caption = f"Where stalled hinges stopped: angle from the latched one, {unit}"
            self.assertEqual(self.heads(caption), ["Hinge", "Runs", "Median", "Least", "Largest"])
            for row, one in zip(self.table(caption), stalled, strict=True):
                self.assertEqual(row[0], one["hinge"])
                self.check(row[1], one["count"], about=row[0])
                for cell, key in zip(row[2:], ("median", "least", "largest"), strict=True):
                    self.check(cell, one[key] * factor, about=f"{key} of {row[0]}")
        gaps = [{"before": "root", "after": "tip", "least": 0.0005, "median": 0.25}]
        wings = [{"wing": "left", "hinges": ["left_root", "left_tip"], "order_kinds": 5, "without_latch": 12, "orders": [{"order": "left_root>left_tip", "count": 150, "gaps": gaps}, {"order": "left_tip>left_root", "count": 60}]},
                 {"wing": "right", "hinges": ["r1", "right"], "order_kinds": 2, "without_latch": 0, "orders": [{"order": "r1>right", "count": 200}, {"order": "right>r1", "count": 100}]}]
        total = self.run_script("const set = W.set(); set.wing_orders = arguments[0]; set.order_kinds = 1; W.outcomes(); return set.orders.reduce((sum, one) => sum + one.count, 0) + (set.orders.some(one => one.order === 'no latch') ? 0 : set.without_latch)", wings)
        self.assertEqual(total, 300)
        left = total - 150 - 60 - 12
        wanted = {"left": [("root › tipgaps 0.25 s (median), at least 0.50 ms", 150), ("tip › root", 60), ("3 other orders", left), ("no hinge latched", 12)], "right": [("r1 › right", 200), ("right › r1", 100)]}
        for wing, rows in wanted.items():
            self.assertEqual(self.heads(f"Wing {wing}"), ["Order", "Runs", "Share"])
            for row, (name, count) in zip(self.table(f"Wing {wing}"), rows, strict=True):
                self.assertEqual(row[0], name)
                self.check(row[1], count, about=name)
                self.check(row[2], count / total, share=True, about=name)
        self.assertEqual(self.run_script("return document.querySelector('small.gaps').title"), "root to tip")
        self.run_script("W.set().more_order_kinds = true; W.outcomes()")
        self.assertIn("other orders, or not told apart", [row[0] for row in self.table("Wing left")])
        self.assertTrue(any("more than 1 order" in text for text in self.run_script("return [...document.querySelectorAll('#verdicts summary')].map(one => one.textContent)")))
        self.run_script("delete W.set().more_order_kinds; W.outcomes()")
        self.assertIn("All wings together: 1 order", self.run_script("return [...document.querySelectorAll('#verdicts summary')].map(one => one.textContent)"))

    def test_runs_without_rows_say_what_they_lack(self):
        self.open(pages.made_up("cases"))
        labels = self.run_script("return W.sets.map(set => set.label)")
        names = self.run_script("return W.set().outputs.map(one => one.name)")
        draws = [f"d{k}" for k in range(14)]
        rows = [[None if (k, at) == (3, 0) else round(math.sin(1 + 3 * k + at), 3) for at in range(len(names))] for k in range(14)]
        self.run_script("""W.sets.forEach(set => { set.rows = false; set.sensitivity = null; set.scatters = []; set.outputs.forEach(one => one.convergence = null);
            set.correlations = { draws: arguments[0], outputs: arguments[1], pearson: arguments[2], spearman: arguments[2].map(row => row.map(() => null)) }; });
            W.outcomes(); W.outputs(); W.why(); W.convergence()""", draws, names, rows)
        self.run_script("W.choose('output', arguments[0])", names[0])
        pages.settle(self.driver)
        self.assertTrue(next(one.text for one in self.all("#verdicts .lead") if "--no-rows" in one.text).startswith(f"{', '.join(labels)}: run with --no-rows."))
        shown = self.run_script("return W.set().label")
        for section, part in (("why", "Rank correlations, their bounds and pictures of pairs need the rows"), ("convergence", "Convergence needs the rows")):
            self.assertIn(f"{part} of the runs, and {shown} was run with --no-rows.", self.one(f"#{section}").text)
        found = sorted(((draw, row[0]) for draw, row in zip(draws, rows) if row[0] is not None), key=lambda one: -abs(one[1]))[:12]
        self.same_rows("tornado", [list(one) for one in found])
        x = self.scale("tornado", "x")
        self.near(self.places("tornado", ".effect", "x", "width"), [(min(x(0), x(value)), abs(x(value) - x(0))) for _, value in found], "correlations")
        self.assertEqual([self.exported("tornado")[0], *self.run_script("return ['.axis-text', '.legend text', '.whisker'].map(s => [...document.querySelectorAll('figure.tornado ' + s)].map(e => e.textContent))")],
                         [["dispersion", "Pearson"], ["correlation"], ["Pearson"], []])
        self.assertEqual(self.run_script("return [...document.querySelectorAll('figure.histogram .legend text')].map(e => e.textContent)"), ["all runs"])
        self.assertNotIn("by latch order", self.run_script("return document.querySelector('figure.histogram desc').textContent"))
        self.run_script("W.sets.forEach(set => { set.rows = true; set.correlations.spearman = arguments[0]; }); W.sets[0].rows = false; W.outcomes(); W.outputs(); W.choose('set', 1)", rows)
        self.assertEqual(self.exported("tornado")[0], ["dispersion", "Spearman"])
        self.assertTrue(next(one.text for one in self.all("#verdicts .lead") if "--no-rows" in one.text).startswith(f"{labels[0]}: run with --no-rows."))
        self.assertIn("Colours show the latch order.", self.one("#outputs").text)

    def test_assumptions_name_what_bends_and_stops(self):
        self.open(pages.made_up("plain"))
        told = lambda *paths: self.run_script("W.set().inputs.scene = arguments[0].map(path => ({ path, label: '', value: 1, unit: '' })); W.outcomes(); return document.querySelector('.assumptions').textContent", list(paths))
        bodies = [f"bodies.p{k}.flexible.stiffness" for k in range(6)]
        self.assertIn("Bodies are rigid, but for p0, p1, p2 and 3 more, which bend", told(*bodies, bodies[0]))
        self.assertIn("Bodies are rigid, but for p0, p1, p2, p3, which bend", told(*bodies[:4]))
        self.assertIn("Elastic joints: a, b. ", told("hinges.a.joint.stiffness", "hinges.b.joint.damping", "hinges.a.joint.damping"))
        self.assertNotIn("Elastic joints", told("hinges.a.spring.scale"))
        self.assertIn("the stops of a:", told("hinges.a.stop.angle", "hinges.a.far_stop.angle"))
        self.assertIn("the stops of 2 hinges:", told("hinges.a.stop.angle", "hinges.b.far_stop.angle"))
        link = self.one(".assumptions a")
        self.assertEqual((link.text, link.get_attribute("href").partition("#")[2]), ("Inputs", "inputs"))

    def test_warnings_reasons_and_errors(self):
        self.open(pages.made_up("plain"))
        listed = lambda: self.run_script("return [...document.querySelectorAll('#verdicts .warnings > ul > li')].map(one => one.textContent)")
        words = [f"warning {'abcdefgh'[k]} of {k}" for k in range(8)]
        self.verdicts("W.set().warnings = arguments[0]", words)
        self.assertEqual(listed(), words[:6])
        self.assertEqual(self.run_script("return [...document.querySelectorAll('#verdicts .warnings details')].map(one => [one.querySelector('summary').textContent, [...one.querySelectorAll('li')].map(li => li.textContent)])"), [["2 more", words[6:]]])
        self.verdicts("W.set().warnings = ['jump of 5 %', 'jump of 6.5e-3 %', 'other']; Object.assign(W.set(), { runs: 1000, planned: 4000, stopped: false })")
        self.assertEqual(listed(), ["mock_wing holds 1,000 of 4,000 planned runs.", "jump of 5 %", "other"])
        for change, partial in (({"stopped": True}, False), ({"stopped": True, "partial": True}, True), ({"stopped": False, "partial": False, "planned": 1000}, False)):
            self.verdicts("Object.assign(W.set(), arguments[0]); W.set().warnings = []", change)
            self.assertEqual(listed(), ["mock_wing holds 1,000 of 4,000 planned runs."] if partial else [])
        self.assertIn("None.", self.one("#verdicts .warnings.none").text)
        limits = lambda kind: (self.run_script("Object.assign(W.set().sensitivity, { kind: arguments[0], warnings: ['the draws of \"a\" do not vary'] }); W.why()", kind), [one.text for one in self.all("#why .of-effects")])[1]
        self.assertEqual(limits("rank"), ["Warning: the draws of \"a\" do not vary."])
        self.assertEqual(limits("sobol"), [])  # those of indices are among the first page's warnings
        self.run_script("W.set().sensitivity.kind = 'rank'; W.set().sensitivity.warnings = []; W.why()")
        reasons = [("stalled", "energy: no hinge can reach its latch, lacks 3 … 5 J"), ("timed_out", ""), ("stalled", "every hinge sticks, and what loads it stays as it is"), ("failed", "mid … is stuck, lacks 2 J"), ("invalid", "e")]
        told = lambda count: self.run_script("W.set().reasons = arguments[0]; W.outcomes(); const one = [...document.querySelectorAll('#verdicts details')].find(each => /Why runs/.test(each.textContent)); return one ? [one.open, [...one.querySelectorAll('li')].map(li => li.textContent)] : null",
                                             [{"status": status, "reason": reason, "count": 1000 + at} for at, (status, reason) in enumerate(reasons[:count])])
        texts = ["1,000 stalled: no hinge can reach its latch: too little energy", "1,001 timed out: no reason given", "1,002 stalled: every hinge sticks, under loads that no longer change", "1,003 failed: mid … is stuck, lacks 2 J", "1,004 invalid: e"]
        for count in (0, 4, 5):
            self.assertEqual(told(count), [count == 4, texts[:count]] if count else None)
        accuracy = {"runs": 1, "method": "auto", "rtol": 1e-8, "reference_method": "dop853", "reference_rtol": 1e-12, "order_in_doubt": 2, "in_doubt": ["3 (order)", "17"], "beyond_largest": {"runs": 0, "share_at_most": 0.25},
                    "moved": {"runs": 3, "share_at_most": 0.125}, "unreached": 4, "outputs": [{"output": "root.latch_time", "largest": 0.5, "rms": 0.1, "standard_error": 0.125}, {"output": "tip.latch_time", "largest": 0.2, "rms": 0.1, "standard_error": 0}]}
        text = self.verdicts("W.set().accuracy = arguments[0]", accuracy)
        for words in ("1 run repeated with dop853 at rtol 1 × 10⁻¹² (the campaign: auto, 1 × 10⁻⁸).", "At worst (root latch time) the integration error is 4.0 times the standard error", "In 2 runs the outcome or the latch order is in doubt: 3 (order), 17.",
                      "As only 1 run was repeated, up to 25.0 % of all runs", "(95 % confidence)", "In 3 runs an output moves by more than 1 %: at most 12.5 % of all.", "4 runs could not be repeated."):
            self.assertIn(words, text)
        one = accuracy["outputs"][0]
        for change, words in (({"runs": 7}, "As only 7 runs were repeated"), ({"order_in_doubt": 0}, "In none of them the outcome or the latch order is in doubt."),
                              ({"outputs": [{**one, "standard_error": 4}]}, "the integration error is 8.0 times smaller than the standard error"),
                              ({"outputs": [{**one, "largest": 0}]}, "They agree to the last digit"), ({"outputs": [{**one, "largest": None}]}, "No runs were repeated at a tighter tolerance.")):
            self.assertIn(words, self.verdicts("W.set().accuracy = arguments[0]", {**accuracy, **change}))
        self.assertNotIn("moves by more than 1 %", self.verdicts("W.set().accuracy = arguments[0]", {**accuracy, "moved": {"runs": 0, "share_at_most": 0.1}}))
        self.assertNotIn("could not be repeated", self.verdicts("W.set().accuracy = arguments[0]", {**accuracy, "unreached": 0}))
        self.assertIn("Unknown: 16 runs could not be repeated", self.verdicts("W.set().accuracy = arguments[0]", {**accuracy, "runs": 0, "unreached": 16, "outputs": []}))

    def test_the_title_says_what_there_is(self):
        self.open(pages.made_up("cases"))
        title = lambda script: self.run_script(script + "; W.subtitle(); return [document.getElementById('title').textContent, document.title, ...['.wing-name', '.identity', '.description', '.facts'].map(s => document.querySelector('#subtitle ' + s)?.textContent ?? null)]")
        runs = "2,000 runs each"
        self.assertEqual(title("W.data.document = {}")[:3], ["mock_wing", "mock_wing · wingspread report", None])
        facts = title("")[5]
        self.assertIn("3 cases: cold, ambient, hot", facts)
        self.assertIn(runs, facts)
        self.assertIn("requirements at 90 % confidence, two-sided bounds at 95 %", facts)
        got = title("W.data.document = { title: 'Deployment', document: 'X-1', revision: 'B', date: '2026-01-02', author: 'A. B.', organisation: 'O' }; W.sets[2].campaign = 'other'")
        self.assertEqual(got[:4], ["Deployment", "Deployment", "Wing: mock_wing", "DocumentX-1RevisionBDate2026-01-02AuthorA. B.OrganisationO"])
        self.assertEqual(title("W.data.document = { author: 'me' }")[:4], ["mock_wing and other", "mock_wing and other · wingspread report", None, "Authorme"])
        facts = title("W.sets[0].runs = 1500; W.sets.forEach((set, at) => set.requirements.forEach((one, k) => one.confidence = at ? 0.95 : 0.8))")[5]
        self.assertIn("1,500 to 2,000 runs", facts)
        self.assertIn("requirements at 80 % and 95 % confidence, two-sided bounds at 95 %", facts)
        self.assertRegex(title("W.sets.forEach(set => set.requirements.forEach(one => one.confidence = 0.95))")[5], "[a-z]bounds at 95 %$")
        self.assertIn("stopped early: its goals were met (5,000 runs planned)", title("Object.assign(W.set(), { stopped: true, planned: 5000 })")[5])
        self.assertNotIn("interim", title("W.set().looks = 1")[5])
        self.assertIn("2 folders (A · x, B) of 2 cases (cold, hot)", title("W.sets.push({ ...W.sets[0] }); W.sets.forEach((set, at) => Object.assign(set, { case: at % 2 ? 'hot' : 'cold', campaign_folder: Math.floor(at / 2), label: `${at < 2 ? 'A · x' : 'B'} · ${at % 2 ? 'hot' : 'cold'}` }))")[5])
        self.assertIn("2 folders: B, C", title("W.sets.length = 2; W.sets.forEach((set, at) => Object.assign(set, { case: null, label: 'BC'[at] }))")[5])
        self.assertRegex(title("W.sets.length = 1; W.chosen.set = 0; W.sets[0].requirements = []")[5], r"^1,500 runsbounds at 95 %")
        self.assertIn("wingspread report results/mock (wingspread 0.2.0+mock)", self.run_script("return document.getElementById('colophon').textContent"))

    def test_modes_swing_at_one_period_in_two_seconds(self):
        self.open(pages.made_up("plain"))
        wing = self.run_script("const set = W.set(); return { ...set.wing, base: { kind: 'free', angle: 0.25 } }")
        modes = {"wing": wing, "rest": [0.1, -0.2, 0.05], "modes": [{"frequency": 0.34567, "damping_ratio": 0.0123, "shape": [1, 0.5, -0.25], "base": {"x": 0.1, "y": -0.2, "angle": 0.05}},
                                                                    {"frequency": 12.5, "damping_ratio": 0.5, "shape": [0, -1, 0.5], "base": None}]}
        self.run_script("W.set().modes = arguments[0]; W.modes()", modes)
        pages.settle(self.driver)
        drawn = lambda nth: self.run_script("return [...document.querySelectorAll('figure.mode')[arguments[0]].querySelectorAll('.pose')].map(pose => [pose.getAttribute('visibility'), [...pose.querySelectorAll('path')].map(e => e.getAttribute('d')).join()])", nth)
        outline = lambda one, size: self.run_script("""const [modes, mode, size] = arguments, P = W.pose, base = mode.base && { x: size * mode.base.x, y: size * mode.base.y, angle: 0.25 + size * mode.base.angle };
            return P.outlines(modes.wing, P.frames(modes.wing, modes.rest.map((angle, at) => angle + size * mode.shape[at]), base || undefined)).flat()""", modes, one, size)
        sizes = []
        for nth, one in enumerate(modes["modes"]):
            self.check(self.run_script("return document.querySelectorAll('figure.mode .caption')[arguments[0]].textContent", nth), nth + 1, one["frequency"], one["damping_ratio"], about="caption")
            heads, *rows = self.copied_from("mode", nth)
            self.assertEqual(heads, ["hinge", "rest deg", "shape"])
            for row, hinge, rest, shape in zip(rows, wing["hinges"], modes["rest"], one["shape"], strict=True):
                self.numbers_of(row, [hinge["name"], rest * DEGREES, shape], "mode")
            note = self.run_script("return document.querySelectorAll('figure.mode > .note')[arguments[0]].textContent", nth)
            (metres, half), (degrees, rounding) = parsed(note)
            rest = outline(one, 0)
            off = lambda size: max(math.dist(a, b) for a, b in zip(rest, outline(one, size)))
            size = min(0.4, 0.07 * wing["scale"] / (off(1e-4) / 1e-4))
            self.assertLessEqual(abs(metres - off(size)), half, note)
            self.assertLessEqual(abs(degrees - size * max(one["shape"], key=abs) * DEGREES) if max(one["shape"], key=abs) > 0 else 0, rounding, note)
            points = [[tuple(map(float, point.split(","))) for path in text.split(",M") for point in re.findall(r"[-\d.]+,[-\d.]+", path)] for _, text in drawn(nth)]
            bar, text = self.run_script("const bar = document.querySelectorAll('figure.mode')[arguments[0]].querySelector('.bar-of-length'); return [bar.querySelector('path').getAttribute('d'), bar.querySelector('text').textContent]", nth)
            pixels = float(re.search(r"H([\d.]+)", bar)[1]) / parsed(text)[0][0]
            for pose, amplitude in zip(points, (0, -size, size), strict=True):
                wanted = [(pixels * a, -pixels * b) for a, b in outline(one, amplitude)]
                first = [a - b for a, b in zip(points[0][0], (pixels * rest[0][0], -pixels * rest[0][1]))]
                self.near([[a - shift for a, shift in zip(point, first)] for point in pose], wanted, f"mode {nth}", 0.05)
            sizes.append((size, pixels, first))
        before = drawn(0)
        seen = self.driver.execute_async_script("""const done = arguments[0], button = document.querySelector('#modes button'), own = window.requestAnimationFrame, frames = [];
            window.requestAnimationFrame = draw => { frames.push(draw); return 0; }; button.click(); const seen = [[button.textContent, button.getAttribute('aria-pressed')]];
            const poses = () => [...document.querySelectorAll('figure.mode')].map(one => [...one.querySelectorAll('.pose')].map(pose => [pose.getAttribute('visibility'), [...pose.querySelectorAll('path')].map(e => e.getAttribute('d')).join()]));
            for (const now of [250, 2000, 2500, 1500]) { frames.shift()(now); seen.push(poses()); } button.click(); frames.shift()(9999); seen.push(poses(), [button.textContent, button.getAttribute('aria-pressed'), frames.length]);
            window.requestAnimationFrame = own; done(seen)""")
        self.assertEqual((seen[0], seen[-1]), (["Stop", "true"], ["Swing", "false", 0]))
        for poses, now in zip(seen[1:5], (250, 2000, 2500, 1500)):
            for one, pose, (size, pixels, first) in zip(modes["modes"], poses, sizes, strict=True):
                self.assertEqual([visible for visible, _ in pose], [None, "hidden", None])
                points = [tuple(map(float, point.split(","))) for point in re.findall(r"[-\d.]+,[-\d.]+", pose[2][1].replace(",M", " M"))]
                wanted = outline(one, size * math.sin(math.pi * now / 1000))
                self.near([[a - shift for a, shift in zip(point, first)] for point in points], [(pixels * a, -pixels * b) for a, b in wanted], f"at {now} ms", 0.05)
        self.assertEqual(seen[5][0], before)
        self.run_script("W.set().modes = null; W.modes()")
        self.assertFalse(self.one("#modes").is_displayed())

    def test_outputs_that_differ_in_what_they_have(self):
        """One that no run has, one without some quantile, one that never varies, one that a case lacks; and what the glossary says of them."""
        self.open(pages.made_up("cases"))
        self.run_script("""const [none, fewer, constant] = W.sets[0].outputs; W.names = [none, fewer, constant].map(one => one.name); W.choose('set', 0);
            Object.assign(none, { count: 0, missing: 2000, mean: null, std: null, min: null, max: null, nominal: null, quantiles: [], histogram: null, curve: null, convergence: null });
            fewer.quantiles = fewer.quantiles.slice(0, 1); Object.assign(constant, { min: 5, max: 5, mean: 5, std: 0, nominal: 5, count: 1999 }); W.outputs()""")
        rows = self.table("Outputs of cold")
        self.assertEqual(rows[0][2:], ["0", "in no run", *["–"] * 6])
        self.assertEqual((rows[1][7] != "–", rows[1][8:]), (True, ["–", "–"]))
        self.assertEqual(rows[2][3:6], ["constant", "286.5", "286.5"] if rows[2][1].startswith("deg") else ["constant", "5.000", "5.000"])
        names = self.run_script("return W.names")
        self.assertEqual(self.run_script("return [...document.querySelectorAll('.outputs tbody tr.zero')].map(row => row.querySelector('button').dataset.output)"), names[:1])
        self.run_script("W.choose('output', W.names[0])")
        self.assertIn("No run of cold has a value.", self.one(".output").text)
        self.assertEqual([row[0] for row in self.table(f"{self.run_script('return W.format.nameOf(W.names[0])')} by case")], ["cold", "ambient", "hot"])
        self.assertEqual(self.run_script("return [...document.querySelectorAll('.pick')].filter(one => one.getAttribute('aria-pressed') === 'true').map(one => one.dataset.output)"), names[:1])
        self.run_script("W.sets[0].outputs = W.sets[0].outputs.slice(1); W.outputs(); W.choose('output', W.names[0])")
        self.assertIn("is not among the outputs of cold.", self.one(".output").text)
        words = self.run_script("return W.names.slice(1).map(name => { W.choose('output', name); return document.querySelector('.output .note')?.textContent ?? ''; })")
        glossary = self.run_script("return W.data.glossary")
        self.assertEqual(words, [glossary.get("HINGE." + name.split(".")[1], {"text": ""})["text"] for name in names[1:]])
        self.run_script("""Object.assign(W.data.glossary, { 'BODY.peak_bending_moment': { unit: 'N m', text: 'of a body' }, 'mode_K.frequency': { unit: 'Hz', text: 'of a mode' }, deployment_time: { unit: 's', text: 'of the wing' } });
            const like = W.sets[0].outputs[0]; W.sets[0].outputs.push({ ...like, name: 'p.peak_bending_moment', hinge: 'p', limits: [] }, { ...like, name: 'mode_2.frequency', hinge: 'mode_2', limits: [] }); W.outputs()""")
        told = self.run_script("return ['p.peak_bending_moment', 'mode_2.frequency', 'deployment_time'].map(name => { W.choose('output', name); return document.querySelector('.output .note').textContent; })")
        self.assertEqual(told, ["of a body", "of a mode", "of the wing"])
        self.put('input[type="search"]', "LATCH  root", "input")
        shown = self.run_script("return [[...document.querySelectorAll('.outputs tbody tr')].filter(row => !row.hidden).map(row => row.querySelector('button').dataset.output), document.querySelector('.controls [role=status]').textContent]")
        wanted = [name for name in self.run_script("return W.set().outputs.map(one => one.name)") if "latch" in name and "root" in name]
        self.assertEqual(shown, [wanted, f"{len(wanted)} of {self.run_script('return W.set().outputs.length')}"])
        self.assertTrue(wanted)
