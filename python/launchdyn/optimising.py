"""Optimising: values of keys at which a disturbance, a load or a time is least."""

from __future__ import annotations

import ctypes
import json
import os
from dataclasses import dataclass, field
from html import escape
from typing import Any, NamedTuple, Optional, Union

import numpy as np

from ._interrupt import Interrupt
from ._library import GO_ON, ld_error, ld_optimise_options, library
from ._memory import Handle, coded_path, printed
from .errors import check
from .scenario import Scenario
from .study import Estimate

PathLike = Union[str, "os.PathLike[str]"]


class OptimisedKey(NamedTuple):
    """A key in SI.

    >>> optimum.keys["rocket.lock.release_force"].unit
    'N'
    """

    value: float  #: at which the aim is least
    before: float  #: the scenario's
    unit: str


@dataclass(frozen=True)
class Optimum:
    """What was found (docs/optimise.md); printed, it is the table of `launchdyn optimise`.

    >>> optimum.holds
    True
    """

    keys: dict[str, OptimisedKey]  #: by path
    least: Estimate  #: the aim, with its 95 % interval on samples that the search did not use
    gain: Estimate  #: how far that is from the aim with the scenario's values
    holds: bool  #: all constraints, on the samples of the search
    document: dict[str, Any] = field(repr=False)  #: all of it, as optimise.json has it
    text: str = field(repr=False)
    handle: Handle = field(repr=False, compare=False)

    def plot(self, file: PathLike) -> None:
        """Draws the course, candidate by candidate, into a .svg, .pdf or .png file.

        >>> optimum.plot(folder / "course.svg")
        """
        error = ld_error()
        check(library.ld_optimise_plot(self.handle.pointer, coded_path(file),
                                       ctypes.byref(error)), error)

    def __str__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        return f"<pre>{escape(self.text)}</pre>"


def _estimate(of: Optional[dict[str, Any]]) -> Estimate:
    values = [np.nan if not of or of[end] is None else float(of[end])
              for end in ("value", "low", "high")]
    return Estimate(*values)


def _optimum_of(handle: Handle) -> Optimum:
    pointer = handle.pointer
    document = json.loads(printed(lambda stream: library.ld_optimise_print_json(pointer, stream)))
    keys = {key["path"]: OptimisedKey(key["found"], key["scenario"], key["unit"])
            for key in document["keys"]}
    others = "_others" if document["samples"] > 1 else ""
    least = document["least"]
    return Optimum(keys, _estimate(least.get("found" + others)),
                   _estimate(least.get("difference" + others)), document["holds"], document,
                   printed(lambda stream: library.ld_optimise_print(pointer, stream)), handle)


def optimise(scenario: Scenario, folder: Optional[PathLike] = None, threads: int = 1) -> Optimum:
    """Searches what the scenario's block `optimise` asks for.

    With a folder, Ctrl-C keeps what was computed: the same call continues, and optimised.yaml is
    written there.

    `threads` run launches side by side.

    >>> found = ld.optimise(asking)
    >>> found.keys["rocket.lock.release_force"].value < 10e3
    True
    """
    error, pointer = ld_error(), ctypes.c_void_p()
    check(library.ld_optimise_create(scenario.handle.pointer, ctypes.byref(pointer),
                                     ctypes.byref(error)), error)
    handle = Handle(pointer.value, library.ld_optimise_free, scenario.handle)
    with Interrupt() as interrupt:
        options = ld_optimise_options(folder=None if folder is None else coded_path(folder),
                                      threads=threads,
                                      go_on=GO_ON(lambda _: not interrupt.asked))
        status = library.ld_optimise_run(handle.pointer, ctypes.byref(options),
                                         ctypes.byref(error))
        if not interrupt.asked:
            check(status, error)
    return _optimum_of(handle)
