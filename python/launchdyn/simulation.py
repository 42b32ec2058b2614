"""Simulations and their runs, in one go or stepped."""

from __future__ import annotations

import ctypes
import enum
import math
import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Callable, NamedTuple, Optional, Union

import numpy as np

from ._interrupt import Interrupt
from ._library import (SHARE_TOLD, ld_base_frame, ld_base_wrench, ld_column, ld_error, ld_event,
                       ld_mode, ld_pole, ld_run_options, library)
from ._memory import Array, Handle, Held, coded, coded_path, printed, text_of
from ._progress import Progress, followed
from .errors import InputError, Status, check, check_name, failure, tell_renamed
from .result import Column, Columns, Quantity, Result, quantities_at

PathLike = Union[str, "os.PathLike[str]"]
#: Simulated time [s] after which a run that is stepped looks whether Ctrl-C was pressed.
PIECE = 0.01
#: Statuses of runs that ended early for reasons of their own, and leave results up to there.
EARLY = (Status.LAUNCH, Status.NUMERIC)


@dataclass(frozen=True)
class BaseFrame:
    """Where the undeformed tube is on its base, and how that moves: its rear end, and axes of
    which x goes along it.

    >>> ld.BaseFrame((0, 1.5, 0), quaternion=(1, 0, 0, 0)).rate
    (0, 0, 0)
    """

    position: Sequence[float]  #: [m] of the rear end in I
    quaternion: Sequence[float] = (1, 0, 0, 0)  #: tube axes against I, scalar part first
    velocity: Sequence[float] = (0, 0, 0)  #: [m/s] of the rear end, in I
    rate: Sequence[float] = (0, 0, 0)  #: [rad/s] angular velocity, in I

    def _struct(self) -> ld_base_frame:
        return ld_base_frame(tuple(self.position), tuple(self.quaternion), tuple(self.velocity),
                             tuple(self.rate))


class Wrench(NamedTuple):
    """What the launching tube does to its base, in I.

    >>> ld.Wrench(force=np.zeros(3), moment=np.zeros(3))._fields
    ('force', 'moment')
    """

    force: Array  #: [N]
    moment: Array  #: [N m] about the undeformed tube's rear end


class EventKind(enum.IntEnum):
    """What happens in a run, in the order in which it can come.

    >>> ld.EventKind["EXIT"] > ld.EventKind.RELEASE
    True
    """

    NONE = 0
    IGNITION = 1  #: of the rocket
    RELEASE = 2  #: the lock lets the rocket go
    CORNER = 3  #: of the thrust curve, or of a commanded angle
    TOUCH = 4  #: adaptor `part` comes to the tube's wall
    BREECH = 5  #: the rocket comes to the breech
    LINE = 6  #: the line that the rocket pulls becomes taut, or breaks
    LIFT = 7  #: wheel `part` leaves the road
    LAND = 8  #: wheel `part` comes back to it
    LEAVE = 9  #: the tube leaves stop `part` of its recoil slides
    STOP = 10  #: the tube comes to it
    EXIT = 11  #: adaptor `part` leaves the guide
    TUBE = 12  #: the rocket's tube takes the place of the one before
    END = 13  #: of the launch


class Event(NamedTuple):
    """An event of a run.

    >>> with scenario.begin() as run:
    ...     event = run.advance_to_event()
    >>> event.kind.name, event.t, event.rocket
    ('IGNITION', 0.0, 1)
    """

    kind: EventKind
    t: float  #: [s] on the run's clock
    rocket: int  #: from 1, in the order of firing
    part: int  #: adaptor, wheel or stop, from 1; 0: of none


class Mode(NamedTuple):
    """A natural frequency and what moves most in it.

    >>> scenario.simulation().tube_modes()[0]._fields
    ('frequency', 'damping', 'real', 'shape')
    """

    frequency: float  #: [Hz]
    damping: float  #: [-] ratio
    real: float  #: [1/s]
    shape: str


class Pole(NamedTuple):
    """An eigenvalue of the linearised system with its dampers; one of each conjugate pair.

    >>> modes, poles = scenario.simulation().system_modes()
    >>> all(pole.real < 0 for pole in poles)
    True
    """

    real: float  #: [1/s]
    imaginary: float  #: [rad/s] >= 0
    shape: str


class _Recording:
    """Where the rows of a run go: into memory and, where requested, into a folder."""

    def __init__(self, model: Handle, out: Optional[PathLike], csv: bool) -> None:
        self._model, self._output = model, None
        error = ld_error()
        if csv and out is None:
            raise ValueError("csv requires a folder: out")
        if out is not None:
            output = ctypes.c_void_p()
            check(library.ld_output_open(coded_path(out), model.pointer, csv,
                                         ctypes.byref(output), ctypes.byref(error)), error)
            self._output = Handle(output.value, library.ld_output_discard, model)
        sink = library.ld_output_sink(self._output.pointer) if self._output else None
        parents = (self._output,) if self._output else ()
        self.history = Handle(library.ld_history_new(sink), library.ld_history_free, *parents)
        self.summary = Handle(library.ld_summary_new(), library.ld_summary_free, model)

    def options(self, base: Optional[BaseFrame], progress: Any) -> ld_run_options:
        options = ld_run_options(sink=library.ld_history_sink(self.history.pointer),
                                 progress=progress)
        if base:
            options.base = ctypes.pointer(base._struct())
        return options

    def finish(self, status: int, error: ld_error) -> Result:
        """Writes the files. Raises what the run said, with what it had until then."""
        kept = not status or status in EARLY
        if self._output and kept:
            problem = ld_error()
            check(library.ld_output_finish(self._output.let_go(), self.summary.pointer,
                                           ctypes.byref(problem)), problem)
        elif self._output:
            library.ld_output_discard(self._output.let_go())
        if not kept:
            raise failure(status, error, self._model.pointer)
        result = Result(self._model, self.summary, self.history)
        if status:
            raised = failure(status, error, self._model.pointer)
            raised.result = result
            raise raised
        return result


class Simulation:
    """What is computed once from a scenario: modes, inertia coefficients, tables. It does not
    change: several threads may run it at a time.

    >>> scenario.simulation()
    <launchdyn.Simulation: 159 columns>
    """

    def __init__(self, model: Handle) -> None:
        error, pointer = ld_error(), ctypes.c_void_p()
        check(library.ld_simulation_create(model.pointer, ctypes.byref(pointer),
                                           ctypes.byref(error)), error, model.pointer)
        self.model = model
        self.handle = Handle(pointer.value, library.ld_simulation_free, model)

    @property
    def columns(self) -> Columns:
        """Columns of the launch's history, in order.

        >>> scenario.simulation().columns["tip.y"].unit
        'm'
        """
        return _columns(library.ld_simulation_columns, self.handle)

    def describe(self) -> str:
        """The bodies of a multibody base as a tree, its loops and degrees of freedom; of other
        bases nothing.

        >>> scenario.simulation().describe()
        ''
        """
        return printed(lambda to: library.ld_simulation_describe(self.handle.pointer, to))

    def run(self, out: Optional[PathLike] = None, csv: bool = False,
            progress: Progress = None, base: Optional[BaseFrame] = None) -> Result:
        """Runs from the start to the end that the scenario asks for.

        `out` is a folder for results (docs/results.md), with `csv` as CSV too; `progress` gets
        the share done, 0 to 1, of the launch and then of each flight, True: a bar in a terminal or
        a notebook; `base` is where the base is at the start (base.kind: external).
        Raises LaunchError, NumericError with what it had until then as `result`; InputError.
        Ctrl-C raises KeyboardInterrupt; results in the folder are those up to there.

        >>> scenario.simulation().run(out=folder / "run", csv=True).rockets
        1
        """
        recording, error = _Recording(self.model, out, csv), ld_error()
        with Interrupt() as interrupt, followed(progress) as share_told:
            options = recording.options(base, SHARE_TOLD(interrupt.asking(share_told)))
            status = library.ld_simulation_run(self.handle.pointer, ctypes.byref(options),
                                               recording.summary.pointer, ctypes.byref(error))
            if interrupt.asked and status in (Status.OK, Status.INTERRUPTED):
                recording.finish(Status.OK, error)
        return recording.finish(status, error)

    def begin(self, base: Optional[BaseFrame] = None, out: Optional[PathLike] = None,
              csv: bool = False) -> Run:
        """Begins a run that is stepped.

        `base`: where an external base is; `out`: folder for results, with `csv` as CSV too.

        >>> with scenario.simulation().begin() as run:
        ...     run.finished
        False
        """
        return Run(self, base, out, csv)

    def load(self, saved: bytes) -> Run:
        """Continues where a run that was saved stood (Run.save()), with the same bits.

        >>> with scenario.begin() as run:
        ...     saved = run.save()
        >>> with scenario.simulation().load(saved) as again:
        ...     again.finished
        False
        """
        if not isinstance(saved, bytes):
            raise TypeError(f"expected the bytes of Run.save(), found {type(saved).__name__}")
        return Run(self, saved=saved)

    def begin_vehicle(self) -> VehicleRun:
        """Begins a run of the scenario's vehicle alone, stepped under a given wrench.

        >>> vehicle.simulation().begin_vehicle().time
        -3.0
        """
        return VehicleRun(self)

    def tube_modes(self, most: int = 64) -> list[Mode]:
        """Natural frequencies [Hz] of tube and tail on their supports, base fixed, ascending.

        >>> [round(mode.frequency) for mode in scenario.simulation().tube_modes(most=2)]
        [67, 67]
        """
        modes = (ld_mode * most)()
        count = library.ld_simulation_tube_modes(self.handle.pointer, modes, most)
        return [Mode(m.frequency, m.damping, m.real, text_of(m.shape)) for m in modes[:count]]

    def system_modes(self, most: int = 256) -> tuple[list[Mode], list[Pole]]:
        """Modes [Hz] and eigenvalues [1/s] of the whole about its static equilibrium.

        `most`: how many of each.

        >>> modes, poles = scenario.simulation().system_modes()
        >>> len(poles) > 0
        True
        """
        error, modes, poles = ld_error(), (ld_mode * most)(), (ld_pole * most)()
        count, pole_count = ctypes.c_int(), ctypes.c_int()
        check(library.ld_simulation_system_modes(
            self.handle.pointer, modes, most, ctypes.byref(count), poles, most,
            ctypes.byref(pole_count), ctypes.byref(error)), error, self.model.pointer)
        return ([Mode(m.frequency, m.damping, m.real, text_of(m.shape))
                 for m in modes[:count.value]],
                [Pole(p.real, p.imaginary, text_of(p.shape)) for p in poles[:pole_count.value]])

    def __repr__(self) -> str:
        return f"<launchdyn.Simulation: {len(self.columns)} columns>"


def _columns(tell: Any, simulation: Handle) -> Columns:
    columns = ctypes.POINTER(ld_column)()
    count = tell(simulation.pointer, ctypes.byref(columns))
    return Columns((text_of(c.name),
                    Column(text_of(c.name), text_of(c.unit), text_of(c.description)))
                   for c in columns[:count])


def _is_told(model: Handle) -> bool:
    """Whether its base is externally driven."""
    error, kind = ld_error(), ctypes.create_string_buffer(64)
    unknown = library.ld_model_text(model.pointer, b"base.kind", kind, len(kind),
                                    ctypes.byref(error))  # a flight alone has none
    return not unknown and kind.value == b"external"


def _give_up(pointer: int) -> None:
    library.ld_run_end(pointer, None, None)


class _Asked:
    """What the library asks while it runs: whether to continue."""

    def __init__(self) -> None:
        self.go_on: Callable[[Any, float], bool] = lambda _, share: True

    def function(self) -> Any:
        return SHARE_TOLD(lambda self_, share: self.go_on(self_, share))


class Run(Held):
    """A run that is stepped: taken forward to a time or to the next event, read, given its
    ignition or its base, saved, ended. `run["tip.y"]` is a column at the present time.
    A context manager that gives up what was not ended. One thread at a time: others wait.

    >>> with scenario.begin() as run:
    ...     run.advance(0.05)
    ...     travel = run["rocket.s"]
    >>> travel > 0
    True
    """

    _over = "the run has ended"

    def __init__(self, simulation: Simulation, base: Optional[BaseFrame] = None,
                 out: Optional[PathLike] = None, csv: bool = False,
                 saved: Optional[bytes] = None) -> None:
        """Begins it at the start of its lead-in, or where the one that was saved stood."""
        error, pointer = ld_error(), ctypes.c_void_p()
        self.simulation = simulation
        self._told_end, self._is_told = False, _is_told(simulation.model)
        self._recording = _Recording(simulation.model, out, csv)
        self._asked, self._event = _Asked(), ld_event()
        # what it points to outlives the run
        self._options = self._recording.options(base, self._asked.function())
        told = ctypes.byref(self._options)
        if saved is None:
            status = library.ld_run_begin(simulation.handle.pointer, told, ctypes.byref(pointer),
                                          ctypes.byref(error))
        else:
            status = library.ld_run_load(simulation.handle.pointer, told, saved, len(saved),
                                         ctypes.byref(pointer), ctypes.byref(error))
        if status and pointer.value:
            _give_up(pointer.value)
        self._check(status, error)
        super().__init__(Handle(pointer.value, _give_up, simulation.handle,
                                self._recording.history))

    def _check(self, status: int, error: ld_error) -> None:
        check(status, error, self.simulation.model.pointer)

    # ---- forward

    def _next(self, t: float) -> float:
        """Up to where the library goes in one call: Ctrl-C is heard in between, and steps change
        nothing, but where an externally driven base ends them."""
        piece = math.inf if self._is_told else float(library.ld_run_time(self._pointer)) + PIECE
        return min(t, piece)

    def advance(self, t: float = math.inf) -> None:
        """Continues to time t [s], or to the end of the launch where that comes before. Ctrl-C
        stops it in between, and it can continue from there.

        >>> with scenario.begin() as run:
        ...     run.advance(t=0.02)
        ...     print(run.time)
        0.02
        """
        error, to, status = ld_error(), -math.inf, int(Status.OK)
        with self._lock:
            self._event = ld_event()
            while to != t and not status:
                to = self._next(t)
                status = library.ld_run_advance(self._pointer, to, ctypes.byref(error))
                if library.ld_run_is_finished(self._pointer):
                    break
        self._check(status, error)

    def advance_to_event(self, t: float = math.inf) -> Optional[Event]:
        """Continues to the next event, but not beyond time t [s]; None: there was none up to t, or
        the end has been reported. Ctrl-C as in advance(): the next call reports the event.

        >>> with scenario.begin() as run:
        ...     print(run.advance_to_event(t=0.1).kind.name)
        IGNITION
        """
        error, to, status = ld_error(), -math.inf, int(Status.OK)
        with self._lock:
            if self._told_end:
                return None
            while not self._event.kind and to != t and not status:
                to = self._next(t)
                status = library.ld_run_advance_to_event(
                    self._pointer, to, ctypes.byref(self._event), ctypes.byref(error))
            self._check(status, error)
            event = Event(EventKind(self._event.kind), self._event.t, self._event.rocket,
                          self._event.part)
            self._told_end, self._event = event.kind is EventKind.END, ld_event()
        return event if event.kind else None

    def events(self, t: float = math.inf) -> Iterator[Event]:
        """Continues from event to event up to time t [s], or to the end of the launch: within the
        loop the run stands at the event.

        >>> with scenario.begin() as run:
        ...     [event.kind.name for event in run.events(t=0.1)][:2]
        ['IGNITION', 'RELEASE']
        """
        while event := self.advance_to_event(t):
            yield event

    @property
    def time(self) -> float:
        """Present time [s] on the run's clock.

        >>> with scenario.begin() as run:
        ...     run.time
        0.0
        """
        with self._lock:
            return float(library.ld_run_time(self._pointer))

    @property
    def finished(self) -> bool:
        """Whether the launch is over: what is left are the flights, by end().

        >>> with scenario.begin() as run:
        ...     run.finished
        False
        """
        with self._lock:
            return bool(library.ld_run_is_finished(self._pointer))

    # ---- read

    def __getitem__(self, name: str) -> float:
        """A column at the present time, in SI."""
        error, value = ld_error(), ctypes.c_double()
        with self._lock:
            status = library.ld_run_number(self._pointer, coded(name), ctypes.byref(value),
                                           ctypes.byref(error))
        if status == Status.INPUT:
            check_name(status, error)
        self._check(status, error)
        tell_renamed(name)
        return value.value

    def row(self) -> Array:
        """All columns at the present time, in SI, in the order of Simulation.columns.

        >>> with scenario.begin() as run:
        ...     len(run.row()) == len(run.simulation.columns)
        True
        """
        error, values = ld_error(), np.empty(len(self.simulation.columns))
        with self._lock:
            status = library.ld_run_row(
                self._pointer, values.ctypes.data_as(ctypes.POINTER(ctypes.c_double)),
                ctypes.byref(error))
        self._check(status, error)
        return values

    def quantities(self) -> dict[str, Quantity]:
        """Numbers of the summary so far, in SI, by their names; energies, warnings, flights are
        there at the end alone.

        >>> with scenario.begin() as run:
        ...     "rocket.1.exit_speed" in run.quantities()
        True
        """
        with self._lock:
            found = quantities_at(library.ld_run_summary(self._pointer))
        return {quantity.name: quantity for quantity in found}

    def wrench(self) -> Wrench:
        """Force [N] and moment [N m] of the tube on its base at the present time, in I.

        >>> with external.begin(ld.BaseFrame((0, 0, 0))) as run:
        ...     run.wrench().force.shape
        (3,)
        """
        error, wrench = ld_error(), ld_base_wrench()
        with self._lock:
            status = library.ld_run_base_wrench(self._pointer, ctypes.byref(wrench),
                                                ctypes.byref(error))
        self._check(status, error)
        return Wrench(np.array(wrench.force), np.array(wrench.moment))

    # ---- inputs

    def ignite(self, t: float) -> None:
        """Ignites the rocket that stands in the tube at time t [s]; inf: not until set again.

        >>> with scenario.derive({"run.lead_in": "0.05 s"}).begin() as run:
        ...     run.ignite(t=0.02)
        """
        error = ld_error()
        with self._lock:
            status = library.ld_run_ignite(self._pointer, t, ctypes.byref(error))
        self._check(status, error)

    def set_base(self, base: BaseFrame) -> None:
        """Sets where the base is at the present time and how it moves (base.kind: external).

        >>> with external.begin(ld.BaseFrame((0, 0, 0))) as run:
        ...     run.advance(1e-3)
        ...     run.set_base(ld.BaseFrame((0, 1e-6, 0), velocity=(0, 1e-3, 0)))
        """
        error, frame = ld_error(), base._struct()
        with self._lock:
            status = library.ld_run_set_base(self._pointer, ctypes.byref(frame),
                                              ctypes.byref(error))
        self._check(status, error)

    # ---- saved, ended

    def save(self) -> bytes:
        """All that the rest depends on, for Simulation.load() here or in another process.

        >>> with scenario.begin() as run:
        ...     run.advance(0.05)
        ...     saved = run.save()
        >>> with scenario.simulation().load(saved) as again:
        ...     print(again.time)
        0.05
        """
        error, size = ld_error(), ctypes.c_size_t()
        room = 0  # it says how much it requires
        with self._lock:
            while True:
                saved = ctypes.create_string_buffer(room)
                status = library.ld_run_save(self._pointer, saved, room, ctypes.byref(size),
                                             ctypes.byref(error))
                if not status or size.value <= room:
                    break
                room = size.value
        self._check(status, error)
        return saved.raw[:size.value]

    def end(self, progress: Progress = None) -> Result:
        """Ends it: flies the rockets that left their tubes where the scenario requires it. A launch
        that is not over ends where it is, and Result.stopped says so. `progress` gets the share
        of each flight, and Ctrl-C stops it, as in Simulation.run().

        >>> with scenario.begin() as run:
        ...     run.advance()
        ...     run.end().rockets
        1
        """
        error = ld_error()
        with self._lock, Interrupt() as interrupt, followed(progress) as share_told:
            pointer = self._pointer
            over = library.ld_run_is_finished(pointer)
            self._asked.go_on = interrupt.asking(share_told)
            handle, self._handle = self._handle, None
            if handle:
                handle.let_go()
            status = library.ld_run_end(pointer, self._recording.summary.pointer,
                                        ctypes.byref(error))
            if status == Status.INTERRUPTED and (interrupt.asked or not over):
                status = Status.OK
            if interrupt.asked and not status:
                self._recording.finish(status, error)
        return self._recording.finish(status, error)

    def __repr__(self) -> str:
        return f"<launchdyn.Run at {self.time:g} s>" if self._handle else "<ended Run>"


class VehicleRun(Held):
    """A run of a scenario's vehicle alone, stepped under a given wrench. A context
    manager; it need not be closed. One thread at a time: others wait.

    >>> with vehicle.simulation().begin_vehicle() as run:
    ...     run.advance(run.time + 1e-3)
    """

    _over = "the run has ended"

    def __init__(self, simulation: Simulation) -> None:
        error, pointer = ld_error(), ctypes.c_void_p()
        check(library.ld_vehicle_run_begin(simulation.handle.pointer, ctypes.byref(pointer),
                                           ctypes.byref(error)), error, simulation.model.pointer)
        self.simulation = simulation
        super().__init__(Handle(pointer.value, library.ld_vehicle_run_end, simulation.handle))

    def _call(self, function: Any, *arguments: Any) -> None:
        error = ld_error()
        with self._lock:
            status = function(self._pointer, *arguments, ctypes.byref(error))
        check(status, error, self.simulation.model.pointer)

    def advance(self, t: float) -> None:
        """Continues to time t [s]; it has no end of its own.

        >>> with vehicle.simulation().begin_vehicle() as run:
        ...     run.advance(t=run.time + 0.01)
        """
        self._call(library.ld_vehicle_run_advance, t)

    @property
    def time(self) -> float:
        """Present time [s] on the clock of the launch.

        >>> vehicle.simulation().begin_vehicle().time
        -3.0
        """
        with self._lock:
            return float(library.ld_vehicle_run_time(self._pointer))

    def frame(self) -> BaseFrame:
        """Where the vehicle holds the undeformed tube, in SI, for Run.set_base().

        >>> len(vehicle.simulation().begin_vehicle().frame().quaternion)
        4
        """
        frame = ld_base_frame()
        self._call(library.ld_vehicle_run_frame, ctypes.byref(frame))
        return BaseFrame(tuple(frame.position), tuple(frame.quaternion), tuple(frame.velocity),
                         tuple(frame.rate))

    def set_wrench(self, wrench: Wrench) -> None:
        """Sets force [N] and moment [N m] of the tube on the vehicle at the present time.

        `wrench`: about the undeformed tube's rear end, in I.

        >>> with vehicle.simulation().begin_vehicle() as run:
        ...     run.set_wrench(ld.Wrench(np.array([-100.0, 0, 0]), np.zeros(3)))
        """
        told = ld_base_wrench(tuple(wrench.force), tuple(wrench.moment))
        self._call(library.ld_vehicle_run_set_wrench, ctypes.byref(told))

    @property
    def columns(self) -> Columns:
        """Columns of a vehicle alone.

        >>> vehicle.simulation().begin_vehicle().columns["chassis.y"].unit
        'm'
        """
        return _columns(library.ld_vehicle_run_columns, self.simulation.handle)

    def row(self) -> Array:
        """All columns at the present time, in SI, in the order of `columns`.

        >>> vehicle.simulation().begin_vehicle().row().ndim
        1
        """
        values = np.empty(len(self.columns))
        self._call(library.ld_vehicle_run_row,
                   values.ctypes.data_as(ctypes.POINTER(ctypes.c_double)))
        return values
