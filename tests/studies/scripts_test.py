"""What the studies' scripts and drivers do with folders, programs and words that they do not expect.

    /usr/bin/python3 tests/studies/scripts_test.py PROGRAM EARLY_END      from the repository's root
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM, EARLY_END = (pathlib.Path(sys.argv.pop(1)).resolve() for _ in range(2))
ROOT = pathlib.Path(__file__).resolve().parents[2]
DRIVERS = ROOT / "studies/drivers"
sys.path.insert(0, str(DRIVERS))
sys.dont_write_bytecode = True
import fit_calibration
import memory


class InFolder(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="wingspread scripts "))
        self.addCleanup(shutil.rmtree, self.folder)

    def write(self, name, text, mode=0o644):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        path.chmod(mode)
        return path

    def stand_in(self, name, text):
        return self.write(name, f"#!/usr/bin/env bash\n{text}\n", 0o755)

    def run_words(self, *words, cwd=None, **environment):
        done = subprocess.run([str(word) for word in words], cwd=cwd or self.folder, env=os.environ | environment, check=False,
                              capture_output=True, text=True, timeout=120)
        return done.returncode, done.stdout, done.stderr

    def campaign(self, name, **more):
        campaign = json.loads((ROOT / "studies/campaigns/seed.json").read_text(encoding="utf-8"))
        campaign |= {"scene": str(ROOT / "studies/scenes/three_panel_flight.json"), "outputs": ["latch_time"], "statistics": {"accuracy_runs": 0},
                     "sampling": {"runs": 30, "seed": 1}}
        return self.write(name, json.dumps(campaign | more))


class Run(InFolder):
    """studies/run beside stand-ins for what installs and builds."""

    def setUp(self):
        super().setUp()
        for folder in ("studies", "build/release", "bin"):
            (self.folder / folder).mkdir(parents=True)
        shutil.copy(ROOT / "studies/run", self.folder / "studies")
        (self.folder / "studies/plots").symlink_to(ROOT / "studies/plots")
        (self.folder / "build/release/wingspread").symlink_to(PROGRAM)
        self.stand_in("studies/install", "")
        self.stand_in("bin/cmake", "")

    def run_campaigns(self, *words, cwd=None):
        return self.run_words(self.folder / "studies/run", *words, cwd=cwd, PATH=f"{self.folder / 'bin'}:{os.environ['PATH']}")

    def test_makes_runs_pictures_and_the_report_from_any_folder(self):
        self.campaign("mine/campaign.json")
        code, _, error = self.run_campaigns("campaign.json", cwd=self.folder / "mine")
        self.assertEqual(code, 0, error)
        for file in ("summary.json", "histograms.png", "report.html"):
            self.assertTrue((self.folder / "results/mine" / file).exists(), file)

    def test_continues_an_interrupted_campaign(self):
        one = self.campaign("one.json")
        self.assertEqual(self.run_campaigns(one)[0], 0)
        rows = self.folder / "results/one/runs.csv"
        whole = rows.read_bytes()
        rows.write_bytes(whole[:len(whole) // 2])
        inode = rows.stat().st_ino
        self.assertEqual(self.run_campaigns(one)[0], 0)
        self.assertEqual((rows.read_bytes(), rows.stat().st_ino), (whole, inode))

    def test_leaves_other_results_as_they_are(self):
        self.assertEqual(self.run_campaigns(self.campaign("one.json"))[0], 0)
        before = (self.folder / "results/one/runs.csv").read_bytes()
        other = self.campaign("one.json", sampling={"runs": 30, "seed": 2})
        code, _, error = self.run_campaigns(other)
        self.assertEqual((code, (self.folder / "results/one/runs.csv").read_bytes()), (2, before))
        self.assertIn("results/one is kept", error)

    def test_reports_runs_that_all_fail(self):
        code, said, error = self.run_campaigns(self.campaign("failing.json", integration={"max_steps": 10}))
        self.assertEqual(code, 3, error)
        self.assertIn("no histograms drawn", said)
        self.assertTrue((self.folder / "results/failing/report.html").exists())

    def test_refuses_a_file_that_is_not_there_and_two_of_one_name(self):
        self.write("results/typo/summary.json", "{}")
        for words, said in ((["typo.json"], "typo.json"), ([self.campaign("a/x.json"), self.campaign("b/x.json")], "results/x")):
            code, _, error = self.run_campaigns(*words)
            self.assertNotEqual(code, 0)
            self.assertIn(said, error)
        self.assertTrue((self.folder / "results/typo/summary.json").exists())
        self.assertFalse((self.folder / "results/x").exists())


class Fuzz(InFolder):
    def test_ends_with_1_where_an_input_failed(self):
        (self.folder / "studies").mkdir()
        shutil.copy(ROOT / "studies/fuzz", self.folder / "studies")
        self.stand_in("bin/cmake", "")
        for fails, code in (("exit 77", 1), ("true", 0)):
            self.stand_in("build/fuzz/tests/fuzz/fuzz_rows", f'[[ "$*" = *-merge* ]] || {{ echo "ft: 7"; {fails}; }}')
            found, said, error = self.run_words(self.folder / "studies/fuzz", "--runs", 1, "rows", PATH=f"{self.folder / 'bin'}:{os.environ['PATH']}")
            self.assertEqual((found, error), (code, ""))
            self.assertIn("rows", said)


class Words(InFolder):
    def test_tests_refuse_unknown_words(self):
        self.stand_in("studies/install", "exit 7")
        for script in ("run", "nightly", "steps.sh"):
            self.write(f"tests/{script}", (ROOT / "tests" / script).read_text(encoding="utf-8"), 0o755)
        for script, known in (("run", "--all"), ("nightly", "--quick")):
            self.assertEqual(self.run_words(self.folder / "tests" / script, known)[0], 7)
            code, _, error = self.run_words(self.folder / "tests" / script, known[:-1])
            self.assertEqual(code, 2)
            self.assertIn(known, error)


class Drivers(InFolder):
    def run_driver(self, name, *words):
        return self.run_words(sys.executable, "-B", DRIVERS / f"{name}.py", *words, cwd=ROOT)

    def killed(self):
        return self.stand_in("killed", "kill -9 $$")

    def test_empty_no_folder_of_others(self):
        mine = self.write("mine/thesis.txt", "all of it")
        for driver in ("fit_ground_tests", "memory", "rowless", "rare_against_counting"):
            code, _, error = self.run_driver(driver, "--quick", "--program", self.killed(), "--out", mine.parent)
            self.assertEqual((code, mine.read_text(encoding="utf-8")), (1, "all of it"), driver)
            self.assertIn("that " + driver, error)

    def test_empty_their_own_folder(self):
        out = self.folder / "own"
        for _ in range(2):  # begins, and meets a program that is killed
            self.assertIn("exit code -9", self.run_driver("memory", "--quick", "--program", self.killed(), "--out", out)[2])
            self.assertEqual({path.name for path in out.iterdir()}, {"made_by", "campaign.json"})
            (out / "rest").mkdir()
        link = self.folder / "link"
        (self.folder / "empty").mkdir()
        link.symlink_to(self.folder / "empty")
        self.assertIn("exit code -9", self.run_driver("memory", "--quick", "--program", self.killed(), "--out", link)[2])
        self.assertTrue((link / "made_by").is_file())

    def test_end_where_a_program_is_killed(self):
        for driver, words in (("same_bytes", ["--campaigns", "seed", "--"]), ("paired_programs", ["--quick"])):
            code, _, error = self.run_driver(driver, *words, self.killed(), self.killed())
            self.assertEqual(code, 1, driver)
            self.assertIn("exit code -9", error)

    def test_same_bytes_of_nothing_are_a_fault(self):
        idle = self.stand_in("idle", "")
        self.assertEqual(self.run_driver("same_bytes", "--campaigns", "seed", "--", idle, idle)[0], 1)

    def test_memory_of_a_program_is_its_own(self):
        held = bytearray(100 << 20)
        del held
        self.assertLess(memory.measure("/bin/true")[1], 30)
        self.assertGreater(memory.measure(sys.executable, "-c", "bytearray(100 << 20)")[1], 100)

    def test_calibration_keeps_no_rows_of_another_program(self):
        rows, made_by = self.folder / "seed.csv", {"program": "1", "case": fit_calibration.CASES["two_wings"]}
        fit_calibration.check_origin(rows, made_by)
        rows.touch()
        fit_calibration.check_origin(rows, made_by)
        with self.assertRaisesRegex(SystemExit, "another program"):
            fit_calibration.check_origin(rows, made_by | {"program": "2"})

    def test_early_end_reports_runs_that_fail(self):
        code, said, _ = self.run_words(EARLY_END, self.campaign("failing.json", integration={"max_steps": 10}), "--out", self.folder / "out")
        self.assertEqual(code, 1)
        self.assertIn("max_steps", said)


if __name__ == "__main__":
    unittest.main()
