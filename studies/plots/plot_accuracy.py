"""Draws the charts of the studies stiffness, latch_model and stability_map, whichever a folder holds.

    /usr/bin/python3 studies/plots/plot_accuracy.py results/stiffness results/latch_model results/stability_map

To each folder, as .png and .svg: stiffness_rtol_….., stiffness_ringing, stiffness_corner; latch_model;
stability_limits, stability_regions.
"""

import math
import pathlib
import sys

from charts import TAB10, distinct, legend_below, plt, read_rows, save, styles
from matplotlib.colors import LogNorm

HINGES = {"root": "o", "mid": "s", "tip": "D"}
COLOURS = {"root": TAB10[0], "mid": TAB10[1], "tip": TAB10[2]}
ERRORS = ("time error", "rate error", "moment error")


def worst(row):
    return max(row[key] for key in ERRORS)


def power(value):
    return f"$10^{{{round(math.log10(value))}}}$"


def log_axes(axes, x, y):
    axes.set_xscale("log"), axes.set_yscale("log")
    axes.set_xlabel(x, fontsize=9), axes.set_ylabel(y, fontsize=9)
    axes.grid(True, which="major", color="0.88", linewidth=0.6)
    axes.tick_params(labelsize=8)


def share_limits(grid):
    """Gives each row of panels one scale, labelled on the left."""
    for row in grid:
        low, high = min(a.get_ylim()[0] for a in row), max(a.get_ylim()[1] for a in row)
        for axes in row:
            axes.set_ylim(low, high)
            if axes is not row[0]:
                axes.set_ylabel("")
                axes.tick_params(labelleft=False)


# ---- stiffness


def mark_failures(axes, rows, look, height):
    """Draws a cross (height 1 is the top edge) where a run failed or latched in another order."""
    for row in rows:
        if row["ending"] != "deployed":
            axes.plot([row["k"]], [height], transform=axes.get_xaxis_transform(), marker="x", color=look["color"],
                      markersize=6, linestyle="")


def draw_stiffness(rows, rtol, folder):
    methods, dampings = distinct(rows, "method"), distinct(rows, "d")
    look = styles(methods)
    figure, grid = plt.subplots(2, len(dampings), figsize=(3.4 * len(dampings), 7.6), squeeze=False)
    for damping, column in zip(dampings, grid.T):
        for rank, method in enumerate(methods):
            its = [row for row in rows if row["method"] == method and row["d"] == damping]
            column[0].plot([r["k"] for r in its], [r["evaluations"] for r in its], label=method, **look[method])
            column[1].plot([r["k"] for r in its], [worst(r) for r in its], **look[method])
            mark_failures(column[0], its, look[method], 0.98 - 0.017 * rank)
        log_axes(column[0], "", "right-hand side evaluations a run")
        log_axes(column[1], "latch stiffness k, N·m/rad", "largest relative error")
        column[1].axhline(rtol, color="0.5", linewidth=0.8, linestyle=":")
        column[0].set_title(f"d = {power(damping)} N·m·s/rad", fontsize=10)
    share_limits(grid)
    for axes in grid[0]:
        low, high = axes.get_ylim()
        axes.set_ylim(low, high * (high / low) ** 0.22)  # room for the crosses
        axes.axhline(high, color="0.8", linewidth=0.6)
    figure.suptitle(f"Seed wing to t = 12 s, peak moments, rtol {rtol:g}: cost and error against the latches' k and d\n"
                    "dotted: rtol; a cross above the line: the run hit the limit of a million steps, or failed",
                    fontsize=10)
    bottom = legend_below(figure, grid[0][0], 5)
    figure.tight_layout(rect=(0, bottom, 1, 0.99))
    save(figure, folder / f"stiffness_rtol_{rtol:.0e}")


def draw_table(axes, rows, key, title, form, colours):
    """Draws a table of k against d with a value in each cell."""
    stiffnesses, dampings = distinct(rows, "k"), distinct(rows, "d")
    values = {(row["k"], row["d"]): row[key] for row in rows}
    cells = [[values[k, d] for k in stiffnesses] for d in dampings]
    image = axes.imshow([[max(value, colours[1]) for value in line] for line in cells], aspect="auto", origin="lower",
                        cmap=colours[0], norm=LogNorm(*colours[1:]))
    for y, line in enumerate(cells):
        for x, value in enumerate(line):
            dark = image.norm(max(value, colours[1])) > 0.6
            axes.text(x, y, form(value), ha="center", va="center", fontsize=9, color="white" if dark else "black")
    axes.set_xticks(range(len(stiffnesses)), [power(k) for k in stiffnesses])
    axes.set_yticks(range(len(dampings)), [power(d) for d in dampings])
    axes.set_xlabel("k, N·m/rad", fontsize=9), axes.set_ylabel("d, N·m·s/rad", fontsize=9)
    axes.set_title(title, fontsize=10)


def draw_cost_a_cycle(axes, rows, prices):
    """Draws cost against oscillations, beside the price of a single undamped oscillation."""
    for rtol, colour in zip(distinct(rows, "rtol"), (TAB10[0], TAB10[3])):
        its = [row for row in rows if row["rtol"] == rtol]
        axes.plot([max(row["cycles"], 1) for row in its], [row["evaluations"] for row in its], "o", color=colour,
                  markersize=5, label=f"rtol {rtol:g}")
        price = next(row["evaluations a cycle"] for row in prices if (row["method"], row["rtol"]) == ("auto", rtol))
        axes.plot([20, 2e4], [20 * price, 2e4 * price], color=colour, linewidth=0.9, linestyle="--",
                  label=f"{price:.0f} a cycle: a pure oscillation")
    log_axes(axes, "oscillations above the tolerance (1: one or none)", "evaluations of auto")
    axes.set_title("each latch a point: the cost is the ringing", fontsize=10)
    axes.legend(fontsize=8, loc="upper left")


def draw_ringing(rows, prices, folder):
    rtol = min(distinct(rows, "rtol"))
    its = [row for row in rows if row["rtol"] == rtol]
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(15, 4.6))
    draw_table(left, its, "cost over nominal", f"auto's evaluations over the seed wing's, rtol {rtol:g}",
               lambda v: f"{v:.2g}" if v < 100 else f"{v:.0f}", ("OrRd", 0.5, 300))
    draw_table(middle, its, "cycles", "oscillations above the tolerance",
               lambda v: f"{v:.0f}", ("PuBu", 1, 2e4))
    draw_cost_a_cycle(right, rows, prices)
    figure.tight_layout()
    save(figure, folder / "stiffness_ringing")


def draw_corner(rows, ringing, folder):
    """Draws error against cost of wings that ring, and three times the cost of the seed wing."""
    methods, look = distinct(rows, "method"), styles(distinct(rows, "method"))
    rtol = min(distinct(ringing, "rtol"))
    budget = 3 * next(r["evaluations"] / r["cost over nominal"] for r in ringing if r["rtol"] == rtol)
    wings = list(dict.fromkeys((row["k"], row["d"]) for row in rows))
    columns = min(3, len(wings))
    figure, grid = plt.subplots(math.ceil(len(wings) / columns), columns, figsize=(4.6 * columns, 7.8), squeeze=False)
    for (k, d), axes in zip(wings, grid.flat):
        for method in methods:
            its = [r for r in rows if (r["k"], r["d"], r["method"]) == (k, d, method) and r["ending"] == "deployed"]
            axes.plot([r["evaluations"] for r in its], [worst(r) for r in its], label=method, **look[method])
        log_axes(axes, "right-hand side evaluations a run", "largest relative error")
        axes.axvspan(1, budget, color="gold", alpha=0.25, zorder=0, linewidth=0)
        axes.axhline(1e-6, color="0.5", linewidth=0.8, linestyle=":")
        axes.set_title(f"k = {power(k)} N·m/rad, d = {power(d)} N·m·s/rad", fontsize=10)
        axes.set_xlim(min(r["evaluations"] for r in rows if r["evaluations"] > 0) / 2,
                      2 * max(r["evaluations"] for r in rows if r["evaluations"] > 0))
    share_limits(grid)
    figure.suptitle(f"Wings that ring, at rtol 0.1 … 1e-10: no method is within 1e-6 (dotted) at three times the cost of "
                    f"the seed wing (yellow, {budget:,.0f} evaluations)", fontsize=10)
    bottom = legend_below(figure, grid[0][0], 5)
    figure.tight_layout(rect=(0, bottom, 1, 0.99))
    save(figure, folder / "stiffness_corner")


def draw_stiffness_study(folder):
    rows, ringing = read_rows(folder / "stiffness.csv"), read_rows(folder / "ringing.csv")
    for rtol in distinct(rows, "rtol"):
        draw_stiffness([row for row in rows if row["rtol"] == rtol], rtol, folder)
    draw_ringing(ringing, read_rows(folder / "price.csv"), folder)
    draw_corner(read_rows(folder / "corner.csv"), ringing, folder)


# ---- latch model


def local_orders(rows, key):
    """d log |change| / d log ε between neighbouring widths: (ε between them, order)."""
    points = [(row["epsilon"], abs(row[key])) for row in rows]
    return [(math.sqrt(e0 * e1), math.log(c0 / c1) / math.log(e0 / e1))
            for (e0, c0), (e1, c1) in zip(points, points[1:])]


def draw_change(axes, by_hinge, key, title):
    """Hollow where the smoothed latch's figure is the smaller one."""
    for hinge, rows in by_hinge.items():
        look = dict(color=COLOURS[hinge], marker=HINGES[hinge], markersize=5)
        axes.plot([r["epsilon"] for r in rows], [100 * abs(r[key]) for r in rows], label=hinge, linewidth=1.3, **look)
        below = [r for r in rows if r[key] < 0]
        axes.plot([r["epsilon"] for r in below], [100 * abs(r[key]) for r in below], linestyle="",
                  markerfacecolor="white", zorder=3, **look)
    log_axes(axes, "width ε of the smoothed latch, rad", f"change of the {title}, %")
    axes.set_title(title, fontsize=10)
    widths, first = [r["epsilon"] for r in rows], 100 * abs(rows[-1][key]) / 3
    axes.plot([min(widths), max(widths)], [first, first * max(widths) / min(widths)], color="0.6", linewidth=0.8,
              linestyle=":", zorder=0)


def draw_latch_model(folder):
    rows = [row for row in read_rows(folder / "latch_model.csv") if row["epsilon"] > 0]
    peaks = {hinge: [row for row in rows if row["hinge"] == hinge] for hinge in HINGES}
    rates = {hinge: peaks[hinge] for hinge in ("mid", "tip")}  # nothing was smoothed before the root latched
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(14, 4.8))
    draw_change(left, peaks, "moment change", "peak moment")
    draw_change(middle, rates, "rate change", "latch rate")
    for hinge, its in peaks.items():
        orders = local_orders(its, "moment change")
        right.plot(*zip(*orders), color=COLOURS[hinge], marker=HINGES[hinge], label=f"{hinge}, peak", linewidth=1.3)
    for hinge, its in rates.items():
        orders = local_orders(its, "rate change")
        right.plot(*zip(*orders), color=COLOURS[hinge], marker=HINGES[hinge], markerfacecolor="white", linestyle="--",
                   label=f"{hinge}, rate", linewidth=1)
    log_axes(right, "width ε, rad", "order of convergence")
    right.set_yscale("linear"), right.set_ylim(-1, 3)
    right.axhline(1, color="0.5", linewidth=0.8)
    right.set_title("order: 1, the error falls with ε", fontsize=10)
    for axes in (left, middle, right):
        axes.legend(fontsize=8)
    figure.suptitle("Smoothed against event latch, seed wing (dotted: slope 1; hollow: the figure is smaller than the event latch's; "
                    "the root's latch rate does not change)",
                    fontsize=10)
    figure.tight_layout()
    save(figure, folder / "latch_model")


# ---- stability


def draw_limits(rows, folder):
    """Three bars a method: theory, near rest, after the latch."""
    kinds = {"theory": ("|R(hλ)| = 1", "0.75"), "near rest": ("measured near rest", TAB10[0]),
             "after the last latch": ("measured after the last latch", TAB10[1])}
    shown = [row for row in rows if not math.isnan(row["theory"])]
    free = [f"{row['method']} ({row['order']:.0f})" for row in rows if math.isnan(row["theory"])]
    figure, axes = plt.subplots(figsize=(9, 0.5 * len(shown) + 1.6))
    for k, (key, (label, colour)) in enumerate(kinds.items()):
        heights = [y + 0.27 * (k - 1) for y in range(len(shown))]
        bars = axes.barh(heights, [1e3 * row[key] for row in shown], height=0.25, color=colour, label=label)
        axes.bar_label(bars, fmt="%.1f", fontsize=7, padding=2)
    axes.set_yticks(range(len(shown)), [f"{row['method']}, order {row['order']:.0f}" for row in shown], fontsize=9)
    axes.invert_yaxis()
    axes.set_xlabel("largest stable step on the latched seed wing, ms", fontsize=9)
    axes.set_title("no limit up to 0.5 s: " + ", ".join(free), fontsize=9)
    axes.legend(fontsize=8, loc="lower right")
    axes.grid(True, axis="x", color="0.9", linewidth=0.6), axes.set_axisbelow(True)
    figure.tight_layout()
    save(figure, folder / "stability_limits")


def mesh(rows):
    """The map of one method as (re, im, growth), mirrored to the lower half-plane."""
    re, im = sorted(set(row["re z"] for row in rows)), sorted(set(row["im z"] for row in rows))
    growth = {(row["re z"], row["im z"]): row["growth a step"] for row in rows}
    levels = [-y for y in im[:0:-1]] + im
    return re, levels, [[growth[x, abs(y)] for x in re] for y in levels]


def draw_region(axes, maps, modes, limits):
    """A method's regions |R| ≤ 1, one an order, and the wing's modes at its step limit."""
    for (order, rows), colour in zip(maps.items(), (TAB10[0], TAB10[2], TAB10[4], TAB10[5])):
        re, im, growth = mesh(rows)
        if len(maps) == 1:
            axes.contourf(re, im, growth, levels=[0, 1], colors=[colour], alpha=0.18)
        axes.contour(re, im, growth, levels=[1], colors=[colour], linewidths=1.3)
        its = [row for row in modes if row["order"] == order and not math.isnan(row["re hλ"])]
        for row in its:
            for sign in (1, -1):
                axes.plot([0, row["re hλ"]], [0, sign * row["im hλ"]], color=colour, linewidth=0.6, alpha=0.6)
                axes.plot([row["re hλ"]], [sign * row["im hλ"]], "o", color=colour, markersize=4)
        h = limits[order]
        label = f"order {order:.0f}: " + (f"{1e3 * h:.1f} ms" if not math.isnan(h) else "no limit")
        axes.plot([], [], color=colour, label=label)
    axes.axhline(0, color="0.6", linewidth=0.6), axes.axvline(0, color="0.6", linewidth=0.6)
    axes.set_xlim(re[0], re[-1]), axes.set_ylim(im[0], im[-1])
    axes.legend(fontsize=7, loc="upper right", framealpha=0.9)
    axes.tick_params(labelsize=8)


def draw_regions(regions, modes, limits, folder):
    methods = distinct(regions, "method")
    figure, grid = plt.subplots(3, 3, figsize=(12, 10.5))
    for method, axes in zip(methods, grid.flat):
        rows = [row for row in regions if row["method"] == method]
        maps = {order: [row for row in rows if row["order"] == order] for order in distinct(rows, "order")}
        draw_region(axes, maps, [row for row in modes if row["method"] == method],
                    {row["order"]: row["theory"] for row in limits if row["method"] == method})
        implicit = method in ("rosenbrock_w", "seulex")
        axes.set_title(method + (": stable outside the curve" if implicit else ": stable inside"), fontsize=10)
        axes.set_xlabel("Re hλ", fontsize=8), axes.set_ylabel("Im hλ", fontsize=8)
    figure.suptitle("Where a step of each method lets nothing grow, |R(hλ)| ≤ 1; dots: the six eigenvalues of the latched "
                    "seed wing\nat the largest stable step, which is in the legend", fontsize=11)
    figure.tight_layout(rect=(0, 0, 1, 0.99))
    save(figure, folder / "stability_regions")


def draw_stability(folder):
    limits = read_rows(folder / "limits.csv")
    draw_limits(limits, folder)
    draw_regions(read_rows(folder / "regions.csv"), read_rows(folder / "modes.csv"), limits, folder)


STUDIES = {"stiffness.csv": draw_stiffness_study, "latch_model.csv": draw_latch_model, "regions.csv": draw_stability}


def main(folders):
    for folder in map(pathlib.Path, folders):
        draws = [draw for file, draw in STUDIES.items() if (folder / file).exists()]
        if not draws:
            sys.exit(f"{folder} holds none of {', '.join(STUDIES)}")
        for draw in draws:
            draw(folder)


if __name__ == "__main__":
    main(sys.argv[1:])
