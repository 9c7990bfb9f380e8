"""The installed library in a program of somebody else's: built by find_package, and its numbers are the program's.

    /usr/bin/python3 tests/consumer/consumer_test.py build/release
"""

import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).parent
SOURCE = HERE.parent.parent
BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
SCENE = SOURCE / "studies/scenes/three_panel.json"
CAMPAIGN = SOURCE / "studies/campaigns/seed.json"


def output_of(*command):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True).stdout


class Consumer(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.held = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.held.name)
        output_of("cmake", "--install", BUILD, "--prefix", cls.folder / "prefix", "--component", "development")
        output_of("cmake", "-S", HERE, "-B", cls.folder / "build", "-G", "Ninja",
                  f"-DCMAKE_PREFIX_PATH={cls.folder / 'prefix'}")
        output_of("cmake", "--build", cls.folder / "build")
        cls.printed = output_of(cls.folder / "build/consumer", SCENE, CAMPAIGN)
        cls.lines = cls.printed.splitlines()

    @classmethod
    def tearDownClass(cls):
        cls.held.cleanup()

    def test_no_flag_of_ours_reaches_it(self):
        flags = json.loads((self.folder / "build/compile_commands.json").read_text())[0]["command"]
        for flag in ("-Werror", "-march", "-fopenmp", "-ffp-contract", "-fno-tree-vectorize", "eigen", str(SOURCE) + " "):
            self.assertNotIn(flag, flags)
        self.assertIn(f"-isystem {self.folder / 'prefix/include'}", flags)

    def test_headers_are_few_and_include_nothing_but_the_standard_library(self):
        headers = sorted((self.folder / "prefix/include").rglob("*.*"))
        self.assertEqual([header.name for header in headers],
                         ["machine_error.hpp", "spec_error.hpp", "stopped.hpp", "wingspread.hpp"])
        for header in headers:
            for name in re.findall(r"#include (.*)", header.read_text()):
                self.assertRegex(name, r"^<(wingspread/[a-z_]+\.hpp|[a-z_]+)>$")

    def test_a_deployment_is_what_simulate_prints(self):
        said = output_of(BUILD / "wingspread", "simulate", SCENE, "--json")
        self.assertTrue(self.printed.startswith(said))

    def test_a_campaigns_rows_are_those_of_run(self):
        subprocess.run([BUILD / "wingspread", "run", CAMPAIGN, "--out", self.folder / "rows", "--runs", "64", "--seed",
                        "7"], check=False, capture_output=True)
        with open(self.folder / "rows/runs.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        first = self.lines.index("run,deployment_time,latch_order") + 1
        expected = [f"{row['run']},{row['deployment_time']},{row['latch_order']}" for row in rows]
        self.assertEqual(len(expected), 64)
        self.assertEqual(self.lines[first:first + 64], expected)

    def test_a_scene_as_a_function(self):
        done, nominal, stronger_is_faster = self.lines[-3].split()
        told = json.loads(output_of(BUILD / "wingspread", "simulate", SCENE, "--json"))
        self.assertEqual((done, stronger_is_faster), ("1", "1"))
        self.assertAlmostEqual(float(nominal), told["latches"][-1]["time"], delta=1e-9)

    def test_the_trajectory_and_the_version(self):
        steps, version = self.lines[-2].split()
        self.assertGreater(int(steps), 50)
        self.assertEqual(f"wingspread {version}", output_of(BUILD / "wingspread", "--version").strip())

    def test_what_is_wrong_is_an_exception_with_every_problem(self):
        self.assertRegex(self.lines[-1], r"^[2-9] problems: ")


if __name__ == "__main__":
    unittest.main()
