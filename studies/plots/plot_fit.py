"""Draws what ground tests say of a wing and of its flight, from the files of studies/drivers/fit_ground_tests.py.

    /usr/bin/python3 studies/plots/plot_fit.py results/fit_ground_tests

To the folder: fit_3_s.png and .svg for the traces of 3 s, and so for every other length. Upper row: priors and posteriors of the parameters
beside the truth. Lower row: the flight as predicted before and after the tests, and as the true wing makes it.
"""

import json
import pathlib
import sys

import numpy
from charts import TAB10, plt, read_rows, save
from scipy import stats

TRUTH = {"spring": 0.96, "friction": 1.5, "harness": 1.25}  # as in the driver
OUTPUTS = {"deployment_time": "deployment time, s", "root.latch_rate": "latch rate of the root, rad/s", "root.peak_moment": "its peak moment, N·m"}
FITS = {"warm test": TAB10[1], "both tests": TAB10[0], "both and torque test": TAB10[3]}


def column(path, name):
    """A column's numbers. @param path a CSV, or a folder that has one runs.csv"""
    file = path if path.suffix else next(path.rglob("runs.csv"))
    return numpy.array([row[name] for row in read_rows(file) if row[name] == row[name]])


def density(values, points):
    return stats.gaussian_kde(values)(points)


def prior(law, points):
    if law["type"] == "normal":
        return stats.norm.pdf(points, law["mean"], law["std"])
    return stats.lognorm.pdf(points, law["sigma_log"], scale=numpy.exp(law["mu_log"]))


def draw(axes, before, spread, after, truth):
    """Densities over their own largest values: they differ a hundredfold. @param before points and density. @param spread values before"""
    axes.fill_between(before[0], before[1] / before[1].max(), color="0.85", label="before the tests")
    for name, values in after.items():
        points = numpy.linspace(values.min(), values.max(), 300)
        height = density(values, points)
        axes.plot(points, height / height.max(), color=FITS[name], linewidth=1.4, label=name)
    axes.axvline(truth, color="black", linewidth=1, linestyle="--", label="truth")
    all_values = numpy.concatenate([spread, *after.values(), [truth]])
    low, high = numpy.quantile(all_values, [0.001, 0.999])  # a run that nearly stalls would take the whole width
    margin = 0.05 * (high - low)
    axes.set(yticks=[], ylim=(0, 1.08), xlim=(low - margin, high + margin))
    axes.tick_params(labelsize=8)


def main(folder):
    folder = pathlib.Path(folder)
    laws = {each["name"]: each["distribution"] for each in json.loads((folder / "campaign.json").read_text())["dispersions"]}
    for base in sorted(folder.glob("*_s")):
        figure, grid = plt.subplots(2, 3, figsize=(10.5, 5.6))
        fits = {name: base / name.replace(" ", "_") for name in FITS}
        for axes, (name, truth) in zip(grid[0], TRUTH.items()):
            width = {"spring": 0.1}.get(name, 0.9)
            points = numpy.linspace(max(0.2, 1 - width), 1 + (width if name == "spring" else 1.3), 400)
            height = prior(laws[name], points)
            spread = numpy.repeat(points, numpy.rint(100 * height / height.max()).astype(int))
            draw(axes, (points, height), spread, {fit: column(path / "posterior.csv", name) for fit, path in fits.items()}, truth)
            axes.set_xlabel(f"{name}, times its nominal value", fontsize=9)
        for axes, (name, label) in zip(grid[1], OUTPUTS.items()):
            earlier = column(folder / "before", name)
            points = numpy.linspace(earlier.min(), earlier.max(), 400)
            draw(axes, (points, density(earlier, points)), earlier, {fit: column(path / "flight", name) for fit, path in fits.items()},
                 column(folder / "truth_flight", name)[0])
            axes.set_xlabel(label, fontsize=9)
        grid[0][0].set_ylabel("parameters", fontsize=9)
        grid[1][0].set_ylabel("flight at −40 °C", fontsize=9)
        figure.legend(*grid[0][0].get_legend_handles_labels(), loc="lower center", ncol=5, fontsize=9, frameon=False)
        figure.suptitle(f"Ground tests with traces of {base.name.replace('_', ' ')}", fontsize=11)
        figure.tight_layout(rect=(0, 0.05, 1, 0.99))
        save(figure, folder / f"fit_{base.name}")


if __name__ == "__main__":
    main(sys.argv[1])
