"""The page's building blocks: texts of numbers and units, copying, legends, upright lines, hatches, dashes, saved and printed pictures, poses and states in words."""

import json
import re

import assemble
import mock
import pages
from fit_page_checks import fit
from number_checks import DEGREES, parsed

PRINTED = {"histogram": 440, "distribution": 440, "history": 440, "scatter": 440, "settling": 440, "still": 300, "envelopes": 940, "tornado": 940, "static-margins": 860, "forest": 860,
           "stage": 440, "strobe": 660, "strips": 660, "margin": 660, "rare": 660}  # px: as wide as they stand on a printed page


def crossings(box, a, b, c, dotted):
    """The lines ax + by = c, c + 6, … inside a box, each by the two points where it crosses the sides; a dotted one begins at its first dot."""
    left, top, right, bottom = box[0], box[1], box[0] + box[2], box[1] + box[3]
    for level in range(c - 300, 300, 6):
        on_sides = {(x, (level - a * x) / b) for x in (left, right) if b} | {((level - b * y) / a, y) for y in (top, bottom) if a}
        ends = sorted((x, y) for x, y in on_sides if left <= x <= right and top <= y <= bottom)
        if dotted and ends:
            ends[0] = (next(x for x in range(c - 300, 300, 6) if x >= left), ends[0][1])
        if len(ends) == 2 and ends[0] < ends[1]:
            yield ends


class ShapeChecks:
    """For a Page with MarkChecks."""

    def test_limits_and_values_as_text_in_both_units(self):
        self.open(pages.made_up("single"))
        five = 5 / DEGREES
        written = [(five, "rad/s", "5 deg/s", "5 deg/s (0.08727 rad/s)"), (1.5, "rad", "1.5 rad (85.94 deg)", "1.5 rad"), (-0.25, "rad/s^2", "−0.25 rad/s² (−14.32 deg/s²)", "−0.25 rad/s²"), (12, "N m", "12 N·m", "12 N·m"), (3, "", "3", "3"),
                   (90 / DEGREES, "rad", "90 deg", "90 deg (1.571 rad)"), (2, "rad", "2 rad (114.6 deg)", "2 rad")]
        values = [(1.23456, "rad", 0.01, "70.74", "1.235"), (1.23456, "N m", None, "1.2346", "1.2346"), (7, "", None, "7", "7"), (7.5, "", None, "7.5000", "7.5000"), (7, "s", None, "7.0000", "7.0000"), (7, "", 0, "7", "7"), (None, "s", 1, "–", "–"), (12.5, "s", 0.25, "12.50", "12.50")]
        for place, unit in enumerate(("deg", "rad")):
            self.angles(unit)
            for value, own, *texts in written:
                self.assertEqual(self.run_script("return W.format.written(arguments[0], arguments[1])", value, own), texts[place])
            for value, own, spread, *texts in values:
                self.assertEqual(self.run_script("return W.format.value(...arguments)", value, own, spread), texts[place], f"{value} {own}")
                text = self.run_script("return W.format.withUnit(...arguments)", value, own, spread)
                self.assertEqual(text, "–" if value is None else f"{texts[place]} {own.replace('rad', unit).replace(' ', '·')}".strip())
        for script, wanted in (("F.unit('N m s/rad^2 kg*m')", "N·m·s/rad²·kg·m"), ("F.unit(null)", ""), ("F.level(0.01)", "1 %"), ("F.level(0.995)", "99.5 %"), ("F.level(0.9)", "90 %"), ("F.level(1)", "100 %"), ("F.level(0.00135)", "0.135 %"), ("F.level(0.99865)", "99.865 %"), ("F.written(2.32434212, 's')", "2.32434212 s"), ("F.limit(2.32434212, { unit: 's', std: 1e-6 })", "2.32434212"), ("F.limit(190, { unit: 'N m', std: 1e-3 })", "190"), ("F.limit(1 / 3, { unit: 's', std: null })", "0.333333"), ("F.level(0.9999)", "99.99 %"), ("F.quantileName(0.5)", "Median"), ("F.quantileName(0.25)", "25 % quantile"), ("F.order('a>b>c')", "a › b › c"),
                               ("F.order('no latch')", "no hinge latched"), ("F.order('others')", "other orders"), ("F.runs(1)", "1 run"), ("F.runs(1234)", "1,234 runs"), ("F.counted(2, 'hinge or group', 'many')", "2 many"), ("F.count(null)", "–"), ("F.count(1234567)", "1,234,567"),
                               ("F.axis('a', '')", "a"), ("F.axis('a', 'm')", "a (m)"), ("F.nameOf('left_wing.peak_rate')", "left wing peak rate"), ("F.nameOf('root.latch_time')", "root latch time"), ("F.unitOf('root.latch_time')", "s"), ("F.unitOf('none')", ""), ("F.superscript(-120)", "⁻¹²⁰"),
                               ("F.name({ name: 'a_b.peak_rate', hinge: 'a_b' })", "a_b peak rate"), ("F.name({ name: 'a_b.peak_rate', hinge: null })", "a b peak rate"), ("String(F.grain({ std: 5 }))", "0.5"), ("String(F.grain({ std: 0 }))", "null"), ("String(F.decimals(0.034, 1))", "3"), ("String(F.decimals(0, 123.4))", "1"),
                               ("String(F.decimals(null, 0))", "0"), ("String(F.decimals(250, 1))", "0"), ("F.shareBounds(null, null)", "no bounds"), ("F.shareBounds(0, 0.25)", "below 25.0 %"), ("F.shareBounds(0.5, 1)", "above 50.0 %"), ("F.shareBounds(0.991, 0.9995)", "99.100 % – 99.950 %"),
                               ("F.share(0.999999925)", "99.9999925 %"), ("F.share(1 - 1 / 4e7)", "99.9999975 %"), ("F.shareBounds(0.9999997808181891, 0.9999999845331966)", "99.9999781 % – 99.9999985 %"), ("F.shareBounds(0.9999997808, 1)", "above 99.999978 %"), ("F.share(7.5e-8)", "7.5 × 10⁻⁶ %"),
                               ("F.tick(2.5)", "2.5"), ("F.tick(2.5000001, 1e-7)", "2.5000001"), ("F.tick(1050000, 50000)", "1.05 × 10⁶"), ("F.tick(1e6, 50000)", "10⁶".replace("10⁶", "1 × 10⁶")), ("F.tick(0, 1e-9)", "0"), ("F.tick(12.5, 0.5)", "12.5"),
                               ("F.sized(2.5000000012, 1e-10)", "2.50000000120"), ("F.sized(2.5, 1e-16)", "2.500"), ("F.sized(1000000003, 1)", "1.0000000030 × 10⁹".replace("0030", "003")), ("F.sized(1.5e-7, 1e-8)", "1.5 × 10⁻⁷")):
            self.assertEqual(self.run_script(f"const F = W.format; return {script}"), wanted, script)
        self.run_script("W.set().wing.hinges = [{ name: 'others' }]")
        self.assertEqual(self.run_script("return W.format.order('others')"), "others")
        self.run_script("W.set().orders = [{ order: 'others', count: 2000 }]; W.outcomes()")
        self.assertEqual((self.table("Latch orders")[0][0], self.run_script("return W.marks.ofOrder(W.set(), 0)")), ("others", 0))
        self.assertTrue(self.run_script("return d3.range(60).every(width => { const text = W.marks.shorten('🛰🛰🛰🛰', width); return encodeURIComponent(text) && text; })"))  # no half of a character

    def test_text_is_copied_without_a_clipboard_too(self):
        self.open(pages.made_up("single"))
        heard = self.driver.execute_async_script("""const done = arguments[0], W = window.wingspread; Object.defineProperty(navigator, 'clipboard', { value: undefined });
            document.execCommand = what => { const area = document.activeElement; window.heard = [what, area.value.slice(area.selectionStart, area.selectionEnd), area.className, area.getAttribute('aria-hidden')]; return true; };
            W.copy('some text', 'Word'); done([...window.heard, document.querySelectorAll('textarea').length, document.getElementById('spoken').textContent])""")
        self.assertEqual(heard, ["copy", "some text", "unseen", "true", 0, "Word copied."])
        self.assertEqual(self.run_script("const made = W.h('td.number.wide', { title: 'moment', hidden: true, 'data-a': null, 'data-b': false, id: 0 }, '1', [null, ['2', false]], W.h('b', 3)); return made.outerHTML"), '<td class="number wide" title="moment" hidden="" id="0">12<b>3</b></td>')
        self.assertEqual(self.run_script("return [W.h('button', 'x').type, W.h('p', ['a', 'b']).textContent, W.isNumber(NaN), W.isNumber('1'), W.isNumber(0), W.newId('a') === W.newId('a')]"), ["button", "ab", False, False, True, False])
        table = self.run_script("""const box = W.table("caption", ["A", W.number("B", "s")], [["a", 1], { cells: ["b", 2], mark: "zero" }], { class: "own", stacks: true, showCaption: true });
            return [box.getAttribute("aria-label"), box.getAttribute("role"), box.firstChild.className, box.querySelector("caption").className, ...[...box.querySelectorAll("th[scope=col]")].map(one => one.outerHTML), ...[...box.querySelectorAll("tbody tr")].map(one => one.outerHTML)]""")
        self.assertEqual(table, ["caption", "group", "own", "", '<th scope="col">A</th>', '<th scope="col" class="number">B<span class="unit"> s</span></th>', '<tr><th scope="row">a</th><td class="number" data-label="B">1</td></tr>',
                                 '<tr class="zero"><th scope="row">b</th><td class="number" data-label="B">2</td></tr>'])
        plain = self.run_script("const box = W.table('caption', ['A', 'B'], [['a', 1]]); return [box.querySelector('caption').className, box.querySelector('td').outerHTML]")
        self.assertEqual(plain, ["unseen", "<td>1</td>"])
        wide = self.run_script("const box = W.table('c', ['A'], [['x'.repeat(2000)]]), small = W.table('c', ['A'], [['x']]); document.querySelector('main').prepend(box, small); window.boxes = [box, small]; return null")
        pages.settle(self.driver)
        self.assertEqual((wide, self.run_script("return window.boxes.map(box => box.getAttribute('tabindex'))")), (None, ["0", None]))

    def test_legends_upright_lines_and_looks(self):
        self.open(pages.made_up("single"))
        got = self.run_script("""const M = W.marks, svg = d3.select(document.querySelector('main')).append('svg').attr('class', 'chart').attr('width', 400).attr('height', 300);
            const tall = M.legend(svg, [{ text: 'one', fill: 'red', opacity: 0.5 }, { text: 'two', line: 'blue', dash: '7 3' }, { text: 'three', mark: 'green' }, { text: 'x'.repeat(99), line: 'red', heavy: 5 }], 200);
            return [tall, M.legend(svg, [], 200), [...svg.node().querySelector('.legend').children].map(one => { const m = one.transform.baseVal[0].matrix, s = one.firstChild; return [m.e, m.f, s.tagName, s.style.fill, s.style.fillOpacity, s.getAttribute('stroke-dasharray'), s.getAttribute('stroke-width'), one.getBBox().width]; }), ['one', 'two', 'three'].map(text => M.textWidth(text))]""")
        tall, none, items, widths = got
        self.assertEqual((none, [one[2] for one in items], items[0][3:5], items[1][5:7], items[3][6]), (0, ["rect", "line", "path", "line"], ["red", "0.5"], ["7 3", "2"], "5"))
        x, y = 0, 11
        for at, (item, wide) in enumerate(zip(items, [*widths, 200])):
            needed = 22 + wide + 16
            if x > 0 and x + needed > 212:
                x, y = 0, y + 18
            self.assertAlmostEqual(item[0], x, delta=0.01, msg=str(at))
            self.assertAlmostEqual(item[1], y, delta=0.01, msg=str(at))
            x += needed
        self.assertEqual(tall, y + 14)
        self.assertLessEqual(items[3][7], 212)
        labels = self.run_script("""const M = W.marks, svg = d3.select(document.querySelector('main')).append('svg'), of = low => { const group = svg.append('g');
            M.uprights(group, { left: 10, right: 300, top: 20, bottom: 120 }, [{ x: 5, text: 'out', kind: 'limit' }, { x: 100, text: 'first', kind: 'limit' }, { x: 101, text: 'second', kind: 'nominal' }, { x: 102, text: 'third', kind: 'limit' }, { x: 299, text: 'last', kind: 'limit' }, { x: 301, text: 'out', kind: 'limit' }], low);
            return [[...group.node().querySelectorAll('line')].map(e => [e.getAttribute('class'), ...['x1', 'x2', 'y1', 'y2'].map(n => Number(e.getAttribute(n)))]), [...group.node().querySelectorAll('text')].map(e => [e.textContent, e.getAttribute('class'), e.getAttribute('text-anchor'), Number(e.getAttribute('y')), e.getBBox().x, e.getBBox().x + e.getBBox().width])]; };
            return [of(false), of(true)]""")
        for (lines, texts), rows in zip(labels, ((lambda row: 30 + 13 * row), (lambda row: 112 - 13 * row))):
            self.assertEqual(lines, [["limit", 100, 100, 20, 120], ["nominal", 101, 101, 20, 120], ["limit", 102, 102, 20, 120], ["limit", 299, 299, 20, 120]])
            self.assertEqual([text[:2] for text in texts], [["first", "limit-text"], ["second", "nominal-text"], ["third", "limit-text"], ["last", "limit-text"]])
            self.assertEqual(texts[3][2], "end")  # no room at the right
            for text in texts:
                self.assertTrue(10 <= text[4] and text[5] <= 300, text)
                self.assertIn(text[3], [rows(0), rows(1), rows(2)])
            for one in texts:
                self.assertFalse(any(other is not one and one[3] == other[3] and one[4] < other[5] and other[4] < one[5] for other in texts), texts)
        self.assertEqual(self.run_script("return d3.range(49).map(at => [W.marks.colour(at), W.marks.dash(at)].join()).filter((one, at, all) => all.indexOf(one) === at).length"), 49)  # colour and dash together
        self.assertEqual(self.run_script("return [W.marks.dash(0), W.marks.colour(-1), W.marks.colour(8), new Set(d3.range(7).map(W.marks.colour)).size, new Set(d3.range(7).map(W.marks.shape)).size, W.marks.shape(-1) === W.marks.shape(6)]"), ["", "var(--none)", "var(--c1)", 7, 7, True])
        self.assertEqual(self.run_script("const set = { orders: [{ order: 'a>b' }, { order: 'others' }, { order: 'no latch' }] }; return [0, 1, 2, 3].map(at => W.marks.ofOrder(set, at))"), [0, 6, -1, -1])
        scales = self.run_script("return [[1, 3], [2, 2], [0], [null], [-4, null, 6]].map(values => [W.marks.linear(values, [0, 1]).domain(), W.marks.linear(values, [0, 1], 0.5).domain()])")
        self.assertEqual([[[round(end, 9) for end in ends] for ends in one] for one in scales], [[[0.94, 3.06], [0, 4]], [[1.9, 2.1]] * 2, [[-1, 1]] * 2, [[0, 1]] * 2, [[-4.3, 6.3], [-9, 11]]])
        short, long = self.run_script("const long = W.marks.shorten('a long label of a row', 60); return [W.marks.shorten('ab', 60), [long, W.marks.textWidth(long), W.marks.textWidth(long.slice(0, -1) + 'xx…')]]")
        self.assertEqual(short, "ab")
        self.assertTrue(long[0].endswith("…") and long[1] <= 60 < long[2], long)

    def test_bars_are_hatched_each_colour_in_its_way(self):
        """Each hatching's lines within three boxes: where they cross a box's sides, found side by side."""
        self.open(pages.made_up("single"))
        boxes = [(3.25, 7.5, 20, 15.5), (-4, 30.75, 6, 0.5), (2.5, 41, 3, 12)]
        drawn = self.run_script("""return d3.range(-1, 9).map(at => { const svg = d3.select(document.querySelector('main')).append('svg'); W.marks.hatch(svg, at, arguments[0]); W.marks.hatch(svg, at, []);
            return [...svg.node().children].map(one => [one.getAttribute('d'), one.getAttribute('stroke-dasharray'), one.getAttribute('class'), getComputedStyle(one).pointerEvents]); })""", boxes)
        kinds = {0: [], 1: [(1, 1, 0)], 2: [(0, 1, 3)], 3: [(1, 0, 3)], 4: [(1, -1, 0)], 5: [(1, 1, 0), (1, -1, 0)], 6: [(0, 1, 1), (0, 1, 4)]}
        for at, paths in zip(range(-1, 9), drawn):
            kind = 0 if at < 0 else at % 7
            if kind == 0:
                self.assertEqual(paths, [], at)
                continue
            (path, dashes, name, pointer), = paths
            self.assertEqual((dashes, name, pointer), ("1 5" if kind == 6 else None, "hatch", "none"), at)
            lines, wanted = [], [ends for box in boxes for line in kinds[kind] for ends in crossings(box, *line, kind == 6)]
            for x, y, step, end in re.findall(r"M([-\d.]+),([-\d.]+)([VHL])([-\d.,]+)", path):
                last = {"V": f"{x},{end}", "H": f"{end},{y}", "L": end}[step].split(",")
                lines.append(sorted([(float(x), float(y)), tuple(map(float, last))]))
            self.assertEqual(len(lines), len(wanted), at)
            for line, want in zip(sorted(lines), sorted(wanted)):
                self.assertTrue(all(abs(a - b) < 0.006 for one, two in zip(line, want) for a, b in zip(one, two)), (at, line, want))

    def test_bars_and_their_samples_have_one_hatching(self):
        """In the histogram and among the influences: lines lie on bars of their colour alone, and on the legend's sample of it."""
        self.open(pages.made_up("plain"))
        for figure, bars in (("histogram", ".bin"), ("tornado", ".effect")):
            colours, samples, wrong = self.run_script("""const figure = document.querySelector('figure.' + arguments[0]), bars = [...figure.querySelectorAll(arguments[1])], points = {}, wrong = [];
                const hatched = [...figure.querySelectorAll('.hatch')].filter(one => !one.closest('.legend')), found = new Set(), at = (path, point) => path.isPointInStroke(point);
                hatched.forEach(path => { path.getAttribute('d').match(/M[-\\d.]+,[-\\d.]+/g).forEach(start => { const [x, y] = start.slice(1).split(',').map(Number);
                    const under = bars.filter(bar => { const [l, t, w, tall] = ['x', 'y', 'width', 'height'].map(n => Number(bar.getAttribute(n))); return x > l - 0.01 && x < l + w + 0.01 && y > t - 0.01 && y < t + tall + 0.01; });
                    const own = path.closest('.layer') ? under.filter(bar => bar.parentNode === path.parentNode) : under;
                    if (!own.length) wrong.push(start); else found.add(own[0].style.fill); }); });
                return [[...found].sort(), [...figure.querySelectorAll('.legend > g')].map(one => [one.firstChild.style.fill, one.querySelectorAll('.hatch').length]), wrong]""", figure, bars)
            self.assertEqual(wrong, [])
            self.assertEqual(colours, sorted(fill for fill, hatched in samples if hatched), figure)
            self.assertEqual([fill for fill, hatched in samples if not hatched], ["var(--c0)"], figure)
            self.assertGreater(len(samples), 1)

    def test_pictures_are_saved_and_printed_in_their_sizes(self):
        self.open(pages.made_up("cases"), 1700)
        wide, saved = self.run_script("""const one = document.querySelector('figure.histogram .picture'), box = one.querySelector('svg').viewBox.baseVal, theme = document.documentElement;
            theme.setAttribute('data-theme', 'dark'); const text = W.standalone(one); const kept = theme.getAttribute('data-theme'); theme.removeAttribute('data-theme');
            const svg = new DOMParser().parseFromString(text, 'image/svg+xml').documentElement, paper = [...svg.children].find(each => each.tagName === 'rect');
            return [[box.width, box.height], [svg.getAttribute('viewBox'), Number(svg.getAttribute('width')), Number(svg.getAttribute('height')), ...['x', 'y', 'width', 'height', 'fill'].map(n => paper.getAttribute(n)), kept, svg.querySelectorAll('[class]').length, [...svg.querySelectorAll('text')].every(each => /font-size:[\\d.]+px/.test(each.getAttribute('style')))]]""")
        width, height = (int(size) for size in wide)
        self.assertEqual(saved, [f"-14 -12 {width + 28} {height + 24}", width + 28, height + 24, "-14", "-12", str(width + 28), str(height + 24), "#fff", "dark", 0, True])
        sizes = lambda: self.run_script("return [...document.querySelectorAll('figure')].filter(one => one.querySelector('svg') && !one.closest('details:not([open])')).map(one => [one.className, one.querySelector('svg').viewBox.baseVal.width, one.querySelector('.picture').clientWidth])")
        growth = self.run_script("return Math.max(1, parseFloat(getComputedStyle(document.documentElement).fontSize) / 14.3)")
        before = sizes()
        self.assertGreater(growth, 1)
        for name, drawn, shown in before:
            self.assertAlmostEqual(drawn, shown / growth, delta=1.01, msg=name)
        roles = self.run_script("return [...document.querySelectorAll('figure')].filter(one => one.querySelector('svg.chart')).map(one => [one.className, one.querySelector('svg.chart').getAttribute('role')])")
        self.assertEqual({role for name, role in roles if name == "scatter"}, {"group"})
        self.assertEqual({role for name, role in roles if name != "scatter"}, {"img"})
        folded = self.run_script("document.querySelector('#inputs details').open = false; dispatchEvent(new Event('beforeprint')); return document.querySelector('#inputs details').open")
        printed = {}
        for name, drawn, _ in sizes():
            printed.setdefault(name, set()).add(drawn)
        self.assertEqual(printed, {name: {size} for name, size in PRINTED.items()})
        self.run_script("dispatchEvent(new Event('afterprint'))")
        self.assertEqual((folded, self.run_script("return document.querySelector('#inputs details').open"), sizes()), (True, False, before))

    def test_what_a_hinge_has_done_in_words(self):
        self.open(pages.made_up("single"))
        latch, event = lambda time, hinge=0: {"hinge": hinge, "time": time}, lambda kind, time, hinge=0: {"kind": kind, "hinge": hinge, "time": time}
        for hinge, latches, events, time, latched, text in (
                ({}, [latch(2)], [], 1.5, None, "open"), ({}, [latch(2)], [], 2, True, "latched at 2.000 s"), ({}, [], [], 9, None, "open, never latches"), ({}, [latch(2, 1)], [], 9, None, "open, never latches"), ({"latch": False}, [], [], 9, None, "has no latch"),
                ({"latch": False, "held": True}, [], [event("released", 1)], 0.5, None, "held"), ({"latch": False, "held": True}, [], [event("released", 1)], 2, None, "released at 1.000 s"), ({"held": True}, [], [], 2, None, "held, never released"),
                ({"held": True}, [latch(3)], [event("released", 1)], 2, False, "released at 1.000 s"), ({"held": True}, [], [event("released", 1)], 2, False, "released at 1.000 s, never latches"), ({}, [latch(3)], [event("missed", 1.25)], 2, False, "passed its latch too fast at 1.250 s"),
                ({}, [latch(3), latch(5)], [event("let_go", 4)], 4.5, False, "latch let go at 4.000 s"), ({}, [latch(5), latch(3)], [event("let_go", 4)], 6, True, "latched at 5.000 s")):
            got = self.run_script("return W.pose.state({ hinges: [arguments[0], {}] }, { latches: arguments[1], events: arguments[2] }, 0, arguments[3])", hinge, latches, events, time)
            self.assertEqual((got["text"], got.get("latched")), (text, latched))
        self.assertEqual(self.run_script("return W.pose.deployed({ hinges: [{ latched: 0.5 }, { latched: null }] })"), [0.5, 0])
        bar = self.run_script("return [100, 33, 0.7, 450].map(factor => { const svg = d3.select(document.querySelector('main')).append('svg'); W.pose.bar(svg, { factor }, 3, 4); return [svg.select('path').attr('d'), svg.select('text').text(), Number(svg.select('text').attr('x')), svg.select('g').attr('transform')]; })")
        for factor, (path, text, x, place) in zip((100, 33, 0.7, 450), bar):
            (metres, _), = parsed(text)
            pixels = float(path.split("H")[1].split("V")[0])
            self.assertAlmostEqual(pixels, metres * factor)
            self.assertTrue(36 <= pixels <= 90 and x == pixels + 6 and place == "translate(3,4)", (factor, path, text))
        box, scale = self.run_script("""const wing = { hinges: [], base: {}, bodies: [{ hinge: -1, outline: [[0, 1], [4, 3]], inner: [0, 0], joint_in_parent: [0, 0] }] }, box = W.pose.bounds(wing, [{ angles: [] }]), s = W.pose.scale(box, 200, 50, 7);
            return [box, [s.factor, s.height, s.x(box.left), s.x(box.right), s.y(box.top), s.y(box.bottom)]]""")
        self.assertEqual([round(box[key], 9) for key in ("left", "right", "bottom", "top")], [-0.16, 4.16, 0.84, 3.16])
        factor = min(200 / 4.32, 50 / 2.32)
        for got, want in zip(scale, (factor, 2.32 * factor, 100 - 2.16 * factor, 100 + 2.16 * factor, 7, 7 + 2.32 * factor)):
            self.assertAlmostEqual(got, want)

    def test_numbers_of_an_axis_do_not_overlap(self):
        """Nor do those of the small pictures of requirements; on a telephone and on a wide screen."""
        for width in (360, 1280):
            self.open(pages.made_up("plain"), width)
            crowded = self.run_script("""const boxes = (one, s) => [...one.querySelectorAll(s)].filter(text => text.textContent).map(text => text.getBoundingClientRect()), found = [];
                const overlap = (list, low, high) => [...list].sort((a, b) => a[low] - b[low]).some((box, at, all) => at && box[low] < all[at - 1][high] - 0.5);
                for (const axis of document.querySelectorAll('.axis')) if (axis.getBoundingClientRect().width && overlap(boxes(axis, '.tick text'), ...(axis.classList.contains('x') ? ['left', 'right'] : ['top', 'bottom'])))
                    found.push([axis.closest('figure').className, axis.getAttribute('class'), axis.textContent]);
                for (const svg of document.querySelectorAll('svg.bullet')) if (overlap(boxes(svg, 'text'), 'left', 'right')) found.push(['bullet', svg.textContent]);
                return found""")
            self.assertEqual(crowded, [], width)
        crowded = self.run_script("""return [[0.1, 0.1001], [12345, 12399], [-1234567, 99], [0.5, 1e6]].map(([limit, value]) => { const svg = W.bullet({ limit, observed_value: value, guaranteed_value: value, upper: true }, { factor: 1, unit: 'N·m' });
            document.querySelector('main').prepend(svg); const all = [...svg.querySelectorAll('text')].map(text => text.getBoundingClientRect()).sort((a, b) => a.left - b.left); return [all.length, all.some((box, at) => at && box.left < all[at - 1].right)]; })""")
        self.assertEqual([overlaps for _, overlaps in crowded], [False] * 4, crowded)
        self.assertTrue(any(count > 1 for count, _ in crowded), crowded)

    def test_long_names_widen_neither_a_narrow_screen_nor_a_printed_page(self):
        block = mock.KINDS["cases"]()
        text = json.dumps(block).replace('"root', '"' + "root_hinge_of_the_outer_wing_with_a_name_as_long_as_a_line").replace('"cold', '"' + "cold" * 16)
        path = pages.SCRATCH / "long_names.html"
        path.write_text(assemble.page(text), "utf-8")
        self.open(path, 360)
        self.assertLessEqual(self.driver.execute_script("return document.documentElement.scrollWidth"), 360)
        cut = self.run_script("""return [...document.querySelectorAll('svg.chart .axis-text')].filter(text => text.getClientRects().length && text.getBBox().x + text.getBBox().width > text.ownerSVGElement.viewBox.baseVal.width + 1
            || text.getBBox().x < -1).map(text => text.textContent)""")
        self.assertEqual(cut, [])
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
        self.run_script("document.querySelectorAll('#verdicts details').forEach(one => one.open = true)")
        pages.resize(self.driver, 695)
        wide = self.run_script("return [...document.querySelectorAll('#verdicts table.requirements')].map(table => table.getBoundingClientRect().right)")
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})
        self.assertTrue(wide and max(wide) <= 697, wide)

    def printed_letters(self):
        """Of each picture with letters: its name, and the size of its smallest letters on paper in points."""
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
        self.driver.execute_script("dispatchEvent(new Event('beforeprint'))")
        pages.resize(self.driver, 695)
        letters = self.run_script("""return [...document.querySelectorAll('figure svg.chart')].filter(svg => svg.getClientRects().length).map(svg => [svg.closest('figure').className,
            0.75 * Math.min(...[...svg.querySelectorAll('text')].map(text => parseFloat(getComputedStyle(text).fontSize))) * svg.getBoundingClientRect().width / svg.viewBox.baseVal.width])""")
        self.driver.execute_script("dispatchEvent(new Event('afterprint'))")
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})
        return letters

    def test_letters_of_printed_studies_can_be_read(self):
        self.open(pages.made_up("beside"))
        studies = self.printed_letters()
        self.opened_block("fit_page", lambda: mock.block([mock.study("fit", fit=fit())]))
        letters = studies + self.printed_letters()
        self.assertLessEqual({"margin", "tornado", "rare", "static-margins", "fit-trace", "fit-pairs", "fit-parameters"}, {name for name, _ in letters})
        self.assertEqual([one for one in letters if one[1] < 6], [])
