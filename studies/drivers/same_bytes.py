"""Runs campaigns with two programs and compares every file of their results byte by byte.

    /usr/bin/python3 studies/drivers/same_bytes.py before/wingspread build/release/wingspread
    /usr/bin/python3 studies/drivers/same_bytes.py --runs 2000 --campaigns seed stall -- before/wingspread build/release/wingspread

Shows that a change of the code moves no number. The comparison leaves out timing.json and the program's version in JSON files. The script also compares trajectories of each scene. It prints one
line for each campaign and scene, names every file that differs, and exits 1 if any does.
"""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parents[1]
RUNS = {"long_chain": 20, "yoke_wing": 150, "two_wing_free": 150, "prescribed_base": 300}  # the others: 600
SKIPPED = {"timing.json"}


def call(program, *words):
    done = subprocess.run([program, *map(str, words)], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):  # 1: a requirement is not met
        sys.exit(f"{program} {' '.join(map(str, words))}: exit code {done.returncode}\n{done.stderr}")


def contents(folder):
    """Each file's bytes by its path, without the version of the program."""
    files = {}
    for path in sorted(folder.rglob("*")):
        if path.is_file() and path.name not in SKIPPED:
            text = path.read_bytes()
            if path.suffix == ".json":
                text = re.sub(rb'"version": "[^"]*"', b'"version": ""', text)
            files[str(path.relative_to(folder))] = text
    return files


def compare(name, before, after):
    different = sorted(file for file in before.keys() | after.keys() if before.get(file) != after.get(file))
    verdict = "DIFFERENT: " + ", ".join(different) if different else "the same" if after else "NOTHING TO COMPARE"
    print(f"{name:28} {len(after):3} files   {verdict}", flush=True)
    return verdict == "the same"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before")
    parser.add_argument("after")
    parser.add_argument("--campaigns", nargs="+", help="names; without it, all that are shipped")
    parser.add_argument("--runs", type=int, help="of each campaign")
    parser.add_argument("--options", nargs="+", default=[], metavar="OPTION", help="passed on to both, e.g. --options=--lanes=1")
    given = parser.parse_args()
    names = given.campaigns or sorted(path.stem for path in (HERE / "campaigns").glob("*.json"))
    same = True
    with tempfile.TemporaryDirectory() as scratch:
        for name in names:
            found = []
            for side, program in (("before", given.before), ("after", given.after)):
                out = pathlib.Path(scratch) / name / side
                out.parent.mkdir(exist_ok=True)
                call(program, "run", HERE / "campaigns" / f"{name}.json", "--out", out, "--runs",
                     given.runs or (1024 if name == "correlated" else RUNS.get(name, 600)), *given.options)
                found.append(contents(out))
            same = compare(name, *found) and same
        if not given.campaigns:
            for scene in sorted((HERE / "scenes").glob("*.json")):
                found = []
                for side, program in (("before", given.before), ("after", given.after)):
                    out = pathlib.Path(scratch) / "scenes" / scene.stem / side
                    out.mkdir(parents=True)
                    call(program, "simulate", scene, "--out", out / "trajectory.csv")
                    found.append(contents(out))
                same = compare(f"scene {scene.stem}", *found) and same
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
