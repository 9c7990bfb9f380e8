"""Compares runs of random wings at the default tolerance with runs at rtol 1e-10.

    /usr/bin/python3 studies/drivers/strangers_accuracy.py --program build/release/wingspread            # 240 wings, 5 runs each
    /usr/bin/python3 studies/drivers/strangers_accuracy.py --program … --wings 60 --detents              # with narrow steep tables

The wings are those of strangers.py. Of each wing the script takes the largest difference of each kind of output: peaks
relative, latch times in s, latch rates in rad/s, overtravels in rad. It prints the median over the wings, the worst tenth and the
three worst with wing, run and column, and the runs whose status differs; exits 1 if any does. With --detents every hinge's harness has a
rise and fall somewhere on its way, 1e-5 to 1e-2 rad wide, which a step could leap over.
"""

import argparse
import concurrent.futures
import csv
import json
import math
import os
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile

import strangers

KINDS = {"latch_time": False, "latch_rate": False, "overtravel": False, "peak_moment": True, "peak_force": True, "peak_angle": True, "peak_rate": True}


def add_detents(dice, scene):
    """Replaces every harness by one with a detent, whose work is at most a hundredth of the springs'."""
    for hinge in scene["hinges"]:
        stowed, latched = hinge["angle"]["stowed"], hinge["angle"]["latched"]
        spring = hinge["spring"]
        torques = spring.get("measured", {}).get("deploying") or spring.get("table", {}).get("torque") or [spring["torque_latched"]]
        way = latched - stowed
        width = strangers.spread(dice, 1e-5, 1e-2)
        rise = min(torques) * min(0.3, 0.01 * abs(way) / width) * dice.uniform(0.2, 1)
        middle = stowed + way * dice.uniform(0.1, 0.9)
        half = math.copysign(width / 2, way)
        hinge["harness"] = {"table": {"angle": [stowed, middle - half, middle, middle + half, latched], "torque": [0, 0, rise, 0, 0]},
                            "interpolation": dice.choice(["linear", "monotone"])}


def rows(program, campaign, folder, name):
    (folder / f"{name}.json").write_text(json.dumps(campaign))
    done = subprocess.run([program, "run", folder / f"{name}.json", "--out", folder / name, "--threads", "1"], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1, 3):
        sys.exit(f"{folder / name}: exit code {done.returncode}\n{done.stderr}")
    with open(folder / name / "runs.csv", newline="") as file:
        return list(csv.DictReader(file))


def compare(given, index):
    """The largest differences of a wing, by kind: (difference, wing, run, column); and the runs whose status differs."""
    dice = random.Random(f"{given.seed}/{index}")
    scene, _ = strangers.make_scene(dice, f"stranger_{index}")
    if given.detents:
        add_detents(dice, scene)
    campaign = strangers.make_campaign(scene, given.runs, given.seed)
    with tempfile.TemporaryDirectory() as scratch:
        usual = rows(given.program, campaign, pathlib.Path(scratch), "usual")
        campaign["integration"].update(rtol=1e-10, atol=1e-13)
        fine = rows(given.program, campaign, pathlib.Path(scratch), "fine")
    worst, differing = {}, []
    for number, (one, exact) in enumerate(zip(usual, fine, strict=True)):
        if one["status"] != exact["status"]:
            differing.append(f"wing {index} run {number}: {one['status']}, at 1e-10 {exact['status']}")
            continue
        for column, text in one.items():
            kind = column.rsplit(".", 1)[-1]
            if kind not in KINDS or not text or not exact[column]:
                continue
            value, right = float(text), float(exact[column])
            off = abs(value - right) / (abs(right) if KINDS[kind] and right else 1)
            worst[kind] = max(worst.get(kind, (0, 0, 0, "")), (off, index, number, column))
    return worst, differing


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/wingspread", type=lambda path: pathlib.Path(path).resolve())
    parser.add_argument("--wings", type=int, default=240)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--detents", action="store_true")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    given = parser.parse_args()
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        found = list(pool.map(lambda index: compare(given, index), range(given.wings)))
    print(f"{'':12} {'wings':>5} {'median':>8} {'tenth':>8}  worst: wing, run, column")
    for kind in KINDS:
        ordered = sorted((worst[kind] for worst, _ in found if kind in worst), reverse=True)
        if not ordered:
            continue
        middle, tenth = statistics.median(one[0] for one in ordered), ordered[len(ordered) // 10][0]
        three = "   ".join(f"{off:.1e}: {wing}, {run}, {column}" for off, wing, run, column in ordered[:3])
        print(f"{kind:12} {len(ordered):5} {middle:8.1e} {tenth:8.1e}  {three}")
    differing = [line for _, lines in found for line in lines]
    print(*differing, sep="\n")
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
