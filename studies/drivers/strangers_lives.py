"""Whether methods agree, and runs in lanes with runs alone, on random wings that live a whole life.

    /usr/bin/python3 studies/drivers/strangers_lives.py --program build/release/wingspread               # 40 wings
    /usr/bin/python3 studies/drivers/strangers_lives.py --program … --wings 300 --seed 9 --keep DIR      # their scenes stay
    /usr/bin/python3 studies/drivers/strangers_lives.py --program … --wings 200 --mirrored               # left against right

Draws the wings of strangers.py, and gives them what they lack: rigid and elastic holds, releases in sequence, latches that
miss a pass or let go, backlash, dissipation, motors, stops on both sides and panels that bend. Each is simulated by auto,
by dopri5 at a tenth of the tolerance, and by seulex; and as a campaign of 12 draws, in lanes and one run at a time.

It reports a run that fails (of auto and of the campaign), an event recorded twice within 1e-9 s, a latch that lets go
unengaged, events that another method lacks or has at another time, and peaks that differ by more than 3e-4. Wings whose
events have moved apart by more than 1e-6 s are chaotic: what follows is not compared. A run of more than 60 s is left out
("–" in place of its evaluations), and dopri5 may give up, for many of these wings are stiff. Rattling wings (backlash) move
peaks: look at those with `simulate --check`. Exits 1 if it reports anything.

With --mirrored each wing is the right one of two on a free base at rest, and the key "mirror" makes the left one. Events
and peaks of the left wing must be those of the right one, by each method; there are no campaigns then.
"""

import argparse
import json
import pathlib
import random
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
from strangers import make_campaign, make_scene, rounded, spread

METHODS = (("auto", 1e-8), ("dopri5", 1e-9), ("seulex", 1e-8))
KINDS = ("latches", "releases", "missed", "let_go")
PEAKS = ("peak_moment", "peak_force", "hold_moment")
PATIENCE = 60  # s of one run
CHAOTIC = 1e-6  # s


def make_release(dice, hinge, inward):
    """A release by time, or by an event of the hinge inward of it."""
    kind = dice.choice(["time", "event", "latched"])
    if kind == "time" or not inward:
        return {"time": round(dice.uniform(0, 5), 2)}
    event = "latched"
    if kind == "event":
        travel = abs(inward["angle"]["stowed"] - inward["angle"]["latched"])
        event = {"angle": rounded(dice.uniform(0.05, 0.9) * travel)}
    return {"after": inward["name"], "event": event, "delay": round(dice.uniform(0, 1), 2)}


def make_motor(dice):
    rate = rounded(dice.uniform(0.02, 0.4))
    if dice.random() < 0.5:
        table = {"time": [0, 1, 5, dice.randint(6, 12)], "rate": [0, 0.1, 0.2, 0]}
        rate = {"table": table, "interpolation": dice.choice(["linear", "monotone"])}
    return {"rate": rate, "gain": rounded(spread(dice, 1, 1e5)), "torque_limit": rounded(spread(dice, 1, 50))}


def make_stop(dice, side):
    return {"side": side, "stiffness": rounded(spread(dice, 1e2, 1e5)), "dissipation": 0.3, "gap": rounded(dice.uniform(0, 0.05))}


def bend(dice, scene):
    """Makes one body flexible."""
    body = dice.choice(scene["bodies"])
    inward = next(h["child_point"][0] for h in scene["hinges"] if h["child"] == body["name"])
    outward = [h["parent_point"][0] for h in scene["hinges"] if h["parent"] == body["name"]]
    body["plate"] = {"from": [inward, 0], "to": [outward[0] if outward else -inward, 0], "width": 1, "drag_coefficient": 0}
    body["flexible"] = {"joints": dice.choice([1, 2, 3]), "frequency": rounded(spread(dice, 2, 40)),
                        "damping_ratio": rounded(spread(dice, 3e-3, 0.05))}


def give_life(dice, scene):
    inward = {hinge["child"]: hinge for hinge in scene["hinges"]}
    for hinge in scene["hinges"]:
        latch = hinge["latch"]
        if dice.random() < 0.3:
            hinge["release"] = make_release(dice, hinge, inward.get(hinge["parent"]))
            if dice.random() < 0.3:
                hinge["hold"] = {"stiffness": rounded(spread(dice, 1e2, 1e5)), "damping": rounded(spread(dice, 1e-2, 1e2))}
        if dice.random() < 0.2:
            latch["capture_rate"] = rounded(spread(dice, 0.05, 2))
        if dice.random() < 0.2:
            latch["holding_moment"] = rounded(spread(dice, 5, 2000))
        if dice.random() < 0.2:
            latch["backlash"] = rounded(spread(dice, 1e-4, 2e-2))
        if dice.random() < 0.3 and "damping" in latch:
            del latch["damping"]
            latch["dissipation"] = round(dice.uniform(0.05, 1), 3)
        if dice.random() < 0.15:
            hinge["motor"] = make_motor(dice)
        if dice.random() < 0.2:
            hinge["stop"] = [dict(hinge["stop"], side="stowed") if "stop" in hinge else make_stop(dice, "stowed"), make_stop(dice, "latched")]
    if dice.random() < 0.4:
        bend(dice, scene)


def mirror(scene):
    """Puts one wing and its mirror image on a free base at rest."""
    mass = 5 * sum(body["mass"] for body in scene["bodies"])
    root = next(hinge["parent_point"] for hinge in scene["hinges"] if hinge["parent"] == "base")
    scene["base"] = {"motion": "free", "mass": rounded(mass), "inertia": rounded(mass * root[0] ** 2)}
    scene["mirror"] = {"of": "*", "as": "M_*"}


def wing_of(outcome, prefix):
    """Events and peaks of the hinges whose names begin so, by the name without it; prefix "": of the others."""
    mine = lambda name: name.startswith(prefix or "R_")
    wing = {kind: [event | {"hinge": event["hinge"].removeprefix(prefix)} for event in outcome.get(kind) or [] if mine(event["hinge"])]
            for kind in KINDS}
    return wing | {family: {name.removeprefix(prefix): peak for name, peak in (outcome.get(family) or {}).items() if mine(name)}
                   for family in PEAKS}


def simulate(given, scene, method, rtol):
    """@return the outcome; None if the run takes too long"""
    command = [given.program, "simulate", scene, "--t-end", str(given.t_end), "--method", method, "--rtol", str(rtol), "--json"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=PATIENCE)
    except subprocess.TimeoutExpired:
        return None
    if not done.stdout:
        sys.exit(f"{scene}: {done.stderr}")
    return json.loads(done.stdout)


def events_of(outcome):
    """(time, kind, hinge) in order of time."""
    return sorted(((e["time"], kind, e["hinge"]) for kind in KINDS for e in outcome.get(kind) or []), key=lambda e: e[0])


def look_at_events(events):
    engaged = set()
    for one, next_one in zip(events, events[1:]):
        if one[1:] == next_one[1:] and next_one[0] - one[0] < 1e-9:
            yield f"twice: {one}"
    for time, kind, hinge in events:
        if kind == "let_go" and hinge not in engaged:
            yield f"lets go unengaged: {hinge} at {time}"
        if kind == "latches":
            engaged.add(hinge)
        elif kind == "let_go":
            engaged.discard(hinge)


def compare(own, other):
    """What differs between two outcomes until they are too far apart to tell."""
    events, left, apart = events_of(own), events_of(other), 0
    for event in events:
        match = next((e for e in left if e[1:] == event[1:]), None)
        if match is None or abs(match[0] - event[0]) > 1e-3 * max(1, event[0]):
            yield f"lacks {event}" if match is None else f"has {match} for {event}"
            return
        left.remove(match)
        apart = max(apart, abs(match[0] - event[0]))
        if apart > CHAOTIC:
            return
    if left:
        yield f"has more: {left[0]}"
    for family in PEAKS:
        for hinge, peak in (own.get(family) or {}).items():
            values = [p["value"] for p in (peak, other[family][hinge]) if p and p.get("value")]
            if len(values) == 2 and abs(values[0] - values[1]) > 3e-4 * max(values) > 1e-9:
                yield f"{family} of {hinge}: {values[1]:.7g} for {values[0]:.7g}"


def look_at_campaign(given, folder, scene):
    """@return what is wrong with a campaign of the scene, in lanes and alone"""
    campaign = make_campaign(scene, 12, given.seed)
    campaign["integration"]["t_end"] = given.t_end
    campaign["outputs"] += ["final_angle", "captures", "held"] + (["motor_energy"] if any("motor" in h for h in scene["hinges"]) else [])
    (folder / "campaign.json").write_text(json.dumps(campaign))
    rows, found = [], []
    for name, options in (("lanes", []), ("alone", ["--lanes", "1"])):
        command = [given.program, "run", folder / "campaign.json", "--out", folder / name, "--threads", "1", *options]
        try:
            done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=2 * PATIENCE)
        except subprocess.TimeoutExpired:
            continue
        if done.returncode not in (0, 1, 3):
            sys.exit(f"{folder / 'campaign.json'}: exit code {done.returncode}\n{done.stderr}")
        rows.append((folder / name / "runs.csv").read_bytes())
        failed = json.loads((folder / name / "summary.json").read_text())["status"]["failed"]["count"]
        found += [f"{failed} runs fail ({name})"] if failed else []
    return found + (["other bytes alone"] if len(rows) == 2 and rows[0] != rows[1] else [])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/wingspread")
    parser.add_argument("--wings", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--t-end", type=float, default=12)
    parser.add_argument("--mirrored", action="store_true", help="compare left with right")
    parser.add_argument("--keep", metavar="DIR", help="scenes and results stay here")
    given = parser.parse_args()
    reports = 0
    with tempfile.TemporaryDirectory() as scratch:
        for index in range(given.wings):
            dice = random.Random(f"lives {given.seed}/{index}")
            scene, words = make_scene(dice, f"stranger_{index}")
            give_life(dice, scene)
            if given.mirrored:
                if any(body["name"].startswith("L_") for body in scene["bodies"]):
                    continue
                mirror(scene)
            folder = pathlib.Path(given.keep or scratch) / str(index)
            folder.mkdir(parents=True, exist_ok=True)
            (folder / "scene.json").write_text(json.dumps(scene, indent=1))
            runs = {method: simulate(given, folder / "scene.json", method, rtol) for method, rtol in METHODS}
            found = ["auto fails"] if runs["auto"] and runs["auto"]["status"] == "failed" else []
            usable = {method: run for method, run in runs.items() if run and run["status"] != "failed"}
            for method, run in usable.items():
                found += [f"{method}: {what}" for what in look_at_events(events_of(run))]
                if method != "auto" and "auto" in usable:
                    found += [f"{method}: {what}" for what in compare(usable["auto"], run)]
                if given.mirrored:
                    found += [f"{method}, left: {what}" for what in compare(wing_of(run, ""), wing_of(run, "M_"))]
            found += [] if given.mirrored else look_at_campaign(given, folder, scene)
            work = " ".join(f"{run['work']['rhs_evaluations'] if run else '–':>9}" for run in runs.values())
            print(f"{index:4} {work}   {words}", *found, sep="\n       ", flush=True)
            reports += len(found)
    print(f"{reports} reports on {given.wings} wings")
    return 1 if reports else 0


if __name__ == "__main__":
    sys.exit(main())
