"""The program under mpirun: the same bytes from any number of ranks, and an end whatever happens to one of them.

    /usr/bin/python3 tests/ranks/ranks_test.py [NAME…]    from the repository's root

WINGSPREAD_PROGRAM is the program without MPI, WINGSPREAD_MPI_PROGRAM the one with it, WINGSPREAD_MPIRUN mpirun.
"""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

PROGRAM = os.environ.get("WINGSPREAD_PROGRAM", "build/release/wingspread")
MPI_PROGRAM = os.environ.get("WINGSPREAD_MPI_PROGRAM", "build/mpi/wingspread")
MPIRUN = os.environ.get("WINGSPREAD_MPIRUN", "mpirun")
# As many ranks as a test wants, on however few processors, and by whoever runs the tests.
ENVIRONMENT = os.environ | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_NUM_THREADS": "1",
                            "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_hwloc_base_binding_policy": "none"}
SCENE = json.loads(pathlib.Path("studies/scenes/three_panel.json").read_text(encoding="utf-8"))
SPRING = ["hinges.root.spring.torque_stowed", "hinges.root.spring.torque_latched"]


def campaign(runs, **more):
    """Some 0.2 ms a run."""
    return {"scene": SCENE,
            "dispersions": [{"name": "root_spring", "distribution": {"type": "normal", "mean": 1, "std": 0.05},
                             "apply": "scale", "to": SPRING},
                            {"name": "mass", "distribution": {"type": "uniform", "lower": 9, "upper": 11},
                             "apply": "set", "each": "bodies.*.mass"}],
            "sampling": {"runs": runs, "seed": 7}, "integration": {"rtol": 1e-6, "atol": 1e-8, "t_end": 20},
            "outputs": ["latch_time", "latch_rate", "peak_moment"]} | more


def contents(folder):
    """Every file's bytes, less those that say how long it took."""
    return {str(file.relative_to(folder)): file.read_bytes() for file in sorted(folder.rglob("*"))
            if file.is_file() and file.name != "timing.json"}


class Ranks(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="wingspread_ranks_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def start(self, ranks, *arguments):
        """Under mpirun; of no ranks the program by itself."""
        program = [PROGRAM] if ranks == 0 else [MPIRUN, "-n", str(ranks), MPI_PROGRAM]
        return subprocess.Popen([*program, *map(str, arguments)], env=ENVIRONMENT, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True)

    def finish(self, process, seconds=120):
        try:
            out, error = process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            process.kill()
            raise
        return process.returncode, out, error

    def run_program(self, ranks, *arguments):
        return self.finish(self.start(ranks, *arguments))

    def write(self, of):
        path = self.folder / "campaign.json"
        path.write_text(json.dumps(of), encoding="utf-8")
        return path

    def same(self, command, of, *options, ranks=(1, 2, 3), codes=(0,)):
        """The folder of one process and those of several ranks."""
        file = self.write(of)
        alone = self.folder / "alone"
        code, _, error = self.run_program(0, command, file, "--out", alone, *options)
        self.assertIn(code, codes, error)
        expected = contents(alone)
        self.assertGreater(len(expected), 0)
        for count in ranks:
            out = self.folder / f"of_{count}"
            found, _, error = self.run_program(count, command, file, "--out", out, *options)
            self.assertEqual(found, code, error)
            self.assertEqual(contents(out), expected, f"{command}, {count} ranks")

    def test_run(self):
        self.same("run", campaign(400))

    def test_run_with_cases(self):
        self.same("run", campaign(150, cases=[{"name": "cold", "scale": {"hinges.root.spring.torque_stowed": 0.95}},
                                         {"name": "hot"}]), ranks=(2,))

    def test_run_that_stops(self):
        of = campaign(20000, requirements=[{"output": "deployed", "probability": 0.95, "confidence": 0.9}])
        self.same("run", of, "--until", "requirement deployed", ranks=(3,))

    def test_run_without_rows(self):
        self.same("run", campaign(5000), "--no-rows", ranks=(2, 3))
        timing = json.loads((self.folder / "of_3" / "timing.json").read_text(encoding="utf-8"))
        self.assertEqual((timing["ranks"], timing["threads"]), (3, 1))

    def test_sobol_points_and_a_shard(self):
        of = campaign(256)
        of["sampling"] |= {"design": "sobol", "replicates": 4}
        self.same("run", of, "--shard", "2/3", ranks=(2, 5))

    def test_margin(self):
        of = campaign(100, requirements=[{"output": "deployed", "probability": 0.97, "confidence": 0.9},
                                         {"output": "root.latch_rate", "min": -1, "probability": 0.97, "confidence": 0.9}],
                      margin={"scale": SPRING, "range": [0.7, 1.4], "points": 3})
        self.same("margin", of, ranks=(2, 3), codes=(0, 1))

    def test_rare(self):
        for event in ((), ("--output", "root.peak_moment", "--above", "300")):
            self.same("rare", campaign(1), *event, "--samples", 100, "--repeats", 2, ranks=(3,))
            shutil.rmtree(self.folder / "alone")
            shutil.rmtree(self.folder / "of_3")

    def test_sensitivity(self):
        self.same("sensitivity", campaign(1), "--samples", 64, ranks=(2, 3))

    def test_fit(self):
        times = [0.02 * k for k in range(120)]
        of = campaign(50)
        of["sampling"] |= {"design": "latin_hypercube", "replicates": 2}  # the prediction has more runs than the campaign
        alone = self.folder / "truth.csv"
        code, _, error = self.run_program(0, "simulate", self.write(SCENE), "--t-end", times[-1], "--dt", 0.02, "--out", alone)
        self.assertEqual(code, 0, error)
        columns = {"root.angle": {"column": "root.angle", "std": 0.005}, "tip.rate": {"column": "tip.rate", "std": 0.02}}
        trace = {"file": alone.name, "time": "t", "columns": columns}
        values = [{"output": "root.latch_time", "value": 7, "std": 0.5}]
        file, tests = self.write(of), self.folder / "tests.json"
        tests.write_text(json.dumps({"tests": [{"name": "ground", "trace": trace}, {"name": "timer", "values": values}],
                                     "fit": {"parameters": ["root_spring", "mass.panel_1"], "samples": 200, "starts": 2}}), encoding="utf-8")
        expected = None
        for ranks in (0, 1, 2, 3):
            out = self.folder / f"fit_{ranks}"
            code, _, error = self.run_program(ranks, "fit", file, tests, "--out", out)
            self.assertEqual(code, 0, error)
            expected = expected or contents(out)
            self.assertEqual(contents(out), expected, f"{ranks} ranks")
        self.assertIn("posterior.csv", expected)

    def test_bad_input_is_told_once(self):
        file = self.write(campaign(10) | {"outputs": ["latch_tim"]})
        code, _, expected = self.run_program(0, "run", file, "--out", self.folder / "out")
        self.assertEqual(code, 2)
        code, _, error = self.run_program(3, "run", file, "--out", self.folder / "out")
        self.assertEqual(code, 2)
        self.assertEqual([line for line in error.splitlines() if line.startswith("error: ")], expected.splitlines())
        self.assertFalse((self.folder / "out").exists())

    def test_other_commands_are_rank_0s(self):
        scene = self.write(SCENE)
        _, expected, _ = self.run_program(0, "simulate", scene, "--json")
        code, out, error = self.run_program(2, "simulate", scene, "--json")
        self.assertEqual((code, out), (0, expected), error)

    # What follows has runs to make for a minute, and is not to last as long.

    def rows_of(self, folder):
        file = folder / "runs.csv"
        return len(file.read_bytes().splitlines()) if file.exists() else 0

    def begin_long_one(self, ranks):
        self.file, self.out = self.write(campaign(200000)), self.folder / "long"
        process = self.start(ranks, "run", self.file, "--out", self.out)
        end = time.monotonic() + 60
        while self.rows_of(self.out) < 300:
            self.assertIsNone(process.poll(), "it ended by itself")
            self.assertLess(time.monotonic(), end, "there are no rows")
            time.sleep(0.05)
        return process

    def go_on_and_compare(self):
        """Some more runs, by two ranks: to the bytes of one process."""
        rows = self.rows_of(self.out)
        runs = rows + 500
        shorter = self.write(campaign(200000) | {"sampling": {"runs": runs, "seed": 7}})
        # the folder says how many runs it is of
        begun = self.folder / "begun"
        code, _, error = self.run_program(0, "run", shorter, "--out", begun)
        self.assertEqual(code, 0, error)
        expected = (begun / "runs.csv").read_bytes().splitlines(keepends=True)
        found = (self.out / "runs.csv").read_bytes().splitlines(keepends=True)
        complete = found if found[-1].endswith(b"\n") else found[:-1]
        self.assertEqual(complete, expected[:len(complete)])
        shutil.copy(begun / "campaign.json", self.out)
        code, _, error = self.run_program(2, "run", shorter, "--out", self.out, "--resume")
        self.assertEqual(code, 0, error)
        self.assertEqual(contents(self.out), contents(begun))

    def workers(self, process):
        """The processes that mpirun has started, in the order of their ranks."""
        ranks = {}
        for entry in pathlib.Path("/proc").iterdir():
            try:
                parent = int((entry / "stat").read_text(encoding="utf-8").rsplit(")", 1)[1].split()[1])
                if parent == process.pid:
                    words = (entry / "environ").read_bytes().split(b"\0")
                    ranks[next(int(word[21:]) for word in words if word.startswith(b"OMPI_COMM_WORLD_RANK="))] = int(entry.name)
            except (OSError, ValueError, StopIteration):
                continue
        return [ranks[rank] for rank in sorted(ranks)]

    def test_a_killed_rank_ends_the_job(self):
        for victim in (0, 1):
            process = self.begin_long_one(3)
            os.kill(self.workers(process)[victim], signal.SIGKILL)
            code, _, error = self.finish(process, 20)
            self.assertNotEqual(code, 0, error)
            self.go_on_and_compare()
            shutil.rmtree(self.out)
            shutil.rmtree(self.folder / "begun")

    def test_a_signal_to_mpirun_keeps_what_is_done(self):
        process = self.begin_long_one(2)
        process.send_signal(signal.SIGTERM)
        code, _, error = self.finish(process, 20)
        self.assertNotEqual(code, 0, error)
        self.go_on_and_compare()

    def test_a_signal_to_rank_0_ends_it_in_order(self):
        process = self.begin_long_one(2)
        os.kill(self.workers(process)[0], signal.SIGTERM)
        code, _, error = self.finish(process, 20)
        self.assertEqual(code, 130, error)
        self.assertIn("interrupted: ", error)
        self.go_on_and_compare()

    def test_a_study_goes_on_with_another_number_of_ranks(self):
        of = campaign(3000, requirements=[{"output": "deployed", "probability": 0.97, "confidence": 0.9},
                                          {"output": "root.latch_rate", "min": -1, "probability": 0.97, "confidence": 0.9}],
                      margin={"scale": SPRING, "range": [0.7, 1.4], "points": 3, "widest": [0.7, 1.4]})
        file, out, alone = self.write(of), self.folder / "out", self.folder / "alone"
        process = self.start(2, "margin", file, "--out", out)
        end = time.monotonic() + 60
        while not (out / "looks.log").exists() or (out / "looks.log").stat().st_size < 100000:
            self.assertIsNone(process.poll(), "it ended by itself")
            self.assertLess(time.monotonic(), end, "there is no log")
            time.sleep(0.02)
        os.kill(self.workers(process)[1], signal.SIGKILL)
        code, _, error = self.finish(process, 20)
        self.assertNotEqual(code, 0, error)
        expected, _, error = self.run_program(0, "margin", file, "--out", alone)
        self.assertIn(expected, (0, 1), error)
        code, _, error = self.run_program(3, "margin", file, "--out", out, "--resume")
        self.assertEqual(code, expected, error)
        self.assertEqual(contents(out), contents(alone))


if __name__ == "__main__":
    unittest.main()
