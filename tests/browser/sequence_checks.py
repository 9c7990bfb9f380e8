"""The sequence of releases and captures of a campaign of two cases, against the program's replays of all its runs."""

import json
import subprocess

import pages
from number_checks import DEGREES, parsed

RUNS = 24  # fewer than the page samples: its numbers are those of all runs
KINDS = {"released": ("releases", "hold lets go"), "missed": ("missed", "passes too fast for its latch"), "latched": ("latches", "latch engages"),
         "let_go": ("let_go", "latch lets go")}
WEAK = {"hinges.left_mid.latch.holding_moment": 60, "hinges.right_mid.latch.capture_rate": 1.15}  # lets go, misses


def folder():
    """Results of the wing with holds as it is, and with latches that let go and miss."""
    campaign = json.loads((pages.ROOT / "studies/campaigns/two_wing_release.json").read_text("utf-8"))
    campaign["scene"] = str(pages.ROOT / "studies/scenes/two_wing_release.json")
    campaign["cases"] = [{"name": "weak", "set": WEAK}, {"name": "sound"}]
    path = pages.SCRATCH / "release.json"
    path.write_text(json.dumps(campaign), "utf-8")
    return pages.made_of(path, RUNS, "release")


def replayed(case):
    """The outcome of each run of a case, by `replay`."""
    commands = [[pages.PROGRAM, "replay", folder() / case, "--run", str(run), "--json"] for run in range(RUNS)]
    return [json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout) for command in commands]


class SequenceChecks:
    def test_modes_say_how_far_they_are_enlarged(self):
        """The numbers below each mode, against the picture's own scale and the data."""
        self.open(pages.real("seed", 300))
        modes = self.run_script("return W.set().modes")
        found = self.run_script("""return [...document.querySelectorAll('figure.mode')].map(figure => {
            const points = group => [...group.querySelectorAll('path')].flatMap(path => [...path.getAttribute('d').matchAll(/(-?[\\d.]+)[, ](-?[\\d.]+)/g)].map(p => [Number(p[1]), Number(p[2])])),
                [rest, , end] = [...figure.querySelectorAll('g.pose')].map(points),
                bar = figure.querySelector('.bar-of-length'), width = bar.querySelector('path').getBBox().width, text = bar.querySelector('text').textContent;
            return { off: Math.max(...rest.map((p, k) => Math.hypot(p[0] - end[k][0], p[1] - end[k][1]))), width, text, note: figure.querySelector('.note').textContent }; })""")
        self.assertEqual(len(found), len(modes["modes"]))
        for one, mode in zip(found, modes["modes"], strict=True):
            (length, _), = parsed(one["text"])
            (metres, half), (degrees, rounding) = parsed(one["note"])
            self.assertAlmostEqual(metres, one["off"] * length / one["width"], delta=half + 0.02 * metres, msg=one["note"])
            self.assertLessEqual(metres, 0.07 * modes["wing"]["scale"] * 1.05 + half)  # linear to some %
            reach = self.run_script("""const [modes, mode, amplitude] = arguments, P = W.pose, points = size => P.outlines(modes.wing, P.frames(modes.wing,
                modes.rest.map((angle, at) => angle + size * mode.shape[at]))).flat(), [rest, off] = [points(0), points(amplitude)];
                return Math.max(...rest.map((p, at) => Math.hypot(p[0] - off[at][0], p[1] - off[at][1])))""", modes, mode, degrees / DEGREES / max(map(abs, mode["shape"])))
            self.assertAlmostEqual(reach / metres, 1, delta=rounding / degrees + half / metres + 0.01)

    def test_every_hinge_of_a_satellite_is_named(self):
        self.open(pages.real("satellite", 40))
        names, looks = self.run_script("""const items = [...document.querySelectorAll('figure.history .legend g')];
            return [items.map(one => one.textContent), items.map(one => one.querySelector('line').style.stroke + one.querySelector('line').getAttribute('stroke-dasharray'))]""")
        self.assertEqual(names, self.run_script("return W.set().wing.hinges.map(one => one.name)"))
        self.assertEqual(len(set(looks)), 8)

    def test_releases_and_captures_are_those_of_the_runs(self):
        self.open(pages.reported("release", folder()))
        sets = self.run_script("return W.data.sets")
        runs = {one["case"]: replayed(one["case"]) for one in sets}
        names = [one["name"] for one in sets[0]["wing"]["hinges"]]
        wanted = {}  # (case, hinge, kind): times, runs with the event
        for case, outcomes in runs.items():
            for hinge in names:
                for kind, (key, _) in KINDS.items():
                    times = [[event["time"] for event in outcome[key] if event["hinge"] == hinge] for outcome in outcomes]
                    wanted[case, hinge, kind] = sorted(sum(times, [])), sum(bool(each) for each in times)
        for kind in ("missed", "let_go"):
            self.assertGreater(sum(len(times) for (_, _, each), (times, _) in wanted.items() if each == kind), 0)
        for at, one in enumerate(sets):
            self.run_script("W.choose('set', arguments[0])", at)
            pages.settle(self.driver)
            self.time_line(one, {key[1:]: value for key, value in wanted.items() if key[0] == one["case"]})
            self.side_by_side(sets, wanted)
        self.motion_of(sets[0], runs["weak"])

    def time_line(self, one, wanted):
        """The picture: its exported numbers, and each median on the axis."""
        x, near = self.axis("sequence", "x")
        rows, medians = self.exported("sequence")[1:], []
        kind_of = {words: kind for kind, (_, words) in KINDS.items()}
        self.assertEqual(len(rows), sum(bool(times) for times, _ in wanted.values()))
        for hinge, words, count, events, *quantiles in rows:
            times, runs = wanted[hinge, kind_of[words]]
            self.assertEqual([int(float(count)), int(float(events))], [runs, len(times)], hinge)
            ranks = [max(1, -(-len(times) * p // 100)) for p in (0, 5, 25, 50, 75, 95, 100)]
            for got, rank in zip(quantiles, ranks, strict=True):
                self.assertAlmostEqual(float(got), times[rank - 1], delta=1e-5 * times[-1], msg=f"{hinge} {words}")
            medians.append(float(quantiles[3]))
        drawn = [x(place) for place, in self.attributes("figure.sequence line.middle", "x1")]
        for got, median in zip(drawn, medians, strict=True):
            self.assertLess(abs(got - median), 2 * near)
        told = self.run_script("return [...document.querySelectorAll('figure.sequence rect.span title')].map(title => title.textContent)")
        for title, (hinge, words, count, _, first, *_, last) in zip(told, (row for row in rows for _ in range(2)), strict=True):  # two bars each
            self.assertTrue(title.startswith(f"{hinge} {words} at "), title)
            got = parsed(title[len(f"{hinge} {words}"):])
            for (value, half), want in zip(got, (None, float(first), float(last), int(float(count)), RUNS), strict=True):
                self.assertTrue(want is None or abs(value - want) <= half + 1e-5 * want, title)
        self.assertEqual(rows, sorted(rows, key=lambda row: min(float(other[7]) for other in rows if other[0] == row[0])))  # in order of time

    def side_by_side(self, sets, wanted):
        """The table: median, first and last of each case."""
        kind_of = {words: kind for kind, (_, words) in KINDS.items()}
        for row in self.table("Median time of each event, first and last"):
            kind = next(kind for words, kind in kind_of.items() if row[1].startswith(words))
            for cell, one in zip(row[2:], sets, strict=True):
                times, runs = wanted[one["case"], row[0], kind]
                numbers = parsed(cell.replace("of", " of "))
                if not times:
                    self.assertEqual([value for value, _ in numbers], [0, RUNS], cell)
                    continue
                values = [times[-(-len(times) // 2) - 1], times[0], times[-1]] if times[-1] > times[0] else [times[0]]
                for (value, half), want in zip(numbers, values):
                    self.assertLessEqual(abs(value - want), half + 1e-5 * want, f"{row[0]}: {cell}")
                self.assertIn(f"{runs} of {RUNS} runs", cell)
        texts = {row[0]: row[1] for row in self.table("Median time of each event, first and last") if row[1].startswith("hold")}
        self.assertIn("at 0.5 s", texts["left_root"])
        self.assertIn("0.1 s after left_root has turned by 60 deg", texts["left_mid"])
        self.assertIn("0.2 s after left_mid latches", texts["left_tip"])

    def motion_of(self, one, outcomes):
        """The readout of a run whose latch lets go: held, released, latched, let go, latched again."""
        at = next(at for at, motion in enumerate(one["motions"]) if any(event["kind"] == "let_go" for event in motion["events"]) and motion["run"] is not None)
        self.run_script("W.choose('set', 0); W.choose('motion', arguments[0])", at)
        outcome = outcomes[one["motions"][at]["run"]]
        hinge = outcome["let_go"][0]["hinge"]
        released, latched, let_go = (next(event["time"] for event in outcome[key] if event["hinge"] == hinge) for key in ("releases", "latches", "let_go"))
        for time, words in ((released / 2, "held"), ((released + latched) / 2, f"released at {released:.3f} s"), ((latched + let_go) / 2, f"latched at {latched:.3f} s"),
                            (let_go + 1e-3, f"latch let go at {let_go:.3f} s")):
            self.run_script("W.player.seek(arguments[0])", time)
            self.assertIn([hinge, words], [[row[0], row[4]] for row in self.table("Hinges at the cursor's time")], time)
