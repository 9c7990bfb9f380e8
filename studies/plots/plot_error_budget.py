"""Draws speed against numerical and statistical error together, from what studies/drivers/error_budget.cpp wrote.

    /usr/bin/python3 studies/plots/plot_error_budget.py results/error_budget

To the folder: error_budget.png and .svg; and a table for each campaign on standard output.
"""

import math
import pathlib
import sys

import matplotlib.pyplot as plt
from charts import distinct, read_rows, save

TITLES = {"seed": "seed wing with friction", "work_precision": "three panels, no friction", "yoke_wing": "yoke wing, four panels"}
RUNS = [10**k for k in range(2, 7)]
FINE = [10 ** (2 + k / 20) for k in range(81)]


class Tolerance:
    """A tolerance's errors, over σ, of the output that is worst off, and its work a run."""

    def __init__(self, rows):
        rows = [row for row in rows if not math.isnan(row["rms"])]
        self.rtol, self.evaluations, self.cpu = (rows[0][key] for key in ("rtol", "evaluations", "cpu"))
        self.in_doubt, self.runs = rows[0]["in doubt"], rows[0]["runs"]
        self.rms = max(row["rms"] / row["sigma"] for row in rows)
        self.mean = max(abs(row["mean error"]) / row["sigma"] for row in rows)

    def total(self, runs):
        """Of a mean by so many runs: sampling, and the error that is the same in all of them."""
        return math.hypot(1 / math.sqrt(runs), self.mean)


def draw_work(axes, tolerances, spread):
    """Error against evaluations in all: a line a tolerance, along which the number of runs grows."""
    shown = [its for its in tolerances if its.rtol in (1e-3, 1e-6, 1e-8, 1e-11)]
    for its, colour in zip(shown, ("tab:olive", "tab:red", "black", "tab:purple")):
        axes.plot([its.evaluations * n for n in FINE], [its.total(n) for n in FINE], color=colour, linewidth=1.3,
                  label=f"rtol {its.rtol:.0e}".replace("e-0", "e-"))
        axes.plot([its.evaluations * n for n in RUNS], [its.total(n) for n in RUNS], "o", color=colour, markersize=3.5)
    usual = next(its for its in tolerances if its.rtol == 1e-6)
    axes.plot([usual.evaluations * n for n in spread], list(spread.values()), "o", color="tab:red", fillstyle="none",
              markersize=8, label="block means' spread, measured")
    axes.set_xscale("log"), axes.set_yscale("log")
    axes.set_xlabel("evaluations of the whole campaign", fontsize=9)


def draw_tolerances(axes, tolerances):
    """What a run's tolerance leaves, beside what the number of runs does."""
    rtols = [its.rtol for its in tolerances]
    axes.plot(rtols, [its.rms for its in tolerances], "o-", color="tab:blue", label="a run's RMS error", markersize=4)
    axes.plot(rtols, [its.mean for its in tolerances], "s--", color="tab:blue", label="mean error of runs", markersize=4, alpha=0.7)
    for n in RUNS[::2]:
        sampling = 1 / math.sqrt(n)
        axes.axhline(sampling, color="0.45", linewidth=1)
        axes.text(min(rtols), 1.25 * sampling, f"sampling error, N = 1e{round(math.log10(n))}", fontsize=8, color="0.3", ha="right")
        if n > 1e2:  # of the first it is where the last has its sampling error
            axes.axhline(0.01 * sampling, color="0.45", linewidth=1, linestyle=":")
            axes.text(min(rtols), 0.0125 * sampling, f"1 % of it, N = 1e{round(math.log10(n))}", fontsize=8, color="0.3", ha="right")
    axes.set_xscale("log"), axes.set_yscale("log"), axes.invert_xaxis()
    axes.set_xlabel("rtol", fontsize=9)


def draw_gain(axes, tolerances):
    """The error of a mean for the same work at every tolerance, over that at 1e-8."""
    usual = next(its for its in tolerances if its.rtol == 1e-8)
    for n, style in zip((1e2, 1e4, 1e6, 1e8), ("o-", "s-", "^-", "x--")):
        axes.plot([its.rtol for its in tolerances],
                  [its.total(n * usual.evaluations / its.evaluations) / usual.total(n) for its in tolerances], style,
                  color=plt.get_cmap("viridis")(math.log10(n) / 9), markersize=4.5, linewidth=1.2,
                  label=f"the work of 1e{round(math.log10(n))} runs at 1e-8")
    axes.axhline(1, color="0.45", linewidth=1)
    axes.set_xscale("log"), axes.invert_xaxis()
    axes.set_ylim(0, 2.6)
    axes.set_xlabel("rtol", fontsize=9)


def mean_spread(rows):
    """Of the block means over σ, by the blocks' number of runs, averaged over the outputs."""
    spread = {}
    for runs in distinct(rows, "runs"):
        ratios = [row["spread"] / row["sigma"] for row in rows if row["runs"] == runs and row["sigma"] > 0]
        spread[runs] = math.sqrt(sum(ratio**2 for ratio in ratios) / len(ratios))
    return spread


def print_table(name, tolerances):
    print(f"\n{name}: errors over sigma, the worst output; runs that a budget of 1e9 evaluations pays for, and its error")
    print(f"{'rtol':>8}{'evaluations':>13}{'us':>9}{'in doubt':>10}{'RMS':>11}{'mean':>11}{'runs':>12}{'error':>11}")
    for its in tolerances:
        runs = 1e9 / its.evaluations
        print(f"{its.rtol:8.0e}{its.evaluations:13,.0f}{its.cpu:9.0f}{its.in_doubt:6.0f}/{its.runs:.0f}"
              f"{its.rms:11.1e}{its.mean:11.1e}{runs:12,.0f}{its.total(runs):11.2e}")


def main(folder):
    folder = pathlib.Path(folder)
    errors, sampling = (read_rows(folder / f"{name}.csv") for name in ("error_budget", "sampling"))
    names = distinct(errors, "campaign")
    figure, grid = plt.subplots(3, len(names), figsize=(4.6 * len(names), 11.5), squeeze=False)
    for column, name in zip(grid.T, names):
        its = [row for row in errors if row["campaign"] == name]
        tolerances = [Tolerance([row for row in its if row["rtol"] == rtol]) for rtol in distinct(its, "rtol")]
        draw_work(column[0], tolerances, mean_spread([row for row in sampling if row["campaign"] == name]))
        draw_tolerances(column[1], tolerances)
        draw_gain(column[2], tolerances)
        column[0].set_title(TITLES.get(name, name), fontsize=11)
        print_table(name, tolerances)
        for axes in column:
            axes.grid(True, color="0.9", linewidth=0.6)
            axes.tick_params(labelsize=8)
    for row, text in zip(grid, ("error of a mean / σ: sampling and integration\n(dots: N = 1e2 … 1e6)", "error / σ, the worst output",
                                "error of a mean for the same work,\nover that at rtol 1e-8")):
        row[0].set_ylabel(text, fontsize=9)
    for row, corner in zip(grid, ("upper right", "lower left", "upper left")):
        row[0].legend(fontsize=8, frameon=False, loc=corner)
    figure.suptitle("Where is the work best spent: on more runs, or on a tighter tolerance?", fontsize=12)
    figure.tight_layout(rect=(0, 0, 1, 0.985))
    save(figure, folder / "error_budget")


if __name__ == "__main__":
    main(sys.argv[1])
