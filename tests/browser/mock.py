"""Data blocks of the shape that montecarlo/report/page/DATA.md documents, made up from a seed.

    /usr/bin/python3 tests/browser/mock.py KIND OUT.html

No mechanics: a wing of panels whose hinges close at random times and ring a little, so that every part of the page has
something to show, edge cases that a campaign reaches only with luck among them. KIND is one of KINDS below.
"""

import bisect
import json
import math
import random
import sys

import assemble
import mock_numbers as numbers
import mock_wing

STATUSES = ["deployed", "stalled", "timed_out", "invalid", "failed"]


def draws_of(hinges):
    return [f"{name}.{what}" for name in hinges for what in ("spring", "coulomb", "harness")]


def make_runs(rng, hinges, count, shift, stalls, all_failed):
    """Rows: draws as deviations in sigma, the outcome, the latch times (None where there is none), the peaks."""
    rows = []
    for run in range(count):
        draws = {name: rng.gauss(0, 1) for name in draws_of(hinges)}
        status = "failed" if all_failed else "stalled" if rng.random() < stalls else "deployed"
        times, peaks = {}, {}
        for place, hinge in enumerate(hinges):
            spring, coulomb = draws[hinge + ".spring"], draws[hinge + ".coulomb"]
            time = 4.6 + shift + 0.17 * (place % 3) + 0.09 * (coulomb - spring) + 0.06 * rng.gauss(0, 1)
            late = time > 4.95 + shift
            times[hinge] = None if all_failed or (status == "stalled" and place == len(hinges) - 1) else time
            peak = (215 if late else 150) * (1 + 0.06 * spring + 0.02 * rng.gauss(0, 1)) / (1 + 0.3 * (place % 3))
            peaks[hinge] = None if all_failed else peak
        latched = sorted((h for h in hinges if times[h] is not None), key=times.get)
        rows.append({"run": run, "status": status, "draws": draws, "times": times, "peaks": peaks,
                     "order": ">".join(latched)})
    return rows


def columns_of(rows, hinges):
    for hinge in hinges:
        yield f"{hinge}.latch_time", "latch_time", hinge, "s", [row["times"][hinge] for row in rows], 4.8
        yield (f"{hinge}.latch_rate", "latch_rate", hinge, "rad/s",
               [None if row["times"][hinge] is None else -1.2 - 0.1 * row["draws"][hinge + ".spring"] for row in rows], -1.2)
        yield f"{hinge}.peak_moment", "peak_moment", hinge, "N m", [row["peaks"][hinge] for row in rows], 196.0
    whole = [max((t for t in row["times"].values() if t), default=None) if row["status"] == "deployed" else None for row in rows]
    yield "deployment_time", "deployment_time", None, "s", whole, 5.1


def orders_of(rows):
    counts = {}
    for row in rows:
        if row["order"]:
            counts[row["order"]] = counts.get(row["order"], 0) + 1
    frequent = sorted(counts, key=lambda order: -counts[order])
    kept = frequent[:6]
    orders = [{"order": name, "count": counts[name]} for name in kept]
    if len(frequent) > 6:
        orders.append({"order": "others", "count": sum(counts[name] for name in frequent[6:])})
    index = [kept.index(row["order"]) if row["order"] in kept else len(kept) if row["order"] else -1
             for row in rows]
    if -1 in index:
        orders.append({"order": "no latch", "count": index.count(-1)})
        index = [len(orders) - 1 if one < 0 else one for one in index]
    return orders, len(frequent), index


def requirements_of(rows, hinges, limit):
    values = sorted((row["peaks"][hinges[0]] if row["status"] == "deployed" else math.inf, row["run"]) for row in rows)
    broken = [run for value, run in reversed(values) if value > limit]
    count, good = len(rows), sum(row["status"] == "deployed" for row in rows)
    allowed = max(0, int(0.01 * count - 1.3 * math.sqrt(0.01 * count)))
    known = [value for value, _ in values if value < math.inf]
    down = [{"run": row["run"], "latched": row["order"].count(">") + bool(row["order"])} for row in rows if row["status"] != "deployed"]
    down.sort(key=lambda one: one["latched"])
    beyond = [{"run": run, "value": value} for value, run in reversed(values) if limit < value < math.inf]
    split = {"not_deployed": len(down), "without_value": 0, "cut": 0, "not_deployed_runs": down[:5]}
    largest = next(({"run": run, "value": value} for value, run in reversed(values) if value < math.inf), None)
    guaranteed = known[-1 - allowed] if len(known) > allowed and count >= 230 else None
    lower = numbers.clopper_pearson(good, count, 0.9)[0]
    verdict = "open" if count < 230 else "passed" if len(broken) <= allowed else "failed"
    return [
        {"text": f"L-1: {hinges[0]}.peak_moment ≤ {limit} N·m, 99 % at 90 %", "output": f"{hinges[0]}.peak_moment", "kind": "<=",
         "limit": limit, "upper": True, "verdict": verdict, "probability": 0.99, "confidence": 0.9,
         "observed": 1 - len(broken) / count, "guaranteed": max(0, 1 - (len(broken) + 1.6 + 1.3 * math.sqrt(len(broken))) / count),
         "observed_value": known[int(0.99 * (len(known) - 1))] if known else None, "guaranteed_value": guaranteed,
         "margin": limit - guaranteed if guaranteed else None, "broken": len(broken), "name": "L-1", "id": "SYS-1", "source": "specification 4.2",
         "rationale": "strength of the root fitting", "runs": count, **split, "beyond": len(beyond), "beyond_runs": beyond[:5], "worst": largest,
         "evidence": f"{len(broken)} of {count} runs break it; at most {allowed} may"},
        {"text": "D-1: deployed, 99 % at 90 %", "output": "deployed", "kind": "status", "limit": None, "upper": False,
         "verdict": "open" if count < 230 else "passed" if lower >= 0.99 else "failed", "probability": 0.99, "confidence": 0.9,
         "observed": good / count, "guaranteed": lower, "observed_value": None, "guaranteed_value": None, "margin": None,
         "broken": count - good, "name": "D-1", "runs": count, **split, "beyond": 0, "beyond_runs": [], "worst": None,
         "evidence": f"{count - good} of {count} runs break it"}] + ([] if not known else [
        # an angular limit in the picture, one on both sides, one far outside
        limited("R-1", f"{hinges[0]}.latch_rate", ">=", -1.6, "rad/s", False),
        limited("R-2", f"|{hinges[-1]}.latch_rate|", "<=", 1.45, "rad/s", True),
        limited("T-1", f"{hinges[-1]}.latch_time", "<=", 60, "s", False)])


def limited(name, output, kind, limit, unit, both):
    """A passed requirement on an output; the numbers are made up."""
    value = 0.4 * limit
    return {"text": f"{name}: {output} {kind} {limit} {unit}, 99 % at 90 %", "output": output.strip("|"), "kind": kind, "limit": limit,
            "upper": kind == "<=", "abs": both, "verdict": "passed", "probability": 0.99, "confidence": 0.9, "observed": 1, "guaranteed": 0.9985,
            "observed_value": 0.35 * limit, "guaranteed_value": value, "margin": abs(limit - value), "broken": 0, "evidence": "made up",
            "name": name, "not_deployed": 0, "without_value": 0, "cut": 0, "beyond": 0, "beyond_runs": [], "not_deployed_runs": [], "worst": {"run": 3, "value": value}}


def sensitivity_of(rows, outputs, hinges):
    effects = []
    for name, values in outputs.items():
        known = [(row["draws"], value) for row, value in zip(rows, values) if value is not None]
        own = numbers.ranks([value for _, value in known])
        ranked = [(numbers.spearman(numbers.ranks([draws[draw] for draws, _ in known]), own), draw) for draw in draws_of(hinges) if len(known) > 10]
        for rho, draw in sorted(ranked, key=lambda pair: -abs(pair[0]))[:12]:
            width, partial = 1.96 * math.sqrt((1 + rho * rho / 2) / (len(rows) - 3)), max(-1, min(1, 1.06 * rho))
            effects.append({"output": name, "draw": draw, "spearman": rho, "spearman_lower": max(-1, rho - width),
                            "spearman_upper": min(1, rho + width), "prcc": partial, "prcc_lower": max(-1, partial - width),
                            "prcc_upper": min(1, partial + width)})
    return effects


def scatter(rows, index, draw, name, values, rho):
    kept = [(row["run"], row["draws"][draw], value, order) for row, value, order in zip(rows, values, index) if value is not None]
    x_edges, y_edges = (numbers.edges([row[axis] for row in kept], 32) for axis in (1, 2))
    density = [0] * 1024
    for _, x, y, _ in kept:
        density[32 * min(31, bisect.bisect_right(y_edges, y) - 1) + min(31, bisect.bisect_right(x_edges, x) - 1)] += 1
    points = kept[:: max(1, len(kept) // 400 + 1)]
    return {"draw": draw, "output": name, "spearman": rho, "x_edges": x_edges, "y_edges": y_edges, "density": density,
            "points": dict(zip(("run", "x", "y", "order"), map(list, zip(*points))))}


def make_set(label, seed, hinge_count=3, count=2000, shift=0.0, stalls=0.0, all_failed=False, case=None, full=True, limit=215):
    rng = random.Random(seed)
    hinges = ["root", "mid", "tip"] if hinge_count == 3 else [f"h{k + 1}" for k in range(hinge_count)]
    rows = make_runs(rng, hinges, count, shift, stalls, all_failed)
    orders, kinds, index = orders_of(rows)
    outputs, values = [], {}
    for name, family, hinge, unit, column, nominal in columns_of(rows, hinges):
        values[name] = column
        outputs.append(numbers.output(name, family, hinge, unit, column, nominal + (shift if unit == "s" else 0), index, len(orders)))
    requirements = requirements_of(rows, hinges, limit)
    for output in outputs:
        output["limits"] = [k for k, req in enumerate(requirements) if req["output"] == output["name"]]
    effects = sensitivity_of(rows, values, hinges) if hinge_count < 10 and count > 10 else []
    strongest = sorted(effects, key=lambda e: -abs(e["spearman"]))[:6]
    folder = f"results/mock/{case}" if case else "results/mock"
    tally = [sum(row["status"] == status for row in rows) for status in STATUSES]
    return {
        "label": label, "folder": folder, "case": case, "campaign_folder": 0, "campaign": "mock_wing", "seed": str(seed), "foreign": False, "stopped": False, "looks": 1, "hash": "5f1c0a93d2e84b77",
        "description": "Made-up numbers for the tests of the page.", "version": "0.2.0+mock", "runs": count, "planned": count,
        "partial": False, "shard": None, "design": "random", "confidence": 0.95, "replicates": 0,
        "made_by": f"wingspread run studies/campaigns/mock.json --seed {seed} --runs {count} --out results/mock",
        "statuses": [dict(zip(("status", "count", "rate", "lower", "upper"),
                              (status, k, k / count, *numbers.clopper_pearson(k, count, 0.95)))) for status, k in zip(STATUSES, tally)],
        "reasons": [{"status": s, "reason": r, "count": k} for s, r, k in (
            ("stalled", f"{hinges[-1]} sticks, and what loads it stays as it is", tally[1]), ("failed", "more than 1000000 steps", tally[4])) if k],
        "orders": orders, "order_kinds": kinds, "without_latch": sum(not row["order"] for row in rows), "wing_orders": [], "kernel": None,
        "warnings": ["root turned beyond its stowed angle by more than 1 deg in 12 runs, and has no stop"] if full else [],
        "latch_jumps": [],
        "accuracy": {"runs": 40, "method": "auto", "rtol": 1e-8, "reference_method": "dop853", "reference_rtol": 1e-12, "order_in_doubt": 0,
                     "outputs": [{"output": o["name"], "largest": 3e-7 * abs(o["mean"]), "rms": 1e-7 * abs(o["mean"]),
                                  "standard_error": o["mean_error"]} for o in outputs if o["mean"] and o["mean_error"]]} if full else None,
        "requirements": requirements, "outputs": outputs, "correlations": None,
        "sensitivity": {"kind": "rank", "held": True, "effects": effects} if effects else None,
        "scatters": [scatter(rows, index, e["draw"], e["output"], values[e["output"]], e["spearman"]) for e in strongest],
        **mock_wing.parts(rng, hinges, rows, folder, all_failed),
        **(mock_wing.studies(hinges) if full and not all_failed else {"static_margins": None, "margin": None, "rare": None}),
        "inputs": mock_wing.inputs(hinges, case)}


def study(label, **found):
    """What `margin`, `sensitivity` or `rare` left: a set without runs."""
    hinges = ["root", "mid", "tip"]
    empty = {key: [] for key in ("statuses", "reasons", "orders", "warnings", "requirements", "outputs", "scatters", "motions")}
    return {"label": label, "folder": f"results/{label}", "case": None, "campaign": "mock_wing", "description": "", "foreign": False, "seed": "1",
            "hash": "5f1c0a93d2e84b77", "version": "0.2.0+mock", "runs": 0, "planned": 0, "partial": False, "stopped": False, "shard": None, "design": "",
            "confidence": 0.95, "looks": 1, "replicates": 0, "made_by": "", **empty, "without_latch": 0, "order_kinds": 0, "accuracy": None,
            "correlations": None, "sensitivity": None, "wing": mock_wing.wing(hinges), "envelopes": None, "static_margins": None, "margin": None,
            "rare": None, "wing_orders": [], "kernel": None, "inputs": {"scene": [], "dispersions": [], "settings": []}, **found}


def sobol():
    return {"kind": "sobol", "effects": [
        {"output": output, "draw": draw, "first": share, "first_lower": share - 0.05, "first_upper": share + 0.05, "total": share + 0.1,
         "total_lower": share + 0.02, "total_upper": share + 0.2}
        for output in ("root.peak_moment", "tip.latch_time") for draw, share in (("root.spring", 0.6), ("tip.coulomb", 0.2))]}


def studies():
    found = mock_wing.studies(["root", "mid", "tip"])
    return [study("margin", margin=found["margin"], static_margins=found["static_margins"]), study("sobol", sensitivity=sobol()), study("rare", rare=found["rare"])]


def comparison(sets, first, second):
    rows = []
    for one, two in zip(sets[first]["outputs"], sets[second]["outputs"]):
        if one["mean"] is not None and two["mean"] is not None:
            half = 1.96 * math.hypot(one["mean_error"] or 0, two["mean_error"] or 0)
            step = two["mean"] - one["mean"]
            if second == 2 and len(rows) < 2:  # far changes, up and down: the axis is logarithmic then
                step = (5.2, -0.9)[len(rows)] * abs(one["mean"])
            rows.append({"output": one["name"], "difference": step, "lower": step - half, "upper": step + half,
                         "relative": step / abs(one["mean"]), "runs": one["count"], "magnitude": False})
    rates = [(one["status"], two["rate"] - one["rate"]) for one, two in zip(sets[first]["statuses"], sets[second]["statuses"])]
    return {"sets": [first, second], "folders": not sets[first]["case"], "paired": True, "why_unpaired": None, "runs": sets[second]["runs"], "confidence": 0.95, "outputs": rows,
            "text": f"{sets[second]['label']} − {sets[first]['label']}, run by run over the {sets[second]['runs']} runs with the same random numbers",
            "statuses": [{"status": s, "difference": d, "lower": d - 0.004, "upper": d + 0.004} for s, d in rates]}


def block(sets, title="mock_wing"):
    glossary = {f"HINGE.{name}": {"unit": unit, "text": text} for name, unit, text in (
        ("latch_time", "s", "when the hinge reaches its latched angle for the first time"),
        ("latch_rate", "rad/s", "its own relative rate at that instant; signed"), ("peak_moment", "N m", "largest |M| of the whole run"))}
    return {"format": 1, "version": "0.2.0+mock", "command": "wingspread report results/mock", "title": title, "document": {}, "glossary": glossary,
            "sets": sets, "comparisons": [comparison(sets, 0, k) for k in range(1, len(sets)) if sets[k]["runs"]], "unpaired": []}


def odd():
    """A part of a campaign with a design, interim analyses, runs that never latch, one-sided bounds, angles among the inputs."""
    one = make_set("mock_wing", 6, count=300, stalls=0.05)
    one |= {"planned": 1200, "partial": True, "shard": "1/4", "looks": 3, "design": "sobol", "replicates": 4, "confidence": 0.9, "foreign": True,
            "without_latch": 11, "order_kinds": one["order_kinds"] + 9,
            "reasons": [{"status": "stalled", "reason": "tip sticks", "count": 9}, {"status": "stalled", "reason": "root sticks", "count": 4}]}
    one["orders"] = one["orders"][:2] + [{"order": "others", "count": sum(each["count"] for each in one["orders"][2:])}]
    one["accuracy"]["order_in_doubt"] = 2
    for place, row in enumerate(one["accuracy"]["outputs"]):
        row["largest"] *= 1 + place
    output = next(each for each in one["outputs"] if each["name"] == "root.peak_moment")
    output["tolerance_limits"] = [{"text": "95 % at 90 %", "lower": 101.25, "upper": 251.75}]
    output["quantiles"][0]["upper"] = output["quantiles"][1]["lower"] = None
    highest = output["quantiles"][2]
    output["quantiles"][2] = {"p": 0.99, "value": None, "lower": highest["lower"], "upper": None, "note": "285 of 300 runs have a value; the others rank above every value",
                              "among": {key: highest[key] for key in ("value", "lower", "upper")}}
    for place, each in enumerate(one["inputs"]["dispersions"]):
        each |= {"unit": "rad", "low": -0.01 - place, "high": 0.02 + place, "nominal": 0.5 + place, "nominal_unit": "rad", "apply": "add"}
    return block([one]) | {"document": {"revision": 'B\n"2" <x>\\'}}


KINDS = {
    "odd": odd,
    "plain": lambda: block([make_set("mock_wing", 1)]),
    "cases": lambda: block([make_set("cold", 1, shift=0.4, stalls=0.03, case="cold"), make_set("ambient", 1, case="ambient"),
                            make_set("hot", 1, shift=-0.2, case="hot")]),
    "stalls": lambda: block([make_set("mock_wing", 2, count=300, stalls=0.05)]),
    "loads": lambda: block([make_set("cold", 1, case="cold", limit=150), make_set("hot", 1, shift=-0.2, case="hot", stalls=0.02, limit=120)]),
    "all_failed": lambda: block([make_set("mock_wing", 3, count=50, all_failed=True, full=False)]),
    "single": lambda: block([make_set("mock_wing", 4, count=1, full=False)]),
    "studies": lambda: block(studies()),
    "beside": lambda: block([make_set("mock_wing", 2, count=300, full=False), *studies()]),
    "forty": lambda: block([make_set("forty hinges", 5, hinge_count=40, count=300)]),
}

if __name__ == "__main__":
    kind, out = sys.argv[1:3]
    text = assemble.page(json.dumps(KINDS[kind](), allow_nan=False, ensure_ascii=False))
    with open(out, "w", encoding="utf-8") as file:
        file.write(text)
