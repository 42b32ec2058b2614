"""Derivatives of a launch's results by keys of its scenario."""

from __future__ import annotations

import ctypes
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from typing import Any, NamedTuple, Optional, Union

from ._interrupt import Interrupt
from ._library import GO_ON, ld_derivative_key, ld_derivative_options, ld_error, library
from ._memory import Handle, coded, printed
from ._values import value_text
from .errors import check
from .scenario import Scenario


class Derivative(NamedTuple):
    """Of a result by a key, in SI.

    >>> ld.sensitivity(scenario, ["rocket.mass"])["exit_speed"]["rocket.mass"].smooth
    True
    """

    value: Optional[float]  #: of the result
    derivative: Optional[float]
    left: Optional[float]  #: the differences on either side
    right: Optional[float]
    smooth: bool  #: the sides differ by at most 1 % and have the same events


@dataclass(frozen=True)
class Sensitivity:
    """Derivatives by result and key; printed, it is the table of `launchdyn sensitivity`.

    >>> sensitivity = ld.sensitivity(scenario, ["rocket.mass"])
    >>> sensitivity["exit_speed"]["rocket.mass"].derivative < 0
    True
    """

    of: dict[str, dict[str, Derivative]]  #: by result, then key
    document: dict[str, Any] = field(repr=False)  #: all of it, as --json prints it
    text: str = field(repr=False)

    def __getitem__(self, result: str) -> dict[str, Derivative]:
        return self.of[result]

    def __str__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        return f"<pre>{escape(self.text)}</pre>"


def _sensitivity_of(pointer: int, results: Optional[bytes], error: ld_error) -> Sensitivity:
    document = json.loads(printed(lambda stream: check(library.ld_derivatives_print_json(
        pointer, results, stream, ctypes.byref(error)), error)))
    text = printed(lambda stream: check(library.ld_derivatives_print(
        pointer, results, stream, ctypes.byref(error)), error))
    of: dict[str, dict[str, Derivative]] = {}
    for key in document["keys"]:
        for result in key["results"]:
            of.setdefault(result["name"], {})[key["path"]] = Derivative(
                result["value"], result["derivative"], result["left"], result["right"],
                result["smooth"])
    return Sensitivity(of, document, text)


def sensitivity(scenario: Scenario, keys: Union[Sequence[str], Mapping[str, Any]],
                results: Optional[Sequence[str]] = None, threads: int = 1) -> Sensitivity:
    """How the results of a launch change with keys, by central differences along its own steps.

    `keys` are paths, or paths with the step to either side, {"base.azimuth": "0.01 deg"}; None
    stands for 1e-4 of the key's value. `results` are names in place of the usual ones.

    `threads` run launches side by side.

    >>> found = ld.sensitivity(scenario, ["rocket.mass"], results=["exit_speed"])
    >>> found["exit_speed"]["rocket.mass"].smooth
    True
    """
    steps = dict(keys) if isinstance(keys, Mapping) else dict.fromkeys(keys)
    asked = (ld_derivative_key * max(len(steps), 1))()
    for one, (path, step) in zip(asked, steps.items()):
        one.path = coded(path)
        one.step = None if step is None else coded(value_text(path, step))
    error, pointer = ld_error(), ctypes.c_void_p()
    names = None if results is None else coded(",".join(results))
    with Interrupt() as interrupt:
        options = ld_derivative_options(threads=threads,
                                        go_on=GO_ON(lambda _: not interrupt.asked))
        status = library.ld_derivatives_find(scenario.handle.pointer, asked, len(steps),
                                             ctypes.byref(options), ctypes.byref(pointer),
                                             ctypes.byref(error))
        if not interrupt.asked:
            check(status, error)
    handle = Handle(pointer.value, library.ld_derivatives_free, scenario.handle)
    return _sensitivity_of(handle.pointer, names, error)
