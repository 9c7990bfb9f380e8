"""What is shown of several things that a set may have: influences by either coefficient, the orders that are not listed, the spread inside cases."""

import math
import re
import statistics

import pages


class CauseChecks:
    """For a Page with MarkChecks."""

    def test_an_influence_is_told_if_either_coefficient_shows_it(self):
        self.open(pages.made_up("plain"))
        bounds = {True: (0.1, 0.7), False: (-0.1, 0.7)}
        for sign, words in ((1, "increases most with a"), (-1, "decreases most with a")):
            for spearman in (True, False):
                for partial in (True, False):
                    effect = {"output": "root.peak_moment", "draw": "a"}
                    for key, shown in (("spearman", spearman), ("prcc", partial)):
                        ends = sorted(sign * end for end in bounds[shown])
                        effect.update({key: sign * 0.4, f"{key}_lower": ends[0], f"{key}_upper": ends[1]})
                    text = self.run_script("""Object.assign(W.set().sensitivity, { kind: 'rank', effects: [arguments[0]], idle: [] }); W.set().inputs.dispersions = [];
                        W.choose('output', 'root.peak_moment'); W.why(); return [...document.querySelectorAll('#why p.effects')].map(one => one.textContent).join('')""", effect)
                    self.assertEqual(words in text, spearman or partial, (effect, text))

    def test_orders_that_are_not_listed_are_counted_without_those_that_are(self):
        self.open(pages.made_up("plain"))
        for named in (1, 3):
            for without in (False, True):
                for more in (1, 4):
                    orders = [{"order": ">".join("ab"[: 1 + at % 2]) + "c" * at, "count": 50 - at} for at in range(named)] + [{"order": "others", "count": 9}]
                    orders += [{"order": "no latch", "count": 7}] if without else []
                    self.run_script("Object.assign(W.set(), { orders: arguments[0], wing_orders: [], without_latch: 0, order_kinds: arguments[1] }); W.outcomes()", orders, named + more)
                    cells = [row[0] for row in self.table("Latch orders")]
                    self.assertEqual(cells[named], "one other order" if more == 1 else f"{more} other orders")
                    self.assertEqual(len(cells), named + 1 + without)

    def test_cases_of_different_spread_are_pooled_by_their_variances(self):
        self.open(pages.made_up("cases"))
        for means, spreads in (((10, 20, 60), (1, 2, 20)), ((100, 101, 103), (0.5, 8, 3))):
            text = self.run_script("""const [means, stds] = arguments, name = 'root.peak_moment';
                W.sets.forEach((set, at) => Object.assign(set.outputs.find(one => one.name === name), { mean: means[at], std: stds[at] })); return W.caseEffect(W.sets[0], name)""", means, spreads)
            between, inside = statistics.pvariance(means), statistics.mean(one**2 for one in spreads)
            share, pooled = re.search(r"weight, ([\d.]+) % lies between the cases.*pooled over the cases, is ([\d.]+) ", text).groups()
            self.assertAlmostEqual(float(share), 100 * between / (between + inside), delta=0.06, msg=text)
            self.assertAlmostEqual(float(pooled), math.sqrt(inside), delta=0.006 * math.sqrt(inside), msg=text)

    def test_folders_and_their_cases_are_counted(self):
        """Of sets written "label case folder", with "-" for none; behind "without" those of cases without runs."""
        self.open(pages.made_up("cases"))
        for given, text, kind in (
                ("cold cold 0|hot hot 0", "2 cases: cold, hot", "case"), ("A - 0|B - 1", "2 folders: A, B", "folder"),
                ("A·cold cold 0|B·hot hot 1", "2 folders: A · cold, B · hot", "case"), ("A·cold cold 0|A·hot hot 0|B·cold cold 1", "2 folders: A (2 cases: cold, hot), B · cold", "case"),
                ("A·cold cold 0|A·hot hot 0|B·cold cold 1|B·hot hot 1", "2 folders (A, B) of 2 cases (cold, hot)", "case"), ("a/A/cold cold 0|a/A/hot hot 0|b/A/cold cold 1|b/A/hot hot 1", "2 folders (a/A, b/A) of 2 cases (cold, hot)", "case"),
                ("A·cold cold 0|A·hot hot 0|B - 1", "2 folders: A (2 cases: cold, hot), B", "set"), ("A/x/cold cold 0|B/x/cold cold 1", "2 folders (A/x, B/x) of 1 case (cold)", "folder"),
                ("cold cold 0 without late late 0", "1 of 2 cases: cold", "case"), ("A·cold cold 0|B - 1 without A·late late 0|A·dark dark 0", "2 folders: A (1 of 3 cases: cold), B", "set"),
                ("A·cold cold 0|B·cold cold 1 without B·late late 1", "2 folders: A · cold, B (1 of 2 cases: cold)", "folder"), ("B - 1 without A·late late 0|A·dark dark 0", "2 folders: B, A (0 of 2 cases)", "folder")):
            made, _, unmade = given.partition(" without ")
            listed = lambda texts: [text.replace("·", " · ").rsplit(" ", 2) for text in texts.split("|") if text]
            facts, found, head = self.run_script("""const first = W.sets[0], set = ([label, one, folder]) => ({ label, case: one === '-' ? null : one, campaign_folder: Number(folder) }); W.sets.length = 0;
                arguments[0].forEach(one => W.sets.push({ ...first, ...set(one) })); W.data.unmade = arguments[1].map(one => ({ ...set(one), planned: 5 }));
                W.subtitle(); return [[...document.querySelectorAll('#subtitle .facts span')].map(one => one.textContent), W.kindOfSets(), W.headOfSets()]""", listed(made), listed(unmade))
            self.assertIn(text, facts, given)
            self.assertEqual((found, head), (kind, kind.capitalize()), given)
