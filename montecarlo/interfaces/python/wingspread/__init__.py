"""How far the deployment of a spacecraft's solar wing may stray from the drawing.

    import wingspread

    runs = wingspread.run("campaign.json", runs=2000)           # columns as numpy arrays, by the names of runs.csv
    runs["root.peak_moment"].max()

    outcome, trajectory = wingspread.simulate("three_panel.json", set={"hinges.root.spring.scale": 0.9})
    y = wingspread.evaluate("three_panel.json", ["hinges.*.spring.scale"], [[0.9], [1.1]], ["deployment_time"])
    runs = wingspread.read("results/first")

SI units and radians throughout. The same seed gives the same bits as `wingspread run`, whatever the number of threads.
A scene or a campaign is given as the path of its file, as its JSON text, or as what json.load makes of it; files
that are named in text or dictionaries are relative to the working directory. What is wrong with an input is a
SpecError, with the text that the program prints; what the machine refuses is a MachineError. What only looks wrong is
warned of (Notice). Ctrl-C ends a long call.
"""

from __future__ import annotations

import collections.abc
import json
import os
import typing
import warnings

import numpy as np
import numpy.typing as npt

from . import _native
from ._native import MachineError, SpecError

__all__ = ["MachineError", "Model", "Notice", "Simulation", "SpecError", "Table", "evaluate", "read", "run", "simulate"]
__version__: str = _native.version()

Source = typing.Union[str, "os.PathLike[str]", typing.Mapping[str, typing.Any]]
"""A path, JSON text, or what json.load makes of it."""
Changes = typing.Mapping[str, typing.Union[float, str]]
"""Parameters of the nominal wing by their paths: numbers in SI, or text with a unit ("90 deg")."""
Floats = npt.NDArray[np.float64]


class Notice(UserWarning):
    """What looks wrong in a campaign that can be run."""


class Simulation(typing.NamedTuple):
    """One deployment."""

    outcome: dict[str, typing.Any]
    """What `wingspread simulate --json` prints: status, latches, peak_moment, peak_force, final, energy, work, …"""
    trajectory: dict[str, Floats]
    """The columns of `wingspread simulate --out`, by their names: t, root.angle, root.rate, root.moment, …"""


class Table(typing.Mapping[str, npt.NDArray[typing.Any]]):
    """The rows of a campaign: a mapping from the columns of runs.csv to numpy arrays.

    Numbers are views of the table's own memory, read-only; NaN where a quantity did not happen. `status`,
    `latch_order` and `reason` are arrays of str, `peaks_final` of True, False or None. pandas.DataFrame(dict(table))
    is a data frame.
    """

    def __init__(self, native: _native.Table) -> None:
        self._native = native

    def __getitem__(self, column: str) -> npt.NDArray[typing.Any]:
        """The column of that name; KeyError where there is none."""
        if column not in self._native.columns:
            raise KeyError(column)
        if column == "run":
            return self._native.runs()
        if column == "reason":
            return np.array(self._native.reasons(), dtype=object)
        if column not in ("status", "latch_order", "peaks_final"):
            return self._native.numbers(column)
        codes, texts = self.codes(column)
        known: list[typing.Any] = [None, False, True] if column == "peaks_final" else texts
        return np.array(known, dtype=object)[codes]

    def __iter__(self) -> typing.Iterator[str]:
        return iter(self._native.columns)

    def __len__(self) -> int:
        """How many columns there are; `size` is how many rows."""
        return len(self._native.columns)

    def __repr__(self) -> str:
        return f"<wingspread.Table of {self.size} runs: {', '.join(self)}>"

    @property
    def size(self) -> int:
        """How many runs there are."""
        return self._native.size

    @property
    def draws(self) -> list[str]:
        """The names of the columns that were drawn."""
        return self._native.draws

    @property
    def outputs(self) -> list[str]:
        """The names of the columns of results that are numbers."""
        return self._native.outputs

    @property
    def is_complete(self) -> bool:
        """Whether these are all runs; not so of a results folder that is not finished."""
        return self._native.is_complete

    @property
    def campaign(self) -> dict[str, typing.Any]:
        """The campaign in full, all defaults explicit, with its seed and hash: campaign.json."""
        return typing.cast("dict[str, typing.Any]", json.loads(self._native.campaign))

    def codes(self, column: str) -> tuple[npt.NDArray[np.uint32], list[str]]:
        """`status`, `latch_order` or `peaks_final` as codes, a view, and the texts that they stand for."""
        return self._native.words(column)

    def numbers(self, columns: typing.Sequence[str]) -> Floats:
        """Columns of numbers side by side, as one array[run, column], copied."""
        return np.column_stack([self._native.numbers(column) for column in columns])


def run(campaign: Source, *, runs: int | None = None, seed: int | None = None, threads: int = 0, case: str = "",
        set: Changes | None = None) -> Table:
    """Makes a campaign's runs, and writes nothing.

    runs, seed: in place of the campaign's. threads: 0 for all processors. case: which one, of a campaign that has
    cases. set: changes of the nominal wing.
    """
    table = _native.run(_input_of(campaign), runs, seed, threads, case, _changes_of(set))
    for notice in table.notices:
        warnings.warn(notice, Notice, stacklevel=2)
    return Table(table)


def read(folder: str | os.PathLike[str], *, case: str = "") -> Table:
    """The rows of a results folder. case: which one, of a campaign that has cases."""
    return Table(_native.read(os.fspath(folder), case))


def simulate(scene: Source, *, set: Changes | None = None, case: str = "", dt: float | None = None,
             method: str | None = None, latch: str | None = None, step: float | None = None,
             rtol: float | None = None, atol: float | None = None, t_end: float | None = None) -> Simulation:
    """Integrates one deployment, of a scene or of a campaign's nominal scene, to its t_end.

    set: changes of the wing. dt: the trajectory's interval, s; every step of the integration without. The others as
    `wingspread simulate` has them.
    """
    settings = _native.Settings(_changes_of(set), case, method, latch, step, rtol, atol, t_end)
    outcome, trajectory = _native.simulate(_input_of(scene), settings, 0.0 if dt is None else dt)
    return Simulation(json.loads(outcome), trajectory)


class Model:
    """A wing as a function of some of its parameters, read once and called often: model(x[n, d]) → y[n, m].

    paths: of parameters as dispersions name them, "hinges.*.spring.scale" for all springs. outputs: columns of runs.csv;
    all but the families rate_at and base_motion without. The others as simulate has them.
    """

    def __init__(self, scene: Source, paths: typing.Sequence[str], outputs: typing.Sequence[str] = (), *,
                 set: Changes | None = None, case: str = "", method: str | None = None, latch: str | None = None,
                 step: float | None = None, rtol: float | None = None, atol: float | None = None,
                 t_end: float | None = None) -> None:
        settings = _native.Settings(_changes_of(set), case, method, latch, step, rtol, atol, t_end)
        self._native = _native.Model(_input_of(scene), list(paths), list(outputs), settings)

    @property
    def outputs(self) -> list[str]:
        """The columns of y."""
        return self._native.outputs

    @property
    def nominal(self) -> Floats:
        """The nominal values of the parameters, SI."""
        return np.array(self._native.nominal)

    def __call__(self, x: npt.ArrayLike, *, threads: int = 0) -> Floats:
        """One deployment for each row of x, on all processors and without the GIL.

        x: values in SI, that are set. Returns a row of outputs each, NaN where a quantity did not happen or the
        parameters are unphysical. threads: 0 for all processors.
        """
        return self._native.evaluate(np.asarray(x, dtype=float), threads)


def evaluate(scene: Source, paths: typing.Sequence[str], x: npt.ArrayLike, outputs: typing.Sequence[str] = (), *,
             threads: int = 0, set: Changes | None = None, case: str = "", method: str | None = None,
             latch: str | None = None, step: float | None = None, rtol: float | None = None,
             atol: float | None = None, t_end: float | None = None) -> Floats:
    """The outputs of one deployment for each row of x: Model(scene, paths, outputs, …)(x), for one call."""
    model = Model(scene, paths, outputs, set=set, case=case, method=method, latch=latch, step=step, rtol=rtol,
                  atol=atol, t_end=t_end)
    return model(x, threads=threads)


def _input_of(source: Source) -> _native.Input:
    if isinstance(source, collections.abc.Mapping):
        return _native.Input.from_text(json.dumps(source, default=_plain), "")
    if isinstance(source, str) and source.lstrip().startswith("{"):
        return _native.Input.from_text(source, "")
    if isinstance(source, (str, os.PathLike)):
        return _native.Input.from_file(os.fspath(source))
    raise TypeError(f"found {type(source).__name__}, expected a path, JSON text or a dictionary")


def _plain(value: typing.Any) -> typing.Any:
    """What numpy holds, for JSON."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    raise TypeError(f"found {type(value).__name__}, expected what JSON can hold")


def _changes_of(changes: Changes | None) -> list[str]:
    return [f"{path}={value if isinstance(value, str) else repr(float(value))}"
            for path, value in (changes or {}).items()]
