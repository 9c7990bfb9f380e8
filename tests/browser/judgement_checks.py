"""The first screen's sentences on requirements, the comparison of verdicts, influences, studies and inputs, for data of every kind."""

import random

import pages
from number_checks import DEGREES

BASE = {"name": "", "id": "", "output": "root.peak_moment", "kind": "<=", "limit": 200, "upper": True, "abs": False, "static_margin": False, "group": "", "disproved": False, "runs": 2000, "allowed": 12, "verdict": "passed", "probability": 0.99,
        "confidence": 0.9, "observed": 0.995, "guaranteed": 0.992, "observed_value": 150, "guaranteed_value": 160, "margin": 40, "source": "", "rationale": "", "broken": 0, "not_deployed": 0, "without_value": 0, "cut": 0, "beyond": 0,
        "worst": None, "beyond_runs": [], "not_deployed_runs": [], "evidence": "", "changes": []}
SHARE = {"output": "deployed", "kind": "status", "limit": None, "upper": False, "observed_value": None, "guaranteed_value": None, "margin": None}


def stated(text, verdict="passed", **more):
    return {**BASE, "text": text, "id": text, "verdict": verdict, **more}


class JudgementChecks:
    """For a Page with MarkChecks and FitPageChecks."""

    def test_first_screen_holds_every_verdict_and_count(self):
        self.open(pages.made_up("cases"))
        data = self.run_script("return W.data")
        text = self.one("#verdicts").text
        for data_set in data["sets"]:
            self.assertIn(data_set["label"], text)
            for status in data_set["statuses"]:
                if status["count"]:
                    self.assertIn(f"{status['count']:,}", text)
        self.assertIn(data["command"], text)
        self.assertIn(data["sets"][0]["made_by"], text)
        self.assertIn(data["sets"][0]["hash"], text)
        for warning in data["sets"][0]["warnings"]:
            self.assertIn(warning, text)
        verdicts = sum(len(one["requirements"]) for one in data["sets"])
        self.assertEqual(len(self.all("#verdicts details .requirements tbody tr")), verdicts)

    def test_requirements_stand_worst_first(self):
        self.open(pages.made_up("cases"))
        order = self.run_script("return W.verdicts.judged().map(row => row.requirement.verdict)")
        rank = {"failed": 0, "open": 1, "passed": 2}
        self.assertEqual(order, sorted(order, key=rank.get))
        self.assertEqual(order[0], "failed")

    def told(self, selector, *requirements):
        """A part of the first screen with these requirements of each set."""
        return self.run_script("W.sets.forEach((set, at) => { set.requirements = arguments[1][at]; set.outputs.forEach(one => one.limits = []); }); W.outcomes(); return [...document.querySelectorAll(arguments[0])].map(one => one.textContent)", selector, requirements)

    def test_the_headline_counts_and_names_what_decides(self):
        self.open(pages.made_up("plain"))
        head = lambda *given: self.told("#verdicts .headline", [stated("ABCDEFG"[at], verdict) for at, verdict in enumerate(given)])[0]
        for given, text in (([], "This campaign states no requirements. This report has statistics only, no verdicts."), (["passed"], "✓ pass The requirement passes"), (["passed"] * 2, "✓ pass All 2 requirements pass"), (["failed"], "✕ fail The requirement fails"),
                            (["failed"] * 2, "✕ fail Each of 2 requirements fails"), (["failed", "passed"], "✕ fail 1 of 2 requirements fails: A 1 passes"), (["failed", "failed", "open", "passed", "passed"], "✕ fail 2 of 5 requirements fail: A and B 1 undecided, 2 pass"),
                            (["failed"] * 4 + ["passed"], "✕ fail 4 of 5 requirements fail 1 passes"), (["open"], "? undecided The requirement is undecided: too few runs"), (["open"] * 3, "? undecided Each of 3 requirements is undecided: too few runs"),
                            (["open", "passed"], "? undecided 1 of 2 requirements is undecided, for too few runs: A 1 passes"), (["open", "open", "open", "passed"], "? undecided 3 of 4 requirements are undecided, for too few runs: A, B and C 1 passes")):
            self.assertEqual(head(*given), text)
        self.assertEqual(self.run_script("return document.querySelector('.headline').className"), "headline open")
        self.open(pages.made_up("cases"))
        head = lambda *given: self.told("#verdicts .headline", *([stated("ABC"[at], verdict) for at, verdict in enumerate(verdicts)] for verdicts in given))[0]
        for given, text in (((["passed"] * 2,) * 3, "✓ pass All 2 requirements pass in every case"), ((["passed"] * 2, ["passed"], []), "✓ pass All 2 requirements pass in every case that states them cold: 2 pass; ambient: 1 passes; hot: no requirements"),
                            ((["passed"], ["passed"], []), "✓ pass The requirement passes in every case that states it cold and ambient: 1 passes; hot: no requirements"), ((["failed", "passed"], ["passed"] * 2, ["passed"] * 2), "✕ fail 1 of 2 requirements fails in cold: A cold: 1 fails, 1 passes; ambient and hot: 2 pass"),
                            ((["passed", "failed"], ["failed", "passed"], []), "✕ fail Each of 2 requirements fails in at least one case cold and ambient: 1 fails, 1 passes; hot: no requirements"),
                            ((["open", "passed"], ["passed"] * 2, ["open", "passed"]), "? undecided 1 of 2 requirements is undecided, for too few runs: A cold and hot: 1 undecided, 1 passes; ambient: 2 pass")):
            self.assertEqual(head(*given), text)
        self.run_script("W.sets.forEach(set => set.case = null)")  # folders
        self.assertIn("in at least one folder", head(["passed", "failed"], ["failed", "passed"], []))
        self.assertNotRegex(self.page_text("#verdicts .judgement"), r"\b[Cc]ase\b")

    def test_of_one_verdict_the_requirement_that_uses_up_most_of_what_may_break_comes_first(self):
        """Broken runs over those that may break it; where the runs are too few for a pass, over N (1 - p) of the set's own runs."""
        self.open(pages.made_up("cases"))
        chance = random.Random(3)
        for verdict in ("open", "failed"):
            for _ in range(20):
                given = [[stated(f"{at}{k}", verdict, **SHARE, probability=chance.choice([0.5, 0.9, 0.99, 0.999]), allowed=chance.choice([None, 3, 20]) if verdict == "failed" else None, broken=chance.randint(0, 40)) for k in range(4)] for at in range(3)]
                runs = [chance.choice([20, 300, 4000]) for _ in range(3)]
                order = self.run_script("W.sets.forEach((set, at) => Object.assign(set, { runs: arguments[1][at], planned: arguments[1][at], requirements: arguments[0][at] })); return W.verdicts.judged().map(row => row.requirement.text)", given, runs)
                used = {one["text"]: one["broken"] / (runs[at] * (1 - one["probability"]) if one["allowed"] is None else one["allowed"]) for at, listed in enumerate(given) for one in listed}
                shares = [used[text] for text in order]
                self.assertEqual(len(shares), 12)
                self.assertTrue(all(a >= b * (1 - 1e-12) for a, b in zip(shares, shares[1:])), f"{shares} of {given}, {runs}")

    def test_a_campaign_that_lacks_runs_has_no_final_verdict(self):
        self.open(pages.made_up("cases"))
        passing = [[stated("A"), stated("B")]] * 3
        seen = lambda change: [self.run_script(f"{change}; W.subtitle(); return document.querySelector('#subtitle .facts').textContent"), *(" | ".join(self.told(part, *passing)) for part in
                               ("#verdicts .headline", "#verdicts .requirements .badge, #verdicts .matrix .badge", "#verdicts .matrix thead", "#verdicts .warnings li"))]
        facts, head, badges, *_ = seen("")
        self.assertNotIn("incomplete", facts + head)
        self.assertNotIn("so far", badges)
        for change, lacks, late, counts in (("Object.assign(W.sets[0], { runs: 62, planned: 4500 })", "62 of 4,500 runs of case cold", False, "cold: not judged; ambient and hot: 2 pass"), ("W.data.unmade = [{ label: 'late', case: 'late', campaign_folder: 0, planned: 4500 }]", "62 of 4,500 runs of case cold, none of late", True, "cold and late: not judged; ambient and hot: 2 pass"),
                                    ("Object.assign(W.sets[1], { runs: 0, planned: 4500 })", "62 of 4,500 runs of case cold, none of ambient and late", True, "cold, ambient and late: not judged; hot: 2 pass"), ("W.sets.forEach(set => Object.assign(set, { runs: 4500, planned: 4500 }))", "no run of case late", True, "cold, ambient and hot: 2 pass; late: not judged")):
            facts, head, badges, columns, warnings = seen(f"W.data.incomplete = '{lacks}'; {change}")  # the program writes the sentence
            self.assertIn(f"incomplete: {lacks}", facts)
            self.assertTrue(head.startswith(f"? incomplete {lacks}"), head)
            partial = self.run_script("return W.sets.map(W.isPartial)")
            self.assertEqual(set(badges.split(" | ")), {"✓ pass so far" if one else "✓ pass" for one in partial})
            self.assertEqual(self.run_script("return [...document.querySelector('#verdicts .matrix tbody').rows[0].querySelectorAll('.badge')].map(one => one.textContent.includes('so far'))"), partial)
            self.assertEqual(("late" in columns, "late holds none of 4,500 planned runs" in warnings, "3 of 4 cases" in facts), (late,) * 3)
            self.assertTrue(head.endswith(f" There is no final verdict. {counts}"), head)

    def test_a_finished_folder_keeps_its_verdicts_beside_one_that_lacks_runs(self):
        self.open(pages.made_up("cases"))
        self.run_script("W.sets.forEach((set, at) => Object.assign(set, { case: null, label: ['preview', 'whole', 'shard'][at] })); W.data.incomplete = '2,000 of 3,000 runs of preview'; Object.assign(W.sets[0], { planned: 3000, partial: true }); W.sets[2].shard = '2/3'")
        unjudged = [stated(name, "open", guaranteed_value=None, margin=None, allowed=None, observed_value=None) for name in "AB"]
        badges = "return [...document.querySelector('#verdicts .matrix tbody').rows].map(row => [...row.cells].slice(1).map(one => one.textContent))"
        for verdicts, text in ((["passed", "failed"], "✕ fail 1 of 2 requirements fails in whole: B preview and shard: not judged; whole: 1 fails, 1 passes"),
                               (["failed", "failed"], "✕ fail Each of 2 requirements fails in whole preview and shard: not judged; whole: 2 fail"),
                               (["passed", "passed"], "? incomplete 2,000 of 3,000 runs of preview There is no final verdict. preview and shard: not judged; whole: 2 pass"),
                               ([], "? incomplete 2,000 of 3,000 runs of preview There is no final verdict. preview and shard: not judged; whole: no requirements")):
            (head,) = self.told("#verdicts .headline", unjudged, [stated(name, verdict) for name, verdict in zip("AB", verdicts)], unjudged)
            self.assertEqual(head, text)
            words = {"passed": "✓ pass", "failed": "✕ fail"}
            for at, row in enumerate(self.run_script(badges)):
                self.assertTrue(row[1].startswith(f"{words[sorted(verdicts)[at]]} +40") if verdicts else row[1] == "–", row)
                self.assertEqual({row[0], row[2]}, {"? undecided so far not judged"})
        self.assertIn("? undecided so far", [row[1] for row in self.table("Requirements, the worst first")])
        (head,) = self.told("#verdicts .headline", [], [stated("A")], [])  # what lacks runs has no requirements
        self.assertTrue(head.startswith("✓ pass The requirement passes"), head)
        self.run_script("W.data.incomplete = null; W.sets[0].planned = 2000; W.sets[0].partial = false")
        (head,) = self.told("#verdicts .headline", [stated("A")], [stated("A")], unjudged[:1])  # a shard has no verdict either
        self.assertEqual(head, "? not judged shard is shard 2/3 There is no final verdict. preview and whole: 1 passes; shard: not judged")
        (head,) = self.told("#verdicts .headline", [], [], [])
        self.assertIn("statistics only", head)

    def test_a_requirement_and_what_breaks_it_in_words(self):
        self.open(pages.made_up("plain"))
        runs = lambda *numbers: [{"run": run, "value": 0} for run in numbers]
        rows = [stated("A", "failed", id="SYS-1", name="moment", group="G", broken=13, not_deployed=5, not_deployed_runs=runs(4, 3, 2, 1), beyond=6, beyond_runs=runs(9, 8, 7), without_value=1234, cut=1, worst={"run": 9, "value": 211}, evidence="said", margin=-12.5, guaranteed_value=212.5),
                stated("B", "failed", id="", name="rate", output="root.latch_rate", upper=False, kind=">=", limit=-1.5, broken=1, beyond=1, beyond_runs=runs(77), worst={"run": 77, "value": -1.625}, disproved=True, evidence="e", margin=None, guaranteed_value=None, observed_value=-1.55, without_value=0),
                stated("C", "open", id="", limit=250, broken=2, without_value=2, guaranteed_value=None, margin=None, observed_value=None, evidence="disproved already", disproved=True), stated("D", "passed", id="", limit=300, worst={"run": 5, "value": 171}, abs=True),
                stated("E", "passed", **{**SHARE, "id": "DEP", "name": "deploys"}), stated("F", "open", **{**SHARE, "id": "", "guaranteed": None, "observed": 0.5, "broken": 1, "not_deployed": 1, "not_deployed_runs": runs(11)})]
        self.run_script("W.choose('angles', 'deg')")
        self.told("#verdicts", rows)
        cells = {row[0][:12].removesuffix("2,000 r"): row for row in self.table("Requirements, the worst first")}
        texts = {"SYS-1 moment": ["SYS-1 moment: root peak moment ≤ 200 N·m, 99 % at 90 % in group Gsaid", "✕ fail", "150.0 N·m", "212.5 N·m", "−12.5 N·m", None, "13 5 not deployed worst: 4, 3, 2 6 above the limit worst: 9, 8, 7 1,234 without this event 1 with a peak that t_end cut largest 211.0 N·m "],
                 "rate: root l": ["rate: root latch rate ≥ −1.5 rad/s (−85.94 deg/s), 99 % at 90 %e · disproved", "✕ fail", "−88.81 deg/s", "too few runs", "−2.86 deg/s (observed)", None, "1 below the limit run 77 least −93.11 deg/s "],
                 "root peak mo": None, "DEP E": ["DEP E2,000 runs can show no more", "✓ pass", "99.50 %", "99.20 %", "+0.200 %-points", None, "none "], "F": ["F", "? undecided", "50.0 %", "too few runs", "–", None, "1 not deployed run 11 "],
                 "|root peak m": ["|root peak moment| ≤ 300 N·m, 99 % at 90 %", "✓ pass", "150.0 N·m", "160.0 N·m", "+40.0 N·m", None, "none largest 171.0 N·m run 5 "]}
        self.assertEqual(set(cells), set(texts))
        for name, wanted in texts.items():
            if wanted:
                self.assertEqual([cell.replace("\u00a0", " ") for cell, want in zip(cells[name], wanted) if want is not None], [want for want in wanted if want is not None])
        self.assertEqual(cells["root peak mo"][:5], ["root peak moment ≤ 250 N·m, 99 % at 90 %disproved already", "? undecided", "99.50 %", "too few runs with a value", "–"])
        heads = lambda given: (self.told("#verdicts", given), self.run_script("return [...document.querySelector('table.requirements').tHead.rows[0].cells].map(one => one.textContent)"))[1][2:4]
        self.assertEqual([heads(rows), heads(rows[:3]), heads(rows[4:]), heads([rows[0], {**rows[1], "confidence": 0.5}])],
                         [["Quantile or share", "One-sided 90 % bound"], ["Quantile", "One-sided 90 % bound"], ["Share", "One-sided 90 % bound"], ["Quantile", "One-sided bound"]])
        self.told("#verdicts", [rows[0], {**rows[2], "allowed": 10, "cut": 30}])
        self.assertIn("none: t_end cut peaks", [row[3] for row in self.table("Requirements, the worst first")])
        bars = self.run_script("W.set().statuses = [['deployed', 1990], ['stalled', 6], ['failed', 4], ['invalid', 0]].map(([status, count]) => ({ status, count, rate: count / 2000, lower: 0, upper: 1 })); W.outcomes(); return [...document.querySelectorAll('.stack span')].map(one => [one.className, Number(one.style.flexGrow)])")
        self.assertEqual(bars, [["deployed", 1990], ["stalled", 12], ["failed", 12]])  # the few can be seen

    def test_the_worst_is_what_uses_most_of_its_allowance_then_what_has_the_least_margin(self):
        self.open(pages.made_up("plain"))
        order = lambda *given: (self.told("#verdicts", list(given)), self.run_script("return W.verdicts.judged().map(row => row.requirement.text).join('')"))[1]
        self.assertEqual(order(stated("A", broken=0, allowed=22, margin=1), stated("B", broken=4, allowed=22, margin=90), stated("C", broken=1, allowed=0)), "CBA")
        self.assertEqual(order(stated("A", broken=4, allowed=22), stated("B", broken=4, allowed=12), stated("C", "open", allowed=None), stated("D", "failed", broken=13)), "DCBA")
        self.assertEqual(order(stated("A", margin=40), stated("B", margin=2), stated("C", margin=20, limit=50)), "BAC")  # 0.2, 0.01 and 0.4 of the limit
        self.assertEqual(order(stated("A", margin=40, limit=-200), stated("B", margin=2), stated("C", margin=20, limit=-50)), "BAC")  # whatever the limit's sign
        self.assertEqual(order(stated("A", margin=-4, limit=-100), stated("B", margin=-4, limit=-10), stated("C", margin=-0.3, limit=0)), "BCA")  # −0.04, −0.4, and −0.3 as it is
        self.assertEqual(order(stated("A", **{**SHARE, "guaranteed": 0.99923}), stated("B", **{**SHARE, "guaranteed": 0.99885})), "BA")
        self.open(pages.made_up("cases"))
        share = lambda bound: [stated("D", **{**SHARE, "guaranteed": bound})]
        self.told("#verdicts", share(0.99923), share(0.99885), share(0.99885))
        self.assertEqual([row[2] for row in self.table("Requirements, the worst first")][:1], [self.run_script("return W.sets[1].label")])

    def test_a_cell_without_a_margin_names_what_decides(self):
        self.open(pages.made_up("cases"))
        none = {"margin": None, "guaranteed_value": None}
        self.told("#verdicts", [stated("A", "open", **none, cut=135, not_deployed=53, broken=188, allowed=12)], [stated("A", "failed", **none, not_deployed=53, broken=53)],
                  [stated("A", "open", **none, not_deployed=1, broken=1, cut=1, allowed=None)])
        (row,) = self.table("Verdict and distance to the limit by case")
        self.assertEqual([cell[2:].replace("\u00a0", " ").split(" ", 1)[1] for cell in row[1:4]], ["135 peaks cut by t_end", "53 not deployed", "1 not deployed"])
        self.told("#verdicts", *[[stated("A", limit=190), stated("A", "failed", limit=190.00000001)]] * 3)
        self.assertEqual(len(self.table("Verdict and distance to the limit by case")), 2)  # the text has fewer digits than the limits

    def test_commands_of_the_page_are_quoted_for_a_shell(self):
        self.open(pages.made_up("plain"))
        words = ["results/a_1", "a b&c", "it's", "", "Fl\u00fcgel", "$HOME"]
        self.assertEqual(self.run_script("return arguments[0].map(W.shellWord)", words), ["results/a_1", "'a b&c'", "'it'\\''s'", "''", "'Fl\u00fcgel'", "'$HOME'"])

    def test_why_wings_that_do_not_deploy_break_everything(self):
        self.open(pages.made_up("loads"))
        failed = lambda text, **more: stated(text, "failed", broken=40, not_deployed=40, **more)
        cause = lambda *given: self.told("#verdicts p.lead:not(.assumptions):not(.static-shortfall)", *given)
        words = "40 of 2,000 runs did not deploy, and a run that does not deploy breaks every requirement. No deployed run is beyond a limit."
        self.assertEqual(cause([failed("A"), failed("B")], []), ["cold: " + words])
        self.assertEqual(cause([failed("A"), failed("B")], [failed("A"), failed("B"), stated("C")]), ["cold: " + words, "hot: " + words])
        self.assertEqual(cause([failed("A")], []), [])
        self.assertEqual(cause([failed("A"), {**failed("B"), "broken": 41}], []), [])
        self.assertEqual(cause([failed("A"), {**failed("B"), "not_deployed": 0, "broken": 0}], []), [])
        lever = {"words": "w", "draws": ["root.spring"], "scaled": True, "unit": "", "now": 1, "change": 1.2, "lower": 1.1, "upper": 1.3, "least": 0.9, "most": 1.4, "beyond": False, "of_broken": 0.8, "of_others": 1.1, "command": None}
        change = [{"for": "deployment", "runs": 900, "explained": 0.5, "levers": [lever]}]
        items = self.told("#verdicts .stalls > li", [failed("A", changes=change, allowed=20), failed("D", **{**SHARE, "id": "", "name": "D", "changes": change, "allowed": 1, "probability": 0.999}), stated("E", "failed", changes=[])], [])
        self.assertEqual(len(items), 1)
        self.assertTrue(items[0].startswith("D: in cold 40 of 2,000 runs (2.0 %) did not deploy, where at most 1 may (0.1 % of the runs is 2; to be 90 % sure, only 1 may). "), items[0])
        self.assertIn("× 0.80 / × 1.10", items[0])
        beyond = lambda text, **more: stated(text, "failed", name=text, output="root.peak_moment", beyond=3, broken=3, changes=[], **more)
        found = self.told("#verdicts .findings:not(.stalls) > li", [beyond(text) for text in "ABCDEF"], [beyond("A", margin=-3)])
        self.assertEqual([len(found), self.told("#verdicts p.note", [beyond(text) for text in "ABCDEF"], [])[0]], [4, "2 more requirements below."])
        self.assertEqual(self.told("#verdicts p.note", [beyond(text) for text in "ABCDE"], [])[0], "1 more requirement below.")
        found = self.told("#verdicts .findings:not(.stalls) > li", [beyond("A", margin=40)], [beyond("A", margin=-3), beyond("B", upper=False, beyond_runs=[{"run": 6, "value": 1}])])
        self.assertTrue(found[0].startswith("A: in hot 3 of 2,000 runs (0.15 %) have root peak moment above 200 N·m, where at most 12 may"), found[0])
        self.assertIn("Also fails in cold (+40.0 N·m to the limit). ", found[0])
        self.assertTrue("have root peak moment below 200 N·m" in found[1] and "The 1 % quantile is 150.0 N·m, its one-sided 90 % bound 160.0 N·m. " in found[1] and "The worst run is 6. " in found[1], found[1])
        self.assertIn("1 of 2,000 runs (0.050 %) has |root peak moment| above", self.told("#verdicts .findings > li", [stated("A", "failed", beyond=1, broken=1, abs=True)], [])[0])

    def test_verdicts_side_by_side_begin_with_those_that_change(self):
        self.open(pages.made_up("cases"))
        self.told("#verdicts", [stated("A"), stated("B", broken=3, beyond=2, not_deployed=1, margin=-7), stated("C", runs=1500, broken=1)], [stated("A"), stated("B", "failed", broken=5, beyond=5, upper=False), stated("D", "open", margin=None, guaranteed_value=None)], [])
        rows = self.run_script("W.comparison(); return [...document.querySelector('.side-by-side').tBodies[0].rows].map(row => [row.className, ...[...row.cells].map(cell => cell.textContent)])")
        name = "root peak moment ≤ 200 N·m, 99 % at 90 %"
        self.assertEqual(rows, [["changed", f"B: {name}", "✓ pass −7.00 N·m1 not deployed, 2 above the limit", "✕ fail +40.0 N·m5 below the limit"], ["changed", f"C: {name}", "✓ pass +40.0 N·m1 of 1,500 runs break it", "not required"],
                                ["changed", f"D: {name}", "not required", "? undecided +50.0 N·m (observed)0 of 2,000 runs break it"], ["", f"A: {name}", "✓ pass +40.0 N·m0 of 2,000 runs break it", "✓ pass +40.0 N·m0 of 2,000 runs break it"]])
        self.assertEqual(self.run_script("return [...document.querySelectorAll('#comparison > .content > details')].map(one => one.open)"), [True, True])
        self.run_script("W.data.comparisons.push(W.data.comparisons[0]); W.data.comparisons.forEach((one, at) => { one.folders = at === 1; one.statuses = []; }); W.comparison()")
        self.assertEqual(self.run_script("return [[...document.querySelectorAll('#comparison > .content > details')].map(one => one.open), [...document.querySelectorAll('#comparison caption')].some(one => /outcomes/.test(one.textContent))]"), [[False, True, False], False])

    def test_influences_and_dispersions_without_one(self):
        self.open(pages.made_up("plain"))
        effect = lambda draw, value, low, high, partial=None: {"output": "root.peak_moment", "draw": draw, "spearman": value, "spearman_lower": low, "spearman_upper": high, "prcc": value if partial is None else partial, "prcc_lower": low, "prcc_upper": high}
        show = lambda effects, dispersions, **more: (self.run_script("Object.assign(W.set().sensitivity, { effects: arguments[0], idle: [], ...arguments[2] }); W.set().inputs.dispersions = arguments[1]; W.choose('output', 'root.peak_moment'); W.why()", effects, dispersions, more), [one.get_attribute("textContent") for one in self.all("#why p.effects")])[1]
        given = lambda draw, paths, **more: {"draw": draw, "paths": paths, "law": "", "low": 0, "high": 1, "unit": "", **more}
        self.assertEqual(show([effect("a", 0.6, 0.5, 0.7), effect("b", -0.4, -0.5, -0.3), effect("c", 0.1, -0.1, 0.2)], [given("a", ["hinges.a.spring"]), given("b", ["x", "y"], apply="by a table")]),
                         ["root peak moment increases most with a (acts on hinges.a.spring) and decreases most with b (acts on 2 parameters by tables)."])
        self.assertEqual(show([effect("c", 0.1, -0.1, 0.2), effect("b", -0.4, -0.5, -0.3)], [given("b", ["x", "y"], words="friction")]), ["root peak moment decreases most with friction."])
        self.assertEqual(show([effect("a", 0.6, -0.5, 0.7)], []), [])
        self.assertEqual(show([effect("a", 0.3, 0.1, 0.7, -0.5)], [given("a", ["x", "y"])]), ["root peak moment decreases most with a (acts on 2 parameters)."])  # the larger of both coefficients tells
        note = lambda: self.run_script("return document.querySelector('figure.tornado > .note').textContent")
        show([effect("a", 0.6, 0.5, 0.7)], [given("a", [])], confidence=0.9)
        self.assertIn("Lines are 90 % two-sided bounds. Bars", note())
        show([effect("a", 0.6, 0.5, 0.7)], [given(f"d{k}", []) for k in range(20)], confidence=0.9)
        self.assertIn("Lines are 90 % two-sided bounds of one coefficient: if none of the 20 dispersions had an effect, about 2.0 of them would still exclude 0.", note())
        for count in (0, 1, 12, 13):
            show([effect("a", 0.6, 0.5, 0.7)], [], idle=[f"d{k}" for k in range(count)])
            folds = self.run_script("return [...document.querySelectorAll('#why details')].filter(one => /without a visible/.test(one.textContent)).map(one => [one.open, one.querySelector('summary').textContent, one.querySelector('.note').textContent.split('. Here')[0]])")
            self.assertEqual(folds, [[count <= 12, f"{count} dispersion{'s' * (count > 1)} without a visible effect on any output", ", ".join(f"d{k}" for k in range(count))]] if count else [])
        self.run_script("W.set().sensitivity.held = false; W.why()")
        pages.settle(self.driver)
        self.assertIn("PRCC", self.run_script("return [...document.querySelectorAll('figure.tornado .legend text')].map(one => one.textContent)"))
        for count, text in ((4, None), (5, "One more pair"), (6, "2 more pairs")):
            folds = self.run_script("const set = W.set(); W.pair = W.pair ?? set.scatters[0]; set.scatters = d3.range(arguments[0]).map(() => W.pair); W.why(); return [document.querySelectorAll('#why .content > .grid.pairs figure.scatter').length, ...[...document.querySelectorAll('#why details.later > summary')].map(one => one.textContent)]", count)
            self.assertEqual(folds, [4] + ([text] if text else []))

    def test_a_requirement_has_its_unit_where_the_page_leaves_its_output_out(self):
        self.open(pages.made_up("plain"))
        text = self.run_script("""const one = W.set().requirements.find(each => each.name === "R-2"); Object.assign(one, { unit: "rad/s", limit: 0.6981317007977318 });
            const set = W.set(); set.outputs = set.outputs.filter(each => each.name !== one.output); return [W.verdicts.wordsOf(one, set), W.verdicts.valueText(0.5, one, set)]""")
        self.assertIn("≤ 40 deg/s, 99 % at 90 %", text[0])
        self.assertTrue(text[1].endswith(" deg/s"), text[1])

    def test_inputs_of_each_case(self):
        self.open(pages.made_up("cases"))
        self.run_script("""W.sets.forEach((set, at) => { set.inputs.scene = [{ path: 'a.b', label: 'stowed', value: 0.5, unit: 'rad', case_value: [0.25, null, 'off'][at] }, { path: 'c', label: 'mass', value: 2, unit: 'kg m^2', case_value: null }];
            set.inputs.dispersions = [{ draw: 'k', words: 'springs', law: ['normal', 'normal', 'uniform'][at], law_before_case: at === 2 ? 'normal' : null, unit: 'N m', nominal: 3, nominal_unit: 'rad', low: 1, high: 2, apply: 'scale', paths: ['p'] },
                { draw: 'm', law: 'same', unit: 'rad', nominal: 0.5, nominal_unit: 'rad', low: -0.5, high: 1.25, paths: ['p', 'q'] }].slice(0, at === 1 ? 1 : 2); }); W.choose('set', 2)""")
        self.assertEqual(self.table("Changes of the nominal scene by case"), [["stowed", "rad", "0.5", "0.25", "as nominal", "off"]])
        self.assertEqual(self.table("Dispersions whose law differs"), [["springs", "normal", "normal", "uniform"], ["m", "same", "–", "same"]])
        self.assertEqual(self.heads("Dispersions whose law differs"), ["Dispersion", "cold", "ambient", "hot"])
        self.assertEqual(self.table("Scene of hot"), [["stowed", "0.5", "rad", "28.6479 deg", "off", "a.b"], ["mass", "2", "kg·m²", "", "–", "c"]])
        self.assertEqual(self.table("Dispersions of hot"), [["springs k", "uniform (nominal: normal)", "N·m", "3 rad", "1.000 … 2.000", "", "scale: p"], ["m", "same", "rad", "–", "−0.5000 … 1.250", f"{-0.5 * DEGREES:.4f} deg … {1.25 * DEGREES:.4f} deg".replace("-", "−"), "p, q"]])
        summaries = lambda: self.run_script("return [...document.querySelectorAll('#inputs details')].map(one => [one.open, one.querySelector('summary').textContent])")
        self.assertEqual(summaries(), [[True, "Scene: 2 parameters"], [True, "Dispersions: 2"]])
        self.run_script("const set = W.set(); set.inputs.scene = d3.range(81).map(at => ({ path: `p${at}`, label: `p${at}`, value: at, unit: '', case_value: null })); set.inputs.dispersions = d3.range(61).map(at => ({ draw: `d${at}`, law: '', low: 0, high: 1, paths: [] })); W.inputs()")
        self.assertEqual(summaries(), [[False, "Scene: 81 parameters"], [False, "Dispersions: 61"]])
        self.run_script("W.sets.forEach(set => { set.inputs.scene.length = 1; set.inputs.scene[0].case_value = null; }); W.sets[0].inputs.dispersions[0].law_before_case = 'uniform'; W.inputs()")
        self.assertIn("No case changes a listed parameter of the scene; the cases' distributions differ (below).", self.one("#inputs").text)
        self.run_script("W.sets.forEach(set => set.inputs.dispersions = []); W.inputs()")
        text = self.one("#inputs").text
        self.assertTrue("No case changes a listed parameter of the scene." in text and "The campaign has no dispersions." in text, text)
        rows = self.run_script("return Object.entries(W.data.glossary)")
        self.assertEqual(self.table("Meaning, unit and sign of every name"), [[name, one["unit"].replace("rad", "deg").replace(" ", "·"), one["text"]] for name, one in rows])
        traced = [["SYS-1", "L-1: root peak moment ≤ 215 N·m, 99 % at 90 %", "specification 4.2", "strength of the root fitting"]]
        self.assertEqual(self.table("Identifier, source and rationale of each requirement")[:1], traced)
        self.run_script("W.set().inputs.scene = []; W.inputs()")
        self.assertIn("The folder does not contain its campaign's inputs.", self.one("#inputs").text)

    def test_what_requirements_show_together_and_by_which_commands(self):
        self.open(pages.made_up("plain"))
        wanted = {"groups": [{"group": "strength <b>", "confidence": 0.9, "requirements": 3, "passed": 2, "verdict": "failed"}], "confidence": 0.875}
        self.run_script("W.sets[0].together = arguments[0]; W.sets[0].judged_by = 'wingspread analyze again --requirements a/summary.json'; W.outcomes()", wanted)
        passing = self.run_script("return W.sets[0].requirements.filter(one => one.verdict === 'passed').length")
        lines = self.run_script("return [...document.querySelectorAll('ul.together li')].map(e => e.textContent)")
        self.assertGreater(passing, 1)
        self.assertEqual(len(lines), 2)
        for fact in ("group strength <b>", "2 of 3 pass", "joint confidence 90 %"):
            self.assertIn(fact, lines[0])
        self.assertIn("at least 87.5 %", lines[1])
        commands = self.run_script("return [...document.querySelectorAll('.again .command code')].map(e => e.textContent)")
        self.assertEqual(commands[1], "wingspread analyze again --requirements a/summary.json")
        self.run_script("W.sets[0].together.confidence = -0.1; W.sets[0].together.groups = []; W.outcomes()")
        self.assertIn("no guarantee", self.run_script("return document.querySelector('ul.together').textContent"))
        self.open(pages.made_up("cases"))
        self.run_script("for (const set of W.sets) set.together = arguments[0]; W.sets[1].together = { ...arguments[0], groups: [] }; W.outcomes()", wanted)
        labels = self.run_script("return W.sets.map(set => set.label)")
        group = next(line for line in self.run_script("return [...document.querySelectorAll('ul.together li')].map(e => e.textContent)") if "group" in line)
        self.assertEqual([label in group.split("group")[0] for label in labels], [at != 1 for at in range(len(labels))])

    def test_the_scenes_tables_and_the_notes_of_its_modes(self):
        self.open(pages.made_up("plain"))
        table = {"path": "hinges.root.spring.measured", "columns": [{"name": "angle", "unit": "rad", "values": [-1.5, 0, 0.25]}, {"name": "deploying", "unit": "N·m", "values": [2, 1.5, 1]}]}
        self.run_script("W.set().inputs.tables = [arguments[0]]; W.inputs()", table)
        rows = self.run_script("return [...document.querySelectorAll('table.scene-tables tbody tr')].map(row => [...row.cells].map(cell => cell.textContent))")
        self.assertEqual([row[0] for row in rows], ["hinges.root.spring.measured", ""])
        for row, column in zip(rows, table["columns"], strict=True):
            factor, unit = (DEGREES, "deg") if column["unit"] == "rad" else (1, column["unit"])
            self.assertEqual((row[1], row[2]), (column["name"], unit))
            for cell, value in zip(row[3].split(" · "), column["values"], strict=True):
                self.assertAlmostEqual(float(cell.replace("\u2212", "-")), factor * value, delta=1e-4 * abs(factor * value))
        self.run_script("W.set().inputs.tables = []; W.inputs()")
        self.assertEqual(self.run_script("return document.querySelectorAll('table.scene-tables').length"), 0)
        self.run_script("W.set().modes = { wing: W.set().wing, rest: [0, 0, 0], notes: ['root presses its stop'], modes: [{ frequency: 1, damping_ratio: 0, shape: [1, 0, 0], base: null }] }; W.modes()")
        self.assertIn("root presses its stop.", self.one("#modes").text)

    def test_sets_at_different_confidence_have_each_its_own(self):
        """Beside each outcome's bounds; one confidence for all stands in the caption alone."""
        self.open(pages.made_up("cases"))
        self.run_script("W.sets[1].confidence = 0.5; W.outcomes()")
        captions = self.run_script("return [...document.querySelectorAll('#verdicts caption')].map(one => one.textContent)")
        (caption,) = [one for one in captions if one.startswith("Outcomes by")]
        self.assertNotIn("%", caption)
        for at, row in enumerate(self.table(caption)):
            self.assertIn("(50 %)" if at == 1 else "(95 %)", row[2])
        self.assertIn("two-sided bounds at 95 % and 50 %, by case", self.one("#subtitle .facts").text)

    def test_a_curve_over_the_runs_with_a_value_says_so(self):
        self.open(pages.made_up("plain"))

        def words_with(change):
            self.run_script(change + "; W.choose('output', W.chosen.output)")
            self.wait(lambda: self.run_script("return !!document.querySelector('figure.distribution .picture svg')"))  # once its size is seen
            return self.run_script("return document.querySelector('figure.distribution').outerHTML")

        self.assertNotIn("with a value", words_with("W.output().missing = 0"))
        words = words_with("Object.assign(W.output(), { missing: 100, count: 1900 })")
        for fact in ("share of the runs with a value at or below", "1,900 of 2,000 runs", "their quantiles with bounds"):
            self.assertIn(fact, words)

    def test_what_breaks_a_requirement_is_counted_whole(self):
        """Values beyond the limit are one cause of several; a change of the draws is proposed where they alone are too many."""
        self.open(pages.made_up("loads"))
        told = lambda **counts: self.run_script("""W.sets.length = 1; W.chosen.set = 0; const one = W.set().requirements.find(each => each.limit !== null);
            Object.assign(one, { verdict: "failed", allowed: 90, without_value: 0, margin: null }, arguments[0]); one.broken = one.not_deployed + one.without_value + one.cut + one.beyond; one.runs = W.set().runs = W.set().planned = 200;
            W.set().requirements = [one]; W.outcomes();
            return [document.querySelector('.findings:not(.stalls) li').textContent, document.querySelectorAll('.findings:not(.stalls) .needed').length, document.querySelector('.matrix tbody, table.requirements tbody').textContent]""", counts)
        text, needed, _ = told(not_deployed=98, cut=39, beyond=63)
        for fact in ("200 of 200 runs (100", "break it, where at most 90 may", ": 98 did not deploy, 39 have a peak that t_end cut and 63 have ", "would be few enough"):
            self.assertIn(fact, text)
        self.assertEqual(needed, 0)
        text, needed, _ = told(not_deployed=0, cut=0, beyond=93, changes=[{"for": "limit", "runs": 200, "explained": 0.9, "levers": [], "needs": []}])
        self.assertIn("93 of 200 runs", text)
        self.assertNotIn("few enough", text)
        self.assertEqual(needed, 1)
        self.assertIn("1 has a peak", told(not_deployed=1, cut=1, beyond=92)[0])

    def test_cut_peaks_are_named_where_they_decide(self):
        self.open(pages.made_up("cases"))
        told = lambda **counts: self.run_script("""W.sets.forEach(set => set.requirements = [Object.assign(set.requirements.find(each => each.limit !== null), { verdict: "failed", allowed: 90, margin: null, guaranteed_value: null, observed_value: null }, arguments[0])]);
            W.outcomes(); return document.querySelector('table.matrix tbody').textContent + W.verdicts.guaranteed(W.sets[0].requirements[0], W.sets[0])""", counts)
        for text in ("58 peaks cut by t_end", "none: t_end cut peaks"):  # two cells, one rule
            self.assertIn(text, told(not_deployed=20, cut=58, beyond=40, broken=118))
        for text in ("151 not deployed", "too few runs with a value"):
            self.assertIn(text, told(not_deployed=151, cut=58, beyond=0, broken=209))
        self.assertIn("58 peaks cut by t_end", told(not_deployed=0, cut=58, beyond=100, broken=158))

    def test_nothing_that_varies_can_be_changed(self):
        self.open(pages.made_up("loads"))
        told = self.run_script("""W.sets.length = 1; W.chosen.set = 0; W.set().inputs.dispersions.forEach(one => Object.assign(one, { low: 1, high: 1 }));
            for (const one of W.set().requirements) one.changes = [{ for: "limit", runs: 0, explained: null, levers: [], needs: [] }];
            W.outcomes(); return document.querySelector('.findings').textContent""")
        self.assertIn("No dispersion varies", told)
        self.assertNotIn("Too few runs", told)

    def test_a_share_that_is_undecided_has_no_distance(self):
        self.open(pages.made_up("plain"))
        row = lambda verdict: self.run_script("""const one = W.set().requirements.find(each => each.output === "deployed"); Object.assign(one, { verdict: arguments[0], guaranteed: 0.1, probability: 0.9 }); W.set().requirements = [one]; W.outcomes();
            return document.querySelector('table.requirements tbody').textContent""", verdict)
        self.assertIn("%-points", row("failed"))
        self.assertNotIn("%-points", row("open"))

    def test_an_outcome_without_bounds_says_why_and_each_analysis_has_its_command(self):
        self.open(pages.made_up("cases"))
        self.run_script("""W.sets.forEach((set, at) => { set.made_by = "wingspread run c.json --out again"; set.judged_by = ["wingspread analyze again --bins 7", "wingspread analyze again --bins 7", "wingspread analyze again/hot --bins 9"][at];
            set.statuses.forEach(one => Object.assign(one, { lower: null, upper: null, note: "one replicate has none" })); }); W.outcomes()""")
        commands = self.run_script("return [...document.querySelectorAll('.again .command code')].map(e => e.textContent)")
        self.assertEqual(commands[:3], ["wingspread run c.json --out again", "wingspread analyze again --bins 7", "wingspread analyze again/hot --bins 9"])
        self.assertIn("one replicate has none", self.table("Outcomes by case, with 95 % two-sided bounds")[0][2])
        told = lambda judged_by: self.run_script("""W.sets.forEach(set => set.judged_by = arguments[0]); W.outcomes(); return document.querySelector('.findings')?.textContent ?? ''""", judged_by)
        self.open(pages.made_up("loads"))
        if "It judges all" in told(""):
            self.assertIn("requirements of the campaign's file", told("wingspread analyze again --bins 7"))
            self.assertIn("requirements on this page", told("wingspread analyze again --requirements r.json"))
