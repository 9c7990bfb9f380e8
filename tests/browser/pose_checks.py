"""The wing's pose, its motion between samples and its drawing, against the mechanics that DATA.md states, computed here anew."""

import bisect
import cmath
import random
import re

import pages
from mark_checks import pairs
from number_checks import DEGREES, parsed


def corners(wing, angles, base):
    """The corners of every body's outline as complex numbers: θ = θ_parent + φ, o = o_parent + R(θ_parent) joint − R(θ) inner."""
    root, frames, found = (complex(base["x"], base["y"]), base["angle"]), {}, []
    for body in wing["bodies"]:
        origin, angle = root
        if body["hinge"] >= 0:
            origin, angle = frames.get(wing["hinges"][body["hinge"]]["parent"], root)
            origin += cmath.rect(1, angle) * complex(*body["joint_in_parent"])
            angle += angles[body["hinge"]]
            origin -= cmath.rect(1, angle) * complex(*body["inner"])
            frames[body["hinge"]] = origin, angle
        found.append([origin + cmath.rect(1, angle) * complex(*point) for point in body["outline"]])
    return found


class PoseChecks:
    """For a Page with MarkChecks."""

    def test_poses_of_a_tree_on_a_moving_base(self):
        self.open(pages.made_up("single"))
        rng = random.Random(5)
        point = lambda: [rng.uniform(-1, 1), rng.uniform(-1, 1)]
        wing = {"hinges": [{"parent": parent} for parent in (-1, 0, 0, 2, -1)], "base": {"angle": 0.3},
                "bodies": [{"hinge": hinge, "outline": [point() for _ in range(4)], "inner": point(), "joint_in_parent": point()} for hinge in range(-1, 5)]}
        for base in ({"x": 0.4, "y": -2.0, "angle": 1.1}, None):
            angles = [rng.uniform(-3, 3) for _ in range(5)]
            got = self.run_script("return W.pose.outlines(arguments[0], W.pose.frames(arguments[0], arguments[1], arguments[2]))", wing, angles, base)
            for one, want in zip(got, corners(wing, angles, base or {"x": 0, "y": 0, "angle": 0.3}), strict=True):
                self.near(one, [(each.real, each.imag) for each in want], "corners", 1e-12)

    def test_motion_between_samples(self):
        """A cubic angle is itself between samples, a straight rate and base too; before and after the run nothing moves."""
        self.open(pages.made_up("single"))
        t = [0, 0.5, 0.7, 2, 2.25]
        cubic, slope, line = lambda x: 1 - 2 * x + 0.5 * x**2 + 0.3 * x**3, lambda x: -2 + x + 0.9 * x**2, lambda x: 3 - 0.25 * x
        motion = {"t": t, "angles": [[cubic(x) for x in t]], "rates": [[slope(x) for x in t]], "moments": [[line(x) for x in t]],
                  "base": {"x": [line(x) for x in t], "y": [2 * line(x) for x in t], "angle": [-line(x) for x in t]}}
        for time in (-1, 0, 0.1, 0.5, 0.61, 1.3, 1.999, 2.2, 2.25, 9):
            now, at = self.run_script("return W.pose.at(arguments[0], arguments[1])", motion, time), min(2.25, max(0, time))
            low = min(3, bisect.bisect_right(t, at) - 1)
            share = (at - t[low]) / (t[low + 1] - t[low])
            wanted = [cubic(at), slope(t[low]) * (1 - share) + slope(t[low + 1]) * share, line(at), line(at), 2 * line(at), -line(at)]
            for got, want in zip([now["angles"][0], now["rates"][0], now["moments"][0], *(now["base"][key] for key in ("x", "y", "angle"))], wanted, strict=True):
                self.assertAlmostEqual(got, want, places=12, msg=str(time))

    def test_samples_that_are_unknown_are_not_invented(self):
        """Between a known and an unknown sample nothing is drawn but the earlier one; without samples there is none."""
        self.open(pages.made_up("single"))
        row = [4, 5, None, 8]
        at = lambda time, **more: self.run_script("return W.pose.at(arguments[0], arguments[1])", {"t": [0, 1, 2, 3], "angles": [row], **more}, time)
        for time, want in ((0, 4), (0.5, 4.5), (1.25, 5), (2.5, None), (3, None)):
            self.assertEqual(at(time)["angles"], [want], time)
            self.assertEqual(at(time, rates=[None])["angles"], [want], time)
            got = at(time, rates=[row], moments=[row, None], base={"x": row, "y": None, "angle": [0, 0, 0, 0]})
            self.assertEqual((got["rates"], got["moments"], got["base"]), ([want], [want, None], {"x": want, "y": None, "angle": 0}), time)
        self.assertEqual(at(1.25, rates=[row])["angles"], [5])  # a cubic needs all four
        self.assertEqual((at(1)["rates"], at(1)["moments"], at(1)["base"]), ([], [], None))

    def drawn(self, figure, bodies):
        """Poses of a figure in metres, up to a shift: its bodies' corners by its bar of length."""
        svg = self.run_script("""const svg = document.querySelector(`figure.${arguments[0]} svg`), bar = svg.querySelector('.bar-of-length');
            return [bar.querySelector('text').textContent, bar.querySelector('path').getAttribute('d'), [...svg.querySelectorAll('.pose path')].map(e => e.getAttribute('d'))]""", figure)
        pixels = float(re.search(r"H([\d.]+)", svg[1])[1]) / parsed(svg[0])[0][0]
        self.assertLessEqual(40, pixels * parsed(svg[0])[0][0])
        points = [[complex(x, -y) / pixels for x, y in pairs(path.replace("L", " "))[0]] for path in svg[2]]
        return [points[at:at + bodies] for at in range(0, len(points), bodies)], 0.03 / pixels

    def test_drawings_are_to_scale(self):
        self.open(pages.made_up("plain"))
        wing, motion = self.run_script("return [W.set().wing, W.set().motions[0]]")
        still, end = {"x": 0, "y": 0, "angle": 0}, max(one["time"] for one in motion["latches"])
        at = lambda time: self.run_script("return W.pose.at(W.set().motions[0], arguments[0]).angles", time)
        self.run_script("W.player.seek(1.7)")
        wanted = {"stage": [at(1.7)], "strobe": [at(end * k / 8) for k in range(9)], "still": [[hinge["stowed"] for hinge in wing["hinges"]]]}
        for figure, poses in wanted.items():
            got, near = self.drawn(figure, len(wing["bodies"]))
            self.assertEqual(len(got), len(poses), figure)
            first = got[0][0][0] - corners(wing, poses[0], still)[0][0]
            for one, angles in zip(got, poses):
                for body, want in zip(one, corners(wing, angles, still), strict=True):
                    self.assertTrue(all(abs(a - first - b) < near for a, b in zip(body, want, strict=True)), figure)
        self.same_rows("strobe", [[end * k / 8, *(angle * DEGREES for angle in at(end * k / 8))] for k in range(9)])
        note = self.run_script("return document.querySelector('figure.strobe > .note').textContent")
        self.check(note, end / 8, 0, end, about=note)

    def test_the_player_and_its_clock(self):
        self.open(pages.made_up("plain"))
        motion, names = self.run_script("return [W.set().motions[0], W.set().wing.hinges.map(hinge => hinge.name)]")
        described = self.run_script("return document.querySelector('figure.stage desc').textContent")
        self.assertTrue(motion["why"])
        for words in (motion["label"], motion["why"]):
            self.assertIn(words, described)
        end, latches = motion["t"][-1], sorted((one["time"], names[one["hinge"]]) for one in motion["latches"])
        seek = lambda time: self.run_script("W.player.seek(arguments[0]); return [W.player.time, document.querySelector('output.time').textContent, document.querySelector('.stage .clock').textContent]", time)
        for time in (-3, 0, 1.23456, end, 99):
            now, clock, small = seek(time)
            self.assertEqual(now, max(0, min(end, time)))
            self.check(clock.replace("of", ";"), round(now, 3), round(end, 2), about=clock)
            self.check(small, round(now, 3), about=small)
        player = self.one(".player")
        self.run_script("W.player.seek(1); arguments[0].focus()", player)
        for key, want in (("ArrowRight", 1 + end / 200), ("ArrowLeft", 1), ("End", end), ("Home", 0)):
            self.run_script("arguments[0].dispatchEvent(new KeyboardEvent('keydown', { key: arguments[1], bubbles: true }))", player, key)
            self.assertAlmostEqual(self.run_script("return W.player.time"), want, places=12, msg=key)
        values = self.run_script("return [...[...document.querySelectorAll('.player select')].pop().options].map(one => [Number(one.value), one.textContent])")
        wanted = [[0, "start"], *([time, f"{name} latches"] for time, name in latches),
                  *([one["time"], f"peak moment of {names[one['hinge']]}"] for one in motion["peaks"]), [end, "end"]]
        self.assertEqual(values, wanted)
        for time in (latches[0][0] - 1e-6, latches[0][0], latches[1][0], end):
            seek(time)
            done = [one["time"] <= time for one in motion["latches"]]
            order = [one["hinge"] for one in motion["latches"]]
            states = [row[4] for row in self.table("Hinges at the cursor's time")]
            rings = self.run_script("return [...document.querySelectorAll('.stage .hinge')].map(one => one.classList.contains('latched'))")
            for hinge, latched in zip(order, done):
                self.assertEqual(("latched" in states[hinge], rings[hinge]), (latched, latched), names[hinge])
                if latched:
                    self.check(states[hinge], round(motion["latches"][order.index(hinge)]["time"], 3), about=states[hinge])
        self.run_script("[...document.querySelectorAll('.player button')].find(one => one.textContent === 'while latching').click()")
        pages.settle(self.driver)
        first, last = latches[0][0], latches[-1][0]
        room = max(0.06 * last, 0.25 * (last - first))
        x = self.scale("history", "x")
        box = self.run_script("const box = document.querySelector('figure.history .axis.x .domain').getBBox(); return [box.x, box.x + box.width]")
        self.near([box], [(x(max(0, first - room)), x(min(end, last + 5 * room)))], "while latching")

    def test_of_many_hinges_those_with_the_largest_peaks_are_named(self):
        self.open(pages.made_up("forty"))
        count = self.run_script("return W.set().wing.hinges.length")
        for peaks in (random.Random(1).sample(range(1, 10 * count), count), list(range(1, count + 1)), list(range(count, 0, -1)), [5] * (count - 13) + [9] * 13):
            self.run_script("W.set().motions.forEach(motion => motion.moments = arguments[0].map((peak, at) => motion.t.map((_, k) => (at % 2 ? -1 : 1) * peak * (k % 7) / 6))); W.wing()", peaks)
            pages.settle(self.driver)
            names, strokes = self.run_script("""const figure = document.querySelector('figure.history');
                return [[...figure.querySelectorAll('.legend g')].map(one => one.textContent), [...figure.querySelectorAll('.trace')].map(one => [one.querySelector('title').textContent, one.style.stroke])]""")
            largest = sorted(sorted(range(count), key=lambda at: -peaks[at])[:13])
            self.assertEqual(names, [*(f"h{at + 1}" for at in largest), f"{count - 13} others"])
            self.assertEqual({name for name, stroke in strokes if stroke != "var(--none)"}, set(names[:-1]))
