"""The Python module's fit against the program's, and against a closed form. Started as python_test.py is."""

import json
import pathlib
import tempfile
import unittest

import numpy as np

import wingspread
from support import program


class Fitting(unittest.TestCase):
    """One panel whose constant torque follows from its latch time: T = 2 θ J / t²."""

    torque, travel, inertia, seen, std = 2.0, 1.5, 3.0, 2.2, 0.02

    def campaign(self):
        hinge = {"name": "root", "parent": "base", "child": "panel", "parent_point": [0, 0], "child_point": [-0.5, 0],
                 "angle": {"stowed": self.travel, "latched": 0}, "latch": {"stiffness": 1e4, "damping": 100},
                 "spring": {"torque_stowed": self.torque, "torque_latched": self.torque}}
        panel = {"name": "panel", "mass": 10, "inertia": self.inertia - 10 * 0.5**2}
        return {"scene": {"name": "panel", "base": {"motion": "fixed"}, "bodies": [panel], "hinges": [hinge]},
                "dispersions": [{"name": "spring", "distribution": {"type": "normal", "mean": 1, "std": 0.2, "truncate": {"lower": 0.1}}, "apply": "scale",
                                 "to": ["hinges.root.spring.scale"]}],
                "integration": {"t_end": 20}, "outputs": ["latch_time"], "sampling": {"runs": 10, "seed": 5}}

    def ground(self):
        value = {"output": "root.latch_time", "value": self.seen, "std": self.std}
        return {"tests": [{"name": "ground", "values": [value]}], "fit": {"parameters": ["spring"], "samples": 1000}}

    def test_a_fit_is_the_programs_and_finds_the_torque(self):
        with tempfile.TemporaryDirectory() as folder:
            places = {name: pathlib.Path(folder) / f"{name}.json" for name in ("campaign", "tests")}
            places["campaign"].write_text(json.dumps(self.campaign()), encoding="utf-8")
            places["tests"].write_text(json.dumps(self.ground()), encoding="utf-8")
            done = program("fit", places["campaign"], places["tests"], "--out", pathlib.Path(folder) / "by_program")
            self.assertEqual(done.returncode, 0, done.stderr)
            result, posterior = wingspread.fit(self.campaign(), self.ground(), out=pathlib.Path(folder) / "by_module")
            rows = [(pathlib.Path(folder) / out / "posterior.csv").read_bytes() for out in ("by_program", "by_module")]
            self.assertEqual(rows[0], rows[1])
        self.assertTrue(result["finished"])
        spring = result["parameters"]["spring"]
        scale = 2 * self.travel * self.inertia / self.seen**2 / self.torque
        self.assertAlmostEqual(spring["mean"], scale, delta=0.005)
        self.assertAlmostEqual(spring["std"], 2 * scale * self.std / self.seen, delta=0.002)
        self.assertAlmostEqual(float(np.mean(posterior["spring"])), spring["mean"], delta=0.003)

    def test_a_fit_that_is_cut_off_says_so_whatever_else_it_finds(self):
        """Two measurements that contradict each other are found first; the Notice is of the chains that are too short."""
        tests = self.ground()
        tests["tests"].append({"name": "again", "values": [{"output": "root.latch_time", "value": 1.4 * self.seen, "std": self.std}]})
        tests["fit"]["samples"] = 100000
        with self.assertWarns(wingspread.Notice) as caught:
            result, _ = wingspread.fit(self.campaign(), tests, runs=3000)
        self.assertFalse(result["finished"])
        self.assertGreater(len(set(result["findings"])), 1)
        self.assertIn(str(caught.warning), result["findings"])
        self.assertIn(f"not finished: effective sample size {result['sampler']['ess']:.0f} of 100000", str(caught.warning))

    def test_a_fit_warns_of_a_doubtful_campaign_as_the_program_does(self):
        campaign = self.campaign() | {"outputs": ["latch_time", "rate_at"]}
        with self.assertWarnsRegex(wingspread.Notice, "/outputs: found \"rate_at\""):
            wingspread.fit(campaign, self.ground())
        with self.assertRaisesRegex(wingspread.SpecError, "--resume: found True, expected out"):
            wingspread.fit(self.campaign(), self.ground(), resume=True)

    def test_a_fit_that_is_cut_off_goes_on_in_its_folder(self):
        """To the same bytes as one made at once; the finished folder is read."""
        tests = self.ground()
        tests["fit"]["samples"] = 4000
        with tempfile.TemporaryDirectory() as folder:
            cut, whole = pathlib.Path(folder) / "cut", pathlib.Path(folder) / "whole"
            with self.assertWarns(wingspread.Notice):
                first, _ = wingspread.fit(self.campaign(), tests, out=cut, runs=3000)
            self.assertFalse(first["finished"])
            with self.assertRaisesRegex(wingspread.SpecError, "resume"):
                wingspread.fit(self.campaign(), tests, out=cut)
            wingspread.fit(self.campaign(), tests, out=whole)
            made = wingspread.fit(self.campaign(), tests, out=cut, resume=True)
            read = wingspread.fit(self.campaign(), tests, out=cut, resume=True)
            for name in ("fit.json", "posterior.csv"):
                self.assertEqual((cut / name).read_bytes(), (whole / name).read_bytes(), name)
        for result, posterior in (made, read):
            self.assertTrue(result["finished"])
            self.assertEqual(list(posterior), ["spring"])
            np.testing.assert_array_equal(posterior["spring"], made.posterior["spring"])
        self.assertEqual(made.result, read.result)

    def test_faults_of_tests_have_their_place(self):
        tests = self.ground()
        tests["fit"]["parameters"] = ["sprung"]
        with self.assertRaises(wingspread.SpecError) as caught:
            wingspread.fit(self.campaign(), tests)
        self.assertIn("/fit/parameters/0", str(caught.exception))


if __name__ == "__main__":
    unittest.main()
