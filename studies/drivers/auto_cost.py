#!/usr/bin/python3
"""What `auto` costs against the cheapest method, on random wings with stiff dampers, latches of 1e4 … 1e9 N·m/rad and loops.

    studies/drivers/auto_cost.py PROGRAM [--wings 300] [--first 0]

Every wing is simulated to 20 s by dop853, seulex and auto at the default tolerances. The cost of a run is its
evaluations, where those of seulex count 1.5 (a solve beside each). Prints the distribution of auto's cost over
that of the cheaper of the two, and the worst wings.
"""
import argparse
import json
import math
import random
import subprocess
import sys
import tempfile

IMPLICIT_COST = 1.5  # of an evaluation with its solve, made alone
EVALUATIONS = 32  # of a step of seulex on these wings, to share those of a run with two methods
SECONDS = 5  # of a run: what takes longer counts as failed


def wing(seed):
    draws = random.Random(seed)

    def log_uniform(low, high):
        return math.exp(draws.uniform(math.log(low), math.log(high)))

    count, half, mass = draws.choice([1, 2, 2, 3, 3, 4]), draws.uniform(0.3, 1), log_uniform(0.02, 20)
    base = {"motion": draws.choice(["fixed", "fixed", "free"])}
    if base["motion"] == "free":
        base.update(mass=log_uniform(50, 2000), inertia=log_uniform(50, 2000), rate=draws.uniform(-0.01, 0.01))
    bodies, hinges = [], []
    for i in range(count):
        m = mass * draws.uniform(0.5, 2)
        bodies.append({"name": f"b{i}", "mass": m, "inertia": m * half**2 / 3 * draws.uniform(0.8, 1.2)})
    for i in range(count):
        inertia = 4 * bodies[i]["inertia"]
        torque, stiffness = 2 * inertia * log_uniform(0.3, 3), log_uniform(1e4, 1e9)
        hinge = {
            "name": f"h{i}", "parent": "base" if i == 0 else f"b{i - 1}", "child": f"b{i}",
            "parent_point": [0.3 if i == 0 else half, 0], "child_point": [-half, 0.01],
            "angle": {"stowed": (-1) ** i * (math.pi / 2 if i == 0 else math.pi), "latched": 0},
            "spring": {"torque_stowed": torque, "torque_latched": torque * draws.uniform(0.4, 0.9)},
            "latch": {"stiffness": stiffness, "damping": 2 * log_uniform(0.01, 10) * math.sqrt(stiffness * inertia)},
        }
        kind = draws.random()
        if kind < 0.25:
            hinge["damper"] = {"law": "eddy_current", "peak_torque": torque * draws.uniform(0.2, 0.7),
                               "peak_rate": log_uniform(0.003, 1)}
        elif kind < 0.45:
            hinge["damper"] = {"law": "power", "coefficient": torque * draws.uniform(0.2, 0.8),
                               "exponent": draws.uniform(0.3, 1.5), "regularization_rate": log_uniform(1e-5, 1e-2)}
        elif kind < 0.6:
            hinge["damper"] = {"law": "viscous", "coefficient": torque * log_uniform(0.3, 30)}
        friction = draws.random()
        if friction < 0.3:
            hinge["friction"] = {"model": "exact", "coulomb": torque * 0.05, "static": torque * 0.06}
        elif friction < 0.4:
            hinge["friction"] = {"coulomb": torque * 0.05, "regularization_rate": 1e-3}
        hinges.append(hinge)
    scene = {"name": f"wing_{seed}", "base": base, "bodies": bodies, "hinges": hinges}
    if count > 1 and draws.random() < 0.4:
        first, stiffness = draws.randrange(count - 1), log_uniform(100, 1e6)
        loop = {"name": "loop", "between": [f"h{first}", f"h{first + 1}"], "ratio": 2 if first == 0 else 1,
                "stiffness": stiffness}
        loop["damping"] = 2 * log_uniform(0.001, 1) * math.sqrt(stiffness * bodies[first]["inertia"])
        if draws.random() < 0.5:
            loop["preload"] = log_uniform(1, 50)
        scene["synchronisations"] = [loop]
    return scene


def cost(program, path, method):
    """Of a run; none if it fails."""
    command = [program, "simulate", path, "--json", "--method", method, "--t-end", "20"]
    try:
        run = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS, check=False)
    except subprocess.TimeoutExpired:
        return None
    if run.returncode not in (0, 3):  # 3: the run failed
        sys.exit(f"{' '.join(command)}: exit code {run.returncode}\n{run.stderr}")
    outcome = json.loads(run.stdout)
    if outcome["status"] == "failed":
        return None
    evaluations = outcome["work"]["rhs_evaluations"]
    steps = {phase["method"]: 0 for phase in outcome["phases"]}
    for phase in outcome["phases"]:
        steps[phase["method"]] += phase["steps"]
    implicit = evaluations if list(steps) == ["seulex"] else min(evaluations, EVALUATIONS * steps.get("seulex", 0))
    return evaluations + (IMPLICIT_COST - 1) * implicit


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--wings", type=int, default=300)
    parser.add_argument("--first", type=int, default=0)
    options = parser.parse_args()
    ratios, failed = [], []
    for seed in range(options.first, options.first + options.wings):
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            json.dump(wing(seed), file)
            file.flush()
            by_name, chosen = (cost(options.program, file.name, m) for m in ("dop853", "seulex")), None
            least = min((c for c in by_name if c is not None), default=None)
            chosen = cost(options.program, file.name, "auto")
        if chosen is None:
            failed.append((seed, least))
        elif least is not None:
            ratios.append((chosen / least, seed))
    if not ratios:
        sys.exit(f"no wing reaches its end within {SECONDS} s by auto and another method")
    ratios.sort()
    shares = ", ".join(f"{p} % {ratios[min(len(ratios) - 1, len(ratios) * p // 100)][0]:.2f}" for p in (50, 90, 95, 99))
    print(f"auto's cost over the cheapest: {shares}, largest {ratios[-1][0]:.2f}")
    print(f"above 1.75: {sum(r > 1.75 for r, _ in ratios)} of {len(ratios)}")
    print("worst wings: " + ", ".join(f"{seed} ({ratio:.2f})" for ratio, seed in ratios[:-6:-1]))
    print(f"auto fails on {len(failed)}, of which another method reaches the end on {sum(c is not None for _, c in failed)}")


if __name__ == "__main__":
    main()
