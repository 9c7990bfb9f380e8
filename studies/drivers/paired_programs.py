"""Runs two or more programs in turn on the same campaigns. Prints processor time a run, and the last program's speed over the first's.

    /usr/bin/python3 studies/drivers/paired_programs.py before/wingspread build/release/wingspread
    /usr/bin/python3 studies/drivers/paired_programs.py --pairs 9 --campaigns seed yoke_wing -- before/wingspread build/release/wingspread
    /usr/bin/python3 studies/drivers/paired_programs.py --quick build/release/wingspread build/release/wingspread   # seconds

One thread, all outputs, default accuracy, no runs repeated for accuracy; yoke_wing's case "ambient". The user time of a campaign of 5/4 N runs minus
the user time of N/4 runs excludes the start and end of a program, and includes statistics and rows. Ratios compare neighbours in time; the
table has their median and the range of the middle half. Exits 1 if a program fails.
"""

import argparse
import json
import pathlib
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile

RUNS = {
    "seed": 4000,
    "work_precision": 8000,
    "work_precision_rubbing": 4000,
    "work_precision_sticking": 3000,
    "stall": 3000,
    "prescribed_base": 2000,
    "two_wing_free": 600,
    "satellite": 600,
    "yoke_wing": 600,
    "two_wing_release": 100,
    "bending_wings": 100,
}


def user_seconds(program, campaign, runs, folder):
    """User time of the whole program, s; its results are deleted."""
    out = pathlib.Path(folder) / "out"
    options = ["--case", "ambient"] if campaign.stem == "yoke_wing" else []
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run(
        [program, "run", campaign, "--runs", str(runs), "--threads", "1", "--out", out, *options],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    taken = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    if done.returncode not in (0, 1):  # 1: a requirement is not met
        sys.exit(f"{program}: {campaign}: exit code {done.returncode}\n{done.stderr}")
    shutil.rmtree(out)
    return taken


def without_repeats(campaign, folder):
    """The campaign with no runs repeated for accuracy, beside its scene and tables."""
    data = json.loads(campaign.read_text(encoding="utf-8"))
    data["scene"] = str((campaign.parent / data["scene"]).resolve())
    data.setdefault("statistics", {})["accuracy_runs"] = 0
    path = pathlib.Path(folder) / campaign.name
    path.write_text(json.dumps(data), encoding="utf-8")
    return path


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", nargs="+", help="paths; the last is compared with the first")
    parser.add_argument("--campaigns", nargs="+", default=list(RUNS), choices=list(RUNS), metavar="NAME")
    parser.add_argument("--pairs", type=int, default=5)
    parser.add_argument("--untouched", action="store_true", help="the campaigns as they are, for programs that repeat no runs")
    parser.add_argument("--quick", action="store_true", help="one pair of the seed campaign, 200 runs")
    args = parser.parse_args()
    for program in args.programs:
        if not shutil.which(program):
            parser.error(f"{program}: no program is there")
    names, pairs = (["seed"], 1) if args.quick else (args.campaigns, args.pairs)

    print("| campaign | runs | " + " | ".join(f"{program}, us a run" for program in args.programs) + " | faster | middle half |")
    print("|---" * (4 + len(args.programs)) + "|")
    for name in names:
        runs = 200 if args.quick else RUNS[name]
        with tempfile.TemporaryDirectory() as folder:
            campaign = pathlib.Path("studies/campaigns") / f"{name}.json"
            if not args.untouched:
                campaign = without_repeats(campaign, folder)
            times = [
                [
                    (user_seconds(p, campaign, runs + runs // 4, folder) - user_seconds(p, campaign, runs // 4, folder)) / runs
                    for p in args.programs
                ]
                for _ in range(pairs)
            ]
        ratios = sorted(row[0] / row[-1] for row in times)
        middle = ratios[len(ratios) // 4], ratios[-1 - len(ratios) // 4]
        medians = (f"{1e6 * statistics.median(column):.1f}" for column in zip(*times))
        print(
            f"| {name} | {runs} | "
            + " | ".join(medians)
            + f" | {statistics.median(ratios):.2f} | {middle[0]:.2f} to {middle[1]:.2f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
