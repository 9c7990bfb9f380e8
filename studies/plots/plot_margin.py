"""Draws the window of spring strength: the results of `wingspread margin` at every scale, with both edges.

    /usr/bin/python3 studies/plots/plot_margin.py results/margin

To the folder, for each search: margin.png and .svg (margin_HINGE where hinges are sized one by one).
"""

import json
import pathlib
import sys

from charts import distinct, plt, read_rows, save

WINDOW, PASS, FAIL, LIMIT = "#dcecd8", "#2f6db0", "#b03030", "0.25"
UNITS = {"latch_time": "s", "deployment_time": "s", "latch_rate": "rad/s", "rate_at": "rad/s", "peak_rate": "rad/s",
         "peak_moment": "N·m", "hold_moment": "N·m", "peak_bending_moment": "N·m", "peak_force": "N", "motor_energy": "J",
         "overtravel": "rad", "final_angle": "rad", "peak_angle": "rad", "frequency": "Hz"}


def unit(output):
    return UNITS.get("rate_at" if ".rate_at." in output else output.split(".")[-1], "")


def draw_window(axes, search):
    """The window as a band, the recommended scale as a line; hatched where there is none."""
    window = search["window"]
    if window:
        axes.axvspan(window["lower"]["scale"], window["upper"]["scale"], color=WINDOW, zorder=-2)
        for edge in ("lower", "upper"):
            axes.axvline(window[edge]["scale"], color="0.35", linewidth=0.9, zorder=-1)
        if search["recommended"]:
            axes.axvline(search["recommended"]["scale"], color="0.35", linewidth=0.9, linestyle=":", zorder=-1)


def mark(axes, rows, values):
    """Draws a dot where the requirement is met, a cross where it is not."""
    for verdicts, colour, marker in ((("pass",), PASS, "o"), (("fail", "undecided"), FAIL, "x")):
        chosen = [(row["scale"], value) for row, value in zip(rows, values) if row["verdict"] in verdicts]
        if chosen:
            axes.plot(*zip(*chosen), linestyle="", marker=marker, markersize=4.5, color=colour, zorder=3)


def draw_deployed(axes, rows):
    scales = [row["scale"] for row in rows]
    axes.fill_between(scales, [row["deployed_lower"] for row in rows], [row["deployed_upper"] for row in rows],
                      color=PASS, alpha=0.2, linewidth=0)
    axes.plot(scales, [row["deployed"] for row in rows], color=PASS, linewidth=1.2)
    axes.set_ylabel("P(deployed)", fontsize=9)
    axes.set_ylim(top=1.0 + 0.04 * (1 - min(row["deployed"] for row in rows) + 1e-3))


def draw_output(axes, rows):
    """What is guaranteed, and the quantile that was observed, against the limit."""
    output, limit = rows[0]["output"], rows[0]["limit"]
    known = [row for row in rows if isinstance(row["guaranteed"], float) and row["guaranteed"] == row["guaranteed"]]
    axes.plot([row["scale"] for row in known], [row["guaranteed"] for row in known], color=PASS, linewidth=1.2,
              label="guaranteed")
    axes.plot([row["scale"] for row in rows], [row["observed"] for row in rows], color=PASS, linewidth=0.8,
              linestyle="--", alpha=0.7, label="observed quantile")
    mark(axes, known, [row["guaranteed"] for row in known])
    axes.axhline(limit, color=LIMIT, linewidth=1, linestyle="--")
    axes.margins(y=0.15)
    axes.set_ylabel(", ".join(filter(None, (output, unit(output)))), fontsize=9)
    missing = [row["scale"] for row in rows if row not in known]
    if missing:  # so many runs did not deploy that no value is guaranteed
        axes.plot(missing, [0.04] * len(missing), transform=axes.get_xaxis_transform(), linestyle="",
                  marker="x", markersize=4.5, color=FAIL)


def draw_search(rows, search, found, folder):
    """A panel for the share that deploys, and one for every requirement with a limit; the first case's."""
    first = [row for row in rows if row["case"] == found["cases"][0]]
    by_requirement = {name: sorted((row for row in first if row["requirement"] == name), key=lambda row: row["scale"])
                      for name in distinct(first, "requirement")}
    limited = {name: its for name, its in by_requirement.items() if its[0]["output"] != "deployed"}
    deployed = [its for its in by_requirement.values() if its[0]["output"] == "deployed"]
    figure, panels = plt.subplots(1 + len(limited), 1, sharex=True, squeeze=False,
                                  figsize=(7.5, 2.3 * (1 + len(limited)) + 0.6))
    panels = panels[:, 0]
    its = deployed[0] if deployed else next(iter(by_requirement.values()))
    draw_deployed(panels[0], its)
    if deployed:
        panels[0].axhline(its[0]["probability"], color=LIMIT, linewidth=1, linestyle="--")
        mark(panels[0], its, [row["deployed"] for row in its])
    for axes, rows_of_one in zip(panels[1:], limited.values()):
        draw_output(axes, rows_of_one)
    for axes in panels:
        draw_window(axes, search)
        axes.grid(True, color="0.9", linewidth=0.6)
        axes.tick_params(labelsize=8)
    panels[-1].set_xlabel("scale of the springs", fontsize=9)
    panels[-1].set_xscale("log")
    ticks = [tick for tick in (0.3, 0.5, 0.7, 0.8, 0.9, 1, 1.2, 1.4, 1.6, 1.8, 2, 2.5, 3, 4, 5)
             if found["range"][0] <= tick <= found["range"][1]]
    panels[-1].set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    panels[-1].set_xticks([], minor=True)
    panels[0].set_title(title(search, found), fontsize=10)
    if len(panels) > 1:
        panels[1].legend(fontsize=8, frameon=False, loc="best")
    figure.tight_layout()
    figure.align_ylabels()
    save(figure, folder / ("margin" if search["name"] == "joint" else f"margin_{search['name']}"))


def title(search, found):
    window = search["window"]
    if not window:
        return f"{found['scene']}: no scale of the springs meets all requirements"
    chosen = search["recommended"]
    recommended = f"recommended {chosen['scale']:g}" if chosen else "none recommended"
    return (f"{found['scene']}: all requirements are met from {window['lower']['scale']:g} to "
            f"{window['upper']['scale']:g}, {recommended}\n"
            f"{found['runs_per_scale']} runs a scale; dashed: limits; dots meet them, crosses do not "
            "(at the foot: too few runs deploy)")


def main(folder):
    folder = pathlib.Path(folder)
    found = json.loads((folder / "margin.json").read_text())
    rows = read_rows(folder / "margin.csv")
    for search in found["searches"]:
        draw_search([row for row in rows if row["search"] == search["name"]], search, found, folder)


if __name__ == "__main__":
    main(sys.argv[1])
