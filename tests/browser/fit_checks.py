"""The section of a fit (`wingspread fit`): every number and every mark of it against fit.json, traces.csv and posterior.csv."""

import csv
import json
import math
import random
import subprocess

import pages
from number_checks import DEGREES

CAMPAIGN = pages.ROOT / "studies/campaigns/seed.json"
NOISE = 0.005  # rad
COLUMNS = ("root.angle", "tip.rate")  # two quantities, which are measured in degrees and in degrees per second
TESTS = {
    "tests": [{"name": "ground", "trace": {"file": "ground.csv", "time": "t", "columns": {
                   "root.angle": {"column": "th1", "unit": "deg", "std": "0.3 deg", "offset_std": "0.1 deg"},
                   "tip.rate": {"column": "w3", "unit": "deg/s"}}},
               "values": [{"output": "root.latch_time", "value": "5.25 s", "std": "0.05 s"},
                          {"output": "root.latch_rate", "value": "-70 deg/s", "std": "3 deg/s"},
                          {"parameter": "hinges.mid.friction.coulomb", "value": 0.021, "std": 0.002}]}],
    "fit": {"parameters": ["root_spring", "tip_spring", "coulomb.mid"], "samples": 200, "starts": 2},
    "candidates": [{"name": "slower start", "set": {"hinges.root.initial_rate": 0.1},
                    "trace": {"times": {"to": "4 s", "step": "50 ms"}, "columns": {"root.angle": {"std": "0.3 deg"}}}}]}


def simulated(folder):
    """A trace of the nominal wing with noise, to the time before its first latch."""
    subprocess.run([pages.PROGRAM, "simulate", CAMPAIGN, "--t-end", "4.5", "--dt", "0.05", "--out", folder / "exact.csv"], check=True, capture_output=True)
    dice = random.Random(1)
    lines = ["t,th1,w3"]
    for row in csv.DictReader((folder / "exact.csv").read_text().splitlines()):
        lines.append(",".join([row["t"], *(f"{math.degrees(float(row[name]) + dice.gauss(0, NOISE)):.4f}" for name in COLUMNS)]))
    (folder / "ground.csv").write_text("\n".join(lines) + "\n")


def made_fit():
    """The folder of a fit of three parameters to this trace and three values; made once."""
    folder = pages.SCRATCH / "fit"
    if not folder.exists():
        base = pages.SCRATCH / "fit_tests"
        base.mkdir()
        simulated(base)
        (base / "tests.json").write_text(json.dumps(TESTS))
        ran = subprocess.run([pages.PROGRAM, "fit", CAMPAIGN, base / "tests.json", "--out", folder], capture_output=True, text=True)
        assert ran.returncode in (0, 1), ran.stderr  # 1: the chains are not finished
    return folder


class FitChecks:
    def copied(self, figure, place=0):
        """The numbers that a figure's button copies: heads, and rows of numbers and texts."""
        text = self.run_script("""const figure = document.querySelectorAll(`figure.${arguments[0]}`)[arguments[1]]; let text;
            navigator.clipboard.writeText = t => { text = t; return Promise.resolve(); }; [...figure.querySelectorAll('.tools button')].pop().click(); return text""", figure, place)
        return [line.split("\t") for line in text.strip("\n").split("\n")]

    def same_numbers(self, cells, values, about):
        for cell, value in zip(cells, values, strict=True):
            if isinstance(value, str):
                self.assertEqual(cell, value, about)
            else:
                self.assertTrue(math.isclose(float(cell), value, rel_tol=2e-6, abs_tol=1e-9), f"{about}: {cell} for {value}")

    def fit_traces(self, fit, folder):
        """Each trace: its rows, its marks on the axes, its note."""
        stored = list(csv.DictReader((folder / "traces.csv").read_text().splitlines()))
        self.assertEqual(len(self.all("figure.fit-trace")), len(COLUMNS))
        for place, (column, unit) in enumerate(zip(COLUMNS, ("deg", "deg/s"))):
            rows = [row for row in stored if row["column"] == column]
            heads, *cells = self.copied("fit-trace", place)
            self.assertEqual(heads, ["t s", *(f"{key} {unit}" for key in ("measured", "fitted", "lower", "upper"))])
            for got, row in zip(cells, rows, strict=True):
                self.same_numbers(got, [float(row["t"]), *(DEGREES * float(row[key]) for key in ("measured", "fitted", "lower", "upper"))], column)
            one = fit["tests"][0]["traces"][column]
            note = self.run_script("return document.querySelectorAll('figure.fit-trace > .note')[arguments[0]].textContent", place)
            wanted = [one["rms"] * DEGREES] + ([one["chi_squared"], one["n"], one["p_value"]] if one["chi_squared"] is not None else [])
            self.check(note.replace("χ²", "χ"), *wanted, one["n_effective"], about=column)
            marks, tops = self.run_script("""const svg = document.querySelectorAll('figure.fit-trace svg')[arguments[0]],
                of = axis => [...axis.querySelectorAll('.tick')].map(tick => [tick.transform.baseVal[0].matrix.f - 0.5, tick.textContent]);
                return [[...svg.querySelectorAll('circle.sample')].map(c => Number(c.getAttribute('cy'))), [...svg.querySelectorAll('.axis.y')].map(of)]""", place)
            residuals = [float(row["measured"]) - float(row["fitted"]) for row in rows]
            for got, values, ticks in zip((marks[: len(rows)], marks[len(rows):]), ([float(row["measured"]) for row in rows], residuals), tops, strict=True):
                (low, first), (high, last) = ((at, float(text.replace("−", "-").replace(",", ""))) for at, text in (ticks[0], ticks[-1]))
                for y, value in zip(got, values, strict=True):
                    self.assertAlmostEqual(first + (y - low) * (last - first) / (high - low), value * DEGREES, delta=abs(last - first) / 200, msg=column)

    def fit_parameters(self, fit):
        """Prior and posterior of each parameter: the table, the copied numbers, the bars."""
        names = list(fit["parameters"])
        keys = ("mode", "mean", "std", "lower", "upper")
        for row, (name, one) in zip(self.table("Parameters before and after the tests"), fit["parameters"].items(), strict=True):
            unit, factor = {"rad": ("deg", DEGREES), "rad/s": ("deg/s", DEGREES)}.get(one.get("unit"), (one.get("unit", ""), 1))
            self.assertEqual(row[0], f"{name} ({unit})" if unit else name)
            for cell, values in zip(row[1:4], ((one["prior"]["mean"], one["prior"]["std"]), (one["mean"], one["std"]), (one["lower"], one["upper"])), strict=True):
                self.check(cell, *(factor * value for value in values), about=name)
            self.check(row[4], one["std_ratio"], share=True, about=name)
        for got, (name, one) in zip(self.copied("fit-parameters")[1:], fit["parameters"].items(), strict=True):
            self.same_numbers(got, [name, *(one["prior"][key] for key in ("mean", "std", "lower", "upper")), *(one[key] for key in keys), one["std_ratio"]], name)
        value, near = self.axis("fit-parameters", "x")
        bars = self.attributes("figure.fit-parameters rect.interval", "x", "width")
        for name, prior, after in zip(names, bars[::2], bars[1::2], strict=True):
            one = fit["parameters"][name]
            wanted, before = ([(each[key] - one["prior"]["mean"]) / one["prior"]["std"] for key in ("lower", "upper")] for each in (one, one["prior"]))
            for (x, width), (low, high) in ((prior, before), (after, wanted)):
                self.assertLess(abs(value(x) - low), 2 * near, name)
                self.assertLess(abs(value(x + width) - high), max(2 * near, 2.1 * abs(value(1) - value(0))), name)

    def test_every_number_of_a_fit(self):
        folder = made_fit()
        self.open(pages.reported("fit", folder))
        fit = json.loads((folder / "fit.json").read_text())
        text = self.one("#why").text
        self.assertNotRegex(self.page_text(), r"NaN|undefined|Infinity|could not be drawn")
        for sentence in [*fit["findings"], *(one["text"] for one in fit["unseen"])]:
            self.assertIn(sentence, text)
        self.fit_traces(fit, folder)
        self.fit_parameters(fit)
        rows = list(csv.reader((folder / "posterior.csv").read_text().splitlines()))
        heads, *cells = self.copied("fit-pairs")
        self.assertEqual(heads, rows[0])
        step = (len(rows) - 1) / len(cells)
        for at, got in enumerate(cells):
            self.same_numbers(got, [float(cell) for cell in rows[1 + int(at * step + 1e-9)]], f"sample {at}")
        self.assertEqual(len(self.all("figure.fit-pairs circle.sample")), 3 * len(cells))
        values = fit["tests"][0]["values"]
        units = {"root.latch_time": ("s", 1), "root.latch_rate": ("deg/s", DEGREES), "hinges.mid.friction.coulomb": ("N·m", 1)}
        for row, (name, one) in zip(self.table("Measured values"), values.items(), strict=True):
            unit, factor = units[name]
            self.assertEqual((row[0], row[1].replace(" ", "_"), row[2]), ("ground", name if name.startswith("hinges") else name.replace(".", "_"), unit))
            for cell, key, scale in zip(row[3:], ("measured", "fitted", "sigmas", "p_value"), (factor, factor, 1, 1), strict=True):
                self.check(cell, one[key] * scale, about=f"{name}, {key}")
        for row, one in zip(self.table("What further tests would tell"), fit["candidates"], strict=True):
            name = min(one["std_ratio"], key=one["std_ratio"].get)
            self.assertEqual((row[0], row[2].split(":")[0]), (one["name"], name))
            self.check(row[1], one["information"], about=one["name"])
            self.check(row[2].split(":")[1], one["std_ratio"][name], share=True, about=one["name"])
        self.fit_predictions(fit)

    def fit_predictions(self, fit):
        """The outputs that vary, in degrees and in radians."""
        varies = {name: one for name, one in fit["prediction"].items()
                  if any(one[when][0] != one[when][2] for when in ("before", "after"))}
        for unit, factor in (("rad", 1), ("deg", DEGREES)):
            self.run_script("const s = document.getElementById('angles'); s.value = arguments[0]; s.dispatchEvent(new Event('change'))", unit)
            deployed, *rows = self.table("Prediction: median (5 % … 95 %)")
            for cell, when in zip(deployed[2:], ("before", "after"), strict=True):
                self.check(cell, fit["predicted_deployed"][when], share=True, about="deployed")
            for row, (name, one) in zip(rows, varies.items(), strict=True):
                hinge, _, quantity = name.rpartition(".")
                label = quantity.replace("_", " ") + (" (beyond stowed)" if quantity == "overtravel" else "")
                self.assertEqual(row[0], f"{hinge} {label}".strip())
                scale = factor if quantity in ("latch_rate", "overtravel") else 1
                self.assertEqual(row[1], {"latch_rate": f"{unit}/s", "overtravel": unit, "peak_moment": "N·m", "peak_force": "N"}.get(quantity, "s"), name)
                for cell, when in zip(row[2:], ("before", "after"), strict=True):
                    low, middle, high = (value * scale for value in one[when])
                    self.check(cell, middle, low, high, about=f"{name} {when}, {unit}")
