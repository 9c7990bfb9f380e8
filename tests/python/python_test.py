"""The Python module against the program: the same numbers to the last bit, and the same errors.

    WINGSPREAD_PROGRAM=build/release/wingspread PYTHONPATH=build/release/python /usr/bin/python3 tests/python/python_test.py
"""

import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import warnings

import numpy as np

import wingspread
from support import CAMPAIGN, ROOT, SCENE, STALL, program


def scene():
    return json.loads(SCENE.read_text(encoding="utf-8"))


def small(**parts):
    """A campaign as a dictionary: 20 runs that end at the last latch."""
    return {"scene": scene(),
            "dispersions": [{"name": "spring", "distribution": {"type": "normal", "mean": 1, "std": 0.05},
                             "apply": "scale", "to": ["hinges.*.spring.scale"]}],
            "sampling": {"runs": 20, "seed": 5}, "outputs": ["latch_time"], **parts}


class InFolder(unittest.TestCase):
    def setUp(self):
        self.held = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.held.name)

    def tearDown(self):
        self.held.cleanup()

    def same(self, a, b):
        np.testing.assert_array_equal(np.asarray(a), np.asarray(b))  # NaN equals NaN, all else to the bit


class Runs(InFolder):
    def rows(self, campaign, *options):
        done = program("run", campaign, "--out", self.folder / "rows", *options)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        with open(self.folder / "rows/runs.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_every_column_is_that_of_the_program(self):
        for campaign in (CAMPAIGN, STALL):
            rows = self.rows(campaign, "--runs", 96, "--seed", 9)
            for threads in (1, 2):
                table = wingspread.run(campaign, runs=96, seed=9, threads=threads)
                self.assertEqual(list(table), list(rows[0]))
                self.assertEqual((len(table), table.size), (len(rows[0]), 96))
                for name in table:
                    cells = [row[name] for row in rows]
                    if name in table.draws + table.outputs:
                        self.same(table[name], [float(cell) if cell else np.nan for cell in cells])
                    elif name == "run":
                        self.same(table[name], np.arange(96))
                    elif name == "peaks_final":
                        self.assertEqual([{"": None, "true": True, "false": False}[cell] for cell in cells],
                                         list(table[name]))
                    else:
                        self.assertEqual(cells, list(table[name]))
            read = wingspread.read(self.folder / "rows")
            for name in read:
                self.assertTrue(all(a == b or (a != a and b != b) for a, b in zip(read[name], table[name])), name)
            self.assertEqual(read.campaign, json.loads((self.folder / "rows/campaign.json").read_text()))
            self.assertEqual(read.campaign, table.campaign)
            shutil.rmtree(self.folder / "rows")

    def test_a_campaign_is_a_path_or_text_or_a_dictionary(self):
        file = self.folder / "campaign.json"
        file.write_text(json.dumps(small()))
        times = [wingspread.run(given)["root.latch_time"]
                 for given in (file, str(file), json.dumps(small()), small())]
        for other in times[1:]:
            self.same(times[0], other)
        arrays = small(statistics={"quantiles": np.array([0.1, 0.5])}, sampling={"runs": np.int64(20), "seed": 5})
        self.same(times[0], wingspread.run(arrays)["root.latch_time"])
        with self.assertRaisesRegex(TypeError, "found int, expected a path, JSON text or a dictionary"):
            wingspread.run(3)

    def test_columns_are_views_that_outlive_the_table(self):
        table = wingspread.run(small())
        once, again = table["root.latch_time"], table["root.latch_time"]
        self.assertTrue(np.shares_memory(once, again))
        self.assertFalse(once.flags.writeable)
        codes, texts = table.codes("latch_order")
        self.assertEqual(codes.dtype, np.uint32)
        self.assertFalse(codes.flags.owndata)
        self.assertEqual([texts[code] for code in codes], list(table["latch_order"]))
        copied = once.copy()
        del table, again, codes
        _ = [bytearray(1 << 16) for _ in range(100)]
        self.same(once, copied)

    def test_a_table_is_a_mapping(self):
        table = wingspread.run(small(), runs=7, seed=1)
        self.assertIn("deployment_time", table)
        self.assertEqual(table.draws, ["spring"])
        self.assertEqual(table.numbers(["spring", "deployment_time"]).shape, (7, 2))
        self.assertTrue(table.is_complete)
        self.assertTrue(repr(table).startswith("<wingspread.Table of 7 runs: run, status, spring, root.latch_time"))
        with self.assertRaises(KeyError):
            table["no_such"]
        try:
            import pandas
        except ImportError:
            return
        frame = pandas.DataFrame(dict(table))
        self.assertEqual(frame.shape, (7, len(table)))
        self.assertEqual(frame["spring"].mean(), table["spring"].mean())

    def test_of_cases_the_one_that_is_named(self):
        campaign = small(cases=[{"name": "hot", "scale": {"hinges.*.spring.scale": 1.3}}, {"name": "nominal"}])
        hot, nominal = (wingspread.run(campaign, case=name)["deployment_time"] for name in ("hot", "nominal"))
        self.assertTrue((hot < nominal).all())
        self.same(nominal, wingspread.run(small())["deployment_time"])
        with self.assertRaisesRegex(wingspread.SpecError, "hot"):
            wingspread.run(campaign)

    def test_changes_of_the_nominal_wing(self):
        changed = wingspread.run(small(), set={"hinges.root.spring.scale": 0.5, "hinges.mid.angle.stowed": "170 deg"})
        other = small()
        other["scene"]["hinges"][0]["spring"]["scale"] = 0.5
        other["scene"]["hinges"][1]["angle"]["stowed"] = "170 deg"
        self.same(changed["deployment_time"], wingspread.run(other)["deployment_time"])


class Deployments(InFolder):
    def test_outcome_and_trajectory_are_those_of_simulate(self):
        path = self.folder / "trajectory.csv"
        said = program("simulate", SCENE, "--json", "--out", path, "--dt", "0.25", "--t-end", "9", "--rtol", "1e-7",
                       "--set", "hinges.root.spring.scale=0.9", "--method", "dopri5")
        outcome, trajectory = wingspread.simulate(SCENE, dt=0.25, t_end=9, rtol=1e-7, method="dopri5",
                                                  set={"hinges.root.spring.scale": 0.9})
        self.assertEqual(outcome, json.loads(said.stdout))
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(list(trajectory), list(rows[0]))
        for name, values in trajectory.items():
            self.same(values, [float(row[name]) for row in rows])

    def test_every_setting_by_itself_is_that_of_simulate(self):
        settings = [{"rtol": 1e-5}, {"atol": 1e-4}, {"rtol": 1e-6, "atol": 1e-8}, {"t_end": 6.5}, {"method": "dop853"}, {"latch": "smoothed:1e-3"},
                    {"method": "runge_kutta4", "step": 0.0078125}, {"set": {"hinges.root.spring.scale": 0.9123456789012345}}]
        default = wingspread.simulate(SCENE).outcome
        for setting in settings:
            options = [word for name, value in setting.items() for word in
                       (["--set", *(f"{path}={number!r}" for path, number in value.items())] if name == "set" else ["--" + name.replace("_", "-"), str(value)])]
            with self.subTest(str(setting)):
                outcome = wingspread.simulate(SCENE, **setting).outcome
                self.assertEqual(outcome, json.loads(program("simulate", SCENE, "--json", *options).stdout))
                self.assertNotEqual(outcome, default)

    def test_a_scene_may_be_a_path_or_text_or_a_dictionary(self):
        text = pathlib.Path(SCENE).read_text(encoding="utf-8")
        expected = wingspread.simulate(SCENE, t_end=2).outcome
        for source in (str(SCENE), pathlib.Path(SCENE), text, "\n \t" + text, json.loads(text)):
            self.assertEqual(wingspread.simulate(source, t_end=2).outcome, expected)

    def test_a_check_is_that_of_simulate(self):
        said = json.loads(program("simulate", SCENE, "--json", "--t-end", "9", "--check").stdout)
        outcome, _ = wingspread.simulate(SCENE, t_end=9, check=True)
        self.assertEqual(outcome["check"], said["check"])
        self.assertGreaterEqual(min(one["digits"] for one in outcome["check"]["outputs"]), 6)

    def test_a_row_of_evaluate_is_a_deployment(self):
        paths = ["hinges.*.spring.scale", "bodies.panel_1.mass"]
        x = np.array([[1, 10], [1.2, 10], [0.9, 12.5], [1, -1], [np.nan, 10]])
        y = wingspread.evaluate(SCENE, paths, x, ["deployment_time", "root.peak_moment"], t_end=20)
        self.assertEqual(y.shape, (5, 2))
        for row, numbers in zip(x[:3], y):
            outcome = wingspread.simulate(SCENE, set={"hinges.*.spring.scale": row[0], "bodies.panel_1.mass": row[1]},
                                          t_end=20).outcome
            self.assertEqual(numbers[0], outcome["latches"][-1]["time"])
            self.assertEqual(numbers[1], outcome["peak_moment"]["root"]["value"])
        self.assertTrue(np.isnan(y[3:]).all())  # no body has such a mass
        model = wingspread.Model(SCENE, paths, ["deployment_time", "root.peak_moment"], t_end=20)
        self.same(model.nominal, [1, 10])
        self.same(model(np.asfortranarray(x), threads=1), y)
        self.same(model(x[1:2].astype(np.float32).tolist()), model(x[1:2].astype(np.float32)))
        self.assertEqual(model(np.empty((0, 2))).shape, (0, 2))
        many = np.tile(x[:3], (200, 1))  # in a thread of its own
        self.same(model(many), np.tile(y[:3], (200, 1)))
        for shape in ((2,), (1, 3)):
            with self.assertRaisesRegex(ValueError, r"found x of shape .*, expected \(n, 2\)"):
                model(np.zeros(shape))
        self.assertEqual(len(wingspread.Model(SCENE, paths).outputs), 16)

    def test_every_setting_of_evaluate_and_of_a_model_is_that_of_simulate(self):
        campaign = small(cases=[{"name": name, "scale": {"hinges.*.spring.scale": by}} for name, by in (("cold", 0.9), ("hot", 1.2))])
        paths, x, outputs = ["bodies.panel_1.mass"], [[10]], ["root.peak_moment", "root.latch_time"]
        settings = [{}, {"case": "hot"}, {"rtol": 1e-5}, {"atol": 1e-4}, {"t_end": 4}, {"method": "dop853"}, {"latch": "smoothed:1e-3"},
                    *({"method": "runge_kutta4", "step": step, "rtol": 1e-4} for step in (1e-3, 5e-4)), {"set": {"hinges.root.spring.scale": 0.95}}]
        seen = set()
        for setting in settings:
            with self.subTest(str(setting)):
                whole = {"case": "cold", **setting}
                outcome = wingspread.simulate(campaign, **whole).outcome
                times = [one["time"] for one in outcome["latches"] if one["hinge"] == "root"]
                expected = [[outcome["peak_moment"]["root"]["value"], *(times or [np.nan])]]
                self.same(wingspread.evaluate(campaign, paths, x, outputs, **whole), expected)
                self.same(wingspread.Model(campaign, paths, outputs, **whole)(x), expected)
                seen.add(str(expected))
        self.assertEqual(len(seen), len(settings))

    def test_scipy_finds_the_springs_that_deploy_in_four_fifths_of_the_time(self):
        from scipy import optimize
        model = wingspread.Model(SCENE, ["hinges.*.spring.scale"], ["deployment_time"])
        nominal = model([[1.0]])[0, 0]
        scale = optimize.brentq(lambda s: model([[s]])[0, 0] - 0.8 * nominal, 1, 3, xtol=1e-12)
        self.assertAlmostEqual(model([[scale]])[0, 0], 0.8 * nominal, delta=1e-8)
        # without friction and from rest times go with the root of the torques, but for the latches' ringing
        self.assertAlmostEqual(scale, 1 / 0.8**2, delta=0.08)

    def test_openturns_drives_it_to_the_programs_sobol_indices(self):
        try:
            import openturns
        except ImportError:
            self.skipTest("python3-openturns is not installed")
        names, samples = ["root", "mid", "tip"], 1000
        law = {"type": "normal", "mean": 1, "std": 0.05}
        file = self.folder / "campaign.json"
        file.write_text(json.dumps(small(dispersions=[{"name": name, "distribution": law, "apply": "scale",
                                                       "to": [f"hinges.{name}.spring.scale"]} for name in names])))
        answer = program("sensitivity", file, "--samples", samples, "--confidence", 0.99, "--json")
        ours = json.loads(answer.stdout)["outputs"]["mid.latch_time"]["dispersions"]

        model = wingspread.Model(SCENE, [f"hinges.{name}.spring.scale" for name in names], ["mid.latch_time"])
        openturns.RandomGenerator.SetSeed(1)
        springs = openturns.ComposedDistribution([openturns.Normal(1, 0.05)] * 3)
        x = openturns.SobolIndicesExperiment(springs, samples, False).generate()
        y = openturns.PythonFunction(3, 1, func_sample=model)(x)
        self.same(y, model(np.asarray(x)))
        found = openturns.JansenSensitivityAlgorithm(x, y, samples)
        found.setConfidenceLevel(0.99)
        interval = found.getTotalOrderIndicesInterval()
        for name, lower, upper in zip(names, interval.getLowerBound(), interval.getUpperBound()):
            # of runs of their own, each with 99 % of its own: that the two miss each other is as unlikely
            self.assertLess(max(lower, ours[name]["total"]["lower"]), min(upper, ours[name]["total"]["upper"]), name)
            self.assertLess(upper - lower, 0.35)


class Errors(InFolder):
    def texts(self, *words):
        done = program(*words)
        self.assertIn(done.returncode, (2, 4))
        return "\n".join(line[len("error: "):] for line in done.stderr.splitlines())

    def test_bad_input_has_the_programs_text_and_every_problem(self):
        broken = scene()
        broken["bodies"][0]["mass"] = "heavy"
        broken["hinges"][1]["sprng"] = 3
        file = self.folder / "broken.json"
        file.write_text(json.dumps(broken))
        with self.assertRaises(ValueError) as raised:
            wingspread.simulate(file)
        self.assertIsInstance(raised.exception, wingspread.SpecError)
        self.assertEqual(str(raised.exception), self.texts("simulate", file))
        self.assertEqual([problem[1] for problem in raised.exception.problems],
                         ["/bodies/0/mass", "/hinges/1/sprng"])
        with self.assertRaises(wingspread.SpecError) as raised:
            wingspread.run(self.folder / "none.json")
        self.assertEqual(str(raised.exception), self.texts("run", self.folder / "none.json", "--out", self.folder / "o"))
        with self.assertRaises(wingspread.SpecError) as raised:
            wingspread.simulate(SCENE, set={"hinges.rot.spring.scale": 2})
        self.assertEqual(str(raised.exception), self.texts("simulate", SCENE, "--set", "hinges.rot.spring.scale=2.0"))
        with self.assertRaisesRegex(wingspread.SpecError, "--threads: found -2"):
            wingspread.run(small(), threads=-2)
        whole = "a whole number from "
        for make, option, found, expected in [
                (lambda: wingspread.run(small(), seed=-1), "--seed", "-1", whole + "0 to 18446744073709551615"),
                (lambda: wingspread.run(small(), runs=2.5), "--runs", "2.5", whole + "1 to 2147483647"),
                (lambda: wingspread.run(small(), runs="2"), "--runs", "'2'", whole + "1 to 2147483647"),
                (lambda: wingspread.run(small(), runs=True), "--runs", "True", whole + "1 to 2147483647"),
                (lambda: wingspread.fit(small(), small(), runs=-1), "--runs", "-1", whole + "0 to 2147483647"),
                (lambda: wingspread.evaluate(SCENE, ["hinges.*.spring.scale"], [[1]], threads=1.5), "--threads", "1.5",
                 whole + "0 to 1024"),
                (lambda: wingspread.run(small(), threads=None), "--threads", "None", whole + "0 to 1024"),
                (lambda: wingspread.fit(small(), small(), runs=None), "--runs", "None", whole + "0 to 2147483647"),
                (lambda: wingspread.fit(small(), small(), resume=1), "--resume", "1", "True or False"),
                (lambda: wingspread.evaluate(SCENE, ["hinges.*.spring.scale"], [[1j]]), "--x", "dtype('complex128')",
                 "real numbers"),
                (lambda: wingspread.evaluate(SCENE, ["hinges.*.spring.scale"], [[np.datetime64("2026-01-01")]]), "--x",
                 "dtype('<M8[D]')", "real numbers"),
                (lambda: wingspread.simulate(SCENE, dt=0), "--dt", "0", "a number, s, > 0"),
                (lambda: wingspread.simulate(SCENE, t_end="5 s"), "--t-end", "'5 s'", "a number, in SI units")]:
            with self.assertRaises(wingspread.SpecError) as raised:
                make()
            self.assertEqual(str(raised.exception), f"{option}: found {found}, expected {expected}")
            self.assertEqual(raised.exception.problems, [("", option, found, expected)])
        self.assertEqual(wingspread.run(small(), runs=np.int64(2), seed=np.uint64(2**64 - 1)).size, 2)
        with self.assertRaisesRegex(wingspread.SpecError, r"paths\[0\].*did you mean .hinges.root"):
            wingspread.Model(SCENE, ["hinges.rooot.spring.scale"])

    def test_what_the_machine_refuses_is_an_os_error(self):
        script = ("import wingspread, sys\n"
                  "try: wingspread.run(sys.argv[1], runs=40000)\n"
                  "except OSError as error: print(type(error) is wingspread.MachineError, error)")
        file = self.folder / "campaign.json"
        campaign = small(dispersions=[], outputs=["latch_time"])
        campaign["scene"] = json.loads((ROOT / "studies/scenes/three_panel.json").read_text())
        campaign["scene"]["bodies"] = campaign["scene"]["bodies"][:1]
        campaign["scene"]["hinges"] = campaign["scene"]["hinges"][:1]
        file.write_text(json.dumps(campaign))
        done = subprocess.run([sys.executable, "-c", script, file], capture_output=True, text=True, check=True,
                              env={**os.environ, "TMPDIR": str(self.folder / "no")})
        self.assertEqual(done.stdout.strip(), f"True {self.folder / 'no'}: found No such file or directory, expected room "
                                              "for temporary data (TMPDIR names another folder)")

    def test_what_looks_wrong_is_warned_of_with_the_programs_text(self):
        heavy = small()
        heavy["scene"]["bodies"][0]["mass"] = 40000
        file = self.folder / "heavy.json"
        file.write_text(json.dumps(heavy))
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            wingspread.run(file, runs=2)
        said = program("run", file, "--out", self.folder / "out", "--runs", "2").stderr.splitlines()
        self.assertEqual([str(warning.message) for warning in caught],
                         [line[len("warning: "):] for line in said if line.startswith("warning: ")])
        self.assertGreater(len(caught), 0)
        self.assertTrue(all(warning.category is wingspread.Notice for warning in caught))
        self.assertEqual({warning.filename for warning in caught}, {__file__})

    def test_every_call_that_reads_a_wing_warns_of_it_at_its_callers_line(self):
        heavy = scene()
        heavy["bodies"][0]["mass"] = 40000
        file = self.folder / "heavy.json"
        file.write_text(json.dumps(heavy))
        said = [line[len("warning: "):] for line in program("simulate", file, "--json").stderr.splitlines()]
        self.assertGreater(len(said), 0)
        spring = ["hinges.*.spring.scale"]
        for call in (lambda: wingspread.simulate(file), lambda: wingspread.Model(file, spring),
                     lambda: wingspread.evaluate(file, spring, [[1]])):
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                call()
            self.assertEqual([str(warning.message) for warning in caught], said)
            self.assertEqual({(warning.category, warning.filename) for warning in caught}, {(wingspread.Notice, __file__)})
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            wingspread.simulate(SCENE)

    def test_arguments_that_another_type_would_hide_are_refused(self):
        spring = ["hinges.*.spring.scale"]
        model = wingspread.Model(SCENE, spring)
        table = wingspread.run(small(), runs=2)
        for make, place in [(lambda: wingspread.Model(SCENE, spring[0]), "--paths: found 'hinges"),
                            (lambda: wingspread.Model(SCENE, spring, "deployment_time"), "--outputs: found 'deployment_time'"),
                            (lambda: table.numbers("run"), "--columns: found 'run'"),
                            (lambda: wingspread.Model(SCENE, [*spring, 2]), "--paths: found ['hinges"),
                            (lambda: wingspread.Model(SCENE, spring, [None]), "--outputs: found [None]"),
                            (lambda: table.numbers([0]), "--columns: found [0]"),
                            (lambda: model(np.ma.masked_array([[1.0]], [[True]])), "--x: found 'a masked array'"),
                            (lambda: wingspread.simulate(SCENE, set=["a=1"]), "--set: found"),
                            (lambda: wingspread.simulate(SCENE, set={"hinges.root.spring.scale": [1]}), "--set: found"),
                            (lambda: wingspread.simulate(SCENE, dt=1e-9), "--dt: found 1e-09, expected at least")]:
            with self.assertRaises(wingspread.SpecError) as raised:
                make()
            self.assertIn(place, str(raised.exception))
        self.assertEqual(table.numbers([]).shape, (2, 0))


if __name__ == "__main__":
    unittest.main()
