"""What `wingspread export` writes, read by h5py, pandas and Octave, and held against runs.csv: every number.

    /usr/bin/python3 tests/export/readers_test.py build/release/wingspread OUT

Exits 77, which ctest takes for skipped, where none of them can be had; one that is missing is named.
"""

import csv
import json
import math
import pathlib
import shutil
import subprocess
import sys

try:
    import h5py
    import numpy
except ImportError:
    print("skipped: python3-h5py is not installed")
    sys.exit(77)
try:
    import pandas
except ImportError:
    pandas = None

ROOT = pathlib.Path(__file__).resolve().parents[2]
HINGE = "wurzel ü"  # in latch_order and reason
TEXTS = ("status", "latch_order", "reason")
CODES = {"true": 1, "false": 0, "": -1}


def campaign(folder):
    """Runs that deploy, that t_end cuts and that are invalid, in two cases."""
    scene = json.loads((ROOT / "studies/scenes/three_panel.json").read_text(encoding="utf-8"))
    hinge = next(each for each in scene["hinges"] if each["name"] == "tip")
    hinge["name"] = HINGE
    given = {
        "scene": scene,
        "dispersions": [{"name": "root_spring", "distribution": {"type": "normal", "mean": 1, "std": 0.05},
                         "apply": "scale", "to": ["hinges.root.spring.torque_stowed"]},
                        {"name": "mass", "distribution": {"type": "normal", "mean": 10, "std": 6},
                         "apply": "set", "each": "bodies.*.mass"}],
        "cases": [{"name": "cold", "scale": {"bodies.*.inertia": 1.1}}, {"name": "hot"}],
        "sampling": {"runs": 120, "seed": 7},
        "integration": {"rtol": 1e-6, "atol": 1e-8, "t_end": 6.75},
    }
    (folder / "c.json").write_text(json.dumps(given), encoding="utf-8")
    return folder / "c.json"


def rows_of(path):
    with open(path, encoding="utf-8", newline="") as file:
        table = list(csv.reader(file))
    return {name: [row[i] for row in table[1:]] for i, name in enumerate(table[0])}


def expected(name, cells):
    """What the file has to hold for these cells of runs.csv."""
    if name in TEXTS:
        return cells
    if name == "peaks_final":
        return [CODES[cell] for cell in cells]
    return [int(cell) if name == "run" else float(cell) if cell else math.nan for cell in cells]


def same(found, wanted):
    return len(found) == len(wanted) and all(
        f == w or (isinstance(w, float) and math.isnan(w) and math.isnan(f)) for f, w in zip(found, wanted))


def check(group, rows, reader):
    assert list(group) == list(rows), f"{reader}: {list(group)} for {list(rows)}"
    for name, cells in rows.items():
        assert same(group[name], expected(name, cells)), f"{reader}: {name} differs from runs.csv"


def by_h5py(group):
    return {name: [text.decode("utf-8") for text in column[:]] if name in TEXTS else column[:].tolist()
            for name, column in group.items()}


def by_pandas(group):
    table = pandas.DataFrame({name: column[:] for name, column in group.items()})
    for name in TEXTS:
        table[name] = table[name].str.decode("utf-8")  # as h5py's asstr("utf-8")
    return {name: table[name].tolist() for name in table}


def octave_value(name, cells):
    """An expression that is true where Octave's column is these cells."""
    identifier = name.replace(".", "_")
    if name in TEXTS:
        words = "; ".join("'" + cell.replace("'", "''") + "'" for cell in cells)
        return f"isequal(strtrim(cellstr(c.{identifier})), {{{words}}})"
    numbers = " ".join("NaN" if isinstance(value, float) and math.isnan(value) else repr(value)
                       for value in expected(name, cells))
    return f"isequaln(double(c.{identifier}(:)'), [{numbers}])"


def check_octave(file, cases):
    script = [f"r = load('{file}');"]
    for case, rows in cases.items():
        script.append(f"c = r.{case};")
        for name, cells in rows.items():
            if not name.isascii():  # Octave renames the column
                continue
            value = octave_value(name, cells)
            script.append(f"if !{value} error('{case}: {name} differs from runs.csv'); end")
    script.append("disp('as runs.csv');")
    path = file.with_suffix(".m")
    path.write_text("\n".join(script) + "\n", encoding="utf-8")
    done = subprocess.run(["octave", "--no-gui", "--quiet", "--norc", str(path)], capture_output=True, text=True,
                          check=False)
    assert done.returncode == 0 and done.stdout == "as runs.csv\n" and "load:" not in done.stderr, \
        f"octave: {done.stdout}{done.stderr}"


def main():
    program, out = sys.argv[1], pathlib.Path(sys.argv[2])
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    subprocess.run([program, "run", str(campaign(out)), "--out", str(out / "r")], check=True, capture_output=True)
    file = out / "r.h5"
    subprocess.run([program, "export", str(out / "r"), "--out", str(file)], check=True, capture_output=True)
    cases = {name: rows_of(out / "r" / name / "runs.csv") for name in ("cold", "hot")}
    seen = {status for rows in cases.values() for status in rows["status"]}
    assert {"deployed", "timed_out", "invalid"} <= seen, f"the test's campaign has lost its variety: {seen}"
    with h5py.File(file) as opened:
        assert any(HINGE in order for order in opened["cold/latch_order"].asstr("utf-8")[:]), "no hinge with such a name"
        assert opened.attrs["seed"] == 7 and json.loads(opened.attrs["campaign"])["sampling"]["runs"] == 120
        assert opened["cold/root.latch_time"].attrs["unit"] == "s"
        assert opened["cold/mass.panel_1"].attrs["unit"] == "kg"
        assert opened["cold/run"].dtype == numpy.int64 and opened["cold/peaks_final"].dtype == numpy.int8
        for name, rows in cases.items():
            check(by_h5py(opened[name]), rows, "h5py")
            if pandas:
                check(by_pandas(opened[name]), rows, "pandas")
    if not pandas:
        print("left out: python3-pandas is not installed")
    if shutil.which("octave"):
        check_octave(file, cases)
    else:
        print("left out: octave is not installed")


if __name__ == "__main__":
    main()
