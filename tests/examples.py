"""Runs the six examples of studies/examples and checks the key facts of their output.

    /usr/bin/python3 tests/examples.py ROOT PROGRAM CPP_EXAMPLE FOLDER [PYTHONPATH]

ROOT is the repository, PROGRAM wingspread, CPP_EXAMPLE the built deployment.cpp, FOLDER a scratch folder that is emptied. Without
PYTHONPATH the Python example is left out. The README's listings must equal the files, and its outputs the printed ones: the words
exactly, the numbers to 1e-3. A processor may choose another method for a stretch, so that the last digits may differ.
"""

import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys

NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def run(root, *words, expected=0, **environment):
    done = subprocess.run([str(word) for word in words], cwd=root, capture_output=True, text=True, check=False,
                          env={**os.environ, **environment})
    if done.returncode != expected:
        sys.exit(f"{' '.join(map(str, words))}: exit code {done.returncode}, expected {expected}\n{done.stderr}")
    return done.stdout


def check(close, what):
    if not close:
        sys.exit(f"examples.py: {what}")


def near(value, expected, tolerance=1e-5):
    check(math.isclose(value, expected, rel_tol=tolerance), f"found {value}, expected {expected}")


def check_measured_spring(root, program):
    outcome = json.loads(run(root, program, "simulate", "studies/examples/measured_spring.json", "--json"))
    check(outcome["status"] == "deployed", outcome["status"])
    near(outcome["latches"][0]["time"], 2.360437)
    near(outcome["peak_moment"]["root"]["value"], 174.9094)


def check_two_wings(root, program):
    outcome = json.loads(run(root, program, "simulate", "studies/examples/two_wings.json", "--json"))
    check([latch["hinge"] for latch in outcome["latches"]] == ["left_root", "right_root"], "the stronger wing latches first")
    near(outcome["latches"][0]["time"], 2.237810)
    near(outcome["latches"][1]["time"], 2.368155)
    check(abs(outcome["final"]["base"]["rate"]) < 1e-9, "the base comes to rest: angular momentum is conserved")


def check_cold_hot(root, program, folder):
    run(root, program, "run", "studies/examples/cold_hot.json", "--out", folder / "cold_hot", expected=1)
    requirements = json.loads((folder / "cold_hot/cases.json").read_text(encoding="utf-8"))["requirements"]
    moment = requirements[2]["cases"]
    verdicts = {case: its["verdict"] for case, its in moment.items()}
    check(verdicts == {"cold": "pass", "ambient": "fail", "hot": "fail"}, verdicts)
    check(all(its["verdict"] == "pass" for requirement in requirements[:2] for its in requirement["cases"].values()),
          "deployment and latch time pass in every case")


def check_rare_event(root, program):
    said = run(root, program, "rare", "studies/examples/rare_event.json", "--output", "root.peak_moment", "--above", "200")
    near(float(re.search(r"P\(root\.peak_moment > 200 N·m\) = ([-+.\de]+)", said).group(1)), 2.86e-4, 0.05)


def listings(page):
    """The README's indented blocks, without their indent."""
    return [re.sub(r"(?m)^    ", "", block) for block in re.findall(r"(?m)((?:^(?:    .*)?\n)+)", page)]


def check_listing(root, name, printed):
    page = (root / "README.md").read_text(encoding="utf-8")
    source = (root / "studies/examples" / name).read_text(encoding="utf-8").strip()
    blocks = [block.strip() for block in listings(page)]
    check(source in blocks, f"README.md does not show studies/examples/{name} as it is")
    shown = blocks[blocks.index(source) + 1:]
    words = NUMBER.sub("#", printed.strip())
    match = next((block for block in shown if NUMBER.sub("#", block) == words), None)
    check(match is not None, f"README.md does not show what {name} prints:\n{printed}")
    for here, there in zip(NUMBER.findall(printed), NUMBER.findall(match)):
        near(float(here), float(there), 1e-3)


def main():
    if len(sys.argv) not in (5, 6):
        sys.exit(__doc__)
    root, program, example, folder = (pathlib.Path(word).resolve() for word in sys.argv[1:5])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    check_measured_spring(root, program)
    check_two_wings(root, program)
    check_cold_hot(root, program, folder)
    check_rare_event(root, program)
    check_listing(root, "deployment.cpp", run(root, example))
    if len(sys.argv) == 6:
        printed = run(root, sys.executable, "studies/examples/deployment.py", PYTHONPATH=sys.argv[5])
        check_listing(root, "deployment.py", printed)
    for file in sorted((root / "studies/examples").iterdir()):
        lines = file.read_text(encoding="utf-8").count("\n")
        check(lines <= 40, f"{file.name} has {lines} lines, at most 40 are allowed")


if __name__ == "__main__":
    main()
