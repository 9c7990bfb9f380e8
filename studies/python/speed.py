"""Compares the speed of the Python module with the program's, on a campaign, in pairs of runs.

    PYTHONPATH=build/release/python /usr/bin/python3 studies/python/speed.py build/release/wingspread
        [--campaign FILE] [--runs N] [--pairs P] [--least 0.9]

Of each pair one is `wingspread run`, by its own clock: the runs and their rows alone (timing.json), and the whole
program, statistics and files included. The other is wingspread.run in this process, reading the campaign and making
the arrays included. Their order alternates, so that other load on the machine falls on both. Prints the medians of the
ratios; exits 1 if the module has less than `--least` of the program's rate.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time
import warnings

import wingspread

ROOT = pathlib.Path(__file__).parent.parent.parent


def by_program(program, campaign, runs, seed):
    """Runs per second: while they are made, and over the whole program."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out"
        began = time.perf_counter()
        subprocess.run([program, "run", campaign, "--out", out, "--runs", str(runs), "--seed", str(seed)], check=False,
                       capture_output=True)
        seconds = time.perf_counter() - began
        return json.loads((out / "timing.json").read_text())["runs_per_second"], runs / seconds


def by_module(campaign, runs, seed):
    began = time.perf_counter()
    table = wingspread.run(campaign, runs=runs, seed=seed)
    columns = {name: table[name] for name in table.draws + table.outputs}
    assert len(columns["deployment_time"]) == runs
    return runs / (time.perf_counter() - began)


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("program")
    arguments.add_argument("--campaign", default=ROOT / "studies/campaigns/seed.json")
    arguments.add_argument("--runs", type=int, default=4000)
    arguments.add_argument("--pairs", type=int, default=9)
    arguments.add_argument("--least", type=float, default=0.9)
    options = arguments.parse_args()
    warnings.simplefilter("ignore", wingspread.Notice)
    making, whole = [], []
    for seed in range(options.pairs):
        def program():
            return by_program(options.program, options.campaign, options.runs, seed)

        def module():
            return by_module(options.campaign, options.runs, seed)

        if seed % 2:
            (made, all_of_it), own = program(), module()
        else:
            own, (made, all_of_it) = module(), program()
        making.append(own / made)
        whole.append(own / all_of_it)
        print(f"pair {seed + 1}: module {own:.0f} runs/s, program {made:.0f} while it makes runs, {all_of_it:.0f} in whole")
    ratio = statistics.median(making)
    print(f"the module has {100 * ratio:.0f} % of the program's rate while it makes runs ({100 * min(making):.0f} to "
          f"{100 * max(making):.0f} %), {100 * statistics.median(whole):.0f} % of that of the whole program")
    return 0 if ratio >= options.least else 1


if __name__ == "__main__":
    sys.exit(main())
