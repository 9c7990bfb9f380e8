"""How long `wingspread fit` takes: processor time, wall-clock time, and the state of the chains.

    /usr/bin/python3 studies/drivers/fit_times.py       # results/fit_times; a minute of two cores
    /usr/bin/python3 studies/drivers/fit_times.py --case satellite --threads 1 --samples 1000

  seed       three panels with friction; three springs; angles of all hinges at 50 Hz to 8 s, 0.3°; 10,000 effective samples
  satellite  two wings of four hinges on a free spacecraft, with stops, loops, tables and exact friction; eight springs; angles of a
             root and a tip at 50 Hz to 2.4 s, 0.3°; 1,000 effective samples

The data are simulated from a draw of the priors.
"""

import argparse
import json
import pathlib
import random
import resource
import time

import own_folder
from fit_ground_tests import NOISE, ROOT, call, read_csv

SPRING = {"type": "normal", "mean": 1, "std": 0.04, "truncate": {"lower": 0.84, "upper": 1.16}}
CASES = {
    "seed": {"scene": "three_panel_flight.json", "columns": ["root.angle", "mid.angle", "tip.angle"], "until": 8, "samples": 10000},
    "satellite": {"scene": "satellite.json", "columns": ["left_root.angle", "right_tip.angle"], "until": 2.4, "samples": 1000},
}


def make_test(program, case, folder, samples):
    """Writes the campaign of priors, a trace of one draw of it, and the tests."""
    campaign = {"scene": str(ROOT / "studies/scenes" / case["scene"]), "integration": {"t_end": 20},
                "dispersions": [{"name": "spring", "distribution": SPRING, "apply": "scale", "each": "hinges.*.spring.scale"}],
                "sampling": {"runs": 1, "seed": 11}, "outputs": ["latch_time"], "statistics": {"accuracy_runs": 0}}
    (folder / "campaign.json").write_text(json.dumps(campaign, indent=1), encoding="utf-8")
    call(program, "run", folder / "campaign.json", "--out", folder / "truth", "--threads", "1", allowed=(0, 1, 3))
    call(program, "replay", folder / "truth", "--run", 0, "--scene", folder / "truth.json")
    call(program, "simulate", folder / "truth.json", "--t-end", case["until"], "--dt", "0.02", "--out", folder / "exact.csv")
    rows, dice, last = read_csv(folder / "exact.csv"), random.Random(3), None
    with open(folder / "trace.csv", "w", encoding="utf-8") as file:
        file.write("t," + ",".join(case["columns"]) + "\n")
        for row in rows:
            if row["t"] != last:  # a latch gives two samples
                file.write(",".join([row["t"], *(repr(float(row[name]) + dice.gauss(0, NOISE)) for name in case["columns"])]) + "\n")
            last = row["t"]
    columns = {name: {"column": name, "std": NOISE} for name in case["columns"]}
    tests = {"tests": [{"name": "ground", "trace": {"file": "trace.csv", "time": "t", "columns": columns}}],
             "fit": {"parameters": ["spring.*"], "samples": samples, "starts": 4}}
    (folder / "tests.json").write_text(json.dumps(tests, indent=1), encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=ROOT / "build/release/wingspread", type=pathlib.Path)
    parser.add_argument("--case", choices=CASES, action="append", help="default: all")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--samples", type=int, help="effective samples; default: the case's")
    parser.add_argument("--out", default="results/fit_times", type=pathlib.Path)
    given = parser.parse_args()
    for name in given.case or CASES:
        folder = given.out / name
        own_folder.begin(folder)
        make_test(given.program, CASES[name], folder, given.samples or CASES[name]["samples"])
        before, start = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime, time.monotonic()
        call(given.program, "fit", folder / "campaign.json", folder / "tests.json", "--out", folder / "fit", "--threads", given.threads,
             allowed=(0, 1))
        wall, cpu = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        fit = json.loads((folder / "fit/fit.json").read_text(encoding="utf-8"))
        sampler = fit["sampler"]
        print(f"{name}: {len(fit['parameters'])} parameters, {'finished' if fit['finished'] else 'NOT FINISHED'}, {sampler['runs']} runs of the "
              f"sampler, effective sample size {sampler['ess']:.0f}, R-hat {sampler['r_hat']:.4f}, acceptance {sampler['acceptance']:.2f}; "
              f"{wall:.1f} s by {given.threads} threads, {cpu:.1f} s of processor time")


if __name__ == "__main__":
    main()
