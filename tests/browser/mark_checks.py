"""Every line, bar, point and label of the pictures lies where its number belongs, and every sentence has the data's numbers.

Pixels become values by the ticks of the picture's own axes; what is expected comes from the block of data alone.
"""

import math
import re
import statistics

import pages
from number_checks import DEGREES, NUMBER, SUPERSCRIPTS, parsed


def tick_value(text):
    if power := re.fullmatch(r"10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)", text):
        return 10.0 ** int(power[1].translate(SUPERSCRIPTS))
    return parsed(text)[0][0] / (100 if text.endswith("%") else 1)


def nines(share):
    return min(3.6, -math.log10(max(1e-9, 1 - share)))


def pairs(path):
    """The vertices of a path of M and L, one list for each piece."""
    return [[tuple(map(float, point.split(","))) for point in re.findall(r"-?[\d.e-]+,-?[\d.e-]+", piece)] for piece in path.split("M")[1:]]


class MarkChecks:
    """For a Page with NumberChecks."""

    def scale(self, figure, which, of=lambda value: value, nth=0, at=0):
        """Value → pixel along an axis that is linear in of(value): its ticks must say so. `nth`: of several such figures, `at`: axis."""
        ticks = self.run_script("""const axis = document.querySelectorAll(`figure.${arguments[0]}`)[arguments[2]].querySelectorAll(`.axis.${arguments[1]}`)[arguments[3]];
            return [...axis.querySelectorAll('.tick')].map(tick => { const m = tick.transform.baseVal[0].matrix;
                return [(arguments[1] === 'x' ? m.e : m.f) - 0.5, tick.textContent]; }).filter(tick => tick[1] !== '')""", figure, which, nth, at)
        known = [(place, of(tick_value(text.replace(" s", "")))) for place, text in ticks]
        (first, low), (last, high) = known[0], known[-1]
        slope = (last - first) / (high - low)
        self.assertGreater(slope if which == "x" else -slope, 0, f"{figure} {which}: larger values lie to the right, and above")
        for place, value in known:
            self.assertLess(abs(first + slope * (value - low) - place), 1.5, f"{figure} {which}: {ticks}")
        return lambda value: first + slope * (of(value) - low)

    def paths(self, figure, selector, nth=0):
        return self.run_script("return [...document.querySelectorAll(`figure.${arguments[0]}`)[arguments[2]].querySelectorAll(arguments[1])].map(e => e.getAttribute('d'))",
                               figure, selector, nth)

    def places(self, figure, selector, *names):
        return self.attributes(f"figure.{figure} {selector}", *names)

    def near(self, got, wanted, about, pixels=1.5):
        """The points, each within so many pixels, in this order."""
        self.assertEqual(len(got), len(wanted), about)
        for one, want in zip(got, wanted):
            self.assertTrue(all(abs(a - b) < pixels for a, b in zip(one, want)), f"{about}: {one} for {want}")

    def line(self, path, x, y, points, about):
        """A path joins these points; where a point is unknown it breaks."""
        self.near([point for piece in pairs(path) for point in piece], [(x(a), y(b)) for a, b in points if b is not None], about)

    def band(self, path, x, y, rows, about):
        """A path fills the space between the lower and the upper ends of the rows."""
        points = [point for piece in pairs(path) for point in piece]
        self.near(sorted(points), sorted((x(a), y(b)) for a, *both in rows for b in both), about)

    def angles(self, unit):
        self.run_script("const s = document.getElementById('angles'); s.value = arguments[0]; s.dispatchEvent(new Event('change'))", unit)

    def test_the_distribution_function_of_discrete_values_has_steps(self):
        """However many runs its knots stand for; lines join knots that are not all distinct values."""
        self.open(pages.made_up("plain"))
        draw = lambda steps: (self.run_script("""Object.assign(W.output().curve, { x: [1, 2, 3], p: [0.4, 0.5, 1], lower: [0.3, 0.4, 0.9], upper: [0.5, 0.6, 1], steps: arguments[0] });
            W.output().histogram.edges = W.output().histogram.edges.map((_, at, all) => 1 + 2 * at / (all.length - 1)); W.outputs()""", steps), pages.settle(self.driver), pairs(self.paths("distribution", ".curve")[0])[0])[2]
        upright_or_level = lambda points: all(abs(a[0] - b[0]) < 0.01 or abs(a[1] - b[1]) < 0.01 for a, b in zip(points, points[1:]))
        self.assertTrue(upright_or_level(draw(True)))
        self.assertFalse(upright_or_level(draw(False)))

    def test_the_chosen_outputs_lines_and_bars(self):
        self.open(pages.made_up("plain"))
        one_set = self.run_script("return W.set()")
        for name, unit in (("mid.latch_rate", "deg"), ("root.latch_rate", "rad"), ("deployment_time", "rad")):
            self.angles(unit)
            self.run_script("W.choose('scale', 'linear'); W.choose('output', arguments[0])", name)
            pages.settle(self.driver)
            output = next(one for one in one_set["outputs"] if one["name"] == name)
            factor, curve = self.factor(output, unit), output["curve"]
            x, y = self.scale("distribution", "x"), self.scale("distribution", "y")
            knots = list(zip((value * factor for value in curve["x"]), curve["p"], curve["lower"], curve["upper"]))
            (path,), (band,) = self.paths("distribution", ".curve"), self.paths("distribution", ".curve-band")
            self.near(pairs(path)[0][2:-2], [(x(v), y(p)) for v, p, _, _ in knots], name)  # flat lines lead to both ends
            flat = [point[1] for point in (*pairs(path)[0][:2], *pairs(path)[0][-2:])]
            self.near([flat], [(y(0), y(0), y(1), y(1))], name)
            self.band(band, x, y, [(v, low, high) for v, _, low, high in knots], name)
            ends = self.places("distribution", ".quantile-bounds", "x1", "x2", "y1")
            self.near(ends, [(x(q["lower"] * factor), x(q["upper"] * factor), y(q["p"])) for q in output["quantiles"]], name)
            self.near(self.places("distribution", "circle.quantile", "cx", "cy"), [(x(q["value"] * factor), y(q["p"])) for q in output["quantiles"]], name)
            for figure in ("distribution", "histogram"):
                nominal = [(self.scale(figure, "x")(output["nominal"] * factor),)]
                self.near(self.places(figure, "line.nominal", "x1"), nominal, name)
            self.layers(one_set, output, name)
            self.settled(output, factor, name)
            self.run_script("W.choose('scale', 'probit')")
            pages.settle(self.driver)
            smallest, normal = 0.5 / output["count"], statistics.NormalDist().inv_cdf
            height = self.scale("distribution", "y", lambda p: normal(min(1 - smallest, max(smallest, p))))
            (path,) = self.paths("distribution", ".curve")
            x = self.scale("distribution", "x")
            self.near(pairs(path)[0], [(x(v), height(p)) for v, p, _, _ in knots], name)

    def layers(self, one_set, output, about):
        """Each bin's runs of each order stand on those of the orders before."""
        x, y, (edges, counts, rows) = self.scale("histogram", "x"), self.scale("histogram", "y"), (output["histogram"][key] for key in ("edges", "counts", "by_order"))
        left = [count - sum(row[at] for row in rows) for at, count in enumerate(counts)]
        base, wanted = [0] * len(counts), []
        for row in [*rows, left]:
            for at, count in enumerate(row):
                if count > 0:
                    wanted.append((y(base[at] + count), y(base[at]) - y(base[at] + count)))
                    base[at] += count
        self.near(self.places("histogram", ".bin", "y", "height"), wanted, about)

    def settled(self, output, factor, about):
        rows = output["convergence"]
        for nth, (key, low, high) in enumerate((("mean", "lower", "upper"), ("quantile", "quantile_lower", "quantile_upper"))):
            x, y = self.scale("settling", "x", math.log10, nth), self.scale("settling", "y", nth=nth)
            ticks = self.run_script("return [...document.querySelectorAll('figure.settling')[arguments[0]].querySelectorAll('.axis.x .tick')].map(e => e.textContent)", nth)
            self.assertEqual(ticks, [f"{m * 10**k:,}" for k in range(8) for m in (1, 2, 5) if rows["runs"][0] <= m * 10**k <= rows["runs"][-1]], about)
            top, bottom = self.run_script("""const box = document.querySelectorAll('figure.settling')[arguments[0]].querySelector('.axis.y .domain').getBBox();
                return [box.y, box.y + box.height]""", nth)
            inside = lambda value: min(bottom, max(top, y(value * factor)))
            self.line(self.paths("settling", ".trace", nth)[0], x, inside, zip(rows["runs"], rows[key]), about)
            self.band(self.paths("settling", ".curve-band", nth)[0], x, inside, zip(rows["runs"], rows[low], rows[high]), about)
            words = self.run_script("return document.querySelectorAll('figure.settling svg desc')[arguments[0]].textContent", nth)
            self.check(words.partition(": ")[0], rows["runs"][-1], about=about)
            self.check(words.partition(": ")[2].replace("/s²", ""), *(rows[one][-1] * factor for one in (key, low, high)), about=about)

    def test_causes_lie_on_their_axes(self):
        self.open(pages.made_up("plain"))
        one_set = self.run_script("return W.set()")
        for unit in ("rad", "deg"):
            self.angles(unit)
            pages.settle(self.driver)
            x, name = self.scale("tornado", "x"), self.run_script("return W.chosen.output")
            effects = [(one, key) for one in one_set["sensitivity"]["effects"] if one["output"] == name for key in ("spearman", "prcc")]
            bars = [(min(x(0), x(one[key])), abs(x(one[key]) - x(0))) for one, key in effects]
            self.near(self.places("tornado", ".effect", "x", "width"), bars, name)
            whiskers = [tuple(map(float, re.match(r"M(.+),.+H([-\d.e]+)M", path).groups())) for path in self.paths("tornado", ".whisker")]
            self.near(whiskers, [(x(one[f"{key}_lower"]), x(one[f"{key}_upper"])) for one, key in effects], name)
            words = self.run_script("return document.querySelector('figure.tornado svg desc').textContent")
            for part, (one, _) in zip(words.split("; "), effects[::2], strict=True):
                self.check(part.partition(": ")[2], *(round(one[key], 2) for key in ("spearman", "prcc")), about=part)
            for nth, pair in enumerate(one_set["scatters"][:4]):
                output = next(one for one in one_set["outputs"] if one["name"] == pair["output"])
                x, y, factor = self.scale("scatter", "x", nth=nth), self.scale("scatter", "y", nth=nth), self.factor(output, unit)
                moved = self.run_script("""return [...document.querySelectorAll('figure.scatter')[arguments[0]].querySelectorAll('.point')].map(e => {
                    const m = e.transform.baseVal[0].matrix; return [m.e, m.f, e.getAttribute('aria-label')]; })""", nth)
                points = sorted(zip(*(pair["points"][key] for key in ("x", "y", "run"))))
                self.near(sorted(one[:2] for one in moved), sorted((x(a), y(b * factor)) for a, b, _ in points), pair["draw"])
                for (_, _, text), (a, b, run) in zip(moved, points):
                    numbers = parsed(text.replace(pair["draw"], "").replace(pair["output"], ""))
                    for (value, half), want in zip(numbers, (run, a, b * factor)):
                        self.assertLessEqual(abs(value - want), half, text)
                cells = self.run_script("return [...document.querySelectorAll('figure.scatter')[arguments[0]].querySelectorAll('.density rect')].map(e => ['x', 'y', 'height'].map(n => Number(e.getAttribute(n))))", nth)
                edges = [(pair["x_edges"][at % 32], pair["y_edges"][at // 32], pair["y_edges"][at // 32 + 1]) for at, count in enumerate(pair["density"]) if count]
                self.near(cells, [(x(a), y(c * factor), y(b * factor) - y(c * factor)) for a, b, c in edges], pair["draw"])
                note = self.run_script("return document.querySelectorAll('figure.scatter > .note')[arguments[0]].textContent", nth)
                self.check(note.partition(". ")[0], round(pair["spearman"], 2), about=note)

    def test_studies_lie_on_their_axes(self):
        self.open(pages.made_up("studies"))
        sets = self.run_script("return W.data.sets")
        margin, static, rare = sets[0]["margin"], sets[0]["static_margins"], sets[2]["rare"]
        x, y = self.scale("margin", "x"), self.scale("margin", "y", nines)
        for one, path, band in zip(margin["requirements"], self.paths("margin", ".trace"), self.paths("margin", ".curve-band"), strict=True):
            self.line(path, x, y, zip(margin["scales"], one["passed"]), one["text"])
            self.band(band, x, y, zip(margin["scales"], one["lower"], one["upper"]), one["text"])
        filled = self.run_script("return [...document.querySelectorAll('figure.margin .looked')].map(e => e.style.fill !== 'var(--paper)')")
        self.assertEqual(filled, [verdict == "passed" for one in margin["requirements"] for verdict in one["verdict"]])
        self.near(self.places("margin", ".looked", "cx", "cy"), [(x(s), y(p)) for one in margin["requirements"] for s, p in zip(margin["scales"], one["passed"])], "margin")
        low, high = margin["window"]
        self.near(self.places("margin", "rect.window", "x", "width"), [(x(low), x(high) - x(low))], "window")
        self.near(self.places("margin", "line.nominal", "x1"), [(x(1),)], "present")
        self.near(self.places("margin", "line.chosen-line", "x1"), [(x(margin["recommended"]),)], "recommended")
        x, y = self.scale("static-margins", "x"), self.scale("static-margins", "y")
        lines = [(one["angle"], one[key]) for one in static["hinges"] for key in ("margin", "margin_lower")]
        for (angles, values), path in zip(lines, self.paths("static-margins", ".trace"), strict=True):
            self.line(path, x, y, zip((abs(angle - angles[0]) * DEGREES for angle in angles), values), "static margin")
        self.near(self.places("static-margins", "line.limit", "y1", "y2"), [(y(v), y(v)) for v in dict.fromkeys(one["required"] for one in static["hinges"])], "required")
        self.same_rows("static-margins", [[one["hinge"], abs(angle - one["angle"][0]) * DEGREES, nominal, lower, one["required"]] for one in static["hinges"]
                                          for angle, nominal, lower in zip(one["angle"], one["margin"], one["margin_lower"])])
        note = self.run_script("return document.querySelector('figure.static-margins > .note').textContent")
        self.assertIn(f"the {100 * static['lower_p']:g} % quantile over {static['draws']:,} draws", note)
        rows = [row[4] for row in self.table("Least static margins")]
        self.assertEqual(["pass" in text for text in rows], [one["least"] >= one["required"] for one in static["hinges"]])
        rows = [row[5] for row in self.table("Least static margins")]
        self.assertEqual(["pass" in text for text in rows], [one["lower"] >= one["required"] for one in static["hinges"]])
        x, y = self.scale("rare", "x"), self.scale("rare", "y", math.log10)
        repeats = [[(one["threshold"], one["probability"]) for one in levels] for levels in rare["levels"]]
        for points, path in zip(repeats, self.paths("rare", ".trace"), strict=True):
            self.line(path, x, y, points, "rare")
        mean = (repeats[0][-1][0], rare["probability"])  # of all repeats: the estimate
        self.near(self.places("rare", "circle.quantile", "cx", "cy"), [(x(a), y(b)) for a, b in [*sum(repeats, []), mean]], "rare")
        self.near(self.places("rare", "circle.estimate", "cx", "cy"), [(x(mean[0]), y(mean[1]))], "rare")
        self.assertIn("one of 2 repeats", self.run_script("return document.querySelector('figure.rare > .note').textContent"))
        text = next(one.text for one in self.all("p") if one.text.startswith(rare["text"]))[len(rare["text"]):]
        self.check(text, *(rare[key] for key in ("probability", "lower", "upper")), about=text)
        likeliest = sorted(rare["likeliest"]["draws"], key=lambda one: -abs(one["z"]))
        for row, one in zip(self.table("Most likely run of the event"), likeliest, strict=True):
            self.assertEqual(row[0], one["name"])
            self.check(row[1], one["value"], about=row[0])
            self.check(row[3], one["z"], about=row[0])
        x, sobol = self.scale("tornado", "x"), sets[1]["sensitivity"]["effects"]
        name = sobol[0]["output"]
        bars = [(x(0), x(one[key]) - x(0)) for one in sobol if one["output"] == name for key in ("first", "total")]
        self.near(self.places("tornado", ".effect", "x", "width"), bars, "sobol")

    def test_motion_and_envelopes_lie_on_their_axes(self):
        self.open(pages.made_up("plain"))
        one_set = self.run_script("return W.set()")
        motion, envelopes, hinges = one_set["motions"][0], one_set["envelopes"], one_set["wing"]["hinges"]
        for place, (key, factor) in enumerate((("moments", 1), ("angles", DEGREES), ("rates", DEGREES))):
            self.run_script("[...document.querySelectorAll('.player .controls button')][arguments[0]].click()", place)
            pages.settle(self.driver)
            x, y = self.scale("history", "x"), self.scale("history", "y")
            for path, row in zip(self.paths("history", ".trace"), motion[key], strict=True):
                self.line(path, x, y, zip(motion["t"], (value * factor for value in row)), key)
            self.near(self.places("history", ".latch-line", "x1"), [(x(one["time"]),) for one in motion["latches"]], key)
            self.run_script("W.player.seek(1.5)")
            self.near(self.places("history", ".cursor", "x1"), [(x(1.5),)], key)
        words = self.run_script("return document.querySelector('figure.history svg desc').textContent")
        for one in motion["peaks"]:
            self.assertTrue(any(abs(value - one["value"]) <= half for value, half in parsed(words)) and any(abs(value - one["time"]) <= half for value, half in parsed(words)), words)
        bands, medians, levels = self.paths("envelopes", ".envelope"), self.paths("envelopes", ".median"), len(envelopes["levels"])
        for at in range(2 * len(hinges)):
            rows = [[value * DEGREES for value in row] for row in envelopes[("angles", "rates")[at % 2]][at // 2]]
            x, y = self.scale("envelopes", "x", at=at), self.scale("envelopes", "y", at=at)
            for depth in range(levels // 2):
                self.band(bands[at * (levels // 2) + depth], x, y, zip(envelopes["t"], rows[depth], rows[-1 - depth]), f"envelope {at}")
            self.line(medians[at], x, y, zip(envelopes["t"], rows[levels // 2]), f"median {at}")
        x = self.scale("strips", "x")
        for path, times in zip(self.paths("strips", ".strip"), envelopes["latch_times"], strict=True):
            self.near([(float(place),) for place in re.findall(r"M([-\d.]+),", path)], [(x(time),) for time in times], "strips")
        self.near(self.places("strips", ".strip-median", "x1"), [(x(statistics.median(times)),) for times in envelopes["latch_times"]], "medians")
        self.assertEqual([one.text for one in self.all("figure.strips .faint-text")], [f"{runs} of {envelopes['runs']}" for runs in envelopes["latched"]])

    def test_cases_side_by_side(self):
        self.open(pages.made_up("cases"))
        sets, comparisons = self.run_script("return [W.data.sets, W.data.comparisons]")
        statuses = [one["status"] for one in sets[0]["statuses"] if one["status"] == "deployed" or any(s["count"] for each in sets for s in each["statuses"] if s["status"] == one["status"])]
        for row, one in zip(self.table("Outcomes by case, with 95 % two-sided bounds"), sets, strict=True):
            self.check(row[1], one["runs"], about=row[0])
            for cell, status in zip(row[2:], statuses, strict=True):
                found = next(each for each in one["statuses"] if each["status"] == status)
                count, _, share = cell.partition(" · ")
                self.check(count, found["count"], about=cell)
                bounds = [bound for bound, trivial in ((found["lower"], 0), (found["upper"], 1)) if bound != trivial]
                self.check(share.replace("%", "% "), found["rate"], *bounds, share=True, about=cell)
        texts = {self.words(one): None for each in sets for one in each["requirements"]}
        matrix = {row[0]: row[1:] for row in self.table("Verdict and distance to the limit by case")}
        self.assertEqual(set(matrix), set(texts))
        for text, cells in matrix.items():
            for cell, one_set in zip(cells, sets, strict=True):
                one = next(each for each in one_set["requirements"] if self.words(each) == text)
                self.assertIn({"passed": "pass", "failed": "fail", "open": "undecided"}[one["verdict"]], cell)
                values = one["limit"] is not None
                wanted = self.margin(one) if values else 100 * (one["guaranteed"] - one["probability"])
                if values and one["margin"] is None and one["allowed"] is not None and one["cut"]:
                    self.assertIn(f"{one['cut']:,} peak", cell)
                elif values and one["margin"] is None and one["not_deployed"]:
                    self.assertIn(f"{one['not_deployed']:,} not deployed", cell)
                elif wanted is None:
                    self.assertNotRegex(cell, NUMBER)
                else:
                    self.assertLessEqual(abs(parsed(cell)[0][0] - wanted * self.limit_factor(one)), parsed(cell)[0][1], cell)
        self.headline(sets, texts)
        for name in ("root.peak_moment", "tip.latch_time"):
            self.run_script("W.choose('split', 'case'); W.choose('output', arguments[0])", name)
            pages.settle(self.driver)
            outputs = [next(one for one in each["outputs"] if one["name"] == name) for each in sets]
            for row, one in zip(self.table(f"{self.run_script('return W.format.name(W.output())')} by case"), outputs, strict=True):
                values = [one["nominal"], one["mean"], *(each["value"] for each in one["quantiles"]), *([one["missing"]] if any(each["missing"] for each in outputs) else [])]
                for cell, value in zip(row[1:], values, strict=True):
                    self.check(cell, value, about=name)
            x, y = self.scale("histogram", "x"), self.scale("histogram", "y")
            for path, one in zip(self.paths("histogram", ".outline"), outputs, strict=True):
                edges, counts = one["histogram"]["edges"], one["histogram"]["counts"]
                tops = [(edge, count / one["count"] / (b - a)) for a, b, count in zip(edges, edges[1:], counts) for edge in (a, b)]
                self.line(path, x, y, [(edges[0], 0), *tops, (edges[-1], 0)], name)
        for comparison, nth in zip(comparisons[:2], range(2)):
            self.changes(comparison, nth)
            for row, one in zip(self.table(f"Differences of the outcomes: {comparison['text']}"), [one for one in comparison["statuses"] if one["difference"] or next(s["count"] for s in sets[comparison["sets"][0]]["statuses"] if s["status"] == one["status"])], strict=True):
                for text, wanted in ((row[1], [one["difference"]]), (row[2], [one["lower"], one["upper"]])):
                    for (value, half), want in zip(parsed(text), wanted, strict=True):
                        self.assertLessEqual(abs(value - 100 * want), half, text)

    def changes(self, comparison, nth):
        """The forest of a comparison: largest change first, each at its relative difference, with its bounds."""
        rows = sorted((one for one in comparison["outputs"] if one["relative"] is not None), key=lambda one: -abs(one["relative"]))[:24]
        wide = any(abs(one["relative"]) >= 0.4 for one in rows)
        self.assertEqual(wide, "logarithmic" in self.all("figure.forest")[nth].text)
        # d3's symmetric logarithm from 2 % on
        x, places = self.scale("forest", "x", lambda value: math.copysign(math.log1p(abs(value) / 2), value) if wide else value, nth=nth), self.run_script("return [...document.querySelectorAll('figure.forest')[arguments[0]].querySelectorAll('circle.change')].map(e => [Number(e.getAttribute('cx')), e.classList.contains('sure')])", nth)
        relative = lambda one, key: 100 * one[key] * one["relative"] / one["difference"]
        self.near([one[:1] for one in places], [(x(100 * one["relative"]),) for one in rows], "forest")
        self.assertEqual([one[1] for one in places], [one["lower"] * one["upper"] > 0 for one in rows])
        whiskers = [tuple(map(float, re.match(r"M(.+),.+H([-\d.e]+)M", path).groups())) for path in self.paths("forest", ".whisker", nth)]
        self.near(whiskers, [(x(relative(one, "lower")), x(relative(one, "upper"))) for one in rows if one["difference"]], "forest")
        box = self.run_script("const box = document.querySelectorAll('figure.forest')[arguments[0]].querySelector('.axis.x .domain').getBBox(); return [box.x, box.x + box.width]", nth)
        self.assertTrue(all(box[0] - 1 <= place <= box[1] + 1 for one in places for place in one[:1]), f"{box}: {places}")

    def test_sentences_and_small_print(self):
        """On a page whose sets are of every kind: parts of campaigns, designs with replicates, interim analyses, other orders."""
        self.open(pages.made_up("odd"))
        self.assertIn(r'content: "revision B\a \22 2\22  \3c x>\5c "', self.run_script("return [...document.querySelectorAll('head style')].pop().textContent"))  # a string of CSS
        data = self.run_script("return W.data")
        one = data["sets"][0]
        facts = [fact.text for fact in self.all("#subtitle .facts span")]
        for fact in (f"{one['runs']:,} runs", f"bounds at {100 * one['confidence']:g} %", f"shard {one['shard']}",
                     f"bounds hold over {one['looks']} interim analyses", "rows from another tool"):
            self.assertTrue(any(fact in each for each in facts), f"{fact}: {facts}")
        text = self.one("#verdicts").text
        for fact in (f"{one['replicates']} replicates", f"seed {one['seed']}", f"wingspread {one['version']}", one["hash"]):
            self.assertIn(fact, self.one(".again").text)
            self.assertNotIn(fact, self.one("#subtitle").text)
        self.assertIn(f"{one['label']} holds {one['runs']:,} of {one['planned']:,} planned runs", text)
        accuracy = one["accuracy"]
        worst = max(accuracy["outputs"], key=lambda row: row["largest"] / row["standard_error"])
        times = parsed(re.search(r"integration error is (.+) times", text)[1])[0]
        self.assertLessEqual(abs(times[0] - worst["standard_error"] / worst["largest"]) / times[0], 0.05)
        self.assertIn(f"{accuracy['runs']} runs repeated with {accuracy['reference_method']}", text)
        self.assertIn(f"In {accuracy['order_in_doubt']} runs the outcome", text)
        rows = self.table("Numerical and statistical error of each output")
        for row, each in zip(rows, sorted(accuracy["outputs"], key=lambda row: -row["largest"] / row["standard_error"]), strict=True):
            for cell, key in zip(row[2:], ("largest", "rms", "standard_error")):
                self.check(cell, each[key] * (DEGREES if row[1].startswith("deg") else 1), about=row[0])
        total = sum(each["count"] for each in one["orders"]) + one["without_latch"]
        counts = [*(each["count"] for each in one["orders"]), one["without_latch"]]
        for row, count in zip(self.table("Latch orders"), counts, strict=True):
            self.check(row[1], count, about=row[0])
            self.check(row[2], count / total, share=True, about=row[0])
        self.assertIn(f"{one['order_kinds'] - sum(each['order'] != 'others' for each in one['orders'])} other orders", text)
        for reason in one["reasons"]:
            self.assertIn(f"{reason['count']:,} {reason['status']}: {reason['reason']}", text)
        names = [part.text for part in self.all(".broken button.run, button.run")]
        wanted = []
        for each in one["requirements"]:
            wanted += [str(run["run"]) for run in each["not_deployed_runs"][:3] + each["beyond_runs"][:3]]
            wanted += [str(each["worst"]["run"])] if each["worst"] and each["limit"] is not None and not each["beyond"] else []
        self.assertEqual(sorted(names), sorted(wanted))
        output = next(each for each in one["outputs"] if each["name"] == "root.peak_moment")
        self.run_script("W.choose('output', 'root.peak_moment')")
        rows = self.table("Quantiles of root peak moment")
        self.check(rows[-1][1], output["tolerance_limits"][0]["lower"], output["tolerance_limits"][0]["upper"], about=rows[-1][0])
        self.assertIn("above", rows[0][2])
        self.check(rows[0][2], output["quantiles"][0]["lower"], about="above")
        self.assertIn("below", rows[1][2])
        self.check(rows[1][2], output["quantiles"][1]["upper"], about="below")
        highest = output["quantiles"][2]
        self.assertNotRegex(rows[2][1], NUMBER)
        self.assertEqual(rows[2][2], highest["note"])
        self.assertIn("99 % quantile among runs with a value", rows[3][0])
        self.check(rows[3][1], highest["among"]["value"], about="among")
        self.check(rows[3][2], highest["among"]["lower"], highest["among"]["upper"], about="among")
        factor = self.factor(output, "rad")
        circle = self.places("distribution", "circle.quantile", "cx", "cy")[2]
        wanted = (self.scale("distribution", "x")(highest["among"]["value"] * factor), self.scale("distribution", "y")(highest["p"]))
        self.near([circle], [wanted], "a quantile among runs with a value lies on their curve")
        self.run_script("W.selectRun(0, 7, { 'root.peak_moment': 123.456, 'root.spring': 0.25 })")
        numbers = [value for value, _ in parsed(self.one("#selection p").text)]
        self.assertEqual(numbers[0], 7)
        self.assertTrue(any(abs(value - 123.456) < 0.01 for value in numbers) and 0.25 in numbers, numbers)
        for row, each in zip(self.table(f"Dispersions of {one['label']}"), one["inputs"]["dispersions"], strict=True):
            self.check(row[3].replace("rad", ""), each["nominal"] if len(each["paths"]) == 1 else None, about=row[0])
            self.check(row[4], each["low"], each["high"], about=row[0])
            if each["unit"] == "rad":
                self.check(row[5], each["low"] * DEGREES, each["high"] * DEGREES, near=1e-4, about=row[0])
        for row, each in zip(self.table("Integration settings"), one["inputs"]["settings"], strict=True):
            self.assertEqual(row, [each["label"], str(each["value"])])

    def test_small_pictures_and_places_of_the_page(self):
        self.open(pages.made_up("plain"))
        one_set = self.run_script("return W.set()")
        sparks = self.run_script("return [...document.querySelectorAll('.outputs svg.spark')].map(svg => [svg.querySelector('path').getAttribute('d'), svg.querySelector('line')?.getAttribute('x1')])")
        for (path, nominal), output in zip(sparks, one_set["outputs"], strict=True):
            edges, counts = output["histogram"]["edges"], output["histogram"]["counts"]
            x = lambda value: 84 * (value - edges[0]) / (edges[-1] - edges[0])
            bars = [tuple(map(float, bar)) for bar in re.findall(r"M([-\d.]+),18v([-\d.]+)H([-\d.]+)V18", path)]
            self.near(bars, [(x(a), -17 * count / max(counts), x(b)) for a, b, count in zip(edges, edges[1:], counts)], output["name"], 0.06)
            inside = edges[0] <= output["nominal"] <= edges[-1]
            self.assertEqual(nominal is not None, inside, output["name"])
            if inside:
                self.assertAlmostEqual(float(nominal), x(output["nominal"]), places=6)
        named = self.run_script("return [...document.querySelectorAll('figure svg.chart')].every(svg => ['aria-labelledby', 'aria-describedby'].every(name => svg.querySelector('#' + svg.getAttribute(name))))")
        self.assertTrue(named)
        more = [one.get_attribute("textContent") for one in self.all("#why details summary")]
        self.assertIn(f"{len(one_set['scatters']) - 4} more pairs", more)
        self.run_script("document.getElementById('why').scrollIntoView()")
        self.wait(lambda: self.run_script("return [...document.querySelectorAll('nav [aria-current=true]')].map(a => a.getAttribute('href')).join()") == "#why")
