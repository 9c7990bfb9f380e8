"""Simulates the yoke wing without its stops, loops, measured springs and damper, one by one, and draws the changes.

    /usr/bin/python3 studies/plots/plot_real_wings.py [PROGRAM]

Runs the variants of studies/scenes/yoke_wing.json, a minute in all, and writes to results/real_wings: the scenes,
trajectories, stops, loops, torques, damper as PNG and SVG, and tables.md. studies/REAL_WINGS.md shows them.
"""

import argparse
import json
import math
import pathlib
import subprocess

from charts import TAB10, plt, read_rows, save

PARSER = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
PARSER.add_argument("program", nargs="?", default="build/release/wingspread")
PROGRAM = PARSER.parse_args().program
FOLDER = pathlib.Path("results/real_wings")
HINGES = ("root", "h1", "h2", "h3", "h4")
DEGREES = 180 / math.pi
RUNS, T_END = 400, 60


def load():
    return json.loads(pathlib.Path("studies/scenes/yoke_wing.json").read_text())


def degrees(angle):
    return float(angle.split()[0]) if isinstance(angle, str) else angle * DEGREES


# ---- variants: functions of a scene


def without_loops(scene):
    scene.pop("synchronisations", None)


def without_stops(scene):
    for hinge in scene["hinges"]:
        hinge.pop("stop", None)


def without_damper(scene):
    scene["hinges"][0].pop("damper", None)


def loops_of(stiffness):
    """The scene with loops of this stiffness, equally damped, never slack."""
    def change(scene):
        for loop in scene["synchronisations"]:
            loop["damping"] *= math.sqrt(stiffness / loop["stiffness"])
            loop["stiffness"] = stiffness
            loop.pop("preload", None)
    return change


def linear_springs(scene):
    """What a drawing would have: a straight line between the mean torques at both ends, friction as at the end."""
    for hinge in scene["hinges"]:
        test = hinge["spring"]["measured"]
        both = list(zip(test["deploying"], test["stowing"]))
        middle = [(a + b) / 2 for a, b in both]
        hinge["spring"] = {"torque_stowed": middle[0], "torque_latched": middle[-1]}
        level = abs(both[-1][1] - both[-1][0]) / 2
        hinge["friction"]["coulomb"] += level
        hinge["friction"]["static"] += level
        table = hinge["harness"]["table"]["torque"]
        hinge["harness"] = {"torque_stowed": table[0], "torque_latched": table[-1]}


def made(name, *changes):
    """Writes the changed scene and returns its path."""
    scene = load()
    for change in changes:
        change(scene)
    path = FOLDER / f"{name}.json"
    path.write_text(json.dumps(scene, indent=1))
    return path


# ---- what the program says


def simulate(path):
    """Simulates the scene and returns outcome and trajectory."""
    rows = path.with_suffix(".csv")
    done = subprocess.run([PROGRAM, "simulate", path, "--json", "--t-end", str(T_END), "--out", rows],
                          capture_output=True, text=True, check=True)
    return json.loads(done.stdout), read_rows(rows)


def campaign(path):
    """Makes RUNS dispersed runs and returns their summary and rows."""
    whole = json.loads(pathlib.Path("studies/campaigns/yoke_wing.json").read_text())
    has = json.loads(path.read_text())
    kept = {"spring": True, "friction": True, "harness": True, "mass": True, "latch_damping": True,
            "damper": "damper" in has["hinges"][0], "loop_stiffness": "synchronisations" in has,
            "stop_stiffness": "stop" in has["hinges"][0]}
    whole.update(scene=path.name, requirements=[])
    whole["dispersions"] = [one for one in whole["dispersions"] if kept.get(one["name"], "through" not in one)]
    whole.pop("cases", None)  # and the temperature that makes them: one thing at a time
    file, out = path.with_suffix(".campaign.json"), path.with_suffix(".runs")
    file.write_text(json.dumps(whole, indent=1))
    subprocess.run(["rm", "-rf", out], check=True)
    done = subprocess.run([PROGRAM, "run", file, "--out", out, "--runs", str(RUNS)], capture_output=True, text=True)
    if done.returncode not in (0, 1):
        raise SystemExit(done.stderr)
    return json.loads((out / "summary.json").read_text()), read_rows(out / "runs.csv")


def order(outcome):
    return " > ".join(latch["hinge"] for latch in outcome["latches"])


def table(title, head, rows):
    text = f"\n{title}\n\n| " + " | ".join(head) + " |\n|" + "---|" * len(head) + "\n"
    return text + "".join("| " + " | ".join(row) + " |\n" for row in rows)


# ---- pictures


def wing_line(scene, angles):
    """From the base's hinge along the hinges to the tip, in m."""
    x = y = turn = 0.0
    line, before = [(0.0, 0.0)], (0.0, 0.0)
    for hinge, angle in zip(scene["hinges"], angles):
        arm = [a - b for a, b in zip(hinge["parent_point"], before)]
        c, s = math.cos(turn), math.sin(turn)
        x, y = x + c * arm[0] - s * arm[1], y + s * arm[0] + c * arm[1]
        line.append((x, y))
        turn += angle
        before = hinge["child_point"]
    c, s = math.cos(turn), math.sin(turn)
    line.append((x - 2 * c * before[0], y - 2 * s * before[0]))  # panels hang in their middle
    return line[1:]


def at(rows, t):
    return min(rows, key=lambda row: abs(row["t"] - t))


def draw_wing(axes, scene, row, colour, shift=0.0, wide=1.6):
    line = wing_line(scene, [row[f"{hinge}.angle"] for hinge in HINGES])
    axes.plot([x + shift for x, _ in line], [y for _, y in line], color=colour, linewidth=wide, marker="o", markersize=2.5,
              solid_capstyle="round")


def travel(scene, rows, hinge):
    spec = next(one for one in scene["hinges"] if one["name"] == hinge)["angle"]
    stowed, latched = degrees(spec["stowed"]), degrees(spec["latched"])
    sense = 1 if latched > stowed else -1
    return [sense * (row[f"{hinge}.angle"] * DEGREES - stowed) for row in rows]


def stops():
    free = made("no_stops", without_loops, without_damper, without_stops)
    held = made("stops", without_loops, without_damper)
    results = [(name, json.loads(path.read_text()), *simulate(path)) for name, path in
               (("without stops", free), ("with stops", held))]
    figure, panels = plt.subplot_mosaic([["way", "free"], ["way", "held"]], figsize=(13, 5.6), width_ratios=(1, 1.5))
    axes = [panels[name] for name in ("way", "free", "held")]
    for (name, scene, _, rows), colour in zip(results, (TAB10[3], TAB10[0])):
        axes[0].plot([row["t"] for row in rows], travel(scene, rows, "h2"), color=colour, label=name)
    axes[0].axhline(0, color="0.4", linewidth=0.8)
    axes[0].set(xlabel="t, s", ylabel="travel of h2 from its stowed angle, °", xlim=(0, 16), ylim=(-40, 190))
    axes[0].legend(frameon=False)
    deepest = max(results[0][3], key=lambda row: -min(travel(results[0][1], [row], "h2")))["t"]
    times = [0, 0.6 * deepest, deepest, 1.6 * deepest]
    for (name, scene, _, rows), panel in zip(results, axes[1:]):
        for k, t in enumerate(times):
            draw_wing(panel, scene, at(rows, t), TAB10[3] if t == deepest and name == "without stops" else str(0.72 - 0.2 * k),
                      shift=3.4 * k)
            panel.text(3.4 * k, -1.75, f"{t:.2f} s", ha="center", fontsize=8)
        panel.set(title=name, aspect="equal", xticks=[], yticks=[], ylim=(-1.95, 1.5), xlim=(-1, 12.8))
    save(figure, FOLDER / "stops")
    rows = []
    for name, _, outcome, _ in results:
        latches = {latch["hinge"]: latch for latch in outcome["latches"]}
        worst = max(HINGES, key=lambda hinge: outcome["overtravel"][hinge])
        rows.append([name, f"{worst} {outcome['overtravel'][worst] * DEGREES:.1f}°", order(outcome)]
                    + [f"{abs(latches[hinge]['rate']):.2f}" if hinge in latches else "–" for hinge in HINGES])
    return table("Stops, without loops and damper:", ["", "furthest beyond stowed", "order of latching"]
                 + [f"{hinge}, rad/s" for hinge in HINGES], rows)


def loops():
    variants = [("none", made("no_loops", without_loops))]
    variants += [(f"{K:g} N·m/rad", made(f"loops_{K:g}", loops_of(K))) for K in (35, 350, 3500, 35000, 350000)]
    figure, axes = plt.subplots(1, 2, figsize=(13, 4.2))
    rows = []
    for k, (name, path) in enumerate(variants):
        outcome, trajectory = simulate(path)
        scene = json.loads(path.read_text())
        colour = plt.get_cmap("viridis")(k / (len(variants) - 0.5)) if k else TAB10[3]
        t = [row["t"] for row in trajectory]
        apart = [b - 2 * a for a, b in zip(travel(scene, trajectory, "root"), travel(scene, trajectory, "h1"))]
        axes[0].plot(t, apart, color=colour, label=name, linewidth=1.1)
        axes[1].plot(t, travel(scene, trajectory, "h2"), color=colour)
        last = {latch["hinge"]: latch["time"] for latch in outcome["latches"]}
        rows.append([name, order(outcome), f"{max(last.values()) - min(last.values()):.2f}" if len(last) == 5 else "–",
                     f"{max(last.values()):.2f}"] + [f"{outcome['peak_moment'][hinge]['value']:.0f}" for hinge in HINGES]
                    + [f"{outcome['work']['rhs_evaluations']:,}"])
    axes[0].set(xlabel="t, s", ylabel="travel of h1 less twice the root's, °", xlim=(0, 16), ylim=(-4, 2))
    axes[1].set(xlabel="t, s", ylabel="travel of h2, °", xlim=(0, 16))
    axes[0].legend(frameon=False, title="stiffness of the loops")
    save(figure, FOLDER / "loops")
    return table("Loops:", ["stiffness", "order of latching", "first to last latch, s", "deployed after, s"]
                 + [f"{hinge}, N·m" for hinge in HINGES] + ["evaluations to 60 s"], rows)


def drawn_histograms(axes, results, output, label):
    values = [[row[output] for row in rows if row[output] == row[output]] for _, _, rows in results]
    low, high = min(map(min, values)), max(map(max, values))
    bins = [low + (high - low) * k / 36 for k in range(37)]
    for (name, _, _), own, colour in zip(results, values, (TAB10[0], TAB10[1])):
        axes.hist(own, bins=bins, histtype="stepfilled", alpha=0.5, color=colour, label=name)
    axes.set(xlabel=label, ylabel="runs")
    axes.legend(frameon=False)


def statistics_rows(results):
    rows = []
    for name, summary, runs in results:
        row = [name, f"{summary['status']['deployed']['count']} of {RUNS}"]
        for output in ("deployment_time", "root.peak_moment", "h2.peak_moment", "root.peak_force"):
            own = sorted(run[output] for run in runs if run[output] == run[output])
            row.append(f"{own[len(own) // 2]:.1f} ({own[len(own) // 100]:.1f} … {own[-1 - len(own) // 100]:.1f})")
        rows.append(row)
    return rows


HEAD = ["", "deployed", "deployment time, s", "root moment, N·m", "h2 moment, N·m", "root force, N"]


def torques():
    measured, linear = made("measured"), made("linear", linear_springs)
    results = [(name, *campaign(path)) for name, path in (("measured", measured), ("linear", linear))]
    figure, axes = plt.subplots(1, 3, figsize=(13, 4.2))
    test = load()["hinges"][2]["spring"]["measured"]
    angles = [degrees(angle) for angle in test["angle"]]
    axes[0].plot(angles, test["deploying"], color=TAB10[0], marker="o", markersize=3, label="deploying")
    axes[0].plot(angles, test["stowing"], color=TAB10[0], marker="o", markersize=3, linestyle="--", label="stowing")
    ends = [(test["deploying"][k] + test["stowing"][k]) / 2 for k in (0, -1)]
    axes[0].plot([angles[0], angles[-1]], ends, color=TAB10[1], label="linear")
    axes[0].set(xlabel="angle of h2, °", ylabel="spring torque, N·m")
    axes[0].invert_xaxis()
    axes[0].legend(frameon=False)
    drawn_histograms(axes[1], results, "deployment_time", "deployment time, s")
    drawn_histograms(axes[2], results, "h2.peak_moment", "largest moment at h2, N·m")
    save(figure, FOLDER / "torques")
    return table(f"Torque tests against straight lines, {RUNS} dispersed runs, median (1 % … 99 %):", HEAD, statistics_rows(results))


def damper():
    with_it, without = made("damped"), made("undamped", without_damper)
    results = [(name, *campaign(path)) for name, path in (("with the damper", with_it), ("without", without))]
    figure, axes = plt.subplots(1, 2, figsize=(13, 4.2))
    for path, (name, _, _), colour in zip((with_it, without), results, (TAB10[0], TAB10[1])):
        _, rows = simulate(path)
        axes[0].plot([row["t"] for row in rows], [-row["root.rate"] for row in rows], color=colour, label=name)
    axes[0].set(xlabel="t, s", ylabel="rate of the root, rad/s", xlim=(0, 15))
    axes[0].legend(frameon=False)
    drawn_histograms(axes[1], results, "root.peak_moment", "largest moment at the root, N·m")
    save(figure, FOLDER / "damper")
    return table(f"The root's damper, {RUNS} dispersed runs, median (1 % … 99 %):", HEAD, statistics_rows(results))


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    text = "".join(part() for part in (stops, loops, torques, damper))
    (FOLDER / "tables.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
