"""What a launcher answers to small motions, linear, without runs (docs/response.md)."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import Any, NamedTuple, Optional, Union

import numpy as np
import numpy.typing as npt

from ._interrupt import Interrupt
from ._library import GO_ON, ld_column, ld_error, ld_loop_margins, ld_watch, library
from ._memory import Array, Handle, Held, coded, text_of, texts
from .errors import UnknownName, check, check_name, tell_renamed
from .result import Column, Columns

ComplexArray = npt.NDArray[np.complex128]
Numbers = Union[float, Sequence[float], Array]


class Strength(NamedTuple):
    """How much a column moves about the equilibrium, at random and steadily.

    >>> response.on_road("tip.y")["tip.y"]._fields
    ('rms', 'strongest')
    """

    rms: float  #: root mean square, in the column's unit
    strongest: float  #: [Hz] where most of it comes from


class Scatter(NamedTuple):
    """Of a number of a launch, in its unit.

    >>> response.exit("pitch_rate", draws=2)["pitch_rate"]._fields
    ('mean', 'deviation')
    """

    mean: float
    deviation: float  #: standard deviation


class LoopPoints(NamedTuple):
    """A loop at some frequencies, amplitude and phase as complex numbers.

    >>> points = vehicle.loop("elevation").points(5)
    >>> bool(np.allclose(points.sensitivity, 1 / (1 + points.open)))
    True
    """

    open: ComplexArray  #: L [-]: the controller's torque for a torque in its place, sign turned
    tracking: ComplexArray  #: [-] measured angle per commanded one
    sensitivity: ComplexArray  #: S = 1/(1 + L) [-]


class Margins(NamedTuple):
    """What a loop bears before it swings, between 0.05 and 500 Hz.

    >>> vehicle.loop("elevation").margins._fields[:3]
    ('raise_', 'raise_at', 'lower')
    """

    raise_: float  #: all gains times this > 1 are at the limit of stability; infinity: none
    raise_at: float  #: [Hz] where they swing there
    lower: float  #: the same with a factor < 1; 0: none
    lower_at: float  #: [Hz]
    phase: float  #: [rad] least distance of L from -1 where |L| = 1; infinity: nowhere
    crossover: float  #: [Hz] the last frequency at which |L| = 1; NaN: nowhere
    delay: float  #: [s] by which the loop may be later than it is; infinity: any
    bandwidth: float  #: [Hz] at which |tracking| first falls to 1/sqrt(2); NaN: nowhere
    peak: float  #: greatest |S|
    peak_at: float  #: [Hz]


def _numbers(values: Numbers) -> Array:
    found: Array = np.ascontiguousarray(np.atleast_1d(values), np.float64)
    if found.ndim != 1:
        raise ValueError("expected frequencies as a number or a one-dimensional array, found "
                         f"{found.ndim} dimensions")
    return found


class Response(Held):
    """A launcher linearised about its equilibrium, at any speed of a range: made by
    Scenario.response(). Amplitudes and phases are complex numbers: cos(w t) of an input makes
    Re(gain e^(i w t)) of a column. A context manager; it need not be closed. One thread at a time:
    others wait.

    >>> response.speed == vehicle["base.speed"]
    True
    """

    _over = "the response is closed"

    def __init__(self, model: Handle, slowest: float, fastest: float, friction: bool) -> None:
        error, pointer, own = ld_error(), ctypes.c_void_p(), ctypes.c_double()
        check(library.ld_response_create(model.pointer, slowest, fastest, ctypes.byref(pointer),
                                         ctypes.byref(error)), error, model.pointer)
        self._model = model
        super().__init__(Handle(pointer.value, library.ld_response_free, model))
        check(library.ld_response_friction(pointer, friction, ctypes.byref(error)), error,
              model.pointer)
        vehicle = library.ld_model_has_vehicle(model.pointer)
        if vehicle:
            check(library.ld_model_number(model.pointer, b"base.speed", ctypes.byref(own),
                                          ctypes.byref(error)), error)
        #: [m/s] the scenario's own speed; 0 without a vehicle
        self.speed = own.value

    def _told(self, tell: Any) -> Columns:
        columns = ctypes.POINTER(ld_column)()
        count = tell(self._pointer, ctypes.byref(columns))
        return Columns((text_of(c.name),
                        Column(text_of(c.name), text_of(c.unit), text_of(c.description)))
                       for c in columns[:count])

    @property
    def inputs(self) -> Columns:
        """What may act: "road", "elevation.command", "chassis.force_y", "base.y", ...

        >>> "road" in response.inputs
        True
        """
        return self._told(library.ld_response_inputs)

    @property
    def columns(self) -> Columns:
        """What may answer: the columns of the history.

        >>> response.columns["tip.y"].unit
        'm'
        """
        return self._told(library.ld_response_columns)

    def _at(self, speed: Optional[float]) -> float:
        return self.speed if speed is None else speed

    def _choose(self, names: Sequence[str]) -> None:
        if not names:
            raise ValueError("no columns given; `columns` lists them")
        error = ld_error()
        tell_renamed(*names)
        check_name(library.ld_response_choose(self._pointer, texts(names), len(names),
                                              ctypes.byref(error)), error)

    def _check_input(self, name: str, status: int, error: ld_error) -> None:
        if status and name not in self.inputs:
            raise UnknownName(text_of(error.text))
        check(status, error, self._model.pointer)

    def __repr__(self) -> str:
        if not self._handle:
            return "<closed Response>"
        return f"<launchdyn.Response: inputs {len(self.inputs)}, columns {len(self.columns)}>"

    def gain(self, input: str, *names: str, frequency: Numbers,
             speed: Optional[float] = None) -> dict[str, ComplexArray]:
        """Frequency response [unit of the column per unit of the input] from an input to columns
        at frequencies [Hz] > 0; of a vehicle at `speed` [m/s], None: the scenario's.

        `names`: columns.

        >>> response.gain("road", "tip.y", frequency=[1, 2, 5])["tip.y"].shape
        (3,)
        """
        f, error = _numbers(frequency), ld_error()
        gain = np.empty((len(f), len(names)), np.complex128)
        with self._lock:
            self._choose(names)
            status = library.ld_response_gain(self._pointer, self._at(speed), coded(input),
                                              f.ctypes.data, len(f), gain.ctypes.data,
                                              ctypes.byref(error))
        self._check_input(input, status, error)
        return {name: gain[:, i].copy() for i, name in enumerate(names)}

    def on_road(self, *names: str, speed: Optional[float] = None) -> dict[str, Strength]:
        """Root mean squares of columns, in their units, on the scenario's road, over all the phases
        that its sines may have; of a vehicle at `speed` [m/s], None: the scenario's.

        `names`: columns.

        >>> response.on_road("tip.y")["tip.y"].rms > 0
        True
        """
        error = ld_error()
        rms, strongest = np.empty(len(names)), np.empty(len(names))
        with self._lock:
            self._choose(names)
            status = library.ld_response_on_road(self._pointer, self._at(speed), rms.ctypes.data,
                                                 strongest.ctypes.data, ctypes.byref(error))
        check(status, error, self._model.pointer)
        return _strengths(names, rms, strongest)

    def density(self, *names: str, frequency: Numbers,
                speed: Optional[float] = None) -> dict[str, Array]:
        """One-sided power spectral densities [squares of the units per Hz] of columns on the
        random part of the scenario's road at frequencies [Hz].

        `names`: columns; `speed` [m/s] of a vehicle, None: the scenario's.

        >>> response.density("tip.y", frequency=np.linspace(0.5, 20, 5))["tip.y"].shape
        (5,)
        """
        f, error = _numbers(frequency), ld_error()
        density = np.empty((len(f), len(names)))
        with self._lock:
            self._choose(names)
            status = library.ld_response_density(self._pointer, self._at(speed), f.ctypes.data,
                                                 len(f), density.ctypes.data, ctypes.byref(error))
        check(status, error, self._model.pointer)
        return {name: density[:, i].copy() for i, name in enumerate(names)}

    def random(self, input: str, *names: str, frequency: Numbers, density: Numbers,
               speed: Optional[float] = None) -> dict[str, Strength]:
        """Root mean squares of columns where an input is random and steady: `density` is its
        one-sided power spectral density [square of its unit per Hz] at rising frequencies [Hz],
        straight between them, nothing beyond.

        `names`: columns; `speed` [m/s] of a vehicle, None: the scenario's.

        >>> white = {"frequency": [0.5, 20], "density": [1e-8, 1e-8]}
        >>> response.random("elevation.command", "tip.y", **white)["tip.y"].rms > 0
        True
        """
        f, given, error = _numbers(frequency), _numbers(density), ld_error()
        if len(f) != len(given):
            raise ValueError(f"{len(f)} frequencies require as many densities; found {len(given)}")
        rms, strongest = np.empty(len(names)), np.empty(len(names))
        with self._lock:
            self._choose(names)
            status = library.ld_response_random(
                self._pointer, self._at(speed), coded(input), f.ctypes.data, given.ctypes.data,
                len(f), rms.ctypes.data, strongest.ctypes.data, ctypes.byref(error))
        self._check_input(input, status, error)
        return _strengths(names, rms, strongest)

    def exit(self, *names: str, draws: int = 0,
             speed: Optional[float] = None) -> dict[str, Scatter]:
        """By what the scenario's road scatters numbers of a launch that a study keeps, such as
        "pitch_rate": from `draws` launches with sampled phases of the road; 0: to the first order,
        some seconds. Ctrl-C stops it at its next launch.

        `names`: results of a study; `speed` [m/s] of a vehicle, None: the scenario's.

        >>> response.exit("pitch_rate", draws=2)["pitch_rate"].deviation > 0
        True
        """
        if not names:
            raise ValueError("no results of the launch given")
        error = ld_error()
        mean, deviation = np.empty(len(names)), np.empty(len(names))
        with self._lock, Interrupt() as interrupt:
            watch = ld_watch(GO_ON(interrupt.asking()))
            library.ld_response_watch(self._pointer, ctypes.byref(watch))
            status = library.ld_response_exit(
                self._pointer, self._at(speed), draws, texts(names), len(names),
                mean.ctypes.data, deviation.ctypes.data, ctypes.byref(error))
            library.ld_response_watch(self._pointer, None)
        check(status, error, self._model.pointer)
        return {name: Scatter(float(mean[i]), float(deviation[i])) for i, name in enumerate(names)}


def _strengths(names: Sequence[str], rms: Array, strongest: Array) -> dict[str, Strength]:
    return {name: Strength(float(rms[i]), float(strongest[i])) for i, name in enumerate(names)}


class Loop(Held):
    """The loop that holds a hinge of a vehicle, opened at the torque that its controller asks for:
    made by Scenario.loop(). A context manager; it need not be closed. One thread at a time: others
    wait.

    >>> vehicle.loop("elevation").hinge
    'elevation'
    """

    _over = "the loop is closed"

    def __init__(self, model: Handle, hinge: str) -> None:
        error, pointer = ld_error(), ctypes.c_void_p()
        check(library.ld_loop_create(model.pointer, coded(hinge), ctypes.byref(pointer),
                                     ctypes.byref(error)), error, model.pointer)
        self.hinge = hinge
        super().__init__(Handle(pointer.value, library.ld_loop_free, model))

    def __repr__(self) -> str:
        return f"<launchdyn.Loop of {self.hinge}>"

    def _ask(self, ask: Any, frequency: Numbers, width: int) -> ComplexArray:
        f, error = _numbers(frequency), ld_error()
        found = np.empty((len(f), width), np.complex128)
        with self._lock:
            check(ask(self._pointer, f.ctypes.data, len(f), found.ctypes.data,
                      ctypes.byref(error)), error)
        return found

    def points(self, frequency: Numbers) -> LoopPoints:
        """Open loop, tracking, sensitivity at frequencies [Hz] > 0.

        `frequency`: [Hz].

        >>> abs(vehicle.loop("elevation").points([1, 10]).open).shape
        (2,)
        """
        found = self._ask(library.ld_loop_points, frequency, 3)
        return LoopPoints(*(column.copy() for column in found.T))

    def rejection(self, frequency: Numbers) -> ComplexArray:
        """How the base disturbs the platform [-]: its angle against I per angle by which the
        chassis turns about the hinge's axis, at frequencies [Hz] > 0.

        >>> vehicle.loop("elevation").rejection(frequency=2.0).shape
        (1,)
        """
        return self._ask(library.ld_loop_rejection, frequency, 1)[:, 0]

    @property
    def margins(self) -> Margins:
        """What it bears before it swings: factors, [Hz], [rad], [s].

        >>> vehicle.loop("elevation").margins.raise_ > 1
        True
        """
        found = ld_loop_margins()
        with self._lock:
            library.ld_loop_margins_of(self._pointer, ctypes.byref(found))
        return Margins(*(getattr(found, name) for name, _ in found._fields_))
