"""Draws the work-precision charts of a results folder, and finds the cheapest method at each error.

    /usr/bin/python3 studies/plots/plot_work_precision.py results/work_precision

To the folder: work_precision_{A,B}_{us,evaluations}.png and .svg, the same with _friction, and envelope.csv.
"""

import csv
import math
import pathlib
import sys

from charts import number, plt, save, styles
from matplotlib.ticker import LogLocator, NullFormatter

PHASES = {"A": ("to the first latch", ("time", "rate")),
          "B": ("the whole run, with peak moments and forces", ("time", "rate", "moment", "force"))}
COSTS = {"us": "µs of processor time a run", "evaluations": "right-hand side evaluations a run"}
QUANTITIES = {"time": "latch times", "rate": "latch rates", "moment": "peak moments", "force": "peak forces"}
CASES = {"event": "event latch", "smoothed": "smoothed latch", "rubbing": "harness, regularized friction",
         "near_stall": "the same, near stall", "sticking": "harness, exact friction"}
FIGURES = {"": ("event", "smoothed"), "_friction": ("rubbing", "near_stall", "sticking")}  # rows, by the name's end
LEVELS = [10.0 ** -decade for decade in range(3, 10)]
FLOOR = 1e-16  # below this an error of doubles is round-off


def read_points(path):
    """The rows of work_precision.csv, with numbers as such, by method."""
    text = ("method", "case", "phase", "reason")
    points = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            point = {key: value if key in text else number(value) for key, value in row.items()}
            point["bad"] = int(point["mismatches"] + point["failures"])
            points.setdefault(point["method"], []).append(point)
    return points


def read_disagreement(folder):
    """The largest difference between references of two precisions, by case and quantity."""
    apart = {}
    for case in CASES:
        path = folder / f"references_{case}.csv"
        if not path.exists():
            continue
        with open(path, newline="") as file:
            for row in csv.DictReader(file):
                if row["source"] in ("cvode", "regularized"):
                    continue  # a check of another kind: less precise than the references
                for quantity in QUANTITIES:
                    off = number(row[f"off_{quantity}"])
                    if not math.isnan(off):
                        apart[case, quantity] = max(apart.get((case, quantity), 0), off)
    return apart


def front(points, error, cost):
    """A method's worthwhile points, cheapest first: (log error, log cost), errors falling.

    Points at which a scene failed or latched in another order are left out.
    """
    usable = sorted((point[cost], max(error(point), FLOOR)) for point in points
                    if point["bad"] == 0 and not math.isnan(error(point)) and not math.isnan(point[cost]))
    kept = []
    for work, off in usable:
        if not kept or math.log10(off) < kept[-1][0]:
            kept.append((math.log10(off), math.log10(work)))
    return kept


def cost_at(line, level):
    """The work that an error of `level` takes on a front, interpolated between its points; NaN if out of reach."""
    target = math.log10(level)
    if not line or target < line[-1][0]:
        return math.nan
    if target >= line[0][0]:
        return 10 ** line[0][1]
    for (e0, c0), (e1, c1) in zip(line, line[1:]):
        if target >= e1:
            return 10 ** (c0 + (c1 - c0) * (e0 - target) / (e0 - e1))
    return math.nan


def lowest(values):
    return min((value for value in values if not math.isnan(value)), default=math.nan)


def select(points, case, phase):
    return {method: [p for p in its if p["case"] == case and p["phase"] == phase]
            for method, its in points.items()}


def measured(points):
    """The cases that the folder has, in their order."""
    there = {point["case"] for its in points.values() for point in its}
    return [case for case in CASES if case in there]


def draw_envelope(axes, chosen, error, cost):
    fronts = [front(its, error, cost) for its in chosen.values()]
    levels = [10 ** (-k / 20) for k in range(301)]
    work = [lowest(cost_at(line, level) for line in fronts) for level in levels]
    axes.plot(levels, work, color="gold", linewidth=7, alpha=0.6, zorder=0, solid_capstyle="butt")


def draw_bad(axes, its, error, style, row):
    """Crosses at the top edge, a row a method: how many scenes failed or latched otherwise there."""
    height = 0.975 - 0.035 * row
    for point in its:
        if point["bad"] == 0:
            continue
        off = error(point)
        x = 0.2 if math.isnan(off) else off  # nothing to place it by: far right
        edge = axes.get_xaxis_transform()
        axes.plot([x], [height], transform=edge, marker="x", color=style["color"], markersize=5, linestyle="")
        axes.annotate(str(point["bad"]), (x, height), xycoords=edge, xytext=(4, -2.5),
                      textcoords="offset points", fontsize=6, color=style["color"])


def draw_method(axes, method, its, error, cost, style):
    line = sorted(((p["step"] if not math.isnan(p["step"]) else p["tolerance"]), error(p), p[cost], p["bad"])
                  for p in its if not math.isnan(error(p)))
    axes.plot([max(p[1], FLOOR) for p in line], [p[2] for p in line], label=method, **style)
    hollow = [(off, work) for _, off, work, bad in line if bad]
    if hollow and style["marker"]:
        axes.plot(*zip(*hollow), linestyle="", marker=style["marker"], markersize=style["markersize"],
                  color=style["color"], markerfacecolor="white")


def draw_panel(axes, chosen, quantity, cost, style, apart):
    def error(point):
        return point[f"{quantity}_rms"]

    axes.set_xscale("log"), axes.set_yscale("log")
    axes.set_xlim(1e-15, 1)
    if apart > 1e-15:
        axes.axvspan(1e-15, apart, color="0.9", zorder=-1)
    draw_envelope(axes, chosen, error, cost)
    for method, its in chosen.items():
        draw_method(axes, method, its, error, cost, style[method])
    axes.grid(True, which="major", color="0.88", linewidth=0.6)
    axes.xaxis.set_major_locator(LogLocator(numticks=8))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.tick_params(labelsize=8)


def draw_all_bad(axes, chosen, quantity, style):
    rows = [method for method in chosen if any(point["bad"] for point in chosen[method])]
    for row, method in enumerate(rows):
        draw_bad(axes, chosen[method], lambda point: point[f"{quantity}_rms"], style[method], row)


def draw_figure(points, phase, cost, cases, style, apart, path):
    title, quantities = PHASES[phase]
    columns, rows = len(quantities), len(cases)
    figure, grid = plt.subplots(rows, columns, figsize=(5.2 * columns, 4.6 * rows + 0.8), squeeze=False, sharey="row")
    for case, row in zip(cases, grid):
        chosen = select(points, case, phase)
        for quantity, axes in zip(quantities, row):
            draw_panel(axes, chosen, quantity, cost, style, apart.get((case, quantity), 0))
            scenes = int(max((p["scenes"] for its in chosen.values() for p in its), default=0))
            axes.set_title(f"{CASES[case]}, {scenes} wings: {QUANTITIES[quantity]}", fontsize=10)
            axes.set_xlabel("RMS relative error", fontsize=9)
        low, high = row[0].get_ylim()  # shared by the row
        crossed = sum(any(point["bad"] for point in its) for its in chosen.values())
        row[0].set_ylim(low, high * (high / low) ** (0.05 * crossed))  # room for the crosses
        for quantity, axes in zip(quantities, row):
            draw_all_bad(axes, chosen, quantity, style)
        row[0].set_ylabel(COSTS[cost], fontsize=9)
    figure.suptitle(f"{phase}: {title}; dispersed three-panel wings\n"
                    "yellow: the lower-left envelope; grey: closer than the references agree\n"
                    "a cross and a hollow mark: so many scenes failed or latched in another order",
                    fontsize=10)
    handles, labels = grid[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=min(5, len(labels)), fontsize=9, frameon=False)
    figure.tight_layout(rect=(0, (0.025 + 0.02 * math.ceil(len(labels) / 5)) * 2 / rows, 1, 0.985))
    save(figure, path)


def worst(point):
    """The largest of the RMS errors of the four quantities."""
    return max(point[f"{quantity}_rms"] for quantity in QUANTITIES)


def envelope_rows(points, case):
    """For each error level, method by method, the µs and evaluations that it takes; phase B."""
    chosen = {method: its for method, its in select(points, case, "B").items() if its}
    lines = {(m, cost): front(its, worst, cost) for m, its in chosen.items() for cost in COSTS}
    for level in LEVELS:
        at = {key: cost_at(line, level) for key, line in lines.items()}
        best = {cost: lowest(at[m, cost] for m in chosen) for cost in COSTS}
        for method in chosen:
            yield {"case": case, "error": level, "method": method, **{cost: at[method, cost] for cost in COSTS},
                   **{f"{cost}_over_best": at[method, cost] / best[cost] for cost in COSTS}}


def write_envelope(rows, path):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(rows[0]), lineterminator="\n")
        writer.writeheader()
        for row in rows:
            writer.writerow({key: "" if isinstance(value, float) and math.isnan(value) else value
                             for key, value in row.items()})


def shown(value, form):
    return "–" if math.isnan(value) else format(value, form)


def print_envelope(case, rows):
    methods = list(dict.fromkeys(row["method"] for row in rows))
    by_key = {(row["error"], row["method"]): row for row in rows}
    for cost, title in COSTS.items():
        print(f"\n{title}, at an RMS error (the largest of time, rate, peak moment and force) of …; "
              f"whole run, {CASES[case]}")
        print(f"{'method':24}" + "".join(f"{level:>9.0e}" for level in LEVELS))
        for method in methods:
            print(f"{method:24}" + "".join(f"{shown(by_key[level, method][cost], '.0f'):>9}" for level in LEVELS))
        if "auto" in methods:
            ratios = (by_key[level, "auto"][f"{cost}_over_best"] for level in LEVELS)
            print(f"{'auto / best':24}" + "".join(f"{shown(ratio, '.2f'):>9}" for ratio in ratios))


def print_tolerances(case, points):
    """Prints largest errors and evaluations of `auto` and cash_karp54 at each tolerance."""
    by_tolerance = {method: {p["tolerance"]: p for p in select(points, case, "B").get(method, [])}
                    for method in ("auto", "cash_karp54")}
    print(f"\nauto and cash_karp54 at equal rtol: largest errors, evaluations; whole run, {CASES[case]}")
    print(f"{'rtol':8}" + "".join(f"{quantity:>10}" for quantity in QUANTITIES) * 2 + "      auto cash_karp54  ratio")
    for tolerance in sorted(by_tolerance["auto"], reverse=True):
        both = [by_tolerance[method].get(tolerance) for method in by_tolerance]
        if None in both:
            continue
        errors = "".join(f"{point[f'{quantity}_max']:10.1e}" for point in both for quantity in QUANTITIES)
        auto, plain = (point["evaluations"] for point in both)
        print(f"{tolerance:8.0e}{errors}{auto:10.0f}{plain:12.0f}{auto / plain:7.2f}")


def main(folder):
    folder = pathlib.Path(folder)
    points = read_points(folder / "work_precision.csv")
    apart = read_disagreement(folder)
    style = styles(points)
    there = measured(points)
    for end, cases in FIGURES.items():
        drawn = [case for case in cases if case in there]
        for phase in PHASES if drawn else ():
            for cost in COSTS:
                draw_figure(points, phase, cost, drawn, style, apart, folder / f"work_precision_{phase}_{cost}{end}")
    rows = {case: list(envelope_rows(points, case)) for case in there}
    write_envelope([row for case in there for row in rows[case]], folder / "envelope.csv")
    for case in there:
        print_envelope(case, rows[case])
        print_tolerances(case, points)


if __name__ == "__main__":
    main(sys.argv[1])
