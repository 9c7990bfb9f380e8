"""Draws the histograms of a results folder: one panel an output, to FOLDER/histograms.png and .svg."""

import csv
import json
import math
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def read_bins(path):
    """The bins of histograms.csv by output: [(lower, upper, density)]."""
    bins = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            bins.setdefault(row["output"], []).append(
                tuple(float(row[key]) for key in ("lower", "upper", "density")))
    return bins


def draw(axes, output, bins, summary):
    axes.set_title(output, fontsize=9)
    axes.set_yticks([])
    if summary["min"] is not None and summary["min"] == summary["max"]:
        axes.set_xticks([])
        axes.text(0.5, 0.5, f"always {summary['min']:g} {summary['unit']}", ha="center", va="center", fontsize=9,
                  transform=axes.transAxes)
        return
    axes.stairs([density for *_, density in bins], [lower for lower, *_ in bins] + [bins[-1][1]],
                fill=True, color="#4878a8")
    for quantile in summary["quantiles"]:
        if quantile["value"] is not None:
            axes.axvline(quantile["value"], color="#a03030", linewidth=0.8,
                         linestyle="-" if quantile["p"] == 0.5 else "--")
    axes.set_xlabel(summary["unit"], fontsize=8)
    axes.tick_params(labelsize=7)


def main(folder):
    folder = pathlib.Path(folder)
    bins = read_bins(folder / "histograms.csv")
    summary = json.loads((folder / "summary.json").read_text())
    if not bins:
        print(f"no histograms drawn: {folder} has no values")
        return
    columns = min(4, len(bins))
    rows = math.ceil(len(bins) / columns)
    figure, grid = plt.subplots(rows, columns, figsize=(3.2 * columns, 2.2 * rows), squeeze=False)
    for axes in grid.flat[len(bins):]:
        axes.set_visible(False)
    for axes, (output, its_bins) in zip(grid.flat, bins.items()):
        draw(axes, output, its_bins, summary["outputs"][output])
    figure.suptitle(f"{folder.name}: {summary['runs']} runs; median solid, outer quantiles dashed", fontsize=10)
    figure.tight_layout()
    for suffix in (".png", ".svg"):
        figure.savefig(folder / f"histograms{suffix}", dpi=120)
    print(f"histograms drawn: {folder / 'histograms.png'}")


if __name__ == "__main__":
    main(sys.argv[1])
