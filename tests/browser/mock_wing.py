"""A made-up wing for the tests of the page: its drawing, motions, envelopes, inputs and what other studies left."""

import math


def turn(hinges, place):
    return math.pi / 2 if place == 0 else math.pi * (-1 if place % 2 else 1)


def angle(t, stowed, latch):
    """From stowed to 0 at `latch`, ever faster, and then a little ringing."""
    if latch is None:
        latch, floor = 6.0, 0.2
        return stowed * (floor + (1 - floor) * max(0.0, 1 - (t / latch) ** 2)), -2 * stowed * (1 - floor) * t / latch**2 if t < latch else 0.0
    if t < latch:
        return stowed * (1 - (t / latch) ** 2), -2 * stowed * t / latch**2
    ring = math.exp(-3 * (t - latch)) * 0.02
    return ring * math.sin(40 * (t - latch)), 40 * ring * math.cos(40 * (t - latch))


def motion(label, why, run, status, reason, times, hinges, folder):
    latched = {h: t for h, t in times.items() if t is not None}
    end = max(latched.values(), default=8.0) + 1.5
    t = sorted({*(end * k / 240 for k in range(241)), *latched.values()})
    samples = [[angle(time, turn(hinges, place), times[h]) for time in t] for place, h in enumerate(hinges)]
    moments = [[0.8 if times[h] is None or time < times[h] else 190 * math.exp(-3 * (time - times[h])) * math.cos(40 * (time - times[h])) for time in t]
               for h in hinges]
    peaks = [max(range(len(t)), key=lambda k: abs(row[k])) for row in moments]
    return {"label": label, "why": why, "run": run, "status": status, "reason": reason,
            "replay": f"wingspread replay {folder} --run {run}" if run is not None else "wingspread simulate scene.json",
            "t": t, "angles": [[a for a, _ in row] for row in samples], "rates": [[r for _, r in row] for row in samples], "moments": moments,
            "base": None, "latches": [{"hinge": k, "time": times[h]} for k, h in enumerate(hinges) if times[h] is not None],
            "peaks": [{"hinge": k, "value": moments[k][at], "time": t[at]} for k, at in enumerate(peaks)]}


def motions(hinges, rows, folder, all_failed):
    nominal = motion("nominal", "nothing dispersed", None, "deployed", "", {h: 4.7 + 0.17 * (k % 3) for k, h in enumerate(hinges)}, hinges, folder)
    if all_failed:
        return [nominal]
    first = rows[0]
    found = [nominal, motion(f"median of {hinges[0]}.peak_moment", "its value is the median", first["run"], first["status"], "", first["times"], hinges, folder)]
    worst = max(rows, key=lambda row: row["peaks"][hinges[0]])
    found.append(motion(f"worst: {hinges[0]}.peak_moment", "the largest of all runs", worst["run"], worst["status"], "", worst["times"], hinges, folder))
    for row in rows:
        if row["status"] == "stalled":
            found.append(motion("stalled", "it does not deploy", row["run"], "stalled", f"{hinges[-1]} sticks", row["times"], hinges, folder))
            break
    return found


def envelopes(rng, hinges, rows):
    t = [7 * k / 99 for k in range(100)]
    sampled = [row for row in rows[:200] if any(row["times"].values())]
    if not sampled:
        return None
    levels = [0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99]
    bands = {"angles": [], "rates": []}
    for place, hinge in enumerate(hinges):
        both = [[angle(time, turn(hinges, place), row["times"][hinge]) for row in sampled] for time in t]
        for which, key in enumerate(("angles", "rates")):
            ordered = [sorted(pair[which] for pair in column) for column in both]
            bands[key].append([[column[int(level * (len(column) - 1))] for column in ordered] for level in levels])
    times = [sorted(row["times"][hinge] for row in sampled if row["times"][hinge] is not None) for hinge in hinges]
    thinned = [each[:1] + each[2:-1:2] + each[-1:] if len(each) > 50 else each for each in times]
    return {"runs": len(sampled), "t": t, "levels": levels, **bands, "latch_times": thinned, "latched": [len(each) for each in times]}


def wing(hinges):
    bodies = [{"name": "base", "hinge": -1, "outline": [[-0.5, -0.3], [0, -0.3], [0, 0.3], [-0.5, 0.3]], "inner": [0, 0], "joint_in_parent": [0, 0],
               "closed": True}]
    for place, hinge in enumerate(hinges):
        side = 0.02 * (-1 if place % 2 else 1)
        joint = [0, 0] if place == 0 else [0.505, -side]
        bodies.append({"name": f"panel_{place + 1}", "hinge": place, "inner": [-0.505, side], "joint_in_parent": joint, "closed": True,
                       "outline": [[-0.505, -0.02], [0.505, -0.02], [0.505, 0.02], [-0.505, 0.02]]})
    return {"hinges": [{"name": h, "stowed": turn(hinges, k), "latched": 0.0, "parent": k - 1} for k, h in enumerate(hinges)], "bodies": bodies,
            "scale": 1.01 * len(hinges) + 0.5, "base": {"kind": "fixed"}}


def parts(rng, hinges, rows, folder, all_failed):
    return {"wing": wing(hinges), "motions": motions(hinges, rows, folder, all_failed), "envelopes": envelopes(rng, hinges, rows)}


def studies(hinges):
    angles = [math.pi * k / 40 for k in range(41)]
    static = [{"hinge": h, "angle": angles, "margin": [0.3 + 1.2 * math.sin(a) ** 2 - 0.1 * k for a in angles],
               "margin_lower": [0.1 + math.sin(a) ** 2 - 0.1 * k for a in angles], "required": 0.0 if k else 0.2, "least": 0.3 - 0.1 * k,
               "lower": 0.1 - 0.1 * k} for k, h in enumerate(hinges[:5])]
    scales = [0.7 + 0.1 * k for k in range(14)]
    share = [1 / (1 + math.exp(-30 * (s - 0.95))) for s in scales]
    other = [1 / (1 + math.exp(25 * (s - 1.75))) for s in scales]
    rows = [{"text": text, "passed": p, "lower": [max(0, v - 0.02) for v in p], "upper": [min(1, v + 0.01) for v in p],
             "verdict": ["passed" if v > 0.985 else "failed" for v in p]}
            for text, p in (("D-1: deployed, 99 % at 90 %", share), (f"S-1: {hinges[0]}.peak_moment ≤ 300 N·m, 99 % at 90 %", other))]
    rare = {"text": f"P({hinges[0]}.peak_moment > 300)", "probability": 2.6e-6, "lower": 1.9e-6, "upper": 3.5e-6, "reached": True,
            "levels": [[{"threshold": start + 14 * k, "probability": 10.0 ** (-k)} for k in range(1, 6)] + [{"threshold": 300, "probability": end}] for start, end in ((230, 3.1e-6), (228, 2.1e-6))],
            "likeliest": {"draws": [{"name": f"{hinges[0]}.spring", "value": 1.11, "z": 3.6}, {"name": f"{hinges[0]}.coulomb", "value": 0.8, "z": -1.9}]}}
    return {"static_margins": {"kind": "ECSS", "formula": "T / (1.35 ΣT_fixed + 2.5 ΣT_variable) − 1", "draws": 1000, "lower_p": 0.01, "hinges": static}, "rare": rare,
            "margin": {"scales": scales, "requirements": rows, "recommended": 1.42, "window": [1.1, 1.58], "of_springs": True, "paths": ["hinges.*.spring.scale"]}}


def inputs(hinges, case):
    scene = []
    for place, hinge in enumerate(hinges):
        scene += [{"path": f"hinges.{hinge}.angle.stowed", "label": f"{hinge} stowed", "value": turn(hinges, place), "unit": "rad", "case_value": None},
                  {"path": f"hinges.{hinge}.spring.scale", "label": f"{hinge} spring scale", "value": 1, "unit": "", "case_value": 0.95 if case == "cold" else None},
                  {"path": f"hinges.{hinge}.angle.latched", "label": f"{hinge} latched", "value": -0.0123456, "unit": "rad", "case_value": None},
                  {"path": f"hinges.{hinge}.latch.stiffness", "label": f"{hinge} latch stiffness", "value": 1e4, "unit": "N m/rad", "case_value": None}]
    dispersions = [{"draw": f"{h}.spring", "paths": [f"hinges.{h}.spring.scale"], "law": "normal(mean 1, std 0.03)", "nominal": 1, "low": 0.92, "high": 1.08,
                    "unit": ""} for h in hinges]
    return {"scene": scene, "dispersions": dispersions, "settings": [{"label": "method", "value": "auto"}, {"label": "rtol", "value": "1e-8"}]}
