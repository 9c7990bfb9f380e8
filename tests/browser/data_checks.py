"""The block of data of the program's own pages against the rows of runs.csv: counts, moments, pictures' bins and steps, correlations, pairs, differences."""

import bisect
import collections
import csv
import itertools
import json
import math
import statistics

import pages

DIGITS = 2e-6  # the block has seven digits


def ranks(values):
    """Of each value; equal ones share the mean of theirs."""
    ordered = sorted(values)
    return [(bisect.bisect_left(ordered, value) + bisect.bisect_right(ordered, value) + 1) / 2 for value in values]


def pearson(pairs):
    x, y = zip(*pairs)
    a, b = statistics.mean(x), statistics.mean(y)
    spread = math.sqrt(sum((v - a) ** 2 for v in x) * sum((v - b) ** 2 for v in y))
    return sum((v - a) * (w - b) for v, w in pairs) / spread if spread else None


class DataChecks:
    """For Own."""

    def close(self, got, want, about, near=DIGITS, least=0.0):
        if want is None or got is None:
            self.assertEqual(got, want, about)
        else:
            self.assertTrue(math.isclose(got, want, rel_tol=near, abs_tol=least), f"{about}: {got} for {want}")

    def test_the_data_are_those_of_the_rows(self):
        for campaign, runs in (("satellite", 40), ("stall", 300)):
            self.open(pages.real(campaign, runs))
            data = self.run_script("return W.data")
            tables = []
            for one in data["sets"]:
                folder = pages.SCRATCH / campaign / (one["case"] or "")
                rows = list(csv.DictReader((folder / "runs.csv").read_text("utf-8").splitlines()))
                tables.append(rows)
                self.assertEqual((one["runs"], one["confidence"]), (len(rows), 0.95))
                self.set_counts(one, rows)
                values = {output["name"]: [float(row[output["name"]]) if row[output["name"]] else None for row in rows] for output in one["outputs"]}
                for output in one["outputs"]:
                    self.output_numbers(one, output, values[output["name"]], rows)
                self.set_pairs(one, values, rows)
            for comparison in data["comparisons"]:
                self.set_differences(comparison, data["sets"], tables)

    def test_where_hinges_of_stalled_runs_stopped(self):
        """Of a campaign that records final angles; nothing of another."""
        campaign = json.loads((pages.ROOT / "studies/campaigns/stall.json").read_text("utf-8"))
        campaign["scene"] = str((pages.ROOT / "studies/campaigns" / campaign["scene"]).resolve())
        campaign["outputs"] = [*campaign.get("outputs", []), "latch_time", "final_angle"]
        campaign["outputs"] = list(dict.fromkeys(campaign["outputs"]))
        path = pages.SCRATCH / "stopped.json"
        path.write_text(json.dumps(campaign), "utf-8")
        self.open(pages.reported("stopped", pages.made_of(path, 300, "stopped")))
        rows = list(csv.DictReader((pages.SCRATCH / "stopped" / "runs.csv").read_text("utf-8").splitlines()))
        found = {one["hinge"]: one for one in self.run_script("return W.set().stalled_at")}
        wanted = {hinge: [float(row[f"{hinge}.final_angle"]) for row in rows if row["status"] == "stalled" and not row[f"{hinge}.latch_time"]] for hinge in ("root", "mid", "tip")}
        self.assertTrue(any(wanted.values()))
        self.assertEqual({hinge: one["count"] for hinge, one in found.items()}, {hinge: len(values) for hinge, values in wanted.items() if values})
        for hinge, one in found.items():
            self.close(one["least"], min(wanted[hinge]), hinge)
            self.close(one["largest"], max(wanted[hinge]), hinge)
            self.assertTrue(statistics.median_low(wanted[hinge]) - 1e-6 <= one["median"] <= statistics.median_high(wanted[hinge]) + 1e-6, hinge)
        for row, (hinge, one) in zip(self.table("Where stalled hinges stopped: angle from the latched one, deg"), found.items(), strict=True):
            self.assertEqual(row[0], hinge)
            self.check(row[2], math.degrees(one["median"]), about=hinge)
        self.open(pages.real("stall", 300))
        self.assertIsNone(self.run_script("return W.set().stalled_at ?? null"))

    def set_counts(self, one, rows):
        count = collections.Counter(row["status"] for row in rows)
        self.assertEqual({each["status"]: each["count"] for each in one["statuses"] if each["count"]}, dict(count))
        for each in one["statuses"]:
            self.close(each["rate"], each["count"] / len(rows), each["status"])
        reasons = collections.Counter(row["status"] for row in rows if row["status"] != "deployed")
        for status, number in reasons.items():
            self.assertEqual(sum(each["count"] for each in one["reasons"] if each["status"] == status), number, status)
        wings = [wing["hinges"] for wing in one["wing_orders"]]  # of several wings the order is that of each
        of = lambda order: "·".join(">".join(name for name in order.split(">") if name in hinges) for hinges in wings) if wings and order else order
        orders = collections.Counter(of(row["latch_order"]) for row in rows)
        without = orders.pop("", 0)
        self.assertEqual(one["order_kinds"], len(orders))
        self.assertEqual(one["without_latch"], without)
        listed = [each["count"] for each in one["orders"] if each["order"] not in ("others", "no latch")]
        self.assertEqual(listed, sorted(orders.values(), reverse=True)[:6])
        others = sum(orders.values()) - sum(listed)
        self.assertEqual([(each["order"], each["count"]) for each in one["orders"][len(listed):]], [pair for pair in (("others", others), ("no latch", without)) if pair[1]])
        if not one["wing_orders"]:
            for each in one["orders"]:
                if each["order"] in orders:
                    self.assertEqual(each["count"], orders[each["order"]])
                    for gap in each["gaps"]:
                        times = [float(row[f"{gap['after']}.latch_time"]) - float(row[f"{gap['before']}.latch_time"]) for row in rows if row["latch_order"] == each["order"]]
                        self.close(gap["least"], min(times), each["order"], 1e-3)
                        self.assertTrue(0.999 * statistics.median_low(times) <= gap["median"] <= 1.001 * statistics.median_high(times), each["order"])
                    self.assertEqual([gap["before"] for gap in each["gaps"]] + [gap["after"] for gap in each["gaps"][-1:]], each["order"].split(">") if each["gaps"] else [])
        for wing in one["wing_orders"]:
            own = collections.Counter(">".join(name for name in row["latch_order"].split(">") if name in wing["hinges"]) for row in rows)
            none = own.pop("", 0)
            self.assertEqual((wing["order_kinds"], wing["without_latch"]), (len(own), none), wing["wing"])
            self.assertEqual([each["count"] for each in wing["orders"]], sorted(own.values(), reverse=True)[:6])
            for each in wing["orders"]:
                self.assertEqual(each["count"], own[each["order"]])

    def output_numbers(self, one, output, column, rows):
        about, values = output["name"], sorted(value for value in column if value is not None)
        n = len(values)
        self.assertEqual((output["count"], output["missing"]), (n, len(column) - n), about)
        if n < 3:
            return
        mean, std = statistics.fmean(values), statistics.stdev(values)
        scale = max(map(abs, values)) * 1e-6 + 1e-300
        for key, want in (("mean", mean), ("std", std), ("mean_error", std / math.sqrt(n)), ("min", values[0]), ("max", values[-1])):
            self.close(output[key], want, f"{key} of {about}", least=scale)
        if std > 1e-6 * abs(mean):
            third, fourth = (sum((value - mean) ** k for value in values) / n / (std * math.sqrt((n - 1) / n)) ** k for k in (3, 4))
            self.assertAlmostEqual(output["skewness"], third, delta=0.02 * abs(third) + 6 / n, msg=about)
            self.assertAlmostEqual(output["kurtosis"], fourth - 3, delta=0.05 * abs(fourth) + 30 / n, msg=about)
        for quantile in output["quantiles"]:
            among = quantile.get("among") or quantile
            if among["value"] is not None:
                below, upto = sum(value < among["value"] - scale for value in values), sum(value <= among["value"] + scale for value in values)
                self.assertTrue(below - 1.5 <= quantile["p"] * n <= upto + 1.5, f"{about} at {quantile['p']}")
                self.assertTrue(all(bound is None or side * (bound - among["value"]) >= -scale for side, bound in ((-1, among["lower"]), (1, among["upper"]))), about)
        if histogram := output["histogram"]:
            edges = histogram["edges"]
            for got, want in zip((edges[0], edges[-1]), (values[0], values[-1])):
                self.close(got, want if values[-1] > values[0] else got, about, least=scale)
            self.assertEqual(sum(histogram["counts"]), n, about)
            near = (edges[-1] - edges[0]) * 1e-6
            for bin_, (low, high) in enumerate(zip(edges, edges[1:])):
                sure, some = (sum(low + side * near <= value < high - side * near for value in values) for side in (1, -1))
                self.assertTrue(sure <= histogram["counts"][bin_] <= some + (bin_ == len(edges) - 2), f"{about}, bin {bin_}")
            if not one["wing_orders"]:
                for order, counts in zip(one["orders"], histogram["by_order"]):
                    if ">" in order["order"]:
                        self.assertEqual(sum(counts), sum(row["latch_order"] == order["order"] and value is not None for row, value in zip(rows, column)), f"{about} of {order['order']}")
        if curve := output["curve"]:
            for x, p, low, high in zip(*(curve[key] for key in ("x", "p", "lower", "upper")), strict=True):
                self.assertTrue(sum(value < x - scale for value in values) - 1e-6 * n <= p * n <= sum(value <= x + scale for value in values) + 1e-6 * n, f"{about} at {x}")
                self.assertTrue(low <= p <= high, about)
            band = math.sqrt(math.log(2 / 0.05) / (2 * n))
            if "Dvoretzky" in curve["band"]:
                self.assertAlmostEqual(max(high - p for p, high in zip(curve["p"], curve["upper"])), min(band, max(1 - p for p in curve["p"])), places=5, msg=about)
        if settled := output["convergence"]:
            for at, run in enumerate(settled["runs"]):
                sample = [value for value in column[:run] if value is not None]
                self.close(settled["mean"][at], statistics.fmean(sample), f"convergence of {about} at {run}", 1e-5, scale)
            self.close(settled["quantile"][-1], next(quantile["value"] for quantile in output["quantiles"] if quantile["p"] == settled["quantile_p"]), about, 1e-5, scale)

    def set_pairs(self, one, values, rows):
        table = one["correlations"]
        for (at, draw), (place, name) in itertools.product(list(enumerate(table["draws"]))[::3], list(enumerate(table["outputs"]))[::4]):
            pairs = [(float(row[draw]), value) for row, value in zip(rows, values[name]) if value is not None]
            for key, of in (("pearson", list), ("spearman", ranks)):
                got = table[key][at][place]
                if got is not None:
                    self.assertAlmostEqual(got, pearson(list(zip(*map(of, zip(*pairs))))), places=2, msg=f"{key} of {draw} and {name}")
        for pair in one["scatters"]:
            points, column = pair["points"], values[pair["output"]]
            for run, x, y, order in zip(*(points[key] for key in ("run", "x", "y", "order")), strict=True):
                self.close(x, float(rows[run][pair["draw"]]), pair["draw"], 1e-3)
                self.close(y, column[run], pair["output"], 1e-3)
                if not one["wing_orders"] and order >= 0 and ">" in one["orders"][order]["order"]:
                    self.assertEqual(one["orders"][order]["order"], rows[run]["latch_order"])
            kept = [(float(row[pair["draw"]]), value) for row, value in zip(rows, column) if value is not None]
            self.assertEqual((sum(pair["density"]), len(pair["density"])), (len(kept), 1024), pair["output"])
            across = [sum(pair["density"][k::32]) for k in range(32)]
            for bin_, (low, high) in enumerate(zip(pair["x_edges"], pair["x_edges"][1:])):
                near = 1e-3 * abs(high) + 1e-3 * (pair["x_edges"][-1] - pair["x_edges"][0]) / 32
                sure, some = (sum(low + side * near <= x < high - side * near for x, _ in kept) for side in (1, -1))
                self.assertTrue(sure <= across[bin_] <= some + (bin_ == 31), f"{pair['draw']}, column {bin_}")
            self.assertAlmostEqual(pair["spearman"], pearson(list(zip(*map(ranks, zip(*kept))))), places=2, msg=pair["output"])
        if one["envelopes"] and one["envelopes"]["runs"] == len(rows):
            for hinge, times in zip(one["wing"]["hinges"], one["envelopes"]["latch_times"]):
                want = sorted(value for value in values.get(f"{hinge['name']}.latch_time", []) if value is not None)
                for got, time in zip(times, want, strict=True):
                    self.close(got, time, hinge["name"], 1e-3)

    def set_differences(self, comparison, sets, tables):
        """Run by run where both sets have the same draws."""
        first, second = (tables[at] for at in comparison["sets"])
        self.assertTrue(comparison["paired"])
        for one in comparison["outputs"]:
            pairs = [(float(a[one["output"]]), float(b[one["output"]])) for a, b in zip(first, second) if a[one["output"]] and b[one["output"]]]
            if one["magnitude"]:
                pairs = [(abs(a), abs(b)) for a, b in pairs]
            self.assertEqual(one["runs"], len(pairs), one["output"])
            if len(pairs) < 2 or one["difference"] is None:
                continue
            steps = [b - a for a, b in pairs]
            size = max(abs(value) for pair in pairs for value in pair)
            self.close(one["difference"], statistics.fmean(steps), one["output"], 1e-5, 1e-6 * size)
            mean = statistics.fmean(a for a, _ in pairs)
            if one["relative"] is not None and abs(mean) > 1e-9:
                self.close(one["relative"], statistics.fmean(steps) / abs(mean), one["output"], 1e-4, 1e-6)
            if one["lower"] is not None:
                half, error = (one["upper"] - one["lower"]) / 2, statistics.stdev(steps) / math.sqrt(len(steps))
                self.assertTrue(1.95 * error - 1e-6 * size <= half <= 13 * error + 1e-6 * size, one["output"])  # Student's factor
                self.close((one["upper"] + one["lower"]) / 2, one["difference"], one["output"], 1e-4, 1e-6 * size)
        for each in comparison["statuses"]:
            rates = [sum(row["status"] == each["status"] for row in table) / len(table) for table in (first, second)]
            self.close(each["difference"], rates[1] - rates[0], each["status"], 1e-5, 1e-9)
            if each["lower"] is not None:
                self.assertTrue(each["lower"] <= each["difference"] <= each["upper"], each["status"])
