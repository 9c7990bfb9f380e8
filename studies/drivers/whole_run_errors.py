"""Measures the integration's errors in every output of a campaign, by one method and another.

    /usr/bin/python3 studies/drivers/whole_run_errors.py                     # studies/campaigns/work_precision.json, 3,000 runs
    /usr/bin/python3 studies/drivers/whole_run_errors.py --runs 30000 taylor:1e-8 dop853:1e-8
    /usr/bin/python3 studies/drivers/whole_run_errors.py --damping 0.5 --t-end 9 --runs 1500
    /usr/bin/python3 studies/drivers/whole_run_errors.py --quick             # seconds; 200 runs, one tolerance

The campaign is run with all its outputs, without its cases and requirements, by each METHOD:RTOL (atol a hundredth of it) and by dop853 at 1e-13, row against
row: RMS and largest error of each kind of output, relative to the output's mean size. Exits 1 if a run's status differs
or an RMS error is above 100 times the tolerance.
"""

import argparse
import collections
import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile

REFERENCE = "dop853:1e-13"
KINDS = ("latch_time", "latch_rate", "peak_moment", "peak_force", "overtravel")


def rows_by(program, campaign, choice, folder):
    """Runs the campaign by a method at a tolerance and returns its rows."""
    method, rtol = choice.split(":")
    integration = campaign.get("integration", {}) | {"method": method, "rtol": float(rtol), "atol": 1e-2 * float(rtol)}
    path = folder / "campaign.json"
    path.write_text(json.dumps(campaign | {"integration": integration}))
    out = folder / choice.replace(":", "_")
    done = subprocess.run([program, "run", path, "--out", out], check=False, stdout=subprocess.DEVNULL)
    if done.returncode not in (0, 3):  # 3: runs failed, whose status tells
        sys.exit(f"{program}: {choice}: exit code {done.returncode}")
    with open(out / "runs.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def errors_of(rows, exact):
    """kind → (RMS, largest, the run of the largest)."""
    found = collections.defaultdict(list)
    for column in exact[0]:
        kind = column.rpartition(".")[2]
        if kind not in KINDS:
            continue
        both = [(k, float(a[column]), float(b[column])) for k, (a, b) in enumerate(zip(rows, exact)) if a[column] and b[column]]
        size = sum(abs(b) for _, _, b in both) / max(len(both), 1)
        if size > 0:
            found[kind] += [(abs(a - b) / size, k) for k, a, b in both]
    return {kind: (math.sqrt(sum(e * e for e, _ in all_of) / len(all_of)), *max(all_of)) for kind, all_of in found.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("choices", nargs="*", metavar="METHOD:RTOL")
    parser.add_argument("--campaign", type=pathlib.Path, default=pathlib.Path("studies/campaigns/work_precision.json"))
    parser.add_argument("--runs", type=int, default=3000)
    parser.add_argument("--damping", type=float, help="of every latch of the scene, N·m·s/rad")
    parser.add_argument("--t-end", type=float)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--program", default="build/release/wingspread")
    args = parser.parse_args()
    tolerances = ("1e-8",) if args.quick else ("1e-6", "1e-8", "1e-9")
    choices = args.choices or [f"{method}:{rtol}" for rtol in tolerances for method in ("dop853", "taylor")]

    campaign = json.loads(args.campaign.read_text())
    scene = json.loads((args.campaign.parent / campaign["scene"]).read_text())
    for hinge in scene["hinges"]:
        if args.damping is not None and "latch" in hinge:
            hinge["latch"]["damping"] = args.damping
    for key in ("outputs", "requirements", "cases"):
        campaign.pop(key, None)
    campaign.setdefault("sampling", {})["runs"] = 200 if args.quick else args.runs
    campaign.setdefault("statistics", {})["accuracy_runs"] = 0
    if args.t_end:
        campaign.setdefault("integration", {})["t_end"] = args.t_end

    faults = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "scene.json").write_text(json.dumps(scene))
        campaign["scene"] = "scene.json"
        exact = rows_by(args.program, campaign, REFERENCE, folder)
        print(f"{len(exact)} runs against {REFERENCE}: RMS and largest error (in run)")
        for choice in choices:
            rows = rows_by(args.program, campaign, choice, folder)
            faults += [f"{choice}: run {k} is {a['status']}" for k, (a, b) in enumerate(zip(rows, exact)) if a["status"] != b["status"]]
            for kind, (rms, largest, run) in errors_of(rows, exact).items():
                print(f"  {choice:14} {kind:12} {rms:8.1e} {largest:8.1e} ({run})")
                if not rms < 100 * float(choice.split(":")[1]):
                    faults.append(f"{choice}: {kind} is {rms:.1e} off")
    print(*faults, sep="\n", end="\n" if faults else "")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
