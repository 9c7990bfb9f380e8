"""What other studies left, in words: windows of springs, static margins of several standards and groups, rare events, indices by output; and the page's own sections."""

import json

import mock
import pages


class StudyPageChecks:
    """For a Page with MarkChecks and FitPageChecks."""

    def test_windows_and_rare_events_in_words(self):
        self.open(pages.made_up("plain"))
        note = lambda **more: self.run_script("Object.assign(W.set().margin, arguments[0]); W.why(); return document.querySelector('figure.margin > .note').textContent", more)
        for window, recommended, why, text in (([1.1, 1.58], 1.42, None, "The window is from 1.100 to 1.580; recommended: 1.420."), ([None, 1.58], None, "no scale has room", "The window is open below to 1.580. No recommendation: no scale has room."),
                                               ([0.75, None], 1, None, "The window is from 0.7500 and open above; recommended: 1.000."), ([None, None], None, "all are too weak", "All are too weak."), ([None, None], None, None, "No scale meets all requirements."), (None, None, "x", "X.")):
            self.assertEqual(note(window=window, recommended=recommended, why_none=why), text + " Bands are two-sided 95 % bounds of each share.")
        for window, low, high in (([1.1, None], True, False), ([None, 1.58], False, True)):
            note(window=window)
            pages.settle(self.driver)
            x = self.scale("margin", "x")
            left, right, top, bottom = self.run_script("const box = document.querySelector('figure.margin .axis.x .domain').getBBox(), y = document.querySelector('figure.margin .axis.y .domain').getBBox(); return [box.x, box.x + box.width, y.y, y.y + y.height]")
            (got,) = self.places("margin", "rect.window", "x", "width", "y", "height")
            first, last = x(window[0]) if low else left, x(window[1]) if high else right
            self.near([got], [(first, last - first, top, bottom - top)], "window")
        note(window=[None, None])
        pages.settle(self.driver)
        self.assertEqual((len(self.all("figure.margin rect.window")), len(self.all("figure.margin line.chosen-line"))), (0, 0))
        self.assertNotIn("window", self.run_script("return document.querySelector('figure.margin .legend').textContent"))
        titles = self.run_script("return [...document.querySelectorAll('figure.margin circle.looked title')].map(one => one.textContent)")
        margin = self.run_script("return W.set().margin")
        self.assertEqual(len(titles), sum(len(one["passed"]) for one in margin["requirements"]))
        for title, (one, at) in zip(titles, ((one, at) for one in margin["requirements"] for at in range(len(margin["scales"])))):
            self.assertTrue(title.startswith(f"{one['text']}: {one['verdict'][at]} at "), title)
            self.check(title.rpartition(" at ")[2], margin["scales"][at], about=title)
        rare = lambda **more: self.run_script("Object.assign(W.set().rare, arguments[0]); W.why(); return [[...document.querySelectorAll('#why p')].find(one => one.textContent.startsWith('P(')).textContent.split(').')[1], document.querySelectorAll('figure.rare').length, [...document.querySelectorAll('#why caption')].some(one => one.textContent === 'Most likely run of the event')]", more)
        self.assertEqual(rare(reached=True), ["", 1, True])
        told = lambda **more: self.run_script("const own = W.set().rare; W.set().rare = { ...own, ...arguments[0] }; W.why(); const text = [...document.querySelectorAll('#why p b')].map(one => one.parentNode.textContent).find(one => /bounds/.test(one)); W.set().rare = own; return text", more)
        beyond = {"output": "root.peak_moment", "above": True, "limit": 15, "unit": "N·m"}
        for part in ("root peak moment > 15 N·m, case hot: ", "(90 % bounds "):
            self.assertIn(part, told(beyond=beyond, case="hot", confidence=0.9))
        self.assertIn("root latch rate < 5 deg/s: ", told(beyond={"output": "root.latch_rate", "above": False, "limit": 0.08726646259971647, "unit": "rad/s"}))
        title = lambda **more: (told(**more), self.run_script("const own = W.set().rare; W.set().rare = { ...own, beyond: arguments[0] }; W.why(); W.set().rare = own", more["beyond"]), pages.settle(self.driver),
                                self.run_script("return [...document.querySelectorAll('figure.rare svg text')].map(one => one.textContent).find(one => /^probability of/.test(one))"))[3]
        self.assertEqual(title(beyond=beyond), "probability of exceeding it")
        self.assertEqual(title(beyond={**beyond, "above": False}), "probability of falling below it")
        for event, words, about in (("not deployed", "probability of falling below it", "reserve, as a share"), ("root.latch_rate < 5", "probability of falling below it", "threshold"), ("root.latch_rate > 5", "probability of exceeding it", "threshold")):
            self.run_script("Object.assign(W.set().rare, { text: arguments[0], beyond: null }); W.why()", event)  # the latter two: of an older version
            pages.settle(self.driver)
            texts = self.run_script("return [...document.querySelectorAll('figure.rare .axis-text')].map(one => one.textContent)")
            self.assertTrue(words in texts and any(text.startswith(about) for text in texts), texts)
            said = self.run_script("return document.querySelector('figure.rare desc').textContent")
            self.assertEqual("below" in said, "below" in words, said)
        self.run_script("W.set().rare.text = 'P(event)'; W.why()")
        self.assertIn("The upper bound is an estimate, not guaranteed.", told(estimated=True, reached=False, strata=[{"text": "a = 1", "probability": 0.1, "event": 0.2, "reached": False}]))
        self.assertNotIn("guaranteed", told(estimated=False, reached=True))
        self.assertTrue(told(bias=0.1381478, reached=True).endswith("). Bias: such estimates are too large by about 13.8 % on average."))
        self.assertNotIn("Bias", told(bias=0.1381478, reached=False) + told(bias=0, reached=True) + told(bias=None, reached=True))
        words, *_ = rare(reached=False)
        self.assertIn("The event was not reached", words)
        levels = [{"threshold": None, "probability": 1}, {"threshold": 1, "probability": 0.5}, {"threshold": 2, "probability": 0}]
        self.assertEqual(rare(reached=True, levels=[levels], likeliest={"draws": []}), ["", 0, False])
        self.assertEqual(rare(levels=[[*levels, {"threshold": 3, "probability": 0.25}]], likeliest=None), ["", 1, False])
        missing = lambda script: self.run_script(script + "; W.why(); return [...document.querySelectorAll('#why p.note')].pop().textContent")
        self.assertEqual(missing(""), "Not in this report: a fit to deployment tests (wingspread fit).")
        self.assertEqual(missing("W.set().margin = W.set().rare = W.set().static_margins = null"), "Not in this report: the permissible spring strength (wingspread margin), static margins (motorization in the campaign), rare events (wingspread rare), a fit to deployment tests (wingspread fit).")

    def test_what_limits_a_window_is_told(self):
        self.open(pages.made_up("studies"))
        note = lambda **more: self.run_script("Object.assign(W.studySets[0].margin, arguments[0]); W.why(); return document.querySelector('figure.margin > .note').textContent", more)
        plain = note()
        for words in ("oint confidence", "Nothing was run", "Narrower windows", "static margin", "Nearer"):
            self.assertNotIn(words, plain)
        one = {"drive": "root", "margin": "NASA", "at_1": 0.94, "at_scale": 0.61}
        text = note(joint_confidence=0.4, widest_gap=[0.1414, 0.2], other_windows=[[3, 4.5]], passed_over={"scale": 1.15, **one},
                    given_up={"requirements": [{"requirement": "A", "case": "nominal"}, {"requirement": "B", "case": "cold"}], "static_margins": [one]})
        for words in ("Joint confidence of 2 requirements, over all cases and both edges: at least 40 %.", "up to 41.4 % apart (0.1414 and 0.2000)", "from 3.000 to 4.500",
                      "Scale 1.150 breaks fewer runs", "broken by more runs: A; B in cold.", "root (NASA: 0.61, now 0.94)"):
            self.assertIn(words, text)
        self.assertIn("no guarantee", note(joint_confidence=-0.2))

    def test_studies_without_a_scene_have_units_and_no_empty_section(self):
        rare = mock.mock_wing.studies(["root", "mid", "tip"])["rare"]
        rare["likeliest"]["draws"] = [{"name": "a", "value": 2.5, "unit": "N·m", "z": 3}, {"name": "b", "value": 0.1, "unit": "rad", "z": 2}, {"name": "c", "value": 1, "unit": "", "z": 1}]
        self.opened_block("rare_alone", lambda: mock.block([mock.study("rare", rare=rare, wing=None)]))
        self.assertEqual([row[:3] for row in self.table("Most likely run of the event")], [["a", "2.500", "N·m"], ["b", "5.730", "deg"], ["c", "1.000", ""]])
        self.assertFalse(self.one("#wing").is_displayed())
        self.assertEqual(self.run_script("return document.querySelector('#title').textContent"), "mock_wing")
        self.opened_block("rare_first", lambda: mock.block([mock.study("rare", rare=rare, wing=None, campaign="another wing"), mock.studies()[0]]))
        self.assertEqual(self.one("#title").text, "another wing and mock_wing")
        self.assertTrue(self.one("#wing figure.still").is_displayed())  # of the study that has one

    def test_static_margins_by_standard_group_and_case(self):
        self.open(pages.made_up("cases"))
        short = lambda script: self.run_script("W.sets.forEach((set, at) => { set.static_margins.hinges.forEach(one => Object.assign(one, { least: 0.5, lower: 0.25, required: 0 })); " + script + " }); W.outcomes(); return document.querySelector('#verdicts .static-shortfall')?.textContent ?? null")
        lowest = "if (at === 1) Object.assign(set.static_margins.hinges[1], { least: -0.5, lower: -0.25 });"
        self.assertIn("Lowest: −0.50 in ambient (nominal).", short(lowest))
        for hinges, text in (("['a+b']", "of 1 group of coupled hinges are"), ("['a+b', 'c+d']", "of 2 groups of coupled hinges are"), ("['a+b', 'c']", "of 2 hinges and groups of coupled hinges are"), ("['a', 'b']", "of 2 hinges are"), ("['a']", "of 1 hinge are")):
            self.assertIn(text, short(f"{hinges}.forEach((hinge, k) => at || Object.assign(set.static_margins.hinges[k], {{ hinge, lower: -0.1 }}));"))
        self.run_script("W.sets.forEach(set => set.static_margins.hinges.forEach((one, at) => one.hinge = ['root', 'mid', 'tip'][at]))")
        draws = "if (!at) Object.assign(set.static_margins.hinges[0], { lower: -0.25 }); Object.assign(set.static_margins, { draws: 50, lower_p: 0.01 });"
        self.assertIn("Lowest: −0.25 in cold (least of 50 draws).", short(draws))
        self.assertIn("(1 % quantile over 100 draws)", short(draws.replace("50", "100")))
        text = short("Object.assign(set.static_margins.hinges[at], { required: 0.3 + 0.1 * at, lower: 0.31, least: 0.45 });")
        self.assertIn("of 2 hinges are below the required 0.4 and 0.5 in ambient and hot (each in at least one of them); in hot also those of the nominal wing", text)
        self.assertIn("Lowest: 0.31 in hot", text)
        self.assertIn("; those of the nominal wing (every dispersion at its median) are not.", short("Object.assign(set.static_margins.hinges[at], { lower: -0.1 });"))
        self.assertEqual(self.run_script("return W.lowestStaticMargin()"), "−0.10 in cold")
        part = lambda script: self.run_script(script + "; W.choose('set', 0); const part = document.getElementById('static-margins'); return [...part.querySelectorAll('p, .note')].map(one => one.textContent).join(' ')")
        for kind, name, rest in (("ECSS", "ECSS-E-ST-33-01C", "It multiplies the resisting torques"), ("NASA", "NASA-STD-5017B", "It multiplies"), ("NASA, one spring out", "NASA-STD-5017B", "It takes a spring away"), ("GEVS", "GSFC-STD-7000A", "It multiplies"), ("AIAA", "S-114-2005", "It multiplies"), ("own", "", "It multiplies")):
            text = part(f"W.sets.forEach(set => set.static_margins.kind = {json.dumps(kind)})")
            self.assertTrue(name in text and rest in text and ("I and S: inertia" in text) == (kind == "ECSS") and ("with the factors of this campaign: static margin = T / (1.35 ΣT_fixed" in text) == (kind != "own"), text)
        self.assertIn("The picture and the table show cold.", text)
        heads = lambda script: (part(script), self.heads("Least static margins"), self.run_script("return document.querySelector('figure.static-margins > .note').textContent"))[1:]
        self.assertEqual(heads("W.sets[0].static_margins.lower_p = null")[0], ["Hinge", "Least, nominal", "Least, dispersed", "Required", "Nominal verdict"])
        got, note = heads("Object.assign(W.sets[0].static_margins, { lower_p: 0.01, draws: 50 })")
        self.assertEqual((got[2], got[5], "Thin: the least over 50 draws." in note), ("Least of all draws", "Verdict, least", True))
        many = "const all = W.sets[0].static_margins.hinges; W.sets[0].static_margins.hinges = d3.range(16).map(at => ({ ...all[0], hinge: `h${at}` }))"
        self.assertIn("The picture has the first 14 of 16 hinges; the table has all.", heads(many)[1])
        pages.settle(self.driver)
        self.assertEqual((len(self.all("figure.static-margins .trace")), len(self.table("Least static margins"))), (28, 16))

    def test_studies_by_name_and_indices_by_output(self):
        self.open(pages.made_up("beside"))
        titles = self.run_script("return [...document.querySelectorAll('#why .grid.pairs > div > h3')].map(one => one.textContent)")
        self.assertEqual(titles, ["Permissible spring strength · margin", "Static margins · margin", "Sensitivity · sobol", "Rare events · rare"])
        told = self.run_script("W.studySets.forEach(set => { set.case = 'hot'; if (set.rare) set.rare.case = 'hot'; }); W.why(); return [...document.querySelectorAll('#why .grid.pairs > div')].map(one => (one.querySelector('h3').textContent + ' ' + (one.querySelector('p b')?.textContent ?? '')).match(/case hot/g)?.length ?? 0)")
        self.assertEqual(told, [1] * len(titles))  # each names its case, once
        chooser = self.run_script("const one = [...document.querySelectorAll('#why .grid.pairs select')].pop(); return [[...one.options].map(each => each.textContent), one.selectedOptions[0].textContent]")
        self.assertEqual(chooser, [["root peak moment", "tip latch time"], self.run_script("return W.format.nameOf(['root.peak_moment', 'tip.latch_time'].includes(W.chosen.output) ? W.chosen.output : 'root.peak_moment')")])
        self.run_script("const one = [...document.querySelectorAll('#why .grid.pairs select')].pop(); one.value = 'tip.latch_time'; one.dispatchEvent(new Event('change'))")
        pages.settle(self.driver)
        figure = self.run_script("const one = [...document.querySelectorAll('figure.tornado')].pop(); return [one.querySelector('.caption').textContent, [...one.querySelectorAll('.legend text')].map(each => each.textContent), [...one.querySelectorAll('.axis-text')].map(each => each.textContent), one.querySelector(':scope > .note').textContent.slice(0, 12)]")
        self.assertEqual(figure, ["Influences on tip latch time", ["first order", "total"], ["share of the variance"], "First order:"])
        nth = len(self.all("figure.tornado")) - 1
        heads, *rows = self.copied_from("tornado", nth)
        self.assertEqual(heads, ["dispersion", "first order", "lower", "upper", "total", "lower", "upper"])
        effects = [one for one in self.run_script("return W.studySets[1].sensitivity.effects") if one["output"] == "tip.latch_time"]
        for row, one in zip(rows, effects, strict=True):
            self.numbers_of(row, [one["draw"], *(one[f"{key}{bound}"] for key in ("first", "total") for bound in ("", "_lower", "_upper"))], "sobol")
        self.open(pages.made_up("studies"))
        hidden = self.run_script("return Object.fromEntries([...document.querySelectorAll('main > section')].map(one => [one.id, one.hidden]))")
        self.assertEqual(hidden, {"verdicts": False, "outputs": True, "wing": False, "modes": True, "why": False, "convergence": True, "comparison": True, "inputs": True, "glossary": False})
        self.assertEqual(self.one("#subtitle .facts").text, "")  # no confidence of all: each study has its own
        levels = self.run_script("W.studySets.forEach((set, at) => set.confidence = [0.5, 0.99][at]); Object.assign(W.studySets[2].rare, { confidence: 0.8 }); W.why(); return ['margin', 'tornado'].map(name => document.querySelector(`figure.${name} > .note`).textContent)")
        self.assertTrue("two-sided 50 % bounds" in levels[0] and "99 % two-sided bounds" in levels[1], levels)
        self.assertIn("(80 % bounds ", self.one("#why").text)
        unknown = self.run_script("W.studySets.forEach(set => set.confidence = null); W.why(); return ['margin', 'tornado'].map(name => document.querySelector(`figure.${name} > .note`).textContent)")
        self.assertNotRegex(" ".join(unknown), "% .*bounds")  # of folders that do not tell
        links = self.run_script("return [...document.querySelectorAll('.sections a')].map(one => [one.hash.slice(1), one.parentNode.hidden])")
        self.assertTrue(links and all(hidden[name] == gone for name, gone in links), links)
        text = self.one("#verdicts").text
        self.assertIn("margin, sobol, rare: see “Causes”.", text)
        self.assertIn("None.", self.one("#verdicts .warnings.none").text)
        self.run_script("W.studySets[1].warnings = ['one replicate, so no bounds']; W.outcomes()")
        self.assertEqual([one.text for one in self.all("#verdicts .warnings li")], ["one replicate, so no bounds (sobol)"])

    def test_the_page_opens_on_the_worst_case(self):
        self.open(pages.made_up("cases"))
        worst = self.run_script("return [W.chosen.set, W.verdicts.judged()[0].at, document.querySelector('#case-switch select').value, document.querySelector('#case-switch span').textContent, document.querySelector('#case-switch').hidden]")
        self.assertEqual(worst, [0, 0, "0", "Case", False])
        self.assertEqual(self.run_script("return [...document.querySelectorAll('#case-switch option')].map(one => one.textContent)"), ["cold", "ambient", "hot"])
        self.assertEqual(self.run_script("return document.getElementById('angles').value"), "deg")
        self.open(pages.made_up("plain"))
        self.assertTrue(self.run_script("return document.querySelector('#case-switch').hidden"))
        self.open(pages.made_up("forty"))
        parts = self.run_script("return [[...document.querySelectorAll('figure.envelopes .caption')].map(one => one.textContent), [...document.querySelectorAll('#wing details.later > summary')].map(one => one.textContent)]")
        names = [("h1", "h6"), ("h7", "h12"), ("h13", "h18"), ("h19", "h24"), ("h25", "h30"), ("h31", "h36"), ("h37", "h40")]
        self.assertEqual(parts, [[f"Envelopes of angles and rates, {a} to {b}" for a, b in names], [f"Envelopes of {a} to {b}" for a, b in names[1:]]])
        self.run_script("W.set().envelopes = null; W.wing()")
        self.assertIn("No run is long enough for envelopes", self.one("#wing").text)
        self.run_script("W.set().motions = []; W.wing()")
        self.assertIn("No run of this set can be replayed", self.one("#wing").text)
        self.run_script("W.set().wing.bodies = []; W.wing()")
        self.assertIn("The folder contains no scene to draw.", self.one("#wing").text)

    def test_the_most_likely_run_has_its_largest_deviations_first_of_either_sign(self):
        self.open(pages.made_up("plain"))
        names = self.run_script("""const set = [...W.sets, ...W.studySets].find(one => one.rare && one.rare.likeliest), host = document.createElement("div");
            set.rare.likeliest.draws = arguments[0].map((z, at) => ({ name: `x${at}`, value: at, z }));
            W.fill(host, W.studies([set]));
            return [...[...host.querySelectorAll("table")].find(one => one.querySelector("caption")?.textContent.startsWith("Most likely run")).querySelectorAll("tbody th")].map(one => one.textContent)""", [0.5, -3.25, 2, -0.1, 1.5])
        self.assertEqual(names, ["x1", "x2", "x4", "x0", "x3"])
