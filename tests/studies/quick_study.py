"""Runs a study's driver in its quick mode, checks the numbers it writes, and has its charts drawn.

    /usr/bin/python3 tests/studies/quick_study.py NAME DRIVER FOLDER      from the repository's root

FOLDER is made anew. Bounds are wide: they catch a table that makes no sense, not a digit.
"""

import math
import pathlib
import shutil
import subprocess
import sys

sys.path.insert(0, "studies/plots")
sys.dont_write_bytecode = True
from charts import read_rows


def check(condition, what):
    if not condition:
        sys.exit(f"not so: {what}")


def check_stiffness(folder):
    for row in read_rows(folder / "references.csv"):
        check(max(row["time disagrees"], row["rate disagrees"]) < 1e-5, f"references agree: {row}")
    rows = read_rows(folder / "stiffness.csv")
    check(len(rows) == 2 * 4 * 3, "two tolerances of four latches and three methods")
    for row in rows:
        check(row["ending"] == "deployed" and row["evaluations"] > 500 and row["cpu"] > 0, f"a run to the end: {row}")
        worst = max(row["time error"], row["rate error"], row["moment error"])
        check(worst < 100 * row["rtol"], f"an error of the tolerance's size: {row}")
    ringing = {(row["rtol"], row["k"], row["d"]): row for row in read_rows(folder / "ringing.csv")}
    seed, stiff = ringing[1e-8, 1e4, 1e2], ringing[1e-8, 1e6, 1e2]
    check(seed["cost over nominal"] == 1, "the seed wing is the nominal one")
    check(10 < seed["cycles"] < 100 and 5 < stiff["cycles"] / seed["cycles"] < 20, "ten times the frequency")
    check(stiff["cycles"] >= stiff["cycles seen"] > 50, "no more turns than oscillations")
    worth = read_rows(folder / "worth.csv")
    check(worth[-1]["rate change"] > 0.01, "without its ringing a wing latches at other rates")
    check(len(read_rows(folder / "corner.csv")) == 3 * 2, "three methods at two tolerances")
    return ("stiffness_rtol_1e-06", "stiffness_rtol_1e-08", "stiffness_ringing", "stiffness_corner")


def check_latch_model(folder):
    rows = {(row["epsilon"], row["hinge"]): row for row in read_rows(folder / "latch_model.csv")}
    check(math.isclose(rows[0, "root"]["latch time"], 4.819271, rel_tol=1e-6), "the seed's first latch")
    check(math.isclose(rows[0, "root"]["peak moment"], 250.4651, rel_tol=1e-6), "the seed's root peak")
    check(0.0015 < rows[1e-4, "root"]["moment change"] < 0.0016, "root peak at ε = 1e-4 rad")
    for hinge in ("root", "mid", "tip"):
        ratio = rows[1e-3, hinge]["moment change"] / rows[1e-4, hinge]["moment change"]
        check(7 < ratio < 12, f"order one at {hinge}: {ratio}")
        check(rows[1e-3, hinge]["moment check"] < 1e-7, f"the oracle agrees at {hinge}")
    return ("latch_model",)


def check_stability_map(folder):
    limits = read_rows(folder / "limits.csv")
    check(len(limits) == 16, "every formula")
    for row in limits:
        if row["method"] in ("rosenbrock_w", "seulex"):
            check(math.isnan(row["near rest"]) and math.isnan(row["theory"]), f"no limit: {row}")
            continue
        check(math.isclose(row["near rest"], row["theory"], rel_tol=0.06), f"measured as by theory: {row}")
        check(0.75 * row["theory"] < row["after the last latch"] < 1.05 * row["theory"], f"in motion too: {row}")
    rk4 = limits[0]
    check(rk4["method"] == "runge_kutta4" and 0.0140 < rk4["near rest"] < 0.0148, "rk4: between 14.0 and 14.8 ms")
    for row in read_rows(folder / "modes.csv"):
        check(not row["growth a step"] > 1.001, f"nothing grows at the limit: {row}")
    check(len(read_rows(folder / "regions.csv")) == 16 * 41 * 41, "a map of every formula")
    return ("stability_limits", "stability_regions")


def check_design_error(folder):
    rows = read_rows(folder / "design_error.csv")
    check(len(rows) == 3 * 4 * 3 * 5, "three designs at four sizes, five statistics of three outputs")
    sigma = {row["output"]: row["reference"] for row in rows if row["statistic"] == "std"}
    for row in rows:
        if row["statistic"] == "mean":
            ratio = row["rms_error"] / (sigma[row["output"]] / math.sqrt(row["runs"]))
            check(ratio < 2.5, f"no worse than independent draws: {ratio}, {row}")
            check(ratio > 0.3 or row["design"] != "random", f"independent draws gain nothing: {ratio}, {row}")
    return ("design_error",)


def check_error_budget(folder):
    rows = read_rows(folder / "error_budget.csv")
    by_tolerance = {}
    for row in rows:
        check(row["evaluations"] > 500 and row["cpu"] > 0, f"a run to the end: {row}")
        if not math.isnan(row["rms"]):
            check(abs(row["mean error"]) <= row["rms"] * 1.0000001 <= row["largest"] * 1.000001, f"mean, RMS, largest: {row}")
            key = row["campaign"], row["rtol"]
            by_tolerance[key] = max(by_tolerance.get(key, 0), row["rms"] / row["sigma"])
    check(len(by_tolerance) == 3 * 9, "nine tolerances of three campaigns")
    for campaign in ("work_precision", "seed", "yoke_wing"):
        check(by_tolerance[campaign, 1e-8] < 1e-3 * by_tolerance[campaign, 1e-4], f"errors fall with the tolerance: {campaign}")
        check(by_tolerance[campaign, 1e-8] < 1e-5, f"the default's errors are small beside sigma: {campaign}")
    for row in read_rows(folder / "sampling.csv"):
        ratio = row["spread"] / (row["sigma"] / math.sqrt(row["runs"]))
        check(row["sigma"] == 0 or 0.1 < ratio < 2.5, f"block means spread by sigma over the root of N: {ratio}, {row}")
    return ("error_budget",)


CHECKS = {"stiffness": check_stiffness, "latch_model": check_latch_model, "stability_map": check_stability_map,
          "design_error": check_design_error, "error_budget": check_error_budget}


def main(name, driver, folder):
    folder = pathlib.Path(folder)
    shutil.rmtree(folder, ignore_errors=True)
    subprocess.run([driver, "--quick", "--out", folder], check=True)
    figures = CHECKS[name](folder)
    plot = f"plot_{name}.py" if name in ("design_error", "error_budget") else "plot_accuracy.py"
    subprocess.run([sys.executable, f"studies/plots/{plot}", folder], check=True)
    for figure in figures:
        for suffix in (".png", ".svg"):
            check((folder / (figure + suffix)).stat().st_size > 5000, f"{figure}{suffix} is drawn")


if __name__ == "__main__":
    main(*sys.argv[1:])
