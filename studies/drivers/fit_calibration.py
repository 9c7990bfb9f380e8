"""Simulation-based calibration of `wingspread fit`: are its posteriors right over data sets drawn from the priors?

    /usr/bin/python3 studies/drivers/fit_calibration.py                     # both cases, 300 sets each; 25 minutes of one core
    /usr/bin/python3 studies/drivers/fit_calibration.py --case seed --sets 40
    /usr/bin/python3 studies/drivers/fit_calibration.py --quick             # two sets of each case

Each set draws the parameters from their priors, simulates the test, adds noise to the trace, and fits. If the posterior is right, the true
parameter's rank among posterior draws is uniform (S. Talts et al., arXiv:1804.06788), and the 90 % interval holds it in 90 % of the sets.

  seed       three panels; spring, friction and harness of all hinges
  two_wings  two such wings on a free spacecraft; six springs, friction and harness, and unknown offsets of the clock and of four encoders

OUT/CASE.csv gets a row a set as the sets end; a second call makes only the sets that are missing. It refuses rows of another program, seed,
effective sample size or definition of the case, which OUT/CASE.json names. The table at the end: p-values of
χ² tests of uniform ranks (20 classes), and the share of sets whose 90 % interval holds the truth, with its 95 % confidence interval. Exits 1
if a p-value is below 1 % over the number of tests (Bonferroni), or if 90 % is not within the interval of the coverage over all parameters.
"""

import argparse
import csv
import json
import math
import pathlib
import random
import resource
import shutil
import subprocess
import sys
import tempfile

import numpy
from scipy import stats

import own_folder

ROOT = pathlib.Path(__file__).resolve().parents[2]
NOISE = math.radians(0.3)  # of an angle's sample, rad
RANKS = 100  # a truth among 99 posterior draws
CLASSES = 20


def spring(name, to):
    return {"name": name, "apply": "scale", "to": to,
            "distribution": {"type": "normal", "mean": 1, "std": 0.04, "truncate": {"lower": 0.84, "upper": 1.16}}}


def lognormal(name, to, sigma):
    return {"name": name, "apply": "scale", "to": to, "distribution": {"type": "lognormal", "mu_log": 0, "sigma_log": sigma}}


CASES = {
    "seed": {
        "scene": "three_panel_flight.json",
        "dispersions": [spring("spring", ["hinges.*.spring.scale"]), lognormal("friction", ["hinges.*.friction.scale"], 0.3),
                        lognormal("harness", ["hinges.*.harness.scale"], 0.25)],
        "columns": ["root.angle", "tip.angle"], "until": 5.2, "interval": 0.04, "clock": 0, "encoder": 0},
    "two_wings": {
        "scene": "two_wing_free.json",
        "dispersions": [*[spring(f"{side}_{hinge}", [f"hinges.{side}_{hinge}.spring.scale"]) for side in ("left", "right")
                          for hinge in ("root", "mid", "tip")],
                        lognormal("friction", ["hinges.*.friction.scale"], 0.3), lognormal("harness", ["hinges.*.harness.scale"], 0.25)],
        "columns": ["left_root.angle", "left_tip.angle", "right_root.angle", "right_tip.angle"],
        "until": 5.2, "interval": 0.05, "clock": 0.005, "encoder": math.radians(0.2)},
}


def call(*command, allowed=(0,)):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    if done.returncode not in allowed:
        sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stderr}")
    return done


def read_csv(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def column_of(rows, name):
    """The numbers of a column; a unit in brackets may follow the name."""
    key = next(key for key in rows[0] if key.split(" [")[0] == name)
    return [float(row[key]) for row in rows]


def draw_truths(program, case, sets, seed, folder):
    """Writes the campaign of priors and draws the true parameters: runs of the campaign."""
    campaign = {"scene": str(ROOT / "studies/scenes" / case["scene"]), "dispersions": case["dispersions"],
                "sampling": {"design": "random", "runs": sets, "seed": seed}, "integration": {"t_end": 20, "rtol": 1e-6},
                "outputs": ["latch_time"], "statistics": {"accuracy_runs": 0}}
    (folder / "campaign.json").write_text(json.dumps(campaign, indent=1), encoding="utf-8")
    call(program, "run", folder / "campaign.json", "--out", folder / "truths", "--threads", "1", allowed=(0, 1, 3))
    return read_csv(folder / "truths/runs.csv")


def make_test(program, case, index, seed, folder):
    """Simulates the test of one set and writes its trace, with noise and offsets drawn from their laws."""
    dice = random.Random(f"{seed}/{case['scene']}/{index}")
    (folder / "truth.json").unlink(missing_ok=True)
    call(program, "replay", folder / "truths", "--run", index, "--scene", folder / "truth.json")
    clock = dice.gauss(0, case["clock"])
    # a clock that is late by c writes t − c beside what happens at t
    call(program, "simulate", folder / "truth.json", "--t-end", case["until"], "--dt", case["interval"], "--out", folder / "truth.csv")
    rows = read_csv(folder / "truth.csv")
    angles = [column_of(rows, name) for name in case["columns"]]
    offsets = [dice.gauss(0, case["encoder"]) for _ in angles]
    with open(folder / "trace.csv", "w", encoding="utf-8") as file:
        file.write("t," + ",".join(case["columns"]) + "\n")
        last = -math.inf
        for k, t in enumerate(column_of(rows, "t")):
            if t == last:
                continue  # a latch gives two samples
            values = [angle[k] + offset + dice.gauss(0, NOISE) for angle, offset in zip(angles, offsets)]
            file.write(",".join(repr(v) for v in [t - clock, *values]) + "\n")
            last = t
    columns = {name: {"column": name, "std": NOISE, "offset_std": case["encoder"]} for name in case["columns"]}
    return {"name": "test", "trace": {"file": "trace.csv", "time": "t", "time_offset_std": case["clock"], "columns": columns}}


def rank_of(truth, draws):
    return sum(draw < truth for draw in draws)


def make_set(program, case, index, truth, given, folder):
    """One row of the results: for each parameter its truth, rank and 90 % interval."""
    test = make_test(program, case, index, given.seed, folder)
    names = [dispersion["name"] for dispersion in case["dispersions"]]
    (folder / "tests.json").write_text(json.dumps(
        {"tests": [test], "fit": {"parameters": names, "samples": given.samples, "starts": 2}}), encoding="utf-8")
    shutil.rmtree(folder / "fit", ignore_errors=True)
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = call(program, "fit", folder / "campaign.json", folder / "tests.json", "--out", folder / "fit", "--threads", "1", "--seed",
                given.seed + index, allowed=(0, 1))
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    found = json.loads((folder / "fit/fit.json").read_text(encoding="utf-8"))
    posterior = read_csv(folder / "fit/posterior.csv")
    traces = found["tests"][0]["traces"].values()
    row = {"set": index, "finished": int(done.returncode == 0), "runs": found["sampler"]["runs"], "ess": found["sampler"]["ess"],
           "acceptance": found["sampler"]["acceptance"], "seconds": round(seconds, 2),
           "effective_share": min(trace["n_effective"] / trace["n"] for trace in traces), "p_value": min(trace["p_value"] for trace in traces)}
    for name in names:
        draws = [float(sample[name]) for sample in posterior]
        some = [draws[k * len(draws) // (RANKS - 1)] for k in range(RANKS - 1)]
        low, high = numpy.quantile(draws, [0.05, 0.95])
        row |= {f"{name}.truth": float(truth[name]), f"{name}.rank": rank_of(float(truth[name]), some), f"{name}.lower": low, f"{name}.upper": high}
    return row


def add_row(path, row):
    is_new = not path.exists()
    with open(path, "a", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, row)
        if is_new:
            writer.writeheader()
        writer.writerow(row)


def check_origin(path, made_by):
    """Ends the driver if the rows of a file were made otherwise; beside a new file, writes how its rows are made."""
    origin = path.with_suffix(".json")
    if path.exists() and not (origin.exists() and json.loads(origin.read_text(encoding="utf-8")) == made_by):
        found = "another program, seed, sample size or case" if origin.exists() else f"unknown origin, without {origin.name}"
        sys.exit(f"{path}: found rows of {found}: move the file away, and {origin.name} if it is there")
    origin.write_text(json.dumps(made_by, indent=1), encoding="utf-8")


def make_sets(name, given):
    case, path = CASES[name], pathlib.Path(given.out) / f"{name}.csv"
    path.parent.mkdir(parents=True, exist_ok=True)
    check_origin(path, {"program": call(given.program, "--version").stdout.strip(), "seed": given.seed, "samples": given.samples, "case": case})
    made = {int(row["set"]) for row in read_csv(path)} if path.exists() else set()
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        truths = draw_truths(given.program, case, given.sets, given.seed, folder)
        for index in range(given.sets):
            if index not in made:
                add_row(path, make_set(given.program, case, index, truths[index], given, folder))
    return [row for row in read_csv(path) if int(row["set"]) < given.sets]


def uniformity(ranks):
    """The p-value of a χ² test that ranks 0 … 99 are uniform."""
    return stats.chisquare(numpy.histogram(ranks, bins=CLASSES, range=(0, RANKS))[0]).pvalue


def interval(successes, trials):
    return stats.binomtest(successes, trials).proportion_ci(0.95, method="exact")


def print_case(name, rows):
    """@return the p-values, and whether 90 % lies within the coverage's interval"""
    parameters = [dispersion["name"] for dispersion in CASES[name]["dispersions"]]
    finished = sum(int(row["finished"]) for row in rows)
    median = {key: numpy.median([float(row[key]) for row in rows]) for key in ("seconds", "runs", "acceptance")}
    print(f"\n{name}: {len(rows)} sets, {finished} finished; medians: {median['runs']:.0f} runs of the sampler, acceptance "
          f"{median['acceptance']:.2f}, {median['seconds']:.1f} s of processor time")
    print(f"{'parameter':16} {'p of uniform ranks':>18} {'coverage of 90 %':>18} {'95 % interval':>16} {'sd of z':>8}")
    p_values, held = [], numpy.zeros(len(rows))
    for parameter in parameters:
        value = {key: numpy.array([float(row[f"{parameter}.{key}"]) for row in rows]) for key in ("truth", "rank", "lower", "upper")}
        inside = (value["lower"] <= value["truth"]) & (value["truth"] <= value["upper"])
        held += inside
        p_values.append(uniformity(value["rank"]))
        low, high = interval(int(inside.sum()), len(rows))
        z = stats.norm.ppf((value["rank"] + 0.5) / RANKS)
        print(f"{parameter:16} {p_values[-1]:18.3f} {inside.mean():18.3f} {low:8.3f} …{high:6.3f} {z.std():8.2f}")
    mean = held.mean() / len(parameters)
    error = 1.96 * held.std(ddof=1) / math.sqrt(len(rows)) / len(parameters)  # parameters of a set depend on each other
    print(f"{'all':16} {min(p_values) * len(p_values):12.3f} (×{len(p_values):2}) {mean:17.3f} {mean - error:8.3f} …{mean + error:6.3f}")
    return p_values, abs(mean - 0.9) <= error


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=ROOT / "build/release/wingspread", type=pathlib.Path)
    parser.add_argument("--case", choices=CASES, action="append", help="default: all")
    parser.add_argument("--sets", type=int, default=300)
    parser.add_argument("--samples", type=int, default=400, help="effective sample size of a fit")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", default="results/fit_calibration")
    parser.add_argument("--quick", action="store_true", help="two sets of each case, in OUT/quick")
    given = parser.parse_args()
    if given.quick:
        given.sets, given.out = 2, f"{given.out}/quick"
        own_folder.begin(given.out)
    p_values, good = [], True
    for name in given.case or CASES:
        found, covers = print_case(name, make_sets(name, given))
        p_values += found
        good = good and covers
    if given.quick:
        return 0  # too few sets to judge
    return 0 if good and min(p_values) * len(p_values) > 0.01 else 1


if __name__ == "__main__":
    sys.exit(main())
