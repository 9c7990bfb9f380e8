"""Whether all that a campaign writes agrees, on random campaigns of random wings.

    /usr/bin/python3 studies/drivers/strangers_campaigns.py --program build/release/wingspread                # 20 campaigns
    /usr/bin/python3 studies/drivers/strangers_campaigns.py --program … --campaigns 60 --seed 4 --keep DIR   # their files stay

Draws the wings of strangers.py, half of them with the lives of strangers_lives.py, and for each a campaign: laws of every type,
tables, correlations, designs, replicates, 1 to 100 runs, families of outputs, quantiles, tolerance limits, requirements, cases.
It reports

- a command that fails, or an exit code that it must not have;
- other bytes by two threads and single runs, by three shards that are merged, by `analyze`, by an extension of half the runs;
- a status, bound, mean, quantile, number of broken runs or verdict of summary.json that runs.csv and SciPy contradict;
- other counts, quantiles and verdicts of `run --no-rows`;
- a replay that differs, and a wing of `replay --scene` that latches at other times in `simulate`;
- "nan" in a table, in summary.json or on the page.

Needs python3-numpy and python3-scipy. Exits 1 if it reports anything.
"""

import argparse
import csv
import json
import math
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile

import numpy
from scipy import stats

sys.dont_write_bytecode = True
from strangers import make_scene, rounded
from strangers_lives import give_life

PATIENCE = 300  # s of one command
DONE = (0, 1, 3)  # exit codes: done, a requirement is not met, runs failed


class Refused(Exception):
    pass


def call(program, *arguments, codes=DONE):
    command = [str(a) for a in (program, *arguments)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=PATIENCE)
    if done.returncode not in codes:
        raise Refused(f"exit code {done.returncode}: {' '.join(command)}\n{done.stderr[-1000:]}")
    return done


# ---- random campaigns


def make_law(dice, centre, width):
    """A law about `centre`, within some `width` times it."""
    w = centre * width
    laws = [{"type": "normal", "mean": centre, "std": w / 4},
            {"type": "normal", "mean": centre, "std": w, "truncate": {"lower": centre - w, "upper": centre + 1.5 * w}},
            {"type": "uniform", "lower": centre - w, "upper": centre + w},
            {"type": "triangular", "lower": centre - w, "mode": centre + dice.uniform(-1, 1) * w, "upper": centre + w},
            {"type": "lognormal", "mu_log": math.log(centre), "sigma_log": width / 3},
            {"type": "beta", "alpha": dice.uniform(0.5, 4), "beta": dice.uniform(0.5, 4), "lower": centre - w, "upper": centre + w},
            {"type": "gamma", "shape": (3 / width) ** 2, "scale": centre * (width / 3) ** 2},
            {"type": "weibull", "shape": 3.6 / width, "scale": centre},
            {"type": "exponential", "rate": 1 / centre, "truncate": {"lower": centre - w, "upper": centre + w}},
            {"type": "discrete", "values": [rounded(centre - w), centre, rounded(centre + w)], "weights": [dice.uniform(0.1, 1) for _ in range(3)]},
            {"type": "empirical", "values": [rounded(centre + dice.gauss(0, w / 3)) for _ in range(dice.randint(5, 40))]},
            {"type": "constant", "value": centre}]
    return dice.choice(laws)


def paths_to_scale(scene):
    yield from (("spring", "hinges.*.spring.scale", 0.3), ("friction", "hinges.*.friction.scale", 0.5),
                ("mass", "bodies.*.mass", 0.1), ("latch", "hinges.*.latch.stiffness", 0.3))
    for hinge in scene["hinges"]:
        at = f"hinges.{hinge['name']}"
        yield from ((f"{key}_{hinge['name']}", f"{at}.latch.{key}", 0.6) for key in ("capture_rate", "holding_moment", "backlash")
                    if key in hinge["latch"])
        yield from ((f"{law}_{hinge['name']}", f"{at}.{law}.scale", 0.5) for law in ("damper", "harness") if law in hinge)
        if "motor" in hinge:
            yield from ((f"{key}_{hinge['name']}", f"{at}.motor.{key}", 0.4) for key in ("gain", "torque_limit"))
    yield from ((loop["name"], f"synchronisations.{loop['name']}.stiffness", 0.4) for loop in scene.get("synchronisations", []))
    yield from ((f"bends_{b['name']}", f"bodies.{b['name']}.flexible.frequency", 0.2) for b in scene["bodies"] if "flexible" in b)


def make_dispersions(dice, scene):
    pool = list(paths_to_scale(scene))
    dice.shuffle(pool)
    for name, path, width in pool[:dice.randint(2, 8)]:
        yield {"name": name, "distribution": make_law(dice, 1.0, width), "apply": "scale",
               **({"each": path} if "*" in path and dice.random() < 0.6 else {"to": [path]})}
    for hinge in scene["hinges"]:
        if "release" in hinge and dice.random() < 0.3:
            yield {"name": f"fails_{hinge['name']}", "distribution": {"type": "discrete", "values": [0, 1], "weights": [0.95, 0.05]},
                   "apply": "set", "to": [f"hinges.{hinge['name']}.release.fails"]}
    if dice.random() < 0.4:
        yield {"name": "temperature", "distribution": make_law(dice, 293, 0.15), "through": [
            {"to": ["hinges.*.friction.scale"], "apply": "scale", "table": {"at": [200, 250, 293, 350], "value": [2.0, 1.5, 1, 0.9]}},
            {"to": ["hinges.*.spring.scale"], "apply": "scale", "table": {"at": [200, 293, 400], "value": [1.02, 1, 0.97]}}]}


def make_outputs(dice, scene):
    latches = [hinge["latch"] for hinge in scene["hinges"]]
    given = {"hold_moment": any("release" in h for h in scene["hinges"]), "motor_energy": any("motor" in h for h in scene["hinges"]),
             "base_motion": scene["base"]["motion"] == "free" and dice.random() < 0.5,
             "final_angle": dice.random() < 0.4, "frequency": dice.random() < 0.3}
    given |= dict.fromkeys(("captures", "held"), any("capture_rate" in latch or "holding_moment" in latch for latch in latches))
    names = ["latch_time", "latch_rate", "peak_moment", "peak_force", "rate_at", "overtravel"] + [name for name in given if given[name]]
    return [name for name in names if dice.random() < 0.85] or ["latch_time"]


def make_requirements(dice, scene, outputs, t_end):
    limits = {"peak_moment": 50, "latch_time": t_end * 0.7, "latch_rate": -0.3, "peak_force": 100, "deployment_time": t_end * 0.8}
    group, seen = dice.random() < 0.3, set()
    for _ in range(dice.randint(0, 4)):
        family = dice.choice(["deployed", *limits])
        hinge = dice.choice(scene["hinges"])["name"]
        output = family if family.startswith("deploy") else f"{hinge}.{family}"
        if output in seen or not (family.startswith("deploy") or family in outputs):
            continue
        seen.add(output)
        found = {"name": f"R{len(seen)}", "output": output, "probability": dice.choice([0.5, 0.9, 0.99]), "confidence": 0.9}
        if family != "deployed":
            found["abs"] = family == "latch_rate" and dice.random() < 0.5
            limit = limits[family] * dice.uniform(0.3, 1)
            found[dice.choice(["max", "min"])] = abs(limit) if found["abs"] else limit
        yield found | ({"group": "loads"} if group else {})


def make_campaign(dice, index):
    scene, words = make_scene(dice, f"stranger_{index}")
    if dice.random() < 0.6:
        give_life(dice, scene)
    design = dice.choice(["random", "random", "random", "latin_hypercube", "sobol"])
    sampling = {"design": design, "runs": dice.choice([1, 2, 3, 17, 40, 64, 100]), "seed": dice.randrange(10**9)}
    if design != "random" and sampling["runs"] % 4 == 0:
        sampling["replicates"] = 4
    outputs, t_end = make_outputs(dice, scene), dice.choice([6, 12, 20])
    campaign = {"scene": scene, "dispersions": list(make_dispersions(dice, scene)), "sampling": sampling, "outputs": outputs,
                "integration": {"t_end": t_end, "rtol": dice.choice([1e-8, 1e-6])},
                "statistics": {"quantiles": sorted({round(dice.uniform(0.001, 0.999), 3) for _ in range(3)} | {0.5}),
                               "confidence": dice.choice([0.5, 0.9, 0.95]), "accuracy_runs": dice.choice([0, 0, 2])}}
    if design == "random":
        campaign["requirements"] = list(make_requirements(dice, scene, outputs, t_end))
        campaign["statistics"]["tolerance"] = [{"probability": 0.9, "confidence": 0.9, "side": dice.choice(["upper", "lower", "both"])}]
    single = [d["name"] for d in campaign["dispersions"] if "to" in d and d["distribution"]["type"] != "constant"]
    if len(single) > 1 and dice.random() < 0.4:
        campaign["correlations"] = [{"between": single[:2], "spearman": dice.choice([-0.5, 0.3, 0.8])}]
    if dice.random() < 0.3:
        campaign["cases"] = [{"name": "plain"}, {"name": "weak", "scale": {"hinges.*.spring.scale": round(dice.uniform(0.3, 0.9), 2)}},
                             {"name": "sticky", "scale": {"hinges.*.friction.scale": 4}}]
    return campaign, words


# ---- summary.json against runs.csv


class Rows:
    def __init__(self, path):
        with open(path, encoding="utf-8") as file:
            self.names, *self.rows = csv.reader(file)

    def column(self, name):
        place = self.names.index(name)
        return [row[place] for row in self.rows]


def is_near(a, b, tolerance, scale=0.0):
    return abs(a - b) <= tolerance * max(abs(a), abs(b), scale)


def look_for_nan(text, what):
    found = re.search(r"\b(nan|inf|infinity|undefined)\b", text, re.IGNORECASE)
    if found:
        yield f"{found[0]} in {what}: {text[max(0, found.start() - 60):found.end() + 20]}"


def look_at_status(rows, summary):
    states, n = rows.column("status"), len(rows.rows)
    for name, found in summary["status"].items():
        count = states.count(name)
        if found["count"] != count:
            yield f"{found['count']} are {name}, not {count}"
        if summary["independent"] and found["lower"] is not None:
            alpha = 1 - summary["confidence"]
            low = stats.beta.ppf(alpha / 2, count, n - count + 1) if count else 0
            high = stats.beta.ppf(1 - alpha / 2, count + 1, n - count) if count < n else 1
            if not (is_near(found["lower"], low, 1e-8) and is_near(found["upper"], high, 1e-8)):
                yield f"{name}: bounds {found['lower']} to {found['upper']}, not {low} to {high}"


def look_at_output(rows, name, output):
    n, values = len(rows.rows), numpy.array([float(cell) for cell in rows.column(name) if cell])
    if (output["count"], output["missing"]) != (len(values), n - len(values)):
        yield f"{name}: {output['count']} values, {output['missing']} missing, not {len(values)} of {n}"
    if not len(values):
        return
    size = max(abs(values))
    yield from (f"{name}: {key} {output[key]}, not {right}" for key, right in (("mean", values.mean()), ("min", values.min()), ("max", values.max()))
                if not is_near(output[key], right, 1e-10, size))
    beyond = -math.inf if "below" in str(output.get("missing_ranks")) else math.inf
    ranked = numpy.sort(numpy.append(values, [beyond] * (n - len(values))))
    for quantile in output["quantiles"]:
        p, value = quantile["p"], quantile["value"]
        low, high = ranked[max(0, math.floor(p * n) - 1)], ranked[min(n - 1, math.ceil(p * n))]
        if value is None:
            if math.isfinite(low) and math.isfinite(high):
                yield f"{name}: no quantile {p}, which lies within {low} and {high}"
        elif not low - 1e-9 * size <= value <= high + 1e-9 * size:
            yield f"{name}: quantile {p} {value} is not within {low} and {high}"


def breaks(row, names, requirement):
    """Whether a run breaks a requirement."""
    cells, output = dict(zip(names, row)), requirement["output"]
    if cells["status"] != "deployed":
        return True
    if output == "deployed":
        return False
    family = output.split(".")[-1]
    if cells[output] == "":
        return True
    value = abs(float(cells[output])) if requirement.get("abs") else float(cells[output])
    if family.startswith("peak_") and cells["peaks_final"] not in ("true", family):  # it may still rise
        return value < requirement.get("min", math.inf)
    return value > requirement.get("max", math.inf) or value < requirement.get("min", -math.inf)


def look_at_requirement(rows, found, asked):
    n, p, c = len(rows.rows), asked["probability"], found.get("confidence_alone", asked["confidence"])
    seen = sum(breaks(row, rows.names, asked) for row in rows.rows)
    allowed = -1
    while stats.binom.cdf(allowed + 1, n, 1 - p) <= 1 - c:
        allowed += 1
    failures = found["failures"]
    if failures["seen"] != seen or (-1 if failures["allowed"] is None else failures["allowed"]) != allowed:
        yield f"{asked['name']}: {failures['seen']} of {failures['allowed']} allowed, not {seen} of {allowed}"
    disproved = seen > 0 and stats.binom.cdf(seen - 1, n, 1 - p) >= c
    right = "pass" if seen <= allowed else "fail" if allowed >= 0 or disproved else "undecided"
    if found["verdict"] != right and not failures.get("peaks_cut"):
        yield f"{asked['name']}: {found['verdict']}, not {right}: {seen} of {n} break it"


def look_at_folder(folder, campaign):
    rows, text = Rows(folder / "runs.csv"), (folder / "summary.json").read_text()
    summary = json.loads(text) | {"independent": campaign["sampling"]["design"] == "random"}
    yield from look_for_nan(text, "summary.json")
    yield from look_at_status(rows, summary)
    for name, output in summary["outputs"].items():
        yield from look_at_output(rows, name, output)
    for found, asked in zip(summary["requirements"], campaign.get("requirements", [])):
        yield from look_at_requirement(rows, found, asked)


# ---- one campaign by many ways


def differences(one, other, what):
    for path in sorted(one.rglob("*")):
        same = other / path.relative_to(one)
        if path.is_file() and path.name not in ("timing.json", "report.html"):
            if not same.exists() or path.read_bytes() != same.read_bytes():
                yield f"{what}: {path.relative_to(one)} differs"


def look_at_bytes(program, folder, campaign):
    file, whole, runs = folder / "campaign.json", folder / "whole", campaign["sampling"]["runs"]
    call(program, "run", file, "--out", folder / "alone", "--threads", 2, "--lanes", 1)
    yield from differences(whole, folder / "alone", "two threads, single runs")
    if runs >= 3:
        shards = [folder / f"shard_{k}" for k in (3, 1, 2)]
        for shard in shards:
            call(program, "run", file, "--out", shard, "--shard", f"{shard.name[-1]}/3")
        call(program, "merge", *shards, "--out", folder / "merged")
        yield from differences(whole, folder / "merged", "merged")
    if "cases" not in campaign:
        shutil.copytree(whole, folder / "again")
        call(program, "analyze", folder / "again")
        yield from differences(whole, folder / "again", "analyze")
    if campaign["sampling"]["design"] == "random" and runs >= 40 and not campaign["requirements"]:
        call(program, "run", file, "--out", folder / "longer", "--runs", runs // 2)
        call(program, "run", file, "--out", folder / "longer", "--resume", "--runs", runs)
        yield from (what for what in differences(whole, folder / "longer", "extended") if "runs.csv" in what)


def look_at_replay(program, folder, campaign, run):
    scene = folder / "run.json"
    scene.unlink(missing_ok=True)
    own = json.loads(call(program, "replay", folder, "--run", run, "--json", "--scene", scene).stdout)
    how = campaign["integration"]
    other = json.loads(call(program, "simulate", scene, "--json", "--t-end", how["t_end"], "--rtol", how["rtol"]).stdout)
    if not own["same_as_recorded"]:
        yield f"run {run} is replayed otherwise"
    if [latch["time"] for latch in own["latches"]] != [latch["time"] for latch in other["latches"]]:
        yield f"run {run} latches at other times in simulate"


def look_at_rowless(program, folder):
    call(program, "run", folder / "campaign.json", "--out", folder / "rowless", "--no-rows")
    own, other = (json.loads((folder / name / "summary.json").read_text()) for name in ("whole", "rowless"))
    for name, count in own["status"].items():
        if count["count"] != other["status"][name]["count"]:
            yield f"--no-rows: {other['status'][name]['count']} are {name}"
    for name, output in own["outputs"].items():
        for one, two in zip(output["quantiles"], other["outputs"][name]["quantiles"]):
            within = two.get("within") or [-math.inf, math.inf]
            if (one["value"] is None) != (two["value"] is None) or not (one["value"] is None or within[0] - 1e-12 <= one["value"] <= within[1] + 1e-12):
                yield f"--no-rows: {name}, quantile {one['p']}: {two}, not {one['value']}"
    for one, two in zip(own["requirements"], other["requirements"]):
        if (one["verdict"], one["failures"]["seen"]) != (two["verdict"], two["failures"]["seen"]):
            yield f"--no-rows: {one['name']}: {two['verdict']}, not {one['verdict']}"


def look_at_campaign(program, folder, campaign, dice):
    (folder / "campaign.json").write_text(json.dumps(campaign, indent=1))
    call(program, "check", folder / "campaign.json")
    whole = folder / "whole"
    yield from look_for_nan(call(program, "run", folder / "campaign.json", "--out", whole, "--threads", 1, "--table").stdout, "the table")
    yield from look_at_bytes(program, folder, campaign)
    for results in [whole / case["name"] for case in campaign.get("cases", [])] or [whole]:
        yield from (f"{results.name}: {what}" for what in look_at_folder(results, campaign))
        states = Rows(results / "runs.csv").column("status")
        for run in dice.sample(range(len(states)), min(2, len(states))):
            if states[run] != "invalid":
                yield from look_at_replay(program, results, campaign, run)
        yield from look_for_nan(call(program, "sensitivity", results, codes=(0, 1, 2, 3)).stdout, "the table of sensitivity")
    if "cases" not in campaign and campaign["sampling"]["design"] == "random":
        yield from look_at_rowless(program, folder)
    call(program, "report", whole)
    page = (whole / "report.html").read_text()
    yield from look_for_nan(re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)[1], "the page's data")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/wingspread")
    parser.add_argument("--campaigns", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int, nargs="*", help="these campaigns of the seed alone")
    parser.add_argument("--keep", metavar="DIR", help="their files stay")
    given = parser.parse_args()
    reports = 0
    for index in given.only or range(given.campaigns):
        dice = random.Random(f"campaigns {given.seed}/{index}")
        campaign, words = make_campaign(dice, index)
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(given.keep or scratch) / str(index)
            folder.mkdir(parents=True)
            try:
                found = list(look_at_campaign(given.program, folder, campaign, dice))
            except (Refused, subprocess.TimeoutExpired) as fault:
                found = [str(fault)]
        print(f"{index:4} {campaign['sampling']['runs']:4} {campaign['sampling']['design']:15} {words}", *found, sep="\n       ", flush=True)
        reports += len(found)
    print(f"{reports} reports on {len(given.only or range(given.campaigns))} campaigns")
    return 1 if reports else 0


if __name__ == "__main__":
    sys.exit(main())
