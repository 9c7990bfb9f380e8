"""Draws how the error of each statistic falls with the number of runs, design by design.

    /usr/bin/python3 studies/plots/plot_design_error.py results/design_error

To the folder: design_error.png and .svg. The fitted slopes are printed.
"""

import csv
import math
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.ticker import FixedLocator, LogLocator, NullLocator

TITLES = {"mean": "mean", "std": "standard deviation", "q01": "1 % quantile", "q50": "median", "q99": "99 % quantile"}
TAB10 = plt.get_cmap("tab10").colors
STYLES = {"random": dict(color="0.35", marker="o", label="random"),
          "latin_hypercube": dict(color=TAB10[0], marker="s", label="Latin hypercube"),
          "sobol": dict(color=TAB10[3], marker="D", label="scrambled Sobol'")}


def read_points(path):
    """(runs, RMS error) by (output, statistic, design), fewest runs first; and the number of replicates."""
    points = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            key = row["output"], row["statistic"], row["design"]
            points.setdefault(key, []).append((int(row["runs"]), float(row["rms_error"])))
            replicates = int(row["replicates"])
    return {key: sorted(its) for key, its in points.items()}, replicates


def slope(line):
    """Of log error against log runs, by least squares."""
    logs = [(math.log(n), math.log(rms)) for n, rms in line]
    mean_x, mean_y = (sum(values) / len(logs) for values in zip(*logs))
    return sum((x - mean_x) * (y - mean_y) for x, y in logs) / sum((x - mean_x) ** 2 for x, _ in logs)


def draw_guide(axes, line):
    """Where the error of independent draws would be, from their first point on."""
    first_n, first = line[0]
    runs = [n for n, _ in line]
    axes.plot(runs, [first * (n / first_n) ** -0.5 for n in runs], color="0.75", linewidth=1, linestyle=":", zorder=0)


def draw_panel(axes, points, output, statistic, replicates):
    axes.set_xscale("log", base=2), axes.set_yscale("log")
    for design, style in STYLES.items():
        line = points[output, statistic, design]
        runs, errors = [p[0] for p in line], [p[1] for p in line]
        axes.plot(runs, errors, linewidth=1.4, markersize=4.5, **style)
        half = 1 / math.sqrt(2 * replicates)  # relative standard error of an RMS of normal errors
        axes.fill_between(runs, [e * (1 - half) for e in errors], [e * (1 + half) for e in errors],
                          color=style["color"], alpha=0.15, linewidth=0)
    draw_guide(axes, points[output, statistic, "random"])
    axes.xaxis.set_major_locator(FixedLocator([n for n, _ in points[output, statistic, "random"]][::2]))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(lambda n, _: f"{n:.0f}")
    axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axes.yaxis.set_major_formatter(lambda error, _: f"{error:g}")
    axes.yaxis.set_minor_locator(NullLocator())
    axes.grid(True, which="major", color="0.88", linewidth=0.6)
    axes.tick_params(labelsize=8)


def draw_figure(points, replicates, folder):
    outputs = list(dict.fromkeys(output for output, _, _ in points))
    figure, grid = plt.subplots(len(outputs), len(TITLES), figsize=(3.3 * len(TITLES), 2.9 * len(outputs)),
                                squeeze=False, sharex=True)
    for output, row in zip(outputs, grid):
        for (statistic, title), axes in zip(TITLES.items(), row):
            draw_panel(axes, points, output, statistic, replicates)
            if output == outputs[0]:
                axes.set_title(title, fontsize=10)
            if output == outputs[-1]:
                axes.set_xlabel("runs", fontsize=9)
        row[0].set_ylabel(f"{output}\nRMS error, rad/s", fontsize=9)
    figure.suptitle(f"Error of the latch rates' statistics, {replicates} replicates of each design\n"
                    "dotted: 1/√N; shaded: ± one standard error of the RMS", fontsize=10)
    handles, labels = grid[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=len(labels), fontsize=9, frameon=False)
    figure.tight_layout(rect=(0, 0.04, 1, 0.985))
    for suffix in (".png", ".svg"):
        figure.savefig(folder / f"design_error{suffix}", dpi=110)
    plt.close(figure)
    print(f"drawn: {folder / 'design_error.png'}")


def print_slopes(points):
    print(f"\nSlope of log error against log runs\n{'output':18}{'statistic':20}" + "".join(f"{name:>18}" for name in STYLES))
    for output, statistic in dict.fromkeys(key[:2] for key in points):
        slopes = "".join(f"{slope(points[output, statistic, design]):>18.2f}" for design in STYLES)
        print(f"{output:18}{TITLES[statistic]:20}{slopes}")


def main(folder):
    folder = pathlib.Path(folder)
    points, replicates = read_points(folder / "design_error.csv")
    draw_figure(points, replicates, folder)
    print_slopes(points)


if __name__ == "__main__":
    main(sys.argv[1])
