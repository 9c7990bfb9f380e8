"""Measures the speed of campaigns on wings that the program was not tuned to.

    /usr/bin/python3 studies/drivers/strangers.py --program build/release/wingspread              # 60 wings of seed 1
    /usr/bin/python3 studies/drivers/strangers.py --program … --wings 10 --seed 7 --keep DIR      # their files and results stay
    /usr/bin/python3 studies/drivers/strangers.py --program … --releases start                    # what holds cost

Draws realistic wings: one or two, with a yoke or without, 2 to 6 panels, on fixed, free and turning bases; linear, tabulated and
measured springs, harnesses, each damper, loops with and without slack, stops, exact and regularized friction, latches of 1e2 to
1e5 N·m/rad, panels of 0.1 to 50 kg. Each becomes a campaign of 200 draws with all outputs, run on one thread in packs and one run at a time
(--lanes 1). The script prints runs a second, the ratio, the share that deploys, evaluations of the nominal run, and the share of the time that is
spent outside the lanes with its three largest causes (timing.json has all); then the median, the worst tenth and the worst. The results of packs and of single runs must be
the same bytes, and no run may fail: if not, it says so and exits 1.

With --releases it measures instead what holds cost: the user time of each wing's packs with releases over that without, by turns, the
best of three. "start": every hinge is let go at t = 0, which changes no motion. "sequence": each hinge but the first is let go once the
one inward of it has turned by a tenth of its way: another motion, so the ratio of the evaluations of all runs (by replay) stands beside,
and the ratio of the two: what an evaluation costs more. Wings have no loops then, which would hold what waits.
"""

import argparse
import json
import math
import pathlib
import random
import resource
import statistics
import subprocess
import sys
import tempfile

OUTPUTS = ["latch_time", "latch_rate", "peak_moment", "peak_force", "rate_at", "overtravel", "base_motion"]
BASES = ("fixed", "free", "turning", "prescribed")


def spread(dice, low, high):
    """A number between low and high, even in its logarithm."""
    return math.exp(dice.uniform(math.log(low), math.log(high)))


def rounded(value):
    return float(f"{value:.6g}")


def falling(dice, stowed, at_stowed, at_latched, knots):
    """Angles from stowed to 0 and torques between two values, monotone."""
    shares = [0.0] + sorted(dice.uniform(0.1, 0.9) for _ in range(knots - 2)) + [1.0]
    angles = [rounded(stowed * (1 - s)) for s in shares]
    return angles, [at_stowed + (at_latched - at_stowed) * s ** dice.uniform(0.8, 1.3) for s in shares]


def make_spring(dice, kind, stowed, torque):
    ends = torque, torque * dice.uniform(0.6, 0.95)
    if kind == "linear":
        return {"torque_stowed": rounded(ends[0]), "torque_latched": rounded(ends[1])}
    angles, values = falling(dice, stowed, *ends, dice.randint(3, 6))
    if kind == "table":
        return {"table": {"angle": angles, "torque": [rounded(v) for v in values]}}
    loss = dice.uniform(0.03, 0.08)
    return {"measured": {"angle": angles, "deploying": [rounded(v * (1 - loss)) for v in values],
                         "stowing": [rounded(v * (1 + loss)) for v in values]}}


def make_damper(dice, kind, torque, rate):
    """A damper whose torque is some share of the spring's at the rate that the hinge reaches."""
    share = dice.uniform(0.1, 0.5) * torque
    if kind == "viscous":
        return {"law": "viscous", "coefficient": rounded(share / rate)}
    if kind == "power":
        power = dice.uniform(0.6, 1.6)
        return {"law": "power", "coefficient": rounded(share / rate**power), "exponent": rounded(power), "regularization_rate": 1e-3}
    return {"law": "eddy_current", "peak_torque": rounded(2 * share), "peak_rate": rounded(rate * dice.uniform(1.5, 4))}


def make_wing(dice, scene, side, name, style):
    """Adds one folded wing to the scene, to the right (side 1) or to the left (−1)."""
    panels, length, mass, duration = style["panels"], style["length"], style["mass"], style["duration"]
    lengths = ([length * style["yoke"]] if style["yoke"] else []) + [length] * panels
    masses = ([mass * 0.35] if style["yoke"] else []) + [mass * dice.uniform(0.9, 1.1) for _ in range(panels)]
    thickness = length * dice.uniform(0.01, 0.03)
    names = ([f"{name}yoke"] if style["yoke"] else []) + [f"{name}panel_{k + 1}" for k in range(panels)]
    parent, hinges = "base", []
    for k, body in enumerate(names):
        half, m = lengths[k] / 2, masses[k]
        inertia = m * ((2 * half) ** 2 + thickness**2) / 12
        scene["bodies"].append({"name": body, "mass": rounded(m), "inertia": rounded(inertia)})
        stowed = side * (math.pi / 2 if k == 0 else math.pi * (-1 if k % 2 else 1))
        # what hangs outside this hinge, folded, turns with it: a torque that opens it in about the wing's duration
        outer = sum(masses[k:])
        about = inertia + m * half**2 + (outer - m) * (half**2 if k else (2 * half) ** 2)
        torque = style["strength"] * 2 * about * abs(stowed) / duration**2
        rate = 2 * abs(stowed) / duration
        offset = 0 if k == 0 else (thickness / 2) * (-1 if k % 2 else 1)
        at_parent = [side * style["half_base"], 0] if k == 0 else [side * lengths[k - 1] / 2, offset]
        hinge = {"name": f"{name}h{k}", "parent": parent, "child": body, "parent_point": [rounded(v) for v in at_parent],
                 "child_point": [rounded(-side * half), rounded(offset)], "angle": {"stowed": rounded(stowed), "latched": 0},
                 "spring": make_spring(dice, style["spring"], rounded(stowed), torque)}
        if style["harness"]:
            angles, values = falling(dice, rounded(stowed), 0.05 * torque, dice.uniform(0.1, 0.25) * torque, 4)
            hinge["harness"] = {"table": {"angle": angles, "torque": [rounded(v) for v in values]}}
        coulomb = dice.uniform(0.02, 0.12) * torque
        hinge["friction"] = {"model": style["friction"], "coulomb": rounded(coulomb)}
        if style["friction"] == "exact":
            hinge["friction"]["static"] = rounded(coulomb * dice.choice([1, 1.2, 1.5]))
        else:
            hinge["friction"]["regularization_rate"] = rounded(rate * spread(dice, 1e-3, 1e-2))
        if style["damper"] and (k == 0 or dice.random() < 0.3):
            hinge["damper"] = make_damper(dice, style["damper"], torque, rate)
        stiffness = style["latch"] * dice.uniform(0.7, 1.4)
        if style["stop"]:
            hinge["stop"] = {"stiffness": rounded(stiffness * 0.3), "dissipation": rounded(dice.uniform(0.1, 0.6))}
        ratio = dice.uniform(0.01, 0.1)
        hinge["latch"] = {"stiffness": rounded(stiffness), "damping": rounded(2 * ratio * math.sqrt(stiffness * about))}
        hinges.append(hinge)
        parent = body
    scene["hinges"] += hinges
    if style["loops"]:
        for k in range(len(hinges) - 1):
            turns = abs(hinges[k + 1]["angle"]["stowed"] / hinges[k]["angle"]["stowed"])
            loop = {"name": f"{name}loop{k}", "between": [hinges[k]["name"], hinges[k + 1]["name"]], "ratio": rounded(turns),
                    "stiffness": rounded(style["latch"] * spread(dice, 1e-3, 1e-1))}
            loop["damping"] = rounded(loop["stiffness"] * spread(dice, 3e-3, 3e-2))
            if style["loops"] == "slack":
                loop["preload"] = rounded(dice.uniform(0.02, 0.3) * style["strength"] * style["mass"] * style["length"] ** 2 / style["duration"] ** 2)
            scene["synchronisations"].append(loop)


def make_scene(dice, name):
    style = {"panels": dice.randint(2, 6), "length": spread(dice, 0.2, 2.5), "yoke": dice.choice([0, 0.4, 0.7]), "duration": spread(dice, 2, 12),
             "mass": spread(dice, 0.1, 50), "strength": dice.uniform(1.2, 2.5), "spring": dice.choice(["linear", "table", "measured"]),
             "harness": dice.random() < 0.6, "friction": dice.choice(["exact", "exact", "regularized"]),
             "damper": dice.choice([None, "viscous", "power", "eddy_current"]), "stop": dice.random() < 0.5,
             "latch": spread(dice, 1e2, 1e5), "loops": dice.choice([None, None, "plain", "slack"])}
    wings = dice.choice([1, 1, 2])
    mass = wings * style["panels"] * style["mass"]
    base_mass = mass * spread(dice, 2, 20)
    style["half_base"] = style["length"] * dice.uniform(0.3, 0.8)
    motion = dice.choice(BASES)
    base = {"motion": {"turning": "free"}.get(motion, motion)}
    if base["motion"] == "free":
        base |= {"mass": rounded(base_mass), "inertia": rounded(base_mass * style["half_base"] ** 2 / 1.5)}
        if motion == "turning":
            base["rate"] = rounded(dice.choice([-1, 1]) * spread(dice, 1e-3, 5e-2))
    if motion == "prescribed":
        base |= {"rate": rounded(dice.uniform(-0.02, 0.02)), "angular_acceleration": rounded(dice.uniform(-1e-3, 1e-3))}
    scene = {"name": name, "base": base, "bodies": [], "hinges": [], "synchronisations": []}
    for side, prefix in ((1, "R_"), (-1, "L_"))[:wings]:
        make_wing(dice, scene, side, prefix, style)
    if not scene["synchronisations"]:
        del scene["synchronisations"]
    words = [motion, f"{wings}×{'yoke+' if style['yoke'] else ''}{style['panels']}", style["spring"], style["friction"], style["damper"] or "no damper"]
    words += [f"loops {style['loops']}"] if style["loops"] else []
    words += ["stops"] if style["stop"] else []
    return scene, ", ".join(words)


def make_campaign(scene, runs, seed):
    normal = {"type": "normal", "mean": 1, "std": 0.05, "truncate": {"lower": 0.8, "upper": 1.2}}
    dispersions = [{"name": "spring", "distribution": normal, "apply": "scale", "each": "hinges.*.spring.scale"},
                   {"name": "friction", "distribution": {"type": "lognormal", "mu_log": 0, "sigma_log": 0.25}, "apply": "scale",
                    "each": "hinges.*.friction.scale"},
                   {"name": "mass", "distribution": {"type": "normal", "mean": 1, "std": 0.01}, "apply": "scale", "each": "bodies.*.mass"},
                   {"name": "latch", "distribution": normal, "apply": "scale", "each": "hinges.*.latch.stiffness"}]
    outputs = [o for o in OUTPUTS if o != "base_motion" or scene["base"]["motion"] == "free"]
    if any("release" in hinge for hinge in scene["hinges"]):
        outputs.append("hold_moment")
    return {"scene": scene, "dispersions": dispersions, "sampling": {"design": "random", "runs": runs, "seed": seed},
            "integration": {"t_end": 60}, "outputs": outputs, "statistics": {"accuracy_runs": 0}}


def with_releases(scene, kind):
    """The scene with every hinge held until t = 0 ("start"), or until the one inward of it has turned ("sequence")."""
    scene = json.loads(json.dumps(scene))
    inward = {hinge["child"]: hinge for hinge in scene["hinges"]}
    for hinge in scene["hinges"]:
        before = inward.get(hinge["parent"])
        if kind == "start":
            hinge["release"] = {"time": 0}
        elif before:
            tenth = 0.1 * abs(before["angle"]["stowed"] - before["angle"]["latched"])
            hinge["release"] = {"after": before["name"], "event": {"angle": rounded(tenth)}}
    return scene


def user_seconds(function):
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    result = function()
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before, result


def compare_releases(given, scratch):
    """Prints each wing's cost with releases over that without. @return whether no run failed"""
    print(f"{'':4} {'time':>6} {'evaluations':>11} {'time each':>9} {'deployed':>18}", flush=True)
    times, each, failed = [], [], 0
    for index in given.only or range(given.wings):
        scene, words = make_scene(random.Random(f"{given.seed}/{index}"), f"stranger_{index}")
        if given.releases == "sequence":
            scene.pop("synchronisations", None)
        best, share, evaluations = [math.inf, math.inf], [0, 0], [0, 0]
        for turn in range(6):
            k = turn % 2
            folder = pathlib.Path(scratch) / f"{index}_{turn}"
            folder.mkdir(parents=True)
            campaign = make_campaign(with_releases(scene, given.releases) if k else scene, given.runs, given.seed)
            (folder / "campaign.json").write_text(json.dumps(campaign))
            seconds, (_, summary) = user_seconds(lambda f=folder: run(given.program, f / "campaign.json", f / "out", *given.options))
            best[k] = min(best[k], seconds)
            share[k] = summary["status"]["deployed"]["count"] / summary["runs"]
            failed += summary["status"]["failed"]["count"]
            evaluations[k] = evaluations[k] or sum(evaluations_of_run(given.program, folder / "out", r) for r in range(given.runs))
        times.append(best[1] / best[0])
        each.append(times[-1] * evaluations[0] / evaluations[1])
        print(f"{index:4} {times[-1]:6.3f} {times[-1] / each[-1]:11.3f} {each[-1]:9.3f} {share[0]:8.2f} {share[1]:9.2f}   {words}", flush=True)
    for name, ratios in (("time with releases over without", times), ("time of an evaluation", each)):
        print(f"{name:32} median {statistics.median(ratios):.3f}, least {min(ratios):.3f}, largest {max(ratios):.3f}")
    return failed == 0


def run(program, campaign, out, *options):
    done = subprocess.run([program, "run", campaign, "--out", out, "--threads", "1", *options], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1, 3):
        sys.exit(f"{campaign}: exit code {done.returncode}\n{done.stderr}")
    return json.loads((out / "timing.json").read_text()), json.loads((out / "summary.json").read_text())


def rows(folder):
    return (folder / "runs.csv").read_bytes()


def evaluations_of_run(program, results, number):
    done = subprocess.run([program, "replay", results, "--run", str(number), "--json"], capture_output=True, text=True, check=False)
    return json.loads(done.stdout)["work"]["rhs_evaluations"]


def evaluations_of_nominal(program, campaign):
    done = subprocess.run([program, "simulate", campaign, "--json"], capture_output=True, text=True, check=False)
    return json.loads(done.stdout)["work"]["rhs_evaluations"]


def measure(program, folder, index, given):
    scene, words = make_scene(random.Random(f"{given.seed}/{index}"), f"stranger_{index}")
    folder.mkdir(parents=True, exist_ok=True)
    campaign = folder / "campaign.json"
    campaign.write_text(json.dumps(make_campaign(scene, given.runs, given.seed), indent=1))
    packs, summary = run(program, campaign, folder / "packs", *given.options)
    alone, _ = run(program, campaign, folder / "alone", "--lanes", "1", *(o for o in given.options if not o.startswith("--isa")))
    return {"words": words, "packs": packs, "alone": alone, "summary": summary, "same": rows(folder / "packs") == rows(folder / "alone"),
            "evaluations": evaluations_of_nominal(program, campaign)}


def print_summary(name, values, digits):
    """The median, the worst tenth and the worst: the least values."""
    ordered = sorted(values)
    tenth = ordered[max(0, math.ceil(len(ordered) / 10) - 1)]
    print(f"{name:28} median {statistics.median(ordered):9.{digits}f}   worst tenth {tenth:9.{digits}f}   worst {ordered[0]:9.{digits}f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/wingspread")
    parser.add_argument("--wings", type=int, default=60)
    parser.add_argument("--only", type=int, nargs="+", metavar="INDEX", help="these wings alone")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--runs", type=int, default=200)
    parser.add_argument("--keep", metavar="DIR", help="scenes and results stay here")
    parser.add_argument("--options", nargs="+", default=[], metavar="OPTION", help="passed on to every run, e.g. --options=--isa=avx2")
    parser.add_argument("--releases", choices=("start", "sequence"), help="measure what holds cost")
    given = parser.parse_args()
    if any(option.startswith("--lanes") for option in given.options):
        parser.error("--options: found --lanes, which the comparison sets itself")
    found = []
    with tempfile.TemporaryDirectory() as scratch:
        if given.releases:
            return 0 if compare_releases(given, scratch) else 1
        print(f"{'':4} {'runs/s':>8} {'packs/alone':>11} {'deployed':>8} {'evaluations':>11} {'outside':>8}", flush=True)
        for index in given.only or range(given.wings):
            one = measure(given.program, pathlib.Path(given.keep or scratch) / str(index), index, given)
            fast, slow = one["packs"]["runs_per_second"], one["alone"]["runs_per_second"]
            status = one["summary"]["status"]
            deployed = status["deployed"]["count"] / one["summary"]["runs"]
            failed = f"   {status['failed']['count']} FAILED" if status["failed"]["count"] else ""
            causes = one["packs"]["outside_lanes"] or {"method": 1.0}
            outside = sum(causes.values())
            largest = ", ".join(f"{name} {share:.0%}" for name, share in sorted(causes.items(), key=lambda c: -c[1])[:3])
            print(f"{index:4} {fast:8.0f} {fast / slow:11.2f} {deployed:8.2f} {one['evaluations']:11.0f} {outside:8.0%}   {one['words']}"
                  f" | {largest}{failed}{'' if one['same'] else '   DIFFERENT BYTES'}", flush=True)
            found.append({"runs": fast, "ratio": fast / slow, "within": 1 - outside, "good": one["same"] and not failed})
    print()
    print_summary("runs a second of one core", [one["runs"] for one in found], 0)
    print_summary("packs over one at a time", [one["ratio"] for one in found], 2)
    print_summary("share of the time in lanes", [one["within"] for one in found], 2)
    return 0 if all(one["good"] for one in found) else 1


if __name__ == "__main__":
    sys.exit(main())
