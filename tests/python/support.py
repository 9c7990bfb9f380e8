"""For the tests of the Python module: the program beside it, and shipped files."""

import os
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).parent.parent.parent
PROGRAM = pathlib.Path(os.environ["WINGSPREAD_PROGRAM"]).resolve()
SCENE = ROOT / "studies/scenes/three_panel.json"
CAMPAIGN = ROOT / "studies/campaigns/seed.json"
STALL = ROOT / "studies/campaigns/stall.json"


def program(*words):
    return subprocess.run([str(PROGRAM), *map(str, words)], capture_output=True, text=True, check=False)
