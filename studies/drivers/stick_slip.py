"""Looks for wings whose hinges stick and slip without end: what does τ_s = τ_c cost?

    /usr/bin/python3 studies/drivers/stick_slip.py --program build/release/wingspread --wings 2000
    /usr/bin/python3 studies/drivers/stick_slip.py --program … --wings 50 --seed 3 --rtol 1e-6 --keep DIR    # the worst scenes stay
    /usr/bin/python3 studies/drivers/stick_slip.py --program … --wings 500 --loops                           # hinges in loops

Draws wings of one to four bodies with exact friction, on fixed and free bases, with latches from lightly damped to overdamped and, of some, stops,
dampers and gravity; with --loops damped loops tie neighbours, and half of the wings have a last hinge that is never let go. Each is simulated with the static level equal to the kinetic one, where an overdamped latched hinge creeps to where its load is the
limit, and with a static level of 1.2 times that. Prints the ratio of the evaluations: the median, the worst hundredth and the worst wings.
Exits 1 if a run fails or a ratio exceeds 20.
"""

import argparse
import concurrent.futures
import copy
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile

MOST = 20


def spread(dice, low, high):
    return math.exp(dice.uniform(math.log(low), math.log(high)))


def make_scene(dice):
    bodies, hinges, parent, lever = [], [], "base", [dice.uniform(-0.3, 0.3), dice.uniform(-0.1, 0.1)]
    for k in range(dice.randint(1, 4)):
        length, mass = dice.uniform(0.3, 1.5), spread(dice, 0.3, 20)
        inertia = mass * length**2 / 12
        bodies.append({"name": f"b{k}", "mass": mass, "inertia": inertia})
        torque = spread(dice, 0.2, 5)
        stiffness = spread(dice, 1e3, 1e6)
        critical = 2 * math.sqrt(stiffness * inertia)
        hinge = {"name": f"h{k}", "parent": parent, "child": f"b{k}", "parent_point": lever,
                 "child_point": [-length / 2, dice.uniform(-0.03, 0.03)],
                 "angle": {"stowed": (math.pi if k else math.pi / 2) * (1 if k % 2 == 0 else -1), "latched": 0},
                 "spring": {"torque_stowed": torque, "torque_latched": torque * dice.uniform(0.6, 1)},
                 "latch": {"stiffness": stiffness, "damping": critical * spread(dice, 1e-3, 30)},
                 "friction": {"model": "exact", "coulomb": torque * dice.uniform(0.03, 0.4)}}
        if dice.random() < 0.3:
            hinge["stop"] = {"stiffness": stiffness * dice.uniform(0.1, 1), "dissipation": dice.uniform(0, 1)}
        if dice.random() < 0.3:
            hinge["damper"] = {"law": "viscous", "coefficient": torque * spread(dice, 0.03, 3)}
        hinges.append(hinge)
        parent, lever = f"b{k}", [length / 2, dice.uniform(-0.03, 0.03)]
    scene = {"name": "stick_slip", "base": {"motion": "fixed"}, "bodies": bodies, "hinges": hinges}
    if dice.random() < 0.75:
        mass = spread(dice, 1, 300)
        scene["base"] = {"motion": "free", "mass": mass, "inertia": mass * dice.uniform(0.02, 1), "angle": dice.uniform(-1, 1),
                         "rate": dice.choice([0, 0, dice.uniform(-0.05, 0.05)]), "velocity": [dice.uniform(-0.3, 0.3), dice.uniform(-0.3, 0.3)]}
    elif dice.random() < 0.4:
        scene["environment"] = {"gravity": [0, -dice.uniform(0.05, 1)]}
    return scene


def tie(dice, scene):
    """Ties neighbours by loops whose strands are damped, and may hold the last hinge for good."""
    hinges = scene["hinges"]
    loops = scene["synchronisations"] = []
    for first, second in zip(hinges, hinges[1:]):
        stiffness = spread(dice, 1, 1e4)
        ratio = abs(second["angle"]["stowed"] / first["angle"]["stowed"])
        loops.append({"name": f"loop_{second['name']}", "between": [first["name"], second["name"]], "ratio": ratio,
                      "stiffness": stiffness, "damping": stiffness * spread(dice, 1e-2, 1)})
    if dice.random() < 0.5:
        hinges[-1]["release"] = {"time": 0, "fails": 1}
    return scene


def simulate(given, scene, folder):
    path = folder / "scene.json"
    path.write_text(json.dumps(scene))
    done = subprocess.run([given.program, "simulate", path, "--json", "--rtol", str(given.rtol), "--t-end", str(given.t_end)], capture_output=True, text=True,
                          check=False)
    if done.returncode not in (0, 3):
        sys.exit(f"{path}: exit code {done.returncode}\n{done.stderr}")
    found = json.loads(done.stdout)
    return found["status"], found["work"]["rhs_evaluations"]


def measure(given, index):
    dice = random.Random(f"{given.seed}/{index}")
    scene = make_scene(dice)
    if given.loops:
        scene = tie(dice, scene)
    easy = copy.deepcopy(scene)
    for hinge in easy["hinges"]:
        hinge["friction"]["static"] = 1.2 * hinge["friction"]["coulomb"]
    with tempfile.TemporaryDirectory() as scratch:
        status, evaluations = simulate(given, scene, pathlib.Path(scratch))
        easy_status, usual = simulate(given, easy, pathlib.Path(scratch))
    return index, "failed" if "failed" in (status, easy_status) else status, evaluations, evaluations / usual, scene


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/wingspread")
    parser.add_argument("--wings", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--rtol", type=float, default=1e-8)
    parser.add_argument("--t-end", type=float, default=20)
    parser.add_argument("--loops", action="store_true")
    parser.add_argument("--keep", metavar="DIR", help="the ten worst scenes are written there")
    given = parser.parse_args()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        found = sorted(pool.map(lambda index: measure(given, index), range(given.wings)), key=lambda one: one[3])
    failed = [one for one in found if one[1] == "failed"]
    print(f"{len(found)} wings at rtol {given.rtol:g}: {len(failed)} failed; evaluations over those with a static level of 1.2: "
          f"median {found[len(found) // 2][3]:.2f}, worst hundredth {found[len(found) * 99 // 100][3]:.2f}, worst {found[-1][3]:.2f}")
    for index, status, evaluations, ratio, scene in found[-10:]:
        print(f"  {index:5} {status:10} {evaluations:10} evaluations, {ratio:8.2f} times")
        if given.keep:
            pathlib.Path(given.keep).mkdir(parents=True, exist_ok=True)
            (pathlib.Path(given.keep) / f"{index}.json").write_text(json.dumps(scene, indent=1))
    return 1 if failed or found[-1][3] > MOST else 0


if __name__ == "__main__":
    sys.exit(main())
