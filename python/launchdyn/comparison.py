"""A run beside what was measured: simulated sensors against the columns of a log."""

from __future__ import annotations

import ctypes
import os
from dataclasses import dataclass
from html import escape
from typing import Any, Optional, Union

import numpy as np

from ._interrupt import Interrupt
from ._library import (SHARE_TOLD, ld_compare_options, ld_compared_series, ld_error, ld_validation,
                       library)
from ._memory import Array, Handle, coded_path, printed, text_of
from .errors import check

PathLike = Union[str, "os.PathLike[str]"]
VERDICTS = ("agree", "disagree", "cannot tell")


@dataclass(frozen=True)
class Validation:
    """An error with its standard uncertainties, in SI; NaN: not known (docs/compare.md).

    >>> compared.series["height"].of.verdict
    'agree'
    """

    error: float  #: E, simulated less measured; of a series its rms
    u_num: float
    u_input: float
    u_data: float
    u_val: float
    limit: float  #: what 2 u_val must not exceed to tell anything
    verdict: str  #: "agree", "disagree", "cannot tell"


@dataclass(frozen=True)
class ComparedSeries:
    """A sensor's series, in SI, without gaps, saturated samples and what lies outside the run.

    >>> compared.series["height"].unit
    'm'
    """

    name: str  #: of its column in the log
    unit: str  #: "" without
    t: Array  #: [s] from ignition
    measured: Array
    simulated: Array
    u_val: Array
    of: Validation  #: of rms values
    mean: float  #: of E
    largest: float  #: |E|
    t_largest: float  #: [s]
    saturated: int
    gaps: int
    outside: int
    bias: float  #: of the sensor, as given or as found at rest
    bias_uncertainty: float


@dataclass(frozen=True)
class ComparedResult:
    """A number, in SI.

    >>> [(one.name, one.of.verdict) for one in compared.results]
    [('apogee', 'agree'), ('apogee after', 'agree')]
    """

    name: str
    unit: str  #: "" without
    measured: float
    simulated: float
    of: Validation


class Comparison:
    """A run compared with a log; str() is the table of the command.

    >>> compared
    <launchdyn.Comparison: agree, agree, agree>
    """

    def __init__(self, handle: Handle) -> None:
        """Of the library's handle: use compare()."""
        self._handle = handle
        clock = library.ld_comparison_clock(handle.pointer)[0]
        #: [s] time from ignition = time of the log + offset, and its standard uncertainty
        self.offset: float = clock.offset
        self.offset_uncertainty: float = clock.uncertainty

    @property
    def series(self) -> dict[str, ComparedSeries]:
        """Series by the names of their columns.

        >>> list(compared.series)
        ['height']
        """
        found: dict[str, ComparedSeries] = {}
        while pointer := library.ld_comparison_series(self._handle.pointer, len(found)):
            one = _series(pointer[0])
            found[one.name] = one
        return found

    @property
    def results(self) -> list[ComparedResult]:
        """The numbers that were compared.

        >>> [one.name for one in compared.results]
        ['apogee', 'apogee after']
        """
        found: list[ComparedResult] = []
        while pointer := library.ld_comparison_result(self._handle.pointer, len(found)):
            r = pointer[0]
            found.append(ComparedResult(text_of(r.name), text_of(r.unit), r.measured, r.simulated,
                                        _validation(r.of)))
        return found

    @property
    def notes(self) -> list[str]:
        """Remarks.

        >>> len(compared.notes)
        0
        """
        found: list[str] = []
        while note := library.ld_comparison_note(self._handle.pointer, len(found)):
            found.append(text_of(note))
        return found

    def draw(self, file: PathLike) -> None:
        """Draws measured and simulated series with their residuals by gnuplot: file.svg, file.pdf
        or file.png.

        >>> compared.draw(folder / "compared.svg")
        """
        error = ld_error()
        check(library.ld_comparison_draw(self._handle.pointer, coded_path(file),
                                         ctypes.byref(error)), error)

    def __str__(self) -> str:
        return printed(lambda to: library.ld_comparison_print(self._handle.pointer, to))

    def __repr__(self) -> str:
        verdicts = [one.of.verdict for one in self.series.values()]
        verdicts += [one.of.verdict for one in self.results]
        return f"<launchdyn.Comparison: {', '.join(verdicts)}>"

    def _repr_html_(self) -> str:
        return f"<pre>{escape(str(self))}</pre>"


def _validation(v: ld_validation) -> Validation:
    return Validation(v.error, v.u_num, v.u_input, v.u_data, v.u_val, v.limit, VERDICTS[v.verdict])


def _series(s: ld_compared_series) -> ComparedSeries:
    t, measured, simulated, u_val = (np.array(values[:s.count], np.float64) for values in
                                     (s.t, s.measured, s.simulated, s.u_val))
    return ComparedSeries(text_of(s.name), text_of(s.unit), t, measured, simulated, u_val,
                          _validation(s.of), s.mean, s.largest, s.t_largest, s.saturated, s.gaps,
                          s.outside, s.bias, s.bias_uncertainty)


def compare(folder: PathLike, log: PathLike, sensors: Optional[PathLike] = None, *,
            refine: bool = False, samples: int = 0, study: Optional[PathLike] = None,
            rocket: int = 1) -> Comparison:
    """Compares the run in a folder with a log, a CSV file (docs/compare.md). `sensors`: the file
    that says what its sensors are; without it that beside the log. `refine` finds u_num by two
    more runs, `samples` u_input by so many of the scenario's scatter, `study` that of results by
    the study in a folder.

    `rocket`: which, from 1, in the order of firing.

    >>> compared = ld.compare(folder / "student", log)
    >>> compared.series["height"].of.verdict
    'agree'
    """
    error, pointer = ld_error(), ctypes.c_void_p()
    with Interrupt() as interrupt:
        options = ld_compare_options(
            sensors=coded_path(sensors) if sensors else None,
            study=coded_path(study) if study else None, samples=samples, refine=refine,
            rocket=rocket, progress=SHARE_TOLD(interrupt.asking()))
        status: Any = library.ld_compare(coded_path(folder), coded_path(log),
                                         ctypes.byref(options), ctypes.byref(pointer),
                                         ctypes.byref(error))
    check(status, error)
    return Comparison(Handle(pointer.value, library.ld_comparison_free))
