"""Compares campaigns without rows (run --no-rows) with campaigns with rows: results, memory and disk.

    /usr/bin/python3 studies/drivers/rowless.py                    a million runs with rows and without, ten million without
    /usr/bin/python3 studies/drivers/rowless.py --longest 100000000 --first-latch
    /usr/bin/python3 studies/drivers/rowless.py --quick            seconds; ten thousand

Exits 1 if a count, an extreme or a verdict differs, a moment differs by more than rounding, a quantile lies outside its stated
interval, a bound does not contain the bound of the rows, or memory grows with the number of runs. The wing is that of drivers/memory.py,
run to its last latch; with --first-latch only the root has a latch. Prints the figures and writes rowless.csv in the folder.
"""

import argparse
import csv
import json
import pathlib
import sys

import own_folder
from memory import measure, write_cheap_campaign

REQUIREMENTS = [{"output": "root.latch_time", "max": 5.0, "probability": 0.9, "confidence": 0.9},
                {"output": "deployment_time", "max": 8.5, "probability": 0.9973, "confidence": 0.9},
                {"output": "deployed", "probability": 0.9973, "confidence": 0.9}]
MOST_GROWTH_MIB = 7  # for each output, whatever the number of runs: more runs fill more of its bins, which are 6 MB at most


def faults_between(full, found):
    """Lists the faults of a summary without rows, compared with the summary of the rows."""
    faults = []

    def expect(holds, what):
        if not holds:
            faults.append(what)

    for key in ("runs", "status", "reasons", "latch_order", "peaks_final"):
        expect(found.get(key) == full.get(key), f"{key} differs")
    for mine, theirs in zip(found["requirements"], full["requirements"]):
        for key in ("verdict", "failures", "broken", "broken_omitted"):
            expect(mine[key] == theirs[key], f"{theirs['output']}: {key} differs")
    for name, theirs in full["outputs"].items():
        mine = found["outputs"][name]
        for key in ("count", "missing", "min", "max"):
            expect(mine[key] == theirs[key], f"{name}: {key} {mine[key]} for {theirs[key]}")
        for key in ("mean", "std", "skewness", "kurtosis"):
            a, b = mine[key], theirs[key]
            scale = abs(b) if b else 0
            expect(a == b or (a is not None and b is not None and abs(a - b) <= 1e-10 * max(1e-6, scale)),
                   f"{name}: {key} {a} for {b}")
        for a, b in zip(mine["quantiles"], theirs["quantiles"]):
            if b["value"] is None:
                continue
            expect(a["within"][0] <= b["value"] <= a["within"][1], f"{name}: quantile {b['p']} outside")
            for end, sign in (("lower", 1), ("upper", -1)):
                expect((a[end] is None) == (b[end] is None) and (a[end] is None or sign * (b[end] - a[end]) >= 0),
                       f"{name}: {end} bound of quantile {b['p']} does not hold")
    return faults


def worst_rank_error(summary):
    """The largest rank error of all quantiles, as a share of the values."""
    return max(q["rank_error"] / output["count"] for output in summary["outputs"].values()
               for q in output["quantiles"] if "rank_error" in q)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--program", default="build/release/wingspread")
    parser.add_argument("--out", default="results/rowless")
    parser.add_argument("--first-latch", action="store_true")
    parser.add_argument("--longest", type=int, default=10_000_000)
    options = parser.parse_args()
    out = pathlib.Path(options.out)
    own_folder.begin(out)
    file = write_cheap_campaign(out)
    campaign = json.loads(file.read_text())
    campaign["requirements"] = REQUIREMENTS
    if options.first_latch:
        for hinge in campaign["scene"]["hinges"][1:]:
            del hinge["latch"]
    file.write_text(json.dumps(campaign))
    compared = 10_000 if options.quick else 1_000_000
    rows, faults = [], []

    def run(mode, runs, *more):
        folder = out / f"{mode}_{runs}"
        seconds, memory = measure(options.program, "run", file, "--out", folder, "--runs", runs, *more)
        disk = sum(each.stat().st_size for each in folder.iterdir()) / 2**20
        made = json.loads((folder / "timing.json").read_text())["runs_per_second"]
        rows.append({"mode": mode, "runs": runs, "seconds": round(seconds, 1), "runs_per_second": round(made),
                     "memory_mib": round(memory, 1), "disk_mib": round(disk, 1)})
        print(f"{mode:8} {runs:>11} runs  {seconds:8.1f} s  {made:9.0f} runs/s  {memory:7.1f} MiB of memory  "
              f"{disk:8.1f} MiB of disk", flush=True)
        return json.loads((folder / "summary.json").read_text()), memory

    full, _ = run("rows", compared)
    found, least = run("no_rows", compared, "--no-rows")
    faults += faults_between(full, found)
    print(f"worst rank error of a quantile: {worst_rank_error(found):.2g} of the runs; "
          f"{len(faults)} differences that there may not be")
    lengths = [20_000] if options.quick else [n for n in (10_000_000, 100_000_000) if n <= options.longest]
    if not options.quick and options.longest not in lengths:
        lengths.append(options.longest)
    for runs in lengths:
        summary, memory = run("no_rows", runs, "--no-rows")
        print(f"worst rank error of a quantile: {worst_rank_error(summary):.2g} of the runs")
        if memory > least + MOST_GROWTH_MIB * len(summary["outputs"]):
            faults.append(f"{runs} runs took {memory:.0f} MiB, {compared} took {least:.0f}")
    with open(out / "rowless.csv", "w", newline="", encoding="utf-8") as table:
        writer = csv.DictWriter(table, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    for fault in faults:
        print(f"fault: {fault}", file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
