"""Bullets, limits, lines and labels of the drawings, digits of a column, and the numbers of printed pages."""

import math
import pathlib
import re
import shutil
import statistics
import subprocess
import sys

import pages
from number_checks import parsed

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "studies" / "plots"))
import print_report  # noqa: E402


class DrawingChecks:
    def test_convergence_has_each_bound_and_the_last_number_of_runs(self):
        self.open(pages.made_up("stalls"))
        self.run_script("""const one = W.output().convergence; one.quantile_upper = one.quantile_upper.map((value, at, all) => at + 1 < all.length ? null : value); W.convergence()""")
        pages.settle(self.driver)
        runs = self.run_script("return W.output().convergence.runs")
        paths, ticks, legend, note = self.run_script("""const figure = document.querySelectorAll('figure.settling')[1];
            return [[...figure.querySelectorAll('path.bound')].map(one => one.getAttribute('d').split('L').length), [...figure.querySelectorAll('.axis.x .tick')].map(one => one.textContent),
                    figure.querySelector('.legend').textContent, figure.querySelector('.note').textContent]""")
        self.assertEqual(paths[0], len(runs))
        self.assertEqual(ticks[-1], str(runs[-1]))
        self.assertIn("95 % two-sided bounds", legend)
        self.assertIn(f"From {runs[-1]} runs on both bounds are known", note)

    def test_the_player_opens_at_the_start(self):
        self.open(pages.made_up("plain"))
        self.assertEqual(self.run_script("return W.player.time"), self.run_script("return W.set().motions[0].t[0]"))

    def test_the_slider_ends_with_the_displayed_interval(self):
        self.open(pages.made_up("plain"))
        whole, last, shown = self.run_script("const m = W.player.motion; return [m.t[m.t.length - 1], Math.max(...m.latches.map(l => l.time)), W.player.interval()]")
        self.assertTrue(last < shown[1] <= whole)
        stop = lambda: float(self.one(".scrub").get_attribute("max"))
        self.assertAlmostEqual(stop(), shown[1])
        self.assertIn(f"of {shown[1]:.2f} s", self.one(".time").text)
        [one for one in self.all(".buttons button") if one.text == "whole run"][0].click()
        self.assertAlmostEqual(stop(), whole)

    def test_the_label_of_an_upright_line_crosses_no_other_line(self):
        self.open(pages.made_up("plain"))
        crossed = self.run_script("""const svg = document.querySelector('figure.histogram svg'), group = d3.create('svg:svg');
            svg.append(group.node());
            W.marks.uprights(group, { left: 0, right: 400, top: 0, bottom: 100 }, [{ x: 200, text: 'nominal', kind: 'nominal' }, { x: 210, text: '≤ 70', kind: 'limit' }]);
            const [first, second] = [...group.node().querySelectorAll('text')].map(text => text.getBBox());
            return [first.x + first.width, second.x, second.x + second.width]""")
        self.assertLess(crossed[0], 200)  # left of its line
        self.assertGreater(crossed[1], 210)
        self.assertLess(crossed[2], 400)

    def test_contents_have_the_numbers_of_their_pages_where_they_are_given(self):
        """print_report.py prints twice: the second time the page's address has the numbers."""
        told = 'Page  Destination                 Name\n   1 [ XYZ    0  627 null      ] "verdicts"\n  37 [ XYZ    0  830 null      ] "outputs"\n'
        numbers = print_report.destinations(told)  # as pdfinfo prints them
        self.driver.get("about:blank")
        self.driver.get(print_report.address(pages.made_up("cases"), numbers))
        pages.settle(self.driver)
        self.driver.execute_script("dispatchEvent(new Event('beforeprint'))")
        entries = self.run_script("return [...document.querySelectorAll('.contents li')].map(li => [li.querySelector('a').hash, li.querySelector('.page')?.textContent ?? null])")
        self.assertEqual(dict(entries)["#outputs"], "37")
        self.assertEqual(dict(entries)["#verdicts"], "1")
        self.assertIsNone(dict(entries)["#inputs"])
        self.driver.execute_script("dispatchEvent(new Event('afterprint'))")

    def test_an_address_with_a_stray_percent_sign_draws_the_page(self):
        self.driver.get("about:blank")
        self.driver.get(pages.made_up("plain").as_uri() + "#100%")
        pages.settle(self.driver)
        self.assertTrue(self.all(".contents li"))
        self.assertFalse(self.all(".contents .page"))

    def bullet_axis(self, at, one, edge, far, share):
        """Each number of the axis stands at its mark, in the displayed unit, which follows the last number."""
        marks, texts = self.run_script("""const svg = document.querySelectorAll('svg.bullet')[arguments[0]];
            return [[...svg.querySelector('.scale').getAttribute('d').matchAll(/M([\\d.]+),20v/g)].map(one => Number(one[1])),
                    [...svg.querySelectorAll('text')].map(one => [one.textContent, Number(one.getAttribute('x'))])]""", at)
        factor = self.limit_factor(one) if one["limit"] is not None else 100
        unit = self.run_script("return W.format.shown(W.verdicts.unitOf(arguments[0], W.set())).unit", one) if one["limit"] is not None else "%"
        self.assertTrue(texts and max(texts, key=lambda text: text[1])[0].endswith(unit), one["text"])
        for text, x in texts:
            value = parsed(text)[0][0] / factor
            here = 70 + 68 * ((value if one["limit"] is not None else share(value)) - edge) / (1.15 * far)
            self.assertLess(min(abs(mark - here) for mark in marks), 0.5, f"{text} of {one['text']}")
            self.assertLess(abs(x - here), 30, one["text"])

    def test_bullets_stand_on_the_side_of_their_limit(self):
        self.open(pages.made_up("plain"))
        wanted = self.run_script("return W.verdicts.judged().map(row => row.requirement)")
        for at, one in enumerate(wanted):
            observed, guaranteed, limit, good = self.run_script("""const svg = document.querySelectorAll('svg.bullet')[arguments[0]], read = (s, n) => { const e = svg.querySelector(s); return e && e.getAttribute(n); };
                return [Number(read('.observed', 'cx')), Number((read('.guaranteed', 'd') ?? 'MNaN,').slice(1).split(',')[0]), Number(read('.limit-mark', 'x1')),
                        [Number(read('.good', 'x')), Number(read('.good', 'width'))]]""", at)
            values = one["limit"] is not None
            share = lambda p: min(5, -math.log10(max(1e-5, 1 - p)))
            here, sure, edge = (one["observed_value"], one["guaranteed_value"], one["limit"]) if values else map(share, (one["observed"], one["guaranteed"], one["probability"]))
            self.assertAlmostEqual(limit, 70, msg=one["text"])
            far = max(abs(here - edge), abs(sure - edge), abs(edge) * 0.02)
            self.assertAlmostEqual(observed, 70 + 68 * (here - edge) / (1.15 * far), places=3, msg=one["text"])
            self.assertAlmostEqual(guaranteed, 70 + 68 * (sure - edge) / (1.15 * far), places=3, msg=one["text"])
            self.bullet_axis(at, one, edge, far, share)
            self.assertEqual(good, [0, 70] if values and one["upper"] else [70, 70], one["text"])

    def test_the_limit_is_a_line_of_the_quantile_s_convergence(self):
        self.open(pages.made_up("plain"))
        self.run_script("W.choose('output', 'root.peak_moment')")
        pages.settle(self.driver)
        limit = self.run_script("return W.set().requirements.find(one => one.output === 'root.peak_moment').limit")
        ticks, lines, texts = self.run_script("""return [...document.querySelectorAll('figure.settling svg')].map(svg => [[...svg.querySelectorAll('.axis.y .tick')].map(t => [t.transform.baseVal[0].matrix.f - 0.5, t.textContent]),
            [...svg.querySelectorAll('line.limit')].map(l => Number(l.getAttribute('y1'))), [...svg.querySelectorAll('.limit-text')].map(t => t.textContent)])[1]""")
        (low, first), (high, last) = ((at, parsed(text)[0][0]) for at, text in (ticks[0], ticks[-1]))
        self.assertEqual(len(lines), 1)
        self.assertAlmostEqual(first + (lines[0] - low) * (last - first) / (high - low), limit, delta=abs(last - first) / 150)
        self.assertEqual(texts, [f"≤ {limit} N·m"])
        self.assertEqual(self.run_script("return document.querySelectorAll('figure.settling')[0].querySelectorAll('line.limit').length"), 0)  # no limit of a mean
        self.run_script("W.choose('output', 'tip.latch_time')")
        pages.settle(self.driver)
        self.assertIn("The limit ≤ 60 s lies outside", self.all("figure.settling")[1].text)

    def test_a_limit_up_to_two_ranges_beyond_the_quantile_is_a_line_and_a_farther_one_a_note(self):
        self.open(pages.made_up("plain"))
        self.run_script("W.choose('output', 'root.peak_moment')")
        one = self.run_script("return W.output().convergence")
        known = [value for key in ("quantile", "quantile_lower", "quantile_upper") for value in one[key] if value is not None]
        low, high = min(known), max(known)
        for ranges, near in ((1.1, True), (1.9, True), (2.1, False), (30, False)):
            for limit in (low - ranges * (high - low), high + ranges * (high - low)):
                self.run_script("W.set().requirements.find(one => one.output === 'root.peak_moment').limit = arguments[0]; W.convergence()", limit)
                pages.settle(self.driver)
                lines, text = self.run_script("const figure = document.querySelectorAll('figure.settling')[1]; return [figure.querySelectorAll('line.limit').length, figure.innerText]")
                self.assertEqual((lines, "lies outside" in text), (int(near), not near), f"{ranges} ranges: {limit}")

    def test_a_column_of_the_outputs_has_as_many_digits_in_every_row(self):
        self.open(pages.made_up("plain"))
        digits = lambda text: len(re.sub(r"\D", "", text).lstrip("0"))
        rows = self.table(f"Outputs of {self.run_script('return W.set().label')}")
        for place in range(4, len(rows[0])):
            self.assertEqual({digits(row[place]) for row in rows}, {3 if place == 6 else 4})

    def test_every_hinge_has_a_colour_and_dash_and_a_name(self):
        self.open(pages.made_up("forty"))
        names, strokes = self.run_script("""const svg = document.querySelector('figure.history svg'), items = [...svg.querySelectorAll('.legend g')];
            return [items.map(one => one.textContent), items.map(one => one.querySelector('line').style.stroke + ' ' + one.querySelector('line').getAttribute('stroke-dasharray'))]""")
        self.assertEqual(len(names), 14)
        self.assertEqual(names[-1], "27 others")
        self.assertEqual(len(set(strokes)), 14)

    def test_no_printed_page_is_half_empty(self):
        """But the last: how far down each page has ink, above its foot."""
        if not shutil.which("pdftoppm"):
            self.skipTest("pdftoppm is missing (Debian: poppler-utils)")
        if not self.last_print:
            self.open(pages.made_up("cases"))
        subprocess.run(["pdftoppm", "-r", "20", "-gray", "-", pages.SCRATCH / "printed"], input=self.last_print or self.printed(), check=True)
        filled = []
        for path in sorted(pages.SCRATCH.glob("printed-*.pgm")):
            _, size, _, pixels = path.read_bytes().split(b"\n", 3)
            width, height = map(int, size.split())
            top, bottom = height * 14 // 297, height * 280 // 297  # style_print.css: the margins of @page
            ink = [y for y in range(top, bottom) if min(pixels[y * width:(y + 1) * width]) < 200]
            filled.append((max(ink, default=top) - top) / (bottom - top))
        self.assertGreater(min(filled[:-1]), 0.5, filled)
        self.assertGreater(statistics.mean(filled[:-1]), 0.8, filled)
