"""Simulates wings rigid and with panels that bend, and draws when bending matters and what it costs.

    /usr/bin/python3 studies/plots/plot_flexibility.py [PROGRAM] [--quick]

Writes to results/flexibility: the scenes, segments, rule, wing as PNG and SVG, and tables.md. studies/FLEXIBILITY.md
shows them.
"""

import argparse
import json
import math
import pathlib
import shutil
import subprocess

from charts import TAB10, plt, save

PARSER = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
PARSER.add_argument("program", nargs="?", default="build/release/wingspread")
PARSER.add_argument("--quick", action="store_true", help="fewer segments and variants")
GIVEN = PARSER.parse_args()
PROGRAM, QUICK = GIVEN.program, GIVEN.quick
FOLDER = pathlib.Path("results/flexibility")
BETA = 1.8751040687119612  # βL of a cantilever's first mode
LENGTH, MASS = 1.8, 9.5  # of a panel of the yoke wing
EI = 500.0  # N·m², of the cantilever


def written(name, scene):
    path = FOLDER / f"{name}.json"
    path.write_text(json.dumps(scene, indent=1))
    return path


def said(*words):
    done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(done.stderr)
    return json.loads(done.stdout)


def table(title, head, rows):
    text = f"\n{title}\n\n| " + " | ".join(head) + " |\n|" + "---|" * len(head) + "\n"
    return text + "".join("| " + " | ".join(row) + " |\n" for row in rows)


# ---- frequencies of a cantilever against the number of joints


CLAMP = {"stiffness": 1e9 * EI / LENGTH, "damping": 0}


def panel_body(name, flexible=None):
    body = {"name": name, "mass": MASS, "inertia": MASS * LENGTH**2 / 12,
            "plate": {"from": [-LENGTH / 2, 0], "to": [LENGTH / 2, 0], "width": 1, "drag_coefficient": 0}}
    return {**body, "flexible": flexible} if flexible else body


def cantilever(joints):
    """The panel with joints in the middles of elements, clamped."""
    return {"name": "cantilever", "base": {"motion": "fixed"},
            "bodies": [panel_body("panel", {"joints": joints, "bending_stiffness": EI, "damping_ratio": 0})],
            "hinges": [{"name": "root", "parent": "base", "child": "panel", "parent_point": [0, 0],
                        "child_point": [-LENGTH / 2, 0], "angle": 0, "joint": CLAMP}]}


def plain_chain(segments):
    """The panel as equal segments with a joint at the inner end of each but the first, which is clamped."""
    own, stiffness = LENGTH / segments, segments * EI / LENGTH
    bodies = [{"name": f"s{k}", "mass": MASS / segments, "inertia": MASS / segments * own**2 / 12} for k in range(segments)]
    hinges = [{"name": f"j{k}", "parent": f"s{k - 1}" if k else "base", "child": f"s{k}",
               "parent_point": [own / 2 if k else 0, 0], "child_point": [-own / 2, 0], "angle": 0,
               "joint": {"stiffness": stiffness, "damping": 0} if k else CLAMP} for k in range(segments)]
    return {"name": "plain chain", "base": {"motion": "fixed"}, "bodies": bodies, "hinges": hinges}


def first_frequency(name, scene):
    return said("modes", written(name, scene), "--json")["modes"][0]["frequency"]


def segments():
    exact = BETA**2 * math.sqrt(EI / (MASS * LENGTH**3)) / (2 * math.pi)
    counts = [2, 4, 8] if QUICK else [2, 4, 8, 16, 32]
    rows, middle, ends = [], [], []
    for n in counts:
        middle.append(first_frequency(f"middle_{n}", cantilever(n)) / exact - 1)
        ends.append(first_frequency(f"ends_{n}", plain_chain(n)) / exact - 1)
        rows.append([str(n), f"{middle[-1]:+.2e}", f"{ends[-1]:+.2e}"])
    figure, axes = plt.subplots(figsize=(6.5, 4.2))
    axes.loglog(counts, [abs(e) for e in middle], marker="o", color=TAB10[0], label="N joints in the middles of elements")
    axes.loglog(counts, [abs(e) for e in ends], marker="s", color=TAB10[3], label="N segments with joints at their ends")
    axes.set(xlabel="N", ylabel="error of the first frequency")
    axes.legend(frameon=False)
    save(figure, FOLDER / "segments")
    return table("First frequency of a cantilever:", ["N", "N joints in the middles of elements", "segments with joints at their ends"], rows)


# ---- when rigid is enough: one panel that runs into its latch


def arriving_panel(latch_stiffness, flexible):
    """A panel that turns at 0.1 rad/s and latches at once; no torque."""
    return {"name": "arriving panel", "base": {"motion": "fixed"}, "bodies": [panel_body("panel", flexible)],
            "hinges": [{"name": "root", "parent": "base", "child": "panel", "parent_point": [0, 0],
                        "child_point": [-LENGTH / 2, 0], "angle": {"stowed": 1e-6, "latched": 0}, "initial_rate": -0.1,
                        "latch": {"stiffness": latch_stiffness, "damping": 0}}]}


def peak_of(name, scene, hinge, t_end):
    outcome = said("simulate", written(name, scene), "--json", "--t-end", t_end)
    return outcome["peak_moment"][hinge]["value"]


def rule():
    f_1, inertia = 8.0, MASS * LENGTH**2 / 3
    joints = 4 if QUICK else 8
    ratios = [0.1, 1, 3] if QUICK else [0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1, 1.4, 2, 3, 5]
    rows, measured = [], []
    for ratio in ratios:
        stiffness = inertia * (2 * math.pi * f_1 * ratio) ** 2
        rigid = peak_of("arrives_rigid", arriving_panel(stiffness, None), "root", 4 / (f_1 * ratio))
        bent = peak_of("arrives_bent", arriving_panel(stiffness, {"joints": joints, "frequency": f_1, "damping_ratio": 0.01}),
                       "root", max(4 / (f_1 * ratio), 4 / f_1))
        measured.append(rigid / bent)
        rows.append([f"{ratio:g}", f"{rigid:.2f}", f"{bent:.2f}", f"{rigid / bent:.3f}", f"{math.hypot(1, ratio):.3f}"])
    figure, axes = plt.subplots(figsize=(6.5, 4.2))
    axes.loglog(ratios, measured, marker="o", color=TAB10[0], label="rigid over bending, computed")
    axes.loglog(ratios, [math.hypot(1, ratio) for ratio in ratios], color="0.4", linestyle="--", label="√(1 + (f_latch/f_1)²)")
    axes.set(xlabel="f_latch/f_1", ylabel="ratio of the root's peak moments")
    axes.legend(frameon=False)
    save(figure, FOLDER / "rule")
    return table(f"One panel, first frequency {f_1:g} Hz, latches at 0.1 rad/s:",
                 ["f_latch/f_1", "rigid, N·m", "bending, N·m", "rigid/bending", "√(1 + (f_latch/f_1)²)"], rows)


# ---- the yoke wing


HINGES = ("root", "h1", "h2", "h3", "h4")


def yoke_wing(joints, frequency):
    """The yoke wing with panels of this first frequency (clamped), Hz; rigid for 0 joints. The yoke stays rigid."""
    scene = json.loads(pathlib.Path("studies/scenes/yoke_wing.json").read_text())
    for body in scene["bodies"][1:] if joints else []:
        body["plate"] = {"from": [-LENGTH / 2, 0], "to": [LENGTH / 2, 0], "width": 1, "drag_coefficient": 0}
        body["flexible"] = {"joints": joints, "frequency": frequency, "damping_ratio": 0.01}
    return scene


def wing_row(name, scene):
    outcome = said("simulate", written(name, scene), "--json", "--t-end", "30")
    last = max((latch["time"] for latch in outcome["latches"]), default=math.nan)
    return outcome, [f"{last:.3f}"] + [f"{outcome['peak_moment'][hinge]['value']:.0f}" for hinge in HINGES]


def wing():
    _, rigid = wing_row("yoke_rigid", yoke_wing(0, 0))
    head = ["deployed after, s"] + [f"{hinge}, N·m" for hinge in HINGES]
    rows, peaks = [["rigid", *rigid]], {}
    for frequency in [8] if QUICK else [2, 4, 8, 16, 32]:
        outcome, row = wing_row(f"yoke_{frequency}_Hz", yoke_wing(2 if QUICK else 4, frequency))
        rows.append([f"{frequency} Hz", *row])
        peaks[frequency] = [outcome["peak_moment"][hinge]["value"] / float(value) for hinge, value in zip(HINGES, rigid[1:])]
    text = table("The yoke wing, panels of this first frequency, four joints each:", ["", *head], rows)
    rows = [["0", *rigid, "1.0"]]
    base = said("simulate", FOLDER / "yoke_rigid.json", "--json", "--t-end", "30")["work"]["rhs_evaluations"]
    for joints in [1, 2] if QUICK else [1, 2, 4, 8]:
        outcome, row = wing_row(f"yoke_{joints}_joints", yoke_wing(joints, 8))
        rows.append([str(joints), *row, f"{outcome['work']['rhs_evaluations'] / base:.1f}"])
    figure, axes = plt.subplots(figsize=(6.5, 4.2))
    for k, hinge in enumerate(HINGES):
        axes.semilogx(list(peaks), [ratios[k] for ratios in peaks.values()], marker="o", color=TAB10[k], label=hinge)
    axes.axhline(1, color="0.4", linewidth=0.8)
    axes.set(xlabel="first frequency of a clamped panel, Hz", ylabel="peak moment over the rigid wing's")
    axes.legend(frameon=False)
    save(figure, FOLDER / "wing")
    return text + table("The yoke wing at 8 Hz against the number of joints of a panel:",
                        ["joints", *head, "evaluations over rigid"], rows)


# ---- what limits the steps of a wing that bends


STRETCHES = [(0.7, 5), (7, 12.5), (16.5, 20)]  # s: nothing latched; the roots latched; all latched, ringing


def bending_wings(joints=2, frequency=None, damping=None, width=None):
    scene = json.loads(pathlib.Path("studies/scenes/bending_wings.json").read_text())
    for body in scene["bodies"]:
        if not joints:
            body.pop("flexible", None)
        elif "flexible" in body:
            body["flexible"] |= {"joints": joints, "frequency": frequency or body["flexible"]["frequency"]}
    for hinge in scene["hinges"]:
        hinge["latch"]["damping"] = damping or hinge["latch"]["damping"]
        hinge["friction"]["regularization_rate"] = width or hinge["friction"]["regularization_rate"]
    return scene


def mean_steps(name, scene, rtol):
    """Mean length of an explicit step in each stretch, ms."""
    path, lengths = written(name, scene), []

    def count(t):
        return said("simulate", path, "--json", "--method", "dop853", "--rtol", rtol, "--atol", rtol / 100, "--t-end", t)["work"]["steps"]

    for begin, end in STRETCHES:
        lengths.append(f"{1e3 * (end - begin) / (count(end) - count(begin)):.1f}")
    return lengths


def steps():
    variants = [("as shipped", {}, 1e-6), ("rtol 1e-4", {}, 1e-4), ("rtol 1e-8", {}, 1e-8),
                ("rigid panels", {"joints": 0}, 1e-6), ("1 joint", {"joints": 1}, 1e-6), ("4 joints", {"joints": 4}, 1e-6),
                ("16 Hz", {"frequency": "16 Hz"}, 1e-6),
                ("latch damping 160 N·m·s/rad, friction over 0.06 deg/s", {"damping": 160, "width": "0.06 deg/s"}, 1e-6),
                ("the same, rtol 1e-4", {"damping": 160, "width": "0.06 deg/s"}, 1e-4)]
    rows = [[name, *mean_steps(f"steps_{k}", bending_wings(**given), rtol)] for k, (name, given, rtol) in enumerate(variants[:2] if QUICK else variants)]
    return table("Mean step of dop853, ms, bending_wings:", ["", "nothing latched", "roots latched", "all latched"], rows)


# ---- how many joints a campaign needs


def moments(joints):
    """A row of the table below: the campaign bending_wings with so many joints a panel."""
    outputs = ["R_root.peak_moment", "R_tip.peak_moment", "R_panel_2.peak_bending_moment"]
    campaign = json.loads(pathlib.Path("studies/campaigns/bending_wings.json").read_text())
    campaign["scene"] = str(written(f"bending_{joints}", bending_wings(joints)).resolve())
    campaign["statistics"] = campaign.get("statistics", {}) | {"accuracy_runs": 0}
    out = FOLDER / f"bending_{joints}_runs"
    shutil.rmtree(out, ignore_errors=True)
    command = [PROGRAM, "run", written(f"bending_{joints}_campaign", campaign), "--runs", "400", "--threads", "1", "--out", out]
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    if done.returncode not in (0, 1):  # 1: a requirement is not met
        raise SystemExit(done.stderr)
    summary, timing = (json.loads((out / name).read_text()) for name in ("summary.json", "timing.json"))
    found = [f"{summary['outputs'][name]['mean']:.2f}, {summary['outputs'][name]['quantiles'][-1]['value']:.2f}" for name in outputs]
    work = said("simulate", written(f"bending_{joints}", bending_wings(joints)), "--json")["work"]
    return [str(joints), *found, f"{work['rhs_evaluations']:,}", f"{timing['runs_per_second']:.0f}"]


def campaign_joints():
    rows = [moments(joints) for joints in ((1,) if QUICK else (1, 2, 4))]
    head = ["joints a panel", "R_root, N·m", "R_tip, N·m", "bending moment, N·m", "evaluations of the nominal run", "runs a second"]
    return table("Mean and 99 % of peak moments of 400 runs, bending_wings:", head, rows)


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    text = "".join(part() for part in (segments, rule, wing, steps, campaign_joints))
    (FOLDER / "tables.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
