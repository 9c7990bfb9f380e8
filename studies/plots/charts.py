"""Shared by the chart scripts: reading CSV, a style for every method, saving figures."""

import csv
import io
import math
import os

import matplotlib

matplotlib.use("Agg")
matplotlib.rcParams["svg.hashsalt"] = "wingspread"  # the same file for the same data
import matplotlib.pyplot as plt
from PIL import Image

TAB10 = plt.get_cmap("tab10").colors


def number(text):
    """A cell's number; NaN when it is empty."""
    return float(text) if text else math.nan


def read_rows(path):
    """The rows of a CSV file by column, units dropped from the names: numbers as such, other text as it is."""
    def value(text):
        try:
            return number(text)
        except ValueError:
            return text

    with open(path, newline="") as file:
        return [{key.split(" [")[0]: value(text) for key, text in row.items()} for row in csv.DictReader(file)]


def distinct(rows, key):
    """The distinct values of a column, in order of appearance."""
    return list(dict.fromkeys(row[key] for row in rows))


def styles(methods):
    """A line style for each method: auto black and wide, CVODE dashed, the others by colour."""
    markers, colours = iter("osD^vP*Xhp<>"), iter([*TAB10[:7], *TAB10[8:], "black"] * 2)  # its grey is CVODE's
    style = {}
    for method in methods:
        if method == "auto":
            style[method] = dict(color="black", marker="", linewidth=4, alpha=0.35)
        elif method.startswith("cvode"):
            style[method] = dict(color="0.35" if "adams" in method else "0.6", marker=next(markers),
                                 linewidth=1, linestyle="--", markersize=4)
        else:
            style[method] = dict(color=next(colours), marker=next(markers), linewidth=1.2, markersize=4.5)
    return style


def legend_below(figure, axes, columns):
    """Draws one legend for all panels below them, and leaves room for its height."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=min(columns, len(labels)), fontsize=9, frameon=False)
    return 0.01 + 0.03 * math.ceil(len(labels) / columns)


def save(figure, path):
    """Saves path.svg, and path.png in 64 colours (a third of the size)."""
    path = os.fspath(path)
    figure.savefig(f"{path}.svg")
    pixels = io.BytesIO()
    figure.savefig(pixels, dpi=110)
    plt.close(figure)
    Image.open(pixels).convert("RGB").quantize(64, dither=Image.Dither.NONE).save(f"{path}.png", optimize=True)
    print(f"drawn: {path}.png")
