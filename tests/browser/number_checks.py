"""Every number that the page prints or draws, against its data, by unit: tables, exported numbers, marks between the ticks of axes.

What is expected comes from the block of data alone. A printed number must agree with it to half a unit of its last digit, and must not
read 0 (or 100 %) where the value is not.
"""

import math
import re

import pages

DEGREES = 180 / math.pi
SUPERSCRIPTS = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
NUMBER = re.compile(r"[−-]?\d[\d,]*(?:\.\d+)?(?: × 10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?")


def parsed(text):
    """(value, half a unit of the last digit) of each number in a text."""
    found = []
    for match in NUMBER.findall(text):
        mantissa, _, power = match.partition(" × 10")
        digits = mantissa.replace("−", "-").replace(",", "")
        scale = 10.0 ** int(power.translate(SUPERSCRIPTS)) if power else 1.0
        found.append((float(digits) * scale, 0.5000001 * scale * 10.0 ** -len(digits.partition(".")[2])))
    return found


class Numbers:
    """Checks of a page's numbers, for a Page: open, run_script, one, all and unittest's assertions come from it."""

    def check(self, text, *expected, share=False, near=1e9, about=""):
        """The numbers of a text are these (None: a dash or words without a number); shares are printed in per cent. `near`: the largest relative difference."""
        expected = [one for one in expected if one is not None]
        numbers = parsed(text)
        self.assertEqual(len(numbers), len(expected), f"{about}: {text!r} for {expected}")
        for (value, half), one in zip(numbers, expected):
            want = 100 * one if share else one
            self.assertLessEqual(abs(value - want), min(half, near * abs(want)) + 1e-9 * abs(want), f"{about}: {text!r} for {want}")
            self.assertEqual(value == 0, want == 0, f"{about}: {text!r} for {want}")
            if share:
                self.assertEqual(value == 100, one == 1, f"{about}: {text!r} for {want}")

    def table(self, caption):
        """The cells of the table with this caption, by row."""
        return self.run_script("""const table = [...document.querySelectorAll('table')].find(t => t.caption.textContent === arguments[0]);
            return [...table.tBodies[0].rows].map(row => [...row.cells].map(cell => cell.textContent))""", caption)

    def exported(self, figure):
        """The text that a figure's button copies, as rows of cells."""
        text = self.driver.execute_async_script("""const done = arguments[1], button = [...document.querySelectorAll(`figure.${arguments[0]} .tools button`)].pop();
            navigator.clipboard.writeText = text => { done(text); return Promise.resolve(); }; button.click()""", figure)
        return [line.split("\t") for line in text.strip("\n").split("\n")]

    def same_rows(self, figure, rows):
        """A figure exports these rows of numbers (None: nothing), to the last digit."""
        got = [[None if cell == "" else cell for cell in row] for row in self.exported(figure)[1:]]
        self.assertEqual(len(got), len(rows), figure)
        for one, want in zip(got, rows):
            for cell, value in zip(one, want, strict=True):
                if isinstance(value, (int, float)):
                    self.assertTrue(math.isclose(float(cell), value, rel_tol=1e-9, abs_tol=1e-12), f"{figure}: {cell} for {value}")
                else:
                    self.assertEqual(cell, value, figure)

    def axis(self, figure, which):
        """Pixels → values of a linear axis, by its first and last tick; and half a unit of a tick's last digit."""
        ticks = self.run_script("""return [...document.querySelectorAll(`figure.${arguments[0]} .axis.${arguments[1]} .tick`)].map(tick => {
            const at = tick.transform.baseVal[0].matrix; return [arguments[1] === 'x' ? at.e : at.f, tick.textContent]; }).filter(tick => tick[1] !== '')""", figure, which)
        (first, low), (last, high) = [(at - 0.5, parsed(text)[0]) for at, text in (ticks[0], ticks[-1])]  # d3 sets ticks half a pixel off
        slope = (high[0] - low[0]) / (last - first)
        self.assertGreater(slope if which == "x" else -slope, 0, f"{figure} {which}: larger values lie to the right, and above")
        for at, text in ticks:  # every tick lies on the line
            self.assertLessEqual(abs(low[0] + slope * (at - 0.5 - first) - parsed(text)[0][0]), abs(slope) + 2 * parsed(text)[0][1], text)
        return lambda pixel: low[0] + slope * (pixel - first), abs(slope) + low[1] + high[1]

    def attributes(self, selector, *names):
        return self.run_script("return [...document.querySelectorAll(arguments[0])].map(e => arguments[1].map(n => Number(e.getAttribute(n))))", selector, names)

    def factor(self, output, unit):
        return DEGREES if unit == "deg" and output["unit"].startswith("rad") else 1

    def output_tables(self, output, factor, about):
        name = self.run_script("return W.format.name(W.output())")
        for one, row in zip(output["quantiles"], self.table(f"Quantiles of {name}"), strict=True):
            self.check(row[1], one["value"] * factor, about=about)
            self.check(row[2], one["lower"] * factor, one["upper"] * factor, about=about)
        keys = ("count", "missing", "nominal", "mean", "mean_error", "std", "min", "max", "skewness", "kurtosis")
        for place, (key, row) in enumerate(zip(keys, self.table(f"Statistics of {name}"), strict=True)):
            self.check(row[1], output[key] * (factor if 2 <= place < 8 else 1), about=f"{about}, {key}")

    def output_pictures(self, one_set, output, factor, about):
        histogram, curve, settled = output["histogram"], output["curve"], output["convergence"]
        edges = [edge * factor for edge in histogram["edges"]]
        rows = self.exported("histogram")[1:]
        for cells, low, high, count in zip(rows, edges[:-1], edges[1:], histogram["counts"], strict=True):
            self.assertTrue(math.isclose(float(cells[0]), low) and math.isclose(float(cells[1]), high), about)
            self.assertEqual(float(cells[2]), count, about)
        self.same_rows("distribution", [[one_set["label"], x * factor, p, low, high]
                                        for x, p, low, high in zip(curve["x"], curve["p"], curve["lower"], curve["upper"])])
        value, near = self.axis("histogram", "x")
        for left, width in self.attributes("figure.histogram .bin", "x", "width"):
            centre = value(left + width / 2)
            self.assertLess(min(abs((a + b) / 2 - centre) for a, b in zip(edges, edges[1:])), 2 * near, about)
        runs, _ = self.axis("histogram", "y")
        tall = sum(abs(runs(y) - runs(y + height)) for y, height in self.attributes("figure.histogram .bin", "y", "height"))
        self.assertAlmostEqual(tall / output["count"], 1, places=2, msg=about)
        for figure in ("histogram", "distribution"):
            self.limits(one_set, output, figure, factor, about)
        value, near = self.axis("distribution", "x")
        for got, one in zip(self.attributes("figure.distribution circle.quantile", "cx"), output["quantiles"], strict=True):
            self.assertLess(abs(value(got[0]) - one["value"] * factor), 2 * near, about)
        for place, keys in enumerate((("mean", "lower", "upper"), ("quantile", "quantile_lower", "quantile_upper"))):
            cells = self.run_script("""const figure = document.querySelectorAll('figure.settling')[arguments[0]]; let text;
                navigator.clipboard.writeText = t => { text = t; return Promise.resolve(); }; [...figure.querySelectorAll('.tools button')].pop().click(); return text""", place)
            rows = [[float(cell) for cell in line.split("\t")] for line in cells.strip().split("\n")[1:]]
            want = [[runs, *(settled[key][at] * factor for key in keys)] for at, runs in enumerate(settled["runs"])]
            for one, other in zip(rows, want, strict=True):
                self.assertTrue(all(math.isclose(a, b, rel_tol=1e-9, abs_tol=1e-12) for a, b in zip(one, other, strict=True)), f"{about}: {one} for {other}")

    def limits(self, one_set, output, figure, factor, about):
        """Each limit is a line where it belongs, with its number; or the histogram's note has it."""
        value, near = self.axis(figure, "x")
        wanted = {}  # the signs of each limit; |output| ≤ x is −x ≤ output ≤ x
        for requirement in (one_set["requirements"][at] for at in output["limits"]):
            both, limit = requirement.get("abs"), requirement["limit"] * factor
            wanted.setdefault(limit, set()).add("≤" if both or requirement["upper"] else "≥")
            if both:
                wanted.setdefault(-limit, set()).add("≥")
        box = self.run_script("return document.querySelector(`figure.${arguments[0]} .axis.x .domain`).getBBox()", figure)
        drawn = [value(x) for x, in self.attributes(f"figure.{figure} line.limit", "x1")]
        sentence = self.run_script("return document.querySelector('figure.histogram > .note')?.textContent ?? ''")
        note = [number for number, _ in parsed(sentence)]
        for limit in wanted:
            shown, noted = any(abs(one - limit) < 2 * near for one in drawn), any(math.isclose(one, limit, rel_tol=1e-5) for one in note)
            self.assertNotEqual(shown, noted, f"{about}: the limit {limit} is {'both' if shown else 'neither'} in the picture {drawn} and in the note {note}")
            low, high = output["histogram"]["edges"][0] * factor, output["histogram"]["edges"][-1] * factor
            if low - (high - low) < limit < high + (high - low):
                self.assertTrue(shown, f"{about}: the limit {limit} is near the values, and not drawn")
        self.assertLessEqual(len(drawn), len(wanted), about)
        self.assertTrue(all(value(box["x"]) - 2 * near <= one <= value(box["x"] + box["width"]) + 2 * near for one in drawn), about)
        texts = [text.text for text in self.all(f"figure.{figure} text.limit-text")]
        for text in texts + re.findall("[≤≥][^≤≥]*", sentence):
            number = parsed(text)[0][0]
            self.assertTrue(any(math.isclose(number, limit, rel_tol=1e-5) and text[0] in signs for limit, signs in wanted.items()), f"{about}: {text} for {wanted}")

    def margin(self, one):
        """The guaranteed value's distance to the limit; of too few runs the observed value's."""
        if one["limit"] is None or one["margin"] is not None or one["observed_value"] is None:
            return one["margin"]
        return (one["limit"] - one["observed_value"]) * (1 if one["upper"] else -1)

    def used_share(self, one, one_set):
        """The share of the allowed failures that is used up."""
        allowed = one.get("allowed")
        allowed = one_set["runs"] * (1 - one["probability"]) if allowed is None else allowed
        return one["broken"] / allowed if allowed else math.inf if one["broken"] else 0

    def relative_margin(self, one):
        margin = self.margin(one)
        if margin is not None:
            return margin / abs(one["limit"] or 1)
        return ((one["observed"] if one["guaranteed"] is None else one["guaranteed"]) - one["probability"]) / (1 - one["probability"])

    def words(self, one):
        """A requirement as the page states it: in words, and in degrees where they make the shorter number."""
        name = " ".join(word for word in (one.get("id"), one.get("name")) if word)
        if one["limit"] is None:
            return f"{one['id']} {one['text']}" if one.get("id") else one["text"]
        hinge, _, quantity = one["output"].rpartition(".")
        output = f"{hinge} {quantity.replace('_', ' ')}".strip()
        unit = {"latch_rate": "rad/s", "latch_time": "s", "peak_moment": "N·m", "deployment_time": "s", "peak_rate": "rad/s", "peak_force": "N"}[one["output"].split(".")[-1]]
        text = f"{one['limit']:g} {unit}".replace("-", "−")
        if unit.startswith("rad"):
            degrees = float(f"{one['limit'] * DEGREES:.12g}")
            turned = unit.replace("rad", "deg")
            text = f"{degrees:g} {turned}" if len(f"{degrees:g}") < len(repr(one["limit"])) else f"{text} ({f'{degrees:.4g}'.replace('-', '−')} {turned})"
        return f"{f'{name}: ' if name else ''}{f'|{output}|' if one.get('abs') else output} {'≤' if one['upper'] else '≥'} {text}, {100 * one['probability']:g} % at {100 * one['confidence']:g} %"

    def limit_factor(self, one):
        return self.factor({"unit": self.run_script("return W.verdicts.unitOf(arguments[0], W.set())", one)}, self.run_script("return W.chosen.angles"))

    def headline(self, sets, texts):
        """How many requirements fail somewhere, and how each set stands."""
        failed = {self.words(one) for each in sets for one in each["requirements"] if one["verdict"] == "failed"}
        text = self.one(".headline").text
        if failed and not self.run_script("return W.incomplete()"):
            self.assertIn(f"Each of {len(texts)} requirements fails" if len(failed) == len(texts) > 1 else f"{len(failed)} of {len(texts)} requirements fail", text)
        for each in sets:
            count = {word: sum(one["verdict"] == word for one in each["requirements"]) for word in ("failed", "open", "passed")}
            parts = [f"{count['failed']} fail{'s' * (count['failed'] == 1)}", f"{count['open']} undecided", f"{count['passed']} pass{'es' * (count['passed'] == 1)}"]
            entry = next(entry for entry in text.split("\n")[-1].split("; ") if re.search(rf"(^|\W){re.escape(each['label'])}(\W|$)", entry))
            self.assertTrue(entry.endswith(", ".join(part for part, number in zip(parts, count.values()) if number)), f"{each['label']}: {entry}")

    def verdict_numbers(self, kind):
        """Outcomes, orders and requirements of a page with one set, in degrees."""
        one_set = self.run_script("return W.set()")
        for row, one in zip(self.table("Outcomes of the runs"), one_set["statuses"], strict=True):
            self.check(row[1], one["count"], about=kind)
            self.check(row[2], one["rate"], share=True, about=kind)
            bounds = [bound for bound, trivial in ((one["lower"], 0), (one["upper"], 1)) if bound != trivial]
            self.check(row[3], *bounds, share=True, about=kind)
        runs = sum(one["count"] for one in one_set["orders"])
        for row, one in zip(self.table("Latch orders"), one_set["orders"]):
            self.check(row[1], one["count"], about=kind)
            self.check(row[2], one["count"] / runs, share=True, about=kind)
        judged = {self.words(one): one for one in one_set["requirements"]}
        rows = self.table("Requirements, the worst first")
        self.assertEqual(len(rows), len(judged))
        for row in rows:
            one = judged[next(text for text in judged if row[0].startswith(text))]
            values = one["limit"] is not None
            shown = lambda value: value * self.limit_factor(one) if values and value is not None else value
            counted = not values or one["observed_value"] is None  # a share where there is no such value
            self.check(row[2], one["observed"] if counted else shown(one["observed_value"]), share=counted, about=one["text"])
            self.check(row[3], shown(one["guaranteed_value"]) if values else one["guaranteed"], share=not values, about=one["text"])
            self.check(row[4], shown(self.margin(one)) if values else 100 * (one["guaranteed"] - one["probability"]), about=one["text"])
            self.assertEqual("observed" in row[4], values and one["margin"] is None and one["observed_value"] is not None, one["text"])
            causes = sum(bool(count) for count in (one["not_deployed"], one["beyond"] if values else 0, one["without_value"], one["cut"]))
            self.assertEqual("none" in row[6], one["broken"] == 0, one["text"])
            found, parts = [value for value, _ in parsed(row[6])], [one["broken"]] if causes > 1 else []
            if one["not_deployed"]:
                parts += [one["not_deployed"], *(run["run"] for run in one["not_deployed_runs"][:3])]
            if values and (one["beyond"] or one["not_deployed"]):
                parts += [one["beyond"], *(run["run"] for run in one["beyond_runs"][:3])]
            self.assertEqual(found[:len(parts)], parts, one["text"])
            if values and one["worst"]:
                factor = self.limit_factor(one)
                self.assertAlmostEqual(found[len(parts)], one["worst"]["value"] * factor, delta=abs(one["worst"]["value"] * factor) * 1e-3)
            margin = self.margin(one) if values else one["guaranteed"] - one["probability"]
            self.assertEqual(row[4].startswith("+"), margin is not None and margin > 0, one["text"])
        ranked = [(("failed", "open", "passed").index(one["verdict"]), -self.used_share(one, one_set), self.relative_margin(one))
                  for one in self.run_script("return W.verdicts.judged().map(row => row.requirement)")]
        self.assertEqual(ranked, sorted(ranked))
        badges = self.run_script("return [...document.querySelectorAll('.outputs tbody tr')].map(row => row.querySelector('th .badge')?.title)")
        for badge, output in zip(badges, one_set["outputs"], strict=True):
            verdicts = [one_set["requirements"][at]["verdict"] for at in output["limits"]]
            worst = next((word for verdict, word in (("failed", "fail"), ("open", "undecided"), ("passed", "pass")) if verdict in verdicts), None)
            self.assertEqual(badge, worst, output["name"])

    def motion_numbers(self):
        """A motion, the envelopes and the readout, in degrees."""
        one_set = self.run_script("return W.set()")
        motion, envelopes = one_set["motions"][0], one_set["envelopes"]
        self.same_rows("stage", [[t, *(row[at] * DEGREES for row in motion["angles"])] for at, t in enumerate(motion["t"])])
        self.same_rows("history", [[t, *(row[at] for row in motion["moments"])] for at, t in enumerate(motion["t"])])
        names = [one["name"] for one in one_set["wing"]["hinges"]]
        shown = [names.index(column.split(" angle ")[0]) for column in self.exported("envelopes")[0][1::2 * len(envelopes["levels"])]]
        self.same_rows("envelopes", [[t, *(envelopes[key][hinge][level][at] * DEGREES for hinge in shown for level in range(len(envelopes["levels"]))
                                           for key in ("angles", "rates"))] for at, t in enumerate(envelopes["t"])])
        for at in (0, 57, len(motion["t"]) - 1):  # the readout at a sample
            if motion["t"].count(motion["t"][at]) > 1:
                continue  # both sides of a latch
            self.run_script("W.player.seek(arguments[0])", motion["t"][at])
            for hinge, row in enumerate(self.table("Hinges at the cursor's time")):
                for text, key, factor in zip(row[1:4], ("angles", "rates", "moments"), (DEGREES, DEGREES, 1)):
                    self.assertLessEqual(abs(parsed(text)[0][0] - motion[key][hinge][at] * factor), 0.00501, f"{key} of {row[0]} at sample {at}")

    def difference_numbers(self):
        """The differences of all comparisons, in both units."""
        data = self.run_script("return W.data")
        units = {one["name"]: one["unit"] for one in data["sets"][0]["outputs"]}
        for unit in ("rad", "deg"):
            self.run_script("const s = document.getElementById('angles'); s.value = arguments[0]; s.dispatchEvent(new Event('change'))", unit)
            for comparison in data["comparisons"]:
                for row, one in zip(self.table(f"Differences of the means: {comparison['text']}"), comparison["outputs"], strict=True):
                    factor = self.factor({"unit": units[one["output"]]}, unit)
                    shown = lambda value: None if value is None else value * factor
                    self.assertEqual(row[0].startswith("|"), one["magnitude"], row[0])
                    self.check(row[2], shown(one["difference"]), about=one["output"])
                    bounds = [bound for bound in (shown(one["lower"]), shown(one["upper"])) if bound is not None]
                    for (value, half), bound in zip(parsed(row[3]), bounds, strict=True):
                        self.assertLessEqual(abs(value - bound), half, one["output"])
                    self.check(row[4], one["relative"], share=True, about=one["output"])
                    self.check(row[5], one["runs"], about=one["output"])


class NumberChecks(Numbers):
    """The numbers of made-up pages."""

    def test_shares_print_what_they_are(self):
        self.open(pages.made_up("single"))
        shares = [0, 1, 0.5, *(s for k in range(1, 13) for s in (10.0**-k, 3.7 * 10.0**-k, 1 - 10.0**-k, 1 - 3.7 * 10.0**-k))]
        texts = self.run_script("return arguments[0].map(share => W.format.share(share))", shares)
        for share, text in zip(shares, texts):
            self.check(text, share, share=True, about="share")
            self.assertEqual(text in ("0 %", "100 %"), share in (0, 1), text)
        ends = [(low, high) for low in shares for high in shares if low < high and high - low < 1 and min(s for s in (low, high, 1 - low, 1 - high) if s) > 2e-6]
        for (low, high), text in zip(ends, self.run_script("return arguments[0].map(([low, high]) => W.format.shareBounds(low, high))", ends)):
            self.check(text, *([low] if low else []), *([high] if high < 1 else []), share=True, about="bounds")
            self.assertEqual((text.startswith("below"), text.startswith("above")), (low == 0, high == 1 and low > 0), text)
        for digits, (value, want) in ((v[0], v[1:]) for v in ((4, 99999, "99,999"), (4, 1234, "1234"), (4, -12345, "−12,345"), (4, 123456.7, "123,457"), (2, 0, "0"), (4, 1e8, "1 × 10⁸"),
                                                              (4, 99999999, "99,999,999"), (4, 1e-4, "0.0001000"), (4, 9.9e-5, "9.9 × 10⁻⁵"))):
            self.assertEqual(self.run_script("return W.format.number(arguments[0], arguments[1])", value, digits), want)
        for value, spread, want in ((12.3456, 0.5, "12.35"), (12.3456, 20, "12"), (0.012345, 0.0005, "0.01235"), (1e9, 1, "1 × 10⁹"), (2.5, 1e-9, "2.5000000000"), (2.5, 1e-14, "2.500"), (-0.004, 0.5, "0.00")):
            self.assertEqual(self.run_script("return W.format.sized(arguments[0], arguments[1])", value, spread), want)
        for value, want in ((0.1 + 0.2, "0.3"), (12345.678, "12,345.68"), (1e7, "1 × 10⁷"), (9e-5, "9 × 10⁻⁵"), (-0.25, "−0.25"), (0, "0"), (None, "–")):
            self.assertEqual(self.run_script("return W.format.given(arguments[0])", value), want)
        for value, want in ((0, "0"), (1e6, "1 × 10⁶"), (2.5e-5, "2.5 × 10⁻⁵"), (999999, "999,999"), (-0.5, "−0.5"), (1e-4, "0.0001")):
            self.assertEqual(self.run_script("return W.format.tick(arguments[0])", value), want)
        numbers = [s * m * 10.0**k for k in range(-9, 10) for m in (1, 1.234567, 9.9996) for s in (1, -1)]
        for value, text in zip(numbers, self.run_script("return arguments[0].map(v => W.format.number(v, 5))", numbers)):
            self.check(text, value, about="number")

    def test_every_output_by_unit(self):
        self.open(pages.made_up("plain"))
        one_set = self.run_script("return W.set()")
        for unit in ("rad", "deg"):
            self.run_script("const s = document.getElementById('angles'); s.value = arguments[0]; s.dispatchEvent(new Event('change'))", unit)
            listed = self.table(f"Outputs of {one_set['label']}")
            for output, row in zip(one_set["outputs"], listed, strict=True):
                factor, about = self.factor(output, unit), f"{output['name']} in {unit}"
                self.assertEqual(row[1], output["unit"].replace("rad", unit).replace(" ", "·"), about)
                self.check(row[2], output["count"], about=about)
                values = [output["nominal"], output["mean"], output["std"], *(one["value"] for one in output["quantiles"])]
                for text, value in zip(row[4:], values, strict=True):
                    self.check(text, value * factor, about=about)
                self.run_script("W.choose('output', arguments[0])", output["name"])
                self.output_tables(output, factor, about)
                if output["family"] in ("latch_rate", "latch_time") or output["hinge"] == "root":
                    pages.settle(self.driver)
                    self.output_pictures(one_set, output, factor, about)

    def test_verdicts_outcomes_and_orders(self):
        for kind in ("stalls", "plain"):
            self.open(pages.made_up(kind))
            self.verdict_numbers(kind)

    def test_effects_pairs_and_studies(self):
        self.open(pages.made_up("plain"))
        one_set = self.run_script("return W.set()")
        name = self.run_script("return W.chosen.output")
        keys = [f"{measure}{bound}" for measure in ("spearman", "prcc") for bound in ("", "_lower", "_upper")]
        self.same_rows("tornado", [[one["draw"], *(one[key] for key in keys)] for one in one_set["sensitivity"]["effects"] if one["output"] == name])
        pair = one_set["scatters"][-1]
        points = sorted(zip(pair["points"]["x"], pair["points"]["run"], pair["points"]["y"], pair["points"]["order"]))
        got = [row[:3] for row in self.exported("scatter")[1:]]
        self.assertEqual([[float(cell) for cell in row] for row in got], [[run, x, y] for x, run, y, _ in points])
        margin, rare, static = (one_set[key] for key in ("margin", "rare", "static_margins"))
        self.same_rows("margin", [[scale, *(cell for one in margin["requirements"] for cell in (one["passed"][at], one["lower"][at], one["upper"][at], one["verdict"][at]))]
                                  for at, scale in enumerate(margin["scales"])])
        self.check(self.run_script("return document.querySelector('figure.margin > .note').textContent"), *margin["window"], margin["recommended"], 100 * one_set["confidence"])
        self.same_rows("rare", [[at, one["threshold"], one["probability"]] for at, levels in enumerate(rare["levels"], 1) for one in levels])
        for row, one in zip(self.table("Least static margins"), static["hinges"], strict=True):
            for text, key in zip(row[1:4], ("least", "lower", "required")):
                self.assertLessEqual(abs(parsed(text)[0][0] - one[key]), 0.00501, one["hinge"])

    def test_motion_and_envelopes_in_degrees(self):
        self.open(pages.made_up("plain"))
        self.motion_numbers()

    def test_differences_and_inputs(self):
        self.open(pages.made_up("cases"))
        self.difference_numbers()
        said, points = self.run_script("""const own = W.data.comparisons[0], shown = { ...own, paired: false, why_unpaired: 'rows were not kept', statuses: [{ status: 'deployed', difference: 1 / 30000, lower: -1e-4, upper: 2e-4 }, { status: 'stalled', difference: -1 / 30000, lower: null, upper: null }] };
            W.data.comparisons[0] = shown; W.comparison(); const rows = [...document.querySelectorAll('#comparison table')].find(one => one.caption.textContent.startsWith('Differences of the outcomes')).tBodies[0].rows;
            const found = [document.querySelector('figure.forest > .note').textContent, [...rows].map(row => [...row.cells].map(cell => cell.textContent))]; W.data.comparisons[0] = own; W.comparison(); return found""")
        self.assertTrue(said.startswith("Not paired: rows were not kept."), said)
        self.assertEqual(points, [["deployed", "+0.003 points", "−0.010 … 0.020"], ["stalled", "−0.0033 points", "no bounds"]])  # one run of 30,000
        data = self.run_script("return W.data")
        self.run_script("W.choose('set', 0)")
        for row, one in zip(self.table("Scene of cold"), data["sets"][0]["inputs"]["scene"], strict=True):
            self.check(row[1], one["value"], near=1e-6, about=one["path"])
            self.check(row[3], one["value"] * DEGREES if one["unit"] == "rad" else None, near=1e-5, about=one["path"])
            self.check(row[4], one["case_value"], about=one["path"])

    def test_printed_contents_name_what_is_shown_now(self):
        """Headings follow the chosen output and case after the page has been opened."""
        self.open(pages.made_up("cases"))
        self.run_script("W.choose('set', 1); W.choose('output', 'tip.latch_time'); dispatchEvent(new Event('beforeprint'))")
        listed = self.run_script("return [...document.querySelectorAll('.contents li')].map(li => [li.querySelector('a').hash, li.textContent])")
        for (link, text), (section, title, parts) in zip(listed, self.run_script("""return [...document.querySelectorAll('main > section:not([hidden])')].map(section =>
                ['#' + section.id, section.querySelector('h2').textContent, [...section.querySelectorAll('h3')].map(one => one.firstChild.textContent)])"""), strict=True):
            self.assertEqual(link, section)
            self.assertEqual(text, ": ".join([title] + ([" · ".join(dict.fromkeys(parts))] if parts else [])))
        self.assertIn("tip latch time", dict(listed)["#outputs"])
        self.assertIn("ambient", dict(listed)["#inputs"])
