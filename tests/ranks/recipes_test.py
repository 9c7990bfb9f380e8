"""The recipes of studies/cluster as far as any machine can tell: each is a script that bash reads, and GNU parallel's makes
the folder of one process. `studies/cluster/try` runs all of them, on a SLURM of its own.

    /usr/bin/python3 tests/ranks/recipes_test.py     from the repository's root
"""

import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

PROGRAM = pathlib.Path(os.environ.get("WINGSPREAD_PROGRAM", "build/release/wingspread")).resolve()
RECIPES = pathlib.Path("studies/cluster")


class Recipes(unittest.TestCase):
    def test_bash_reads_them(self):
        scripts = [file for file in RECIPES.iterdir() if file.read_bytes().startswith(b"#!/usr/bin/env bash")]
        self.assertGreaterEqual(len(scripts), 6)
        for script in scripts:
            read = subprocess.run(["bash", "-n", script], capture_output=True, text=True, check=False)
            self.assertEqual((read.returncode, read.stderr), (0, ""), script)

    @unittest.skipUnless(shutil.which("parallel"), "GNU parallel is not installed")
    def test_shards_by_parallel(self):
        folder = pathlib.Path(tempfile.mkdtemp(prefix="wingspread_recipes_"))
        self.addCleanup(shutil.rmtree, folder)
        campaign = json.loads(pathlib.Path("studies/campaigns/seed.json").read_text(encoding="utf-8"))
        campaign["scene"] = str(pathlib.Path("studies/scenes/three_panel_flight.json").resolve())
        campaign["sampling"]["runs"] = 90
        campaign["statistics"]["accuracy_runs"] = 0
        file = folder / "campaign.json"
        file.write_text(json.dumps(campaign), encoding="utf-8")
        subprocess.run([PROGRAM, "run", file, "--out", folder / "one"], check=True, capture_output=True)
        for _ in range(2):  # the second time all is there
            subprocess.run([RECIPES / "with_parallel", file, folder / "by", "4", "--jobs", "2"], check=True, capture_output=True,
                           env=os.environ | {"WINGSPREAD": str(PROGRAM)})
            for name in ("campaign.json", "runs.csv", "summary.json", "histograms.json", "histograms.csv"):
                self.assertEqual((folder / "by/whole" / name).read_bytes(), (folder / "one" / name).read_bytes(), name)


if __name__ == "__main__":
    unittest.main()
