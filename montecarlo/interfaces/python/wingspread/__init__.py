"""Monte Carlo simulation of the deployment of spacecraft solar wings.

    import wingspread

    runs = wingspread.run("campaign.json", runs=2000)           # columns as numpy arrays, by the names of runs.csv
    runs["root.peak_moment"].max()

    outcome, trajectory = wingspread.simulate("three_panel.json", set={"hinges.root.spring.scale": 0.9})
    y = wingspread.evaluate("three_panel.json", ["hinges.*.spring.scale"], [[0.9], [1.1]], ["deployment_time"])
    runs = wingspread.read("results/first")
    result, posterior = wingspread.fit("campaign.json", "tests.json", out="fit")

All numbers are in SI units and radians. The same seed gives the same bits as `wingspread run`, with any number of
threads. A scene or a campaign is the path of a file, JSON text, or a dictionary as json.load returns it; files named in
text or dictionaries are relative to the working directory. Wrong input raises SpecError with the text that the program
prints; MachineError is raised when the machine refuses something (memory, disk space). Input that only looks wrong gives
a warning (Notice). Ctrl-C ends a long call within about a second; fit waits for the deployments under way.
"""

from __future__ import annotations

import collections.abc
import json
import math
import numbers
import operator
import os
import sys
import typing
import warnings

import numpy as np
import numpy.typing as npt

from . import _native
from ._native import MachineError, SpecError

__all__ = ["Fit", "MachineError", "Model", "Notice", "Simulation", "SpecError", "Table", "evaluate", "fit", "read", "run",
           "simulate"]
__version__: str = _native.version()

Source = typing.Union[str, "os.PathLike[str]", typing.Mapping[str, typing.Any]]
"""A path, JSON text, or a dictionary as json.load returns it."""
Changes = typing.Mapping[str, typing.Union[float, str]]
"""New values for parameters of the nominal wing, by path: numbers in SI units, or text with a unit ("90 deg")."""
Floats = npt.NDArray[np.float64]


class Notice(UserWarning):
    """Warns of a campaign that can be run but looks wrong."""


class Simulation(typing.NamedTuple):
    """One simulated deployment."""

    outcome: dict[str, typing.Any]
    """The JSON of `wingspread simulate --json`: status, latches, peak_moment, peak_force, final, energy, work, …"""
    trajectory: dict[str, Floats]
    """The columns of `wingspread simulate --out` by name: t, root.angle, root.rate, root.moment, …"""


class Fit(typing.NamedTuple):
    """Parameters fitted to deployment tests."""

    result: dict[str, typing.Any]
    """The content of fit.json: finished, findings, parameters, correlation, unseen, tests, …; `prediction` and
    `predicted_deployed` only with a folder"""
    posterior: dict[str, Floats]
    """Samples of the parameters by name, a row a sample: the columns of posterior.csv"""


class Table(typing.Mapping[str, npt.NDArray[typing.Any]]):
    """The rows of a campaign: a mapping from the columns of runs.csv to numpy arrays.

    Numbers are read-only views of the table's memory; NaN marks a missing value. `status`,
    `latch_order` and `reason` are arrays of str. `peaks_final` is an array of True, False, None, or the name of the only
    family of peaks that is proven ("peak_moment"). pandas.DataFrame(dict(table)) is a data frame; a Table itself cannot be
    pickled, dict(table) can.
    """

    def __init__(self, native: _native.Table) -> None:
        self._native = native

    def __getitem__(self, column: str) -> npt.NDArray[typing.Any]:
        """Returns the column of this name; raises KeyError if there is none."""
        if column not in self._native.columns:
            raise KeyError(column)
        if column == "run":
            return self._native.runs()
        if column == "reason":
            return np.array(self._native.reasons(), dtype=object)
        if column not in ("status", "latch_order", "peaks_final"):
            return self._native.numbers(column)
        codes, texts = self.codes(column)
        known: list[typing.Any] = [None, False, True, *texts[3:]] if column == "peaks_final" else texts
        return np.array(known, dtype=object)[codes]

    def __iter__(self) -> typing.Iterator[str]:
        return iter(self._native.columns)

    def __len__(self) -> int:
        """The number of columns; `size` is the number of rows."""
        return len(self._native.columns)

    def __repr__(self) -> str:
        return f"<wingspread.Table of {self.size} runs: {', '.join(self)}>"

    @property
    def size(self) -> int:
        """The number of runs."""
        return self._native.size

    @property
    def draws(self) -> list[str]:
        """The names of the columns with draws."""
        return self._native.draws

    @property
    def outputs(self) -> list[str]:
        """The names of the columns with numeric outputs."""
        return self._native.outputs

    @property
    def is_complete(self) -> bool:
        """Whether all runs of the campaign, or of the folder's shard, are there; False for a results folder that is not finished."""
        return self._native.is_complete

    @property
    def campaign(self) -> dict[str, typing.Any]:
        """The campaign with all defaults, its seed and its hash: the content of campaign.json."""
        return typing.cast("dict[str, typing.Any]", json.loads(self._native.campaign))

    def codes(self, column: str) -> tuple[npt.NDArray[np.uint32], list[str]]:
        """Returns `status`, `latch_order` or `peaks_final` as a view of codes and the texts that they index."""
        return self._native.words(column)

    def numbers(self, columns: typing.Sequence[str]) -> Floats:
        """Returns a copy of several columns of numbers as one array[run, column]."""
        names = _names("columns", columns)
        if not names:
            return np.empty((self.size, 0))
        return np.column_stack([self._native.numbers(column) for column in names])


def run(campaign: Source, *, runs: int | None = None, seed: int | None = None, threads: int = 0, case: str = "",
        set: Changes | None = None) -> Table:
    """Makes a campaign's runs in memory and returns their rows; writes no files.

    runs, seed: the number of runs and the seed; default: the campaign's. threads: 0 for OMP_NUM_THREADS, or all
    processors. case: the case, required for a campaign with cases. set: changes of the nominal wing.
    """
    table = _native.run(_input_of(campaign), _whole("runs", runs, 1, _MOST_RUNS), _whole("seed", seed, 0, _MOST_SEED),
                        _required("threads", threads, 0, _MOST_THREADS), _text("case", case), _changes_of(set))
    _warn(table.notices)
    return Table(table)


def fit(campaign: Source, tests: Source, *, out: str | os.PathLike[str] = "", seed: int | None = None, runs: int = 0,
        threads: int = 0, resume: bool = False) -> Fit:
    """Fits parameters of a campaign to deployment tests, as `wingspread fit`.

    tests: the tests and the parameters. out: the folder to write; default: no files. runs: most runs of the sampler;
    0: 400 for each sample. threads: 0 for OMP_NUM_THREADS, or all processors. resume: go on with the chains that an
    earlier call, or `wingspread fit`, left in the folder out. If result["finished"] is False, the chains are too short, and
    the numbers are no result; a Notice says so.
    """
    folder = _path("out", out, "a folder") if os.fspath(out) else ""
    if _truth("resume", resume) and not folder:
        raise _wrong("resume", resume, "out, the folder of the fit to go on with")
    text, posterior, notices = _native.fit(
        _input_of(campaign), _input_of(tests), folder, _whole("seed", seed, 0, _MOST_SEED),
        _required("runs", runs, 0, _MOST_RUNS), _required("threads", threads, 0, _MOST_THREADS), bool(resume))
    _warn(notices)
    result = json.loads(text)
    if not result["finished"]:
        why = next(finding for finding in result["findings"] if finding.startswith("not finished"))
        warnings.warn(why, Notice, stacklevel=2)
    return Fit(result, posterior)


def read(folder: str | os.PathLike[str], *, case: str = "") -> Table:
    """Reads the rows of a results folder. case: the case, required for a campaign with cases."""
    table = _native.read(_path("folder", folder, "a results folder"), _text("case", case))
    _warn(table.notices)
    return Table(table)


def simulate(scene: Source, *, set: Changes | None = None, case: str = "", dt: float | None = None,
             method: str | None = None, latch: str | None = None, step: float | None = None,
             rtol: float | None = None, atol: float | None = None, t_end: float | None = None,
             check: bool = False) -> Simulation:
    """Simulates one deployment of a scene, or of a campaign's nominal scene, to its t_end.

    set: changes of the wing. case: the case; default: the campaign's wing without any of its cases. dt: interval
    between rows of the trajectory, s; default: every step. method, latch, step (s), rtol, atol (rad and rad/s), t_end
    (s): as the options of `wingspread simulate`; default: the campaign's. check: repeat the run by another method at a
    tighter tolerance; outcome["check"] has the digits that agree.
    """
    settings = _settings(set, case, method, latch, step, rtol, atol, t_end)
    interval = _number("dt", dt)
    if interval is not None and not 0 < interval < float("inf"):
        raise _wrong("dt", dt, "a number, s, > 0")
    outcome, trajectory, notices = _native.simulate(_input_of(scene), settings, 0.0 if interval is None else interval,
                                                    _truth("check", check))
    _warn(notices)
    return Simulation(json.loads(outcome), trajectory)


class Model:
    """A wing as a function of some of its parameters: model(x[n, d]) → y[n, m]. Read once, called often.

    paths: the d parameters, as dispersions name them; "hinges.*.spring.scale" sets all springs. outputs: the m columns of
    runs.csv; default: all except rate_at, base_motion, frequency and final_angle. The other arguments are those of simulate.
    """

    def __init__(self, scene: Source, paths: typing.Sequence[str], outputs: typing.Sequence[str] = (), *,
                 set: Changes | None = None, case: str = "", method: str | None = None, latch: str | None = None,
                 step: float | None = None, rtol: float | None = None, atol: float | None = None,
                 t_end: float | None = None) -> None:
        settings = _settings(set, case, method, latch, step, rtol, atol, t_end)
        self._native = _native.Model(_input_of(scene), _names("paths", paths), _names("outputs", outputs), settings)
        _warn(self._native.notices)

    @property
    def outputs(self) -> list[str]:
        """The names of the columns of y."""
        return self._native.outputs

    @property
    def nominal(self) -> Floats:
        """The nominal values of the parameters, in SI units; NaN for a path whose parameters have different values."""
        return np.array(self._native.nominal)

    def __call__(self, x: npt.ArrayLike, *, threads: int = 0) -> Floats:
        """Simulates one deployment for each row of x, on several threads and without the GIL.

        x: parameters in SI units, shape (n, d). Returns outputs, shape (n, m); NaN for a missing value, or if the
        parameters are unphysical. threads: 0 for OMP_NUM_THREADS, or all processors.
        """
        if np.ma.isMaskedArray(x):
            raise _wrong("x", "a masked array", "numbers without a mask")
        given = np.asarray(x)
        objects = given.ravel() if given.dtype == object else ()
        if given.dtype.kind not in "biufO" or not all(isinstance(each, numbers.Real) for each in objects):
            raise _wrong("x", given.dtype, "real numbers")
        try:
            real = np.asarray(given, dtype=float)
        except OverflowError:
            raise _wrong("x", "a number beyond double", "real numbers") from None
        return self._native.evaluate(real, _required("threads", threads, 0, _MOST_THREADS))


def evaluate(scene: Source, paths: typing.Sequence[str], x: npt.ArrayLike, outputs: typing.Sequence[str] = (), *,
             threads: int = 0, set: Changes | None = None, case: str = "", method: str | None = None,
             latch: str | None = None, step: float | None = None, rtol: float | None = None,
             atol: float | None = None, t_end: float | None = None) -> Floats:
    """Returns Model(scene, paths, outputs, …)(x): the outputs of one deployment for each row of x."""
    model = Model(scene, paths, outputs, set=set, case=case, method=method, latch=latch, step=step, rtol=rtol,
                  atol=atol, t_end=t_end)
    return model(x, threads=threads)


def _input_of(source: Source) -> _native.Input:
    if isinstance(source, collections.abc.Mapping):
        problems: list[tuple[str, str, str, str]] = []
        plain = _plain(source, "", problems)
        if problems:
            raise _spec_error(problems)
        return _native.Input.from_text(json.dumps(plain), "")
    if isinstance(source, str) and (text := source.removeprefix("\ufeff")).lstrip().startswith("{"):
        return _native.Input.from_text(text, "")
    if isinstance(source, (str, os.PathLike)):
        return _native.Input.from_file(_path("source", source, "the path of a file, JSON text or a dictionary"))
    raise TypeError(f"found {type(source).__name__}, expected a path, JSON text or a dictionary")


def _path(argument: str, path: str | os.PathLike[str], expected: str) -> str:
    plain = os.fspath(path)
    if not plain or "\0" in os.fsdecode(plain):
        raise _spec_error([("", argument, repr(plain), expected)])
    return plain


def _settings(set: Changes | None, case: str, method: str | None, latch: str | None, step: float | None,
              rtol: float | None, atol: float | None, t_end: float | None) -> _native.Settings:
    return _native.Settings(_changes_of(set), _text("case", case), None if method is None else _text("method", method),
                            None if latch is None else _text("latch", latch), _number("step", step),
                            _number("rtol", rtol), _number("atol", atol), _number("t_end", t_end))


_MOST_RUNS, _MOST_SEED, _MOST_THREADS = 2**31 - 1, 2**64 - 1, 1024
"""The limits of the options --runs, --seed and --threads"""


def _spec_error(problems: list[tuple[str, str, str, str]]) -> SpecError:
    error = SpecError("\n".join(f"{place}: found {found}, expected {expected}" for _, place, found, expected in problems))
    error.problems = problems
    return error


def _wrong(argument: str, value: typing.Any, expected: str) -> SpecError:
    return _spec_error([("", "--" + argument.replace("_", "-"), repr(value), expected)])


def _whole(argument: str, value: int | None, least: int, most: int) -> int | None:
    return None if value is None else _required(argument, value, least, most)


def _required(argument: str, value: int, least: int, most: int) -> int:
    """Returns an integer, also a numpy one; raises SpecError for anything else, and beyond the limits."""
    expected = f"a whole number from {least} to {most}"
    try:
        number = operator.index(value)
    except TypeError:
        raise _wrong(argument, value, expected) from None
    if isinstance(value, bool) or not least <= number <= most:
        raise _wrong(argument, value, expected)
    return number


def _truth(argument: str, value: bool) -> bool:
    if not isinstance(value, (bool, np.bool_)):
        raise _wrong(argument, value, "True or False")
    return bool(value)


def _number(argument: str, value: float | None) -> float | None:
    if value is None or (isinstance(value, (numbers.Real, np.floating)) and not isinstance(value, bool)):
        try:
            return None if value is None else float(value)
        except OverflowError:
            pass
    raise _wrong(argument, value, "a number, in SI units")


def _text(argument: str, value: str) -> str:
    if not isinstance(value, str):
        raise _wrong(argument, value, "a text")
    return value


def _names(argument: str, value: typing.Sequence[str]) -> list[str]:
    """Returns a list of texts; a single text would count as its letters."""
    names = list(value) if isinstance(value, collections.abc.Iterable) and not isinstance(value, str) else [None]
    if not all(isinstance(each, str) for each in names):
        raise _wrong(argument, value, "a list of texts")
    return names


def _warn(notices: typing.Iterable[str]) -> None:
    """Warns the caller of the module."""
    depth = 2
    while sys._getframe(depth - 1).f_globals is globals():
        depth += 1
    for notice in notices:
        warnings.warn(notice, Notice, stacklevel=depth)


def _plain(value: typing.Any, pointer: str, problems: list[tuple[str, str, str, str]]) -> typing.Any:
    """Converts mappings, paths, and numpy's numbers and arrays for JSON; notes numbers that are not finite."""
    if isinstance(value, np.ndarray):
        value = value.tolist()
    elif isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, np.floating):  # a longdouble
        value = float(value)
    if isinstance(value, collections.abc.Mapping):
        return {key: _plain(each, f"{pointer}/{str(key).replace('~', '~0').replace('/', '~1')}", problems)
                for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(each, f"{pointer}/{place}", problems) for place, each in enumerate(value)]
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, float) and not math.isfinite(value):
        problems.append(("", pointer, str(value), "a finite number"))
    elif value is not None and not isinstance(value, (str, int, float)):
        raise TypeError(f"{pointer}: found {type(value).__name__}, expected a type that JSON has")
    return value


def _changes_of(changes: Changes | None) -> list[str]:
    if changes is not None and not isinstance(changes, collections.abc.Mapping):
        raise _wrong("set", changes, "a dictionary of values by path")
    return [f"{path}={value if isinstance(value, str) else repr(_number('set', value))}"
            for path, value in (changes or {}).items()]
