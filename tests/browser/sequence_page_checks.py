"""The time line of releases and captures of a made-up wing: its marks, its words and its table, against the data."""

import json

import assemble
import mock
import pages
from number_checks import parsed

KINDS = {"released": "hold lets go", "missed": "passes too fast for its latch", "latched": "latch engages", "let_go": "latch lets go"}
NONE = {"runs": 0, "count": 0, "times": []}


def event(runs, count, first, step=0.125):
    return {"runs": runs, "count": count, "times": [first + step * at for at in (0, 1, 3, 4, 6, 9, 10)]}


def release(kind, delay=0, **more):
    return {"event": kind, "time": 0, "after": -1, "angle": 0, "delay": delay, **more}


# A release of every kind, with a delay and without; mid happens last, tip in no run.
FIRST = [{"release": release("passed", 0.25, after=1, angle=0.5), "released": event(190, 190, 1.5), "missed": event(30, 41, 2.25), "latched": event(180, 205, 3.0625), "let_go": event(20, 25, 3.5)},
         {"release": release("time", time=0.75), "released": event(200, 200, 0.75, 0), "missed": NONE, "latched": event(199, 199, 4.0), "let_go": NONE},
         {"release": release("latched", after=0), "released": NONE, "missed": NONE, "latched": NONE, "let_go": NONE}]
SECOND = [{**FIRST[0], "latched": event(150, 150, 2.5), "missed": NONE}, {**FIRST[1], "latched": NONE}, {**FIRST[2], "released": event(5, 5, 6.0), "latched": event(4, 4, 7.0)}]
WORDS = {"root": "0.25 s after mid has turned by 28.6479 deg", "mid": "at 0.75 s", "tip": "when root latches"}
LANES = [("mid", "released"), ("mid", "latched"), ("root", "released"), ("root", "missed"), ("root", "latched"), ("root", "let_go"), ("tip", "released")]


class SequencePageChecks:
    """For a Page with MarkChecks."""

    def opened_sequence(self):
        path = pages.SCRATCH / "sequence.html"
        if not path.exists():
            block = mock.block([mock.make_set(case, 1, count=300, case=case) for case in ("cold", "hot")])
            for one, sequence in zip(block["sets"], (FIRST, SECOND)):
                one["envelopes"] |= {"runs": 1200, "sequence": sequence}
            path.write_text(assemble.page(json.dumps(block)), "utf-8")
        self.open(path)
        self.run_script("W.choose('set', 0)")
        pages.settle(self.driver)
        return dict(zip(("root", "mid", "tip"), FIRST)), dict(zip(("root", "mid", "tip"), SECOND))

    def test_the_time_line_has_every_event(self):
        first, _ = self.opened_sequence()
        x, count = self.scale("sequence", "x"), 1200
        figure = lambda script: self.run_script("const svg = document.querySelector('figure.sequence svg'), read = (s, ...n) => [...svg.querySelectorAll(s)].map(e => n.map(k => Number(e.getAttribute(k)))); return " + script)
        lanes = [(hinge, kind, first[hinge][kind]) for hinge, kind in LANES]
        known = [(hinge, kind, one) for hinge, kind, one in lanes if one["count"]]
        rows = self.exported("sequence")
        self.assertEqual(rows[0], ["hinge", "event", "runs", "events", "first s", "5 % s", "25 % s", "median s", "75 % s", "95 % s", "last s"])
        self.same_rows("sequence", [[hinge, KINDS[kind], one["runs"], one["count"], *(one["times"] or [None] * 7)] for hinge, kind, one in lanes])
        middles = [y for _, y in figure("[...svg.querySelectorAll('.faint-text')].map(e => [0, Number(e.getAttribute('y'))])")]
        self.assertEqual(middles, sorted(middles))
        self.assertEqual(figure("[...svg.querySelectorAll('.faint-text')].map(e => e.textContent)"), [f"{one['runs']} of 1,200" if one["count"] else "in none" for _, _, one in lanes])
        heights = [y for y, (_, _, one) in zip(middles, lanes) if one["count"]]
        self.near(figure("read('line.reach', 'x1', 'x2', 'y1', 'y2')"), [(x(one["times"][0]), x(one["times"][6]), y, y) for y, (_, _, one) in zip(heights, known)], "reach")
        self.near(figure("read('line.middle', 'x1', 'x2', 'y1', 'y2')"), [(x(one["times"][3]), x(one["times"][3]), y - 7, y + 7) for y, (_, _, one) in zip(heights, known)], "median")
        bars = []
        for y, (_, _, one) in zip(heights, known):
            for low, high in ((1, 5), (2, 4)):
                left, right = x(one["times"][low]), x(one["times"][high])
                wide = max(6, right - left)
                bars.append(((left + right - wide) / 2, wide, y - 5, 10))
        self.near(figure("read('rect.span', 'x', 'width', 'y', 'height')"), bars, "spans")
        looks = figure("[...svg.querySelectorAll('rect.span')].map(e => [e.style.fill, Number(e.style.fillOpacity)])")
        colours = dict(zip(KINDS, figure("[...svg.querySelectorAll('.legend rect')].map(e => e.style.fill)")))
        self.assertEqual(figure("[...svg.querySelectorAll('.legend text')].map(e => e.textContent)"), list(KINDS.values()))
        self.assertEqual(len(set(colours.values())), 4)
        self.assertEqual(looks, [[colours[kind], opacity] for _, kind, _ in known for opacity in (0.35, 0.8)])
        self.assertEqual(figure("[...svg.querySelectorAll('line.reach')].map(e => e.style.stroke)"), [colours[kind] for _, kind, _ in known])
        for title, (hinge, kind, one) in zip(figure("[...svg.querySelectorAll('rect.span title')].map(e => e.textContent)")[::2], known, strict=True):
            self.assertTrue(title.startswith(f"{hinge} {KINDS[kind]} at "), title)
            self.check(title.partition(" at ")[2].replace(" s (", " ").replace(" s)", " "), one["times"][3], one["times"][0], one["times"][6], one["runs"], count, about=title)
        described = figure("svg.querySelector('desc').textContent")
        self.assertEqual([part.partition(":")[0] for part in described.split("; ")], ["mid", "root", "tip"])
        self.assertTrue(described.endswith("tip: hold lets go in none of 1,200 runs"), described)
        names = figure("[...svg.querySelectorAll('text > title')].map(e => [e.textContent, Number(e.parentNode.getAttribute('y'))])")
        wanted = [(hinge, [y for y, (at, _, _) in zip(middles, lanes) if at == hinge]) for hinge in ("mid", "root", "tip")]
        for (name, y), (hinge, own) in zip(names, wanted, strict=True):
            self.assertEqual(name, hinge)
            self.assertAlmostEqual(y, (own[0] + own[-1]) / 2)
        self.assertEqual(self.run_script("return document.querySelector('figure.sequence .caption').textContent"), "Releases and captures: cold")
        self.assertIn("Over 1,200 runs spread evenly", self.run_script("return document.querySelector('figure.sequence > .note').textContent"))
        self.assertFalse(self.all("figure.strips"))  # the time line says all that they would

    def test_the_table_has_every_release_and_each_case(self):
        sets = self.opened_sequence()
        caption = "Median time of each event, first and last"
        rows = self.table(caption)
        both = [("mid", "released"), ("mid", "latched"), ("root", "released"), ("root", "missed"), ("root", "latched"), ("root", "let_go"), ("tip", "released"), ("tip", "latched")]
        self.assertEqual([(row[0], row[1]) for row in rows], [(hinge, KINDS[kind] + (WORDS[hinge] if kind == "released" else "")) for hinge, kind in both])
        for row, (hinge, kind) in zip(rows, both):
            for cell, one in zip(row[2:], (each[hinge][kind] for each in sets), strict=True):
                often = f"{one['runs']} of 1,200 runs" + (f", {one['count']} times" if one["count"] > one["runs"] else "")
                self.assertTrue(cell.endswith(often), cell)
                times = cell.removesuffix(often)
                if not one["count"]:
                    self.assertEqual(times, "–")
                elif one["times"][0] == one["times"][6]:
                    self.assertEqual(times, f"{one['times'][0]:g} (always)")
                else:
                    self.check(times, one["times"][3], one["times"][0], one["times"][6], about=cell)
        heads = lambda: self.run_script("return [...[...document.querySelectorAll('table')].find(t => t.caption.textContent === arguments[0]).tHead.rows[0].cells].map(c => c.textContent)", caption)
        self.assertEqual(heads(), ["Hinge", "Event", "cold s", "hot s"])
        told = lambda hinge: next(row[1] for row in self.table(caption) if row[0] == hinge and row[1].startswith("hold"))
        for changed, words in (({"event": "released", "after": 2, "delay": 0}, "when the hold of tip lets go"), ({"event": "released", "after": 2, "delay": 0.125}, "0.125 s after the hold of tip lets go"),
                               ({"event": "time", "time": 2.5, "delay": 0.5}, "at 2.5 s, and 0.5 s"), ({"event": "latched", "after": 1, "delay": 0.2}, "0.2 s after mid latches"), ({"fails": 1}, "never"), ({"fails": 0}, "0.2 s after mid latches"),
                               ({"event": "passed", "after": 1, "angle": 0.5, "delay": 0}, "when mid has turned by 28.6479 deg")):
            self.run_script("W.sets.forEach(set => Object.assign(set.envelopes.sequence[0].release, arguments[0])); W.wing()", changed)
            self.assertEqual(told("root"), KINDS["released"] + words)
        self.angles("rad")
        self.assertEqual(told("root"), KINDS["released"] + "when mid has turned by 0.5 rad")
        dispersion = {"draw": "signal", "paths": ["hinges.mid.release.time"], "apply": "set", "law": "", "low": 0, "high": 1, "median": 1}
        for change, words in (({}, "at signal"), ({"apply": "add"}, "at 0.75 s"), ({"paths": ["hinges.root.release.time"]}, "at 0.75 s")):
            self.run_script("W.own = W.own ?? W.sets.map(set => [...set.inputs.dispersions]); W.sets.forEach((set, at) => set.inputs.dispersions = [...W.own[at], arguments[0]]); W.wing()", {**dispersion, **change})
            self.assertEqual(told("mid"), KINDS["released"] + words)
        self.run_script("W.sets.length = 1; W.wing()")
        self.assertEqual(heads(), ["Hinge", "Event", "Median s", "First … last s", "Runs"])
        own = [("mid", "released"), ("mid", "latched"), *[("root", kind) for kind in KINDS], ("tip", "released")]
        for row, (hinge, kind) in zip(self.table(caption), own, strict=True):
            one = sets[0][hinge][kind]
            self.assertTrue(row[1].startswith(KINDS[kind]) and row[0] == hinge, row)
            self.assertEqual(row[4], f"{one['runs']} of 1,200 runs" + (f", {one['count']} times" if one["count"] > one["runs"] else ""))
            if not one["count"] or one["times"][0] == one["times"][6]:
                self.assertEqual(row[2:4], ["0.75", "always"] if one["count"] else ["–", "–"])
            else:
                self.check(row[2], one["times"][3], about=row[1])
                self.check(row[3], one["times"][0], one["times"][6], about=row[1])

    def test_hinges_of_several_folders_are_found_by_name(self):
        """Sets with the same hinges stand side by side, in whatever order they list them; a set with others has its own table."""
        first, second = self.opened_sequence()
        caption = "Median time of each event, first and last"
        before = self.table(caption)
        self.run_script("""const [, other] = W.sets; other.wing.hinges.reverse(); other.envelopes.sequence.reverse();
            other.envelopes.sequence.forEach(one => one.release && one.release.after >= 0 && (one.release.after = 2 - one.release.after)); W.wing()""")
        self.assertEqual(self.table(caption), before)
        hold = lambda: next(row[1] for row in self.table(caption) if row[:1] == ["mid"] and row[1].startswith("hold"))
        self.run_script("W.sets[1].envelopes.sequence[1].release.time = 0.5; W.wing()")
        self.assertEqual(hold(), "hold lets gocold: at 0.75 shot: at 0.5 s")
        self.run_script("W.sets[1].envelopes.sequence[1].release = null; W.wing()")
        self.assertEqual(hold(), "hold lets gocold: at 0.75 shot: no hold")
        self.run_script("W.sets[1].wing.hinges[0].name = 'outer'; W.wing()")
        rows = self.table(caption)
        self.assertEqual((len(rows[0]), {row[0] for row in rows}), (5, {"root", "mid", "tip"}))  # of one set: median, range, runs
        self.run_script("W.choose('set', 1)")
        self.assertEqual({row[0] for row in self.table(caption)}, {"root", "mid", "outer"})

    def test_without_an_event_the_latch_times_are_strips(self):
        """Of a wing whose latches cannot miss and which has no hold."""
        self.opened_sequence()
        for given in ("null", "W.set().wing.hinges.map(() => ({ release: null, released: none, missed: none, latched: none, let_go: none }))"):
            self.run_script(f"const none = {{ runs: 0, count: 0, times: [] }}; W.set().envelopes.sequence = {given}; W.wing()")
            pages.settle(self.driver)
            self.assertEqual((len(self.all("figure.strips")), len(self.all("figure.sequence"))), (1, 0), given)
        self.assertFalse(parsed(self.one("figure.strips .caption").text))
