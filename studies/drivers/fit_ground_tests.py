"""From two ground tests to the flight: what `wingspread fit` makes of tests whose truth is known.

    /usr/bin/python3 studies/drivers/fit_ground_tests.py       # results/fit_ground_tests; a minute of one core
    /usr/bin/python3 studies/drivers/fit_ground_tests.py --quick

The seed wing with plates, so that air slows it. Its true springs are weaker, its friction and harness larger than thought. Two deployments on
ground are simulated with the true values, off-loaded to 2 mm/s² and in air, at 20 °C and at −40 °C; encoders at 100 Hz on the root and the tip,
noise 0.3°. Three fits: the warm trace; both; both and a torque test, which measures the friction to 5 %. Each with traces that end before
the root latches, and after it. For each, the driver prints the posterior, and the cold flight's prediction beside the flight of the true wing.
Exits 1 if a 95 % interval misses the truth.
"""

import argparse
import csv
import json
import math
import pathlib
import random
import subprocess
import sys

import numpy

import own_folder

ROOT = pathlib.Path(__file__).resolve().parents[2]
TRUTH = {"spring": 0.96, "friction": 1.5, "harness": 1.25}
TEMPERATURES = {"ambient": 20, "cold": -40}  # °C
COLUMNS = ("root.angle", "tip.angle")
NOISE = math.radians(0.3)
OUTPUTS = {"deployment_time": "s", "root.latch_rate": "rad/s", "root.peak_moment": "N*m"}
GROUND = {"environment.gravity.1": -0.002, "environment.air_density": 1.2}
FITS = {"warm test": ["ambient"], "both tests": ["ambient", "cold"], "both and torque test": ["ambient", "cold", "torque"]}


def call(*command, allowed=(0,)):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    if done.returncode not in allowed:
        sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stderr}")


def read_csv(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def make_campaign(runs):
    scene = json.loads((ROOT / "studies/scenes/three_panel_flight.json").read_text(encoding="utf-8"))
    for body in scene["bodies"]:
        body["plate"] = {"from": [-0.5, 0], "to": [0.5, 0], "width": 1, "drag_coefficient": 1.2}
    table = {"friction": [1.7, 1, 0.9], "harness": [1.9, 1, 0.85]}
    laws = {"spring": {"type": "normal", "mean": 1, "std": 0.03}, "friction": {"type": "lognormal", "mu_log": 0, "sigma_log": 0.3},
            "harness": {"type": "lognormal", "mu_log": 0, "sigma_log": 0.25}}
    dispersions = [{"name": name, "distribution": law, "apply": "scale", "to": [f"hinges.*.{name}.scale"]} for name, law in laws.items()]
    dispersions += [{"name": "mass", "distribution": {"type": "normal", "mean": 1, "std": 0.002}, "apply": "scale", "to": ["bodies.*.mass"]},
                    {"name": "temperature", "distribution": {"type": "normal", "mean": 20, "std": 3},
                     "through": [{"to": [f"hinges.*.{name}.scale"], "apply": "scale", "table": {"at": [-40, 20, 70], "value": values}}
                                 for name, values in table.items()]}]
    cases = [{"name": name, "distributions": {"temperature": {"type": "normal", "mean": at, "std": 3}}} for name, at in TEMPERATURES.items()]
    return {"scene": scene, "dispersions": dispersions, "cases": cases, "sampling": {"runs": runs, "seed": 7}, "integration": {"t_end": 60},
            "outputs": ["latch_time", "latch_rate", "peak_moment"]}


def fly_truth(program, campaign, case, ground, folder):
    """One run with the true values and all else at its median. @return its row, and the scene's file"""
    true = json.loads(json.dumps(campaign))
    values = {**TRUTH, "mass": 1, "temperature": TEMPERATURES[case]}
    for dispersion in true["dispersions"]:
        dispersion["distribution"] = {"type": "constant", "value": values[dispersion["name"]]}
    del true["cases"]
    true["sampling"]["runs"] = 1
    if ground:
        true["scene"]["environment"] = {"gravity": [0, GROUND["environment.gravity.1"]], "air_density": GROUND["environment.air_density"]}
    folder.mkdir(parents=True)
    (folder / "campaign.json").write_text(json.dumps(true), encoding="utf-8")
    call(program, "run", folder / "campaign.json", "--out", folder / "run", "--threads", "1", allowed=(0, 1))
    call(program, "replay", folder / "run", "--run", 0, "--scene", folder / "scene.json")
    return read_csv(folder / "run/runs.csv")[0], folder / "scene.json"


def measure(program, scene, case, until, folder):
    """The trace of a test: COLUMNS at 100 Hz with noise."""
    call(program, "simulate", scene, "--t-end", until, "--dt", "0.01", "--out", folder / f"{case}_exact.csv")
    dice = random.Random(case)
    rows = read_csv(folder / f"{case}_exact.csv")
    keys = {name: next(key for key in rows[0] if key.split(" [")[0] == name) for name in ("t", *COLUMNS)}
    last = None
    with open(folder / f"{case}.csv", "w", encoding="utf-8") as file:
        file.write("t," + ",".join(f"{name} [deg]" for name in COLUMNS) + "\n")
        for row in rows:
            if row[keys["t"]] != last:  # a latch gives two samples
                angles = [math.degrees(float(row[keys[name]]) + dice.gauss(0, NOISE)) for name in COLUMNS]
                file.write(f"{row[keys['t']]}," + ",".join(f"{angle:.4f}" for angle in angles) + "\n")
            last = row[keys["t"]]


def test_of(case):
    if case == "torque":  # both ways: half the difference is friction
        return {"name": "torque", "values": [{"parameter": "hinges.root.friction.scale", "value": 1.03 * TRUTH["friction"],
                                              "std": 0.05 * TRUTH["friction"]}]}
    columns = {name: {"column": name, "std": "0.3 deg", "offset_std": "0.1 deg"} for name in COLUMNS}
    return {"name": case, "case": case, "set": GROUND, "trace": {"file": f"{case}.csv", "time": "t", "columns": columns}}


def outputs_of(folder):
    rows = read_csv(next(folder.rglob("runs.csv")))  # in a folder of the case
    return {name: numpy.array([float(row[name]) for row in rows if row[name]]) for name in OUTPUTS}


def print_fit(name, fit, prediction, flight):
    print(f"\n{name}: effective sample size {fit['sampler']['ess']:.0f}, {fit['sampler']['runs']} runs of each test")
    for text in fit["findings"] + [each["text"] for each in fit["unseen"]]:
        print(f"  {text}")
    good = True
    for parameter, truth in TRUTH.items():
        found = fit["parameters"][parameter]
        inside = found["lower"] <= truth <= found["upper"]
        good = good and inside
        print(f"  {parameter:18} {found['mean']:8.4f} ± {found['std']:.4f}   95 %: {found['lower']:.4f} … {found['upper']:.4f}   truth {truth:g}"
              f"{'' if inside else '   MISSED'}   {100 * found['std_ratio']:.1f} % of the prior's sd left")
    print_prediction(prediction, flight)
    return good


def print_prediction(prediction, flight):
    for output, unit in OUTPUTS.items():
        low, middle, high = numpy.quantile(prediction[output], [0.025, 0.5, 0.975])
        print(f"  {output:18} {middle:8.3f} ({low:.3f} … {high:.3f}) {unit}, truth {float(flight[output]):.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=ROOT / "build/release/wingspread", type=pathlib.Path)
    parser.add_argument("--out", default="results/fit_ground_tests", type=pathlib.Path)
    parser.add_argument("--samples", type=int, default=2000)
    parser.add_argument("--runs", type=int, default=2000, help="of a prediction")
    parser.add_argument("--until", type=float, nargs="+", default=[3, 7], help="ends of the traces, s: before and after the root's latch")
    parser.add_argument("--threads", type=int, default=0, help="default: all processors")
    parser.add_argument("--quick", action="store_true", help="few samples and runs")
    given = parser.parse_args()
    if given.quick:
        given.samples, given.runs, given.until = 100, 100, [3]
    own_folder.begin(given.out)
    campaign = make_campaign(given.runs)
    (given.out / "campaign.json").write_text(json.dumps(campaign, indent=1), encoding="utf-8")
    threads = ["--threads", given.threads] if given.threads else []
    scenes = {case: fly_truth(given.program, campaign, case, True, given.out / f"truth_{case}")[1] for case in TEMPERATURES}
    flight, _ = fly_truth(given.program, campaign, "cold", False, given.out / "truth_flight")
    call(given.program, "run", given.out / "campaign.json", "--case", "cold", "--out", given.out / "before", *threads, allowed=(0, 1))
    print("before the tests, the flight at -40 °C: median (95 %)")
    print_prediction(outputs_of(given.out / "before"), flight)
    good = True
    for until in given.until:
        print(f"\ntraces of {until:g} s")
        good = fit_all(given, campaign, scenes, until, flight, threads) and good
    return 0 if good else 1


def fit_all(given, campaign, scenes, until, flight, threads):
    """All fits to traces that end at a time. @return whether the 95 % intervals hold the truth"""
    base, good = given.out / f"{until:g}_s", True
    base.mkdir()
    (base / "campaign.json").write_text(json.dumps(campaign, indent=1), encoding="utf-8")
    for case, scene in scenes.items():
        measure(given.program, scene, case, until, base)
    for name, tests in FITS.items():
        folder = base / name.replace(" ", "_")
        spec = {"tests": [test_of(case) for case in tests], "fit": {"parameters": list(TRUTH), "samples": given.samples, "starts": 3}}
        path = base / f"{folder.name}.json"
        path.write_text(json.dumps(spec, indent=1), encoding="utf-8")
        call(given.program, "fit", base / "campaign.json", path, "--out", folder, *threads)
        call(given.program, "run", folder / "campaign.json", "--case", "cold", "--out", folder / "flight", *threads, allowed=(0, 1))
        fit = json.loads((folder / "fit.json").read_text(encoding="utf-8"))
        good = print_fit(name, fit, outputs_of(folder / "flight"), flight) and good
    return good


if __name__ == "__main__":
    sys.exit(main())
