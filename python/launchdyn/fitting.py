"""Fits: keys of a scenario at which its launch has the results that were measured."""

from __future__ import annotations

import ctypes
import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from typing import Any, NamedTuple, Optional, Union

import numpy as np
import numpy.typing as npt

from ._interrupt import Interrupt
from ._library import GO_ON, ld_error, ld_fit_key, ld_fit_options, library
from ._memory import Handle, coded, coded_path, printed, texts
from ._values import value_text
from .errors import check
from .scenario import Scenario

PathLike = Union[str, "os.PathLike[str]"]


class FittedKey(NamedTuple):
    """What a fit says of a key, in SI.

    >>> key = fitted.keys["rocket.motor.thrust_scale"]
    >>> key.unit, key.at_bound
    ('', False)
    """

    value: float
    deviation: float  #: standard; NaN at a bound, or where the data do not tell the key
    low: float  #: of the 95 % interval
    high: float
    unit: str
    at_bound: bool


@dataclass(frozen=True)
class Fit:
    """What was fitted (docs/fit.md); printed, it is the table of `launchdyn fit`.

    >>> fitted.keys["rocket.motor.thrust_scale"].deviation > 0
    True
    """

    keys: dict[str, FittedKey]  #: by path
    covariance: npt.NDArray[np.float64]  #: [keys, keys] in SI
    chi2: float
    freedom: int  #: results and priors beyond the keys
    p: float  #: chance of such a chi2 of noise alone; NaN without freedom
    document: dict[str, Any] = field(repr=False)  #: all of it, as fit.json has it
    text: str = field(repr=False)

    def __str__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        return f"<pre>{escape(self.text)}</pre>"


def _number(value: Optional[float]) -> float:
    return np.nan if value is None else float(value)


def _fit_of(pointer: int) -> Fit:
    document = json.loads(printed(lambda stream: library.ld_fit_print_json(pointer, stream)))
    keys = {key["path"]: FittedKey(_number(key["value"]), _number(key["deviation"]),
                                   _number(key["low"]), _number(key["high"]), key["unit"],
                                   key["at_bound"]) for key in document["keys"]}
    covariance = np.array([[_number(value) for value in row] for row in document["covariance"]])
    return Fit(keys, covariance, document["chi2"], document["freedom"], _number(document["p"]),
               document, printed(lambda stream: library.ld_fit_print(pointer, stream)))


def _paths(files: Union[PathLike, Sequence[PathLike]]) -> list[str]:
    if isinstance(files, (str, os.PathLike)):
        return [os.fspath(files)]
    return [os.fspath(path) for path in files]


def fit(scenario: Scenario, files: Union[PathLike, Sequence[PathLike]],
        over: Mapping[str, tuple[Any, Any]],
        prior: Optional[Mapping[str, tuple[Any, Any]]] = None,
        folder: Optional[PathLike] = None, threads: int = 1, starts: int = 4,
        seed: int = 0, logs: Union[PathLike, Sequence[PathLike]] = (),
        sensors: Union[PathLike, Sequence[PathLike], None] = None,
        plot: Optional[PathLike] = None) -> Fit:
    """Fits keys to measured launches, CSV files with a line a launch, and to logs.

    `over` has bounds by path, {"rocket.lock.release_force": ("2 kN", "10 kN")}; `prior` mean
    and standard deviation; bare numbers are in SI. `sensors` describe the logs, in their order,
    in place of the files beside them; `plot` names a picture to draw. With a folder, Ctrl-C
    keeps what was computed: the same call continues, and fitted.yaml is written there.

    `threads` run launches side by side; `starts` searches begin at points that follow from
    `seed`.

    >>> found = ld.fit(scenario, launches, {"rocket.motor.thrust_scale": (0.9, 1.1)}, starts=1)
    >>> round(found.keys["rocket.motor.thrust_scale"].value, 2)
    1.02
    """
    unknown = set(prior or {}) - set(over)
    if unknown:
        raise ValueError(f"prior of a key that is not fitted: {sorted(unknown)[0]}")
    wishes = (ld_fit_key * max(len(over), 1))()
    for wish, (path, bounds) in zip(wishes, over.items()):
        wish.path = coded(path)
        wish.__setattr__("from", coded(value_text(path, bounds[0])))
        wish.to = coded(value_text(path, bounds[1]))
        if prior and path in prior:
            wish.mean, wish.deviation = (coded(value_text(path, part)) for part in prior[path])
    error, pointer = ld_error(), ctypes.c_void_p()
    names, series = texts(_paths(files)), texts(_paths(logs))
    described = None if sensors is None else texts(_paths(sensors))
    if described is not None and len(described) != len(series):
        raise ValueError("expected as many descriptions of sensors as logs")
    check(library.ld_fit_create(scenario.handle.pointer, wishes, len(over), names, len(names),
                                ctypes.byref(pointer), ctypes.byref(error)), error)
    handle = Handle(pointer.value, library.ld_fit_free, scenario.handle)
    if len(series) > 0:
        check(library.ld_fit_add_logs(handle.pointer, series, described, len(series),
                                      ctypes.byref(error)), error)
    with Interrupt() as interrupt:
        options = ld_fit_options(folder=None if folder is None else coded_path(folder),
                                 threads=threads, starts=starts, seed=seed,
                                 go_on=GO_ON(lambda _: not interrupt.asked))
        status = library.ld_fit_run(handle.pointer, ctypes.byref(options), ctypes.byref(error))
        if not interrupt.asked:
            check(status, error)
    if plot is not None and not interrupt.asked:
        check(library.ld_fit_draw(handle.pointer, coded_path(plot), ctypes.byref(error)), error)
    return _fit_of(handle.pointer)
