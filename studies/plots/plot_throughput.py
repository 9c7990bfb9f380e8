"""Draws the charts of a throughput folder.

    /usr/bin/python3 studies/plots/plot_throughput.py results/throughput

To the folder: throughput.png and .svg: runs a second against tolerance, threads and packs, and the cost of an evaluation against
the number of bodies; throughput_campaigns.png and .svg: whole campaigns, and whole runs of chains of more and more panels.
"""

import csv
import pathlib
import sys

from charts import number, plt, save

COLOURS = {"scalar": "tab:gray", "avx2": "tab:blue", "avx512": "tab:orange"}
LANES = {"scalar": "1 lane", "avx2": "4 lanes (AVX2)", "avx512": "8 lanes (AVX-512)"}


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def lines(axes, rows, x, y):
    """One line an instruction set."""
    for name, label in LANES.items():
        points = [(number(row[x]), number(row[y])) for row in rows if row["set"] == name]
        if points:
            axes.plot(*zip(*points), "o-", color=COLOURS[name], label=label)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.grid(True, alpha=0.3)
    axes.legend()


def whole_campaigns(axes, rows):
    """µs a run, alone and in packs, all outputs and to the first latch."""
    names = [f"{row['campaign']}\n{row['what'].replace('A: ', '')}" for row in rows]
    for shift, key, colour, label in ((-0.2, "scalar us", COLOURS["scalar"], "alone"), (0.2, "packs us", COLOURS["avx512"], "in packs")):
        bars = axes.bar([i + shift for i in range(len(rows))], [number(row[key]) for row in rows], width=0.38, color=colour, label=label)
        axes.bar_label(bars, [f"{number(row[key]):.0f}" for row in rows], fontsize=7)
    axes.set_xticks(range(len(rows)), names, fontsize=7, rotation=30, ha="right")
    axes.set(yscale="log", ylabel="µs a run of one core", title="whole campaigns as they stand")
    axes.margins(y=0.2)
    axes.legend(fontsize=8)


def whole_runs(axes, rows):
    """Evaluations of whole runs, and what they are made of: seconds of motion, and evaluations a second of it."""
    n = [number(row["panels"]) for row in rows]
    series = [("evaluations", [number(row["evaluations"]) for row in rows], "o-"),
              ("µs in packs", [number(row["us"]) for row in rows], "s-"),
              ("evaluations a second of motion", [number(row["evaluations"]) / number(row["end [s]"]) for row in rows], "^--"),
              ("seconds to its end", [number(row["end [s]"]) for row in rows], "v--")]
    for label, values, style in series:
        axes.plot(n, values, style, label=label)
    axes.set(xscale="log", yscale="log", xlabel="panels of the long chain", title="whole runs against the number of panels")
    axes.set_xticks(n, [f"{each:g}" for each in n])
    axes.margins(y=0.3)
    axes.grid(True, alpha=0.3)
    axes.legend(fontsize=8, ncols=2)


def main(folder):
    figure, (campaigns, panels) = plt.subplots(1, 2, figsize=(12, 4.8), layout="constrained")
    whole_campaigns(campaigns, read(folder / "campaigns.csv"))
    whole_runs(panels, read(folder / "panels.csv"))
    save(figure, folder / "throughput_campaigns")

    figure, ((tolerance, bodies), (packs, threads)) = plt.subplots(2, 2, figsize=(12, 8.5), layout="constrained")
    lines(tolerance, read(folder / "tolerance.csv"), "rtol", "runs a second")
    tolerance.set(xlabel="rtol", ylabel="runs a second of one core", title="seed wing, all outputs, against tolerance")
    lines(bodies, read(folder / "bodies.csv"), "bodies", "ns an evaluation")
    bodies.set(xlabel="panels", ylabel="ns an evaluation and run", title="against the number of panels (steps and all)")

    rows = read(folder / "packs.csv")
    names = list(dict.fromkeys(row["what"] for row in rows))
    sets = [name for name in LANES if any(row["set"] == name for row in rows)]
    for k, name in enumerate(sets):
        at = [i + 0.27 * (k - (len(sets) - 1) / 2) for i in range(len(names))]
        us = [number(row["us"]) for what in names for row in rows if (row["what"], row["set"]) == (what, name)]
        bars = packs.bar(at, us, width=0.25, color=COLOURS[name], label=LANES[name])
        packs.bar_label(bars, fmt="%.3g", fontsize=8)
    packs.set_xticks(range(len(names)), [name.replace(": ", ":\n").replace(", ", ",\n") for name in names], fontsize=8)
    packs.set(yscale="log", ylabel="µs a run of one core", title="packs against the scalar path, rtol 1e-8")
    packs.legend()

    rows = read(folder / "threads.csv")
    team = [number(row["threads"]) for row in rows]
    rate = [number(row["runs a second"]) for row in rows]
    threads.plot(team, rate, "o-", color="tab:green", label="measured")
    threads.plot(team, [rate[0] * n for n in team], ":", color="black", label="proportional")
    threads.set(xlabel="threads", ylabel="runs a second", ylim=(0, None), xticks=team,
                title="the seed campaign through the sampler")
    threads.grid(True, alpha=0.3)
    threads.legend()
    save(figure, folder / "throughput")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
