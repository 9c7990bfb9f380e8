"""Draws the charts of a throughput folder.

    /usr/bin/python3 studies/plots/plot_throughput.py results/throughput

To the folder: throughput.png and .svg: runs a second against tolerance, threads and packs, and the
cost of an evaluation against the number of bodies.
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


def main(folder):
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
