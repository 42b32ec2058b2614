"""Scenarios: read, set, examined, run."""

from __future__ import annotations

import ctypes
import json
import math
from collections.abc import Mapping, Sequence
from types import TracebackType
from typing import Any, Callable, Optional, Type, Union

import numpy as np

from ._library import (ld_error, ld_fmu_options, ld_messages, ld_response_wish, ld_stretch,
                       ld_wind_section, library)
from ._memory import Array, Handle, PathLike, coded, coded_path, printed, text_of, texts
from ._progress import Progress
from ._values import Key, Sets, key_of, scenario_text, set_texts
from .errors import (InputError, Message, UnknownName, check, check_messages, check_name,
                     take_messages)
from .response import Loop, Response
from .result import Result
from .simulation import BaseFrame, Run, Simulation
from .views import View

Value = Union[float, str, Array]


def read_model(read: Callable[..., int], *arguments: Any,
               free: Callable[[int], Any] = library.ld_model_free) -> Handle:
    """The model, or the study, that one of the library's reading functions makes."""
    pointer, messages = ctypes.c_void_p(), ld_messages()
    check_messages(read(*arguments, ctypes.byref(pointer), ctypes.byref(messages)), messages)
    return Handle(pointer.value, free)


class Scenario:
    """What a scenario says (docs/scenario.md), checked and whole.

    `scenario["rocket.mass"]` is a value in SI (numbers, vectors and tables as floats and arrays,
    words as texts), `scenario["rocket.mass"] = "61 kg"` sets it; a bare number is in SI. Setting
    changes nothing of what was made of it before. A context manager; it need not be closed.

    >>> scenario["rocket.mass"], scenario["base.kind"]
    (60.0, 'fixed')
    """

    def __init__(self, model: Handle) -> None:
        """Of a model's handle: use read(), from_text(), from_dict() or defaults()."""
        if not isinstance(model, Handle):
            raise TypeError("create a scenario by Scenario.read(path), from_text() or from_dict()")
        self._model: Optional[Handle] = model
        self._simulation: Optional[Simulation] = None
        self._drawn = False  # a sample, whose texts say what it was drawn from

    # ---- made

    @classmethod
    def read(cls, path: PathLike, sets: Sets = None) -> Scenario:
        """Reads a file; `sets` override it: {"rocket.mass": "61 kg"}.

        `path`: of the file. None in `sets` takes a key or block away.

        >>> ld.Scenario.read(examples / "fixed.yaml", {"rocket.mass": "61 kg"})["rocket.mass"]
        61.0
        """
        items = texts(set_texts(sets))
        return cls(read_model(library.ld_scenario_read, coded_path(path), items, len(items)))

    @classmethod
    def from_text(cls, text: str, sets: Sets = None, name: str = "text",
                  folder: PathLike = ".") -> Scenario:
        """Reads a text; `name` stands for the file in messages, `folder` is where files that it
        names are searched.

        `sets`: values by path that override it; None takes a key or block away.

        >>> ld.Scenario.from_text("include: fixed.yaml", name="mine", folder=examples)["base.kind"]
        'fixed'
        """
        items, given = texts(set_texts(sets)), coded(text)
        return cls(read_model(library.ld_scenario_read_text, given, len(given), coded(name),
                              coded_path(folder), items, len(items)))

    @classmethod
    def from_dict(cls, values: Mapping[str, Any], sets: Sets = None, name: str = "dict",
                  folder: PathLike = ".") -> Scenario:
        """Of nested mappings as the file's blocks: {"rocket": {"mass": "61 kg", ...}, ...};
        "launchdyn": 1 may be left out.

        `sets`: values by path that override it; None takes a key or block away. `name`
        stands for the file in messages.

        >>> values = {"include": "fixed.yaml", "rocket": {"mass": 61}}
        >>> ld.Scenario.from_dict(values, folder=examples)["rocket.mass"]
        61.0
        """
        return cls.from_text(dict_text(values), sets, name, folder)

    @classmethod
    def defaults(cls, sets: Sets) -> Scenario:
        """Of values alone, by their paths; all else has the language's defaults.

        `sets`: the values by their paths.

        >>> try:
        ...     ld.Scenario.defaults({"rocket.mass": 61})
        ... except ld.InputError as wrong:
        ...     len(wrong.messages) > 1
        True
        """
        items = texts(set_texts(sets))
        return cls(read_model(library.ld_model_new, items, len(items)))

    @property
    def handle(self) -> Handle:
        """The library's object.

        >>> scenario.handle is not None
        True
        """
        if self._model is None:
            raise ValueError("the scenario is closed")
        return self._model

    def close(self) -> None:
        """Gives the model up; results that need it keep it.

        >>> scenario.derive().close()
        """
        self._model = self._simulation = None

    def __enter__(self) -> Scenario:
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self.close()

    # ---- values

    def __getitem__(self, path: str) -> Value:
        """A value in SI; NaN or "" where it is not given. Raises UnknownName."""
        key = key_of(path)
        if key and key.components and key.path.rpartition(".")[2] == path.rpartition(".")[2]:
            return np.array([self._number(f"{path}.{name}") for name in key.components])
        table = self._table(path) if key and "rows [" in key.expected else None
        if table is not None:
            return table
        error, value = ld_error(), ctypes.c_double()
        if not library.ld_model_number(self.handle.pointer, coded(path), ctypes.byref(value),
                                       ctypes.byref(error)):
            return value.value
        try:
            text = self.text(path)
        except InputError:
            raise UnknownName(text_of(error.text)) from None
        return str(json.loads(text)) if text.startswith('"') else text

    def __setitem__(self, path: str, value: Any) -> None:
        """Sets a key: a text as in the file, a number in SI, or (61, "kg")."""
        self.set({path: value})

    def set(self, sets: Sets) -> None:
        """Sets several keys at once, for those that fit only together. Raises InputError with all
        that is wrong; then the scenario is as before.

        `sets`: values by path; None takes a key or block away.

        >>> copy = scenario.derive()
        >>> copy.set({"rocket.mass": 61, "rocket.center": (1.1, 0, 0)})
        >>> copy["rocket.mass"]
        61.0
        """
        self._model = self._derived(sets)
        self._simulation = None

    def derive(self, sets: Sets = None) -> Scenario:
        """Another scenario with some values set; this one stays as it is.

        `sets`: values by path; None takes a key or block away.

        >>> scenario.derive({"rocket.mass": (61500, "g")})["rocket.mass"], scenario["rocket.mass"]
        (61.5, 60.0)
        """
        return Scenario(self._derived(sets))

    def _derived(self, sets: Sets) -> Handle:
        if self._drawn:
            raise ValueError("a sample cannot be changed; Scenario.from_text(sample.to_yaml()) can")
        items = texts(set_texts(sets))
        return read_model(library.ld_model_derive, self.handle.pointer, items, len(items))

    def _number(self, path: str) -> float:
        error, value = ld_error(), ctypes.c_double()
        check_name(library.ld_model_number(self.handle.pointer, coded(path),
                                           ctypes.byref(value), ctypes.byref(error)), error)
        return value.value

    def _table(self, path: str) -> Optional[Array]:
        error = ld_error()
        table = ctypes.POINTER(ctypes.c_double)()
        rows, columns = ctypes.c_size_t(), ctypes.c_size_t()
        if library.ld_model_table(self.handle.pointer, coded(path), ctypes.byref(table),
                                  ctypes.byref(rows), ctypes.byref(columns), ctypes.byref(error)):
            return None
        shape = rows.value, columns.value
        return np.ctypeslib.as_array(table, shape).copy() if table else np.empty((0, 0))

    def text(self, path: str) -> str:
        """A value as a text that can be set again: "61 kg"; "" where it is not given.

        `path`: of the key, "rocket.mass".

        >>> scenario.text("rocket.mass")
        '60 kg'
        """
        error, text = ld_error(), ctypes.create_string_buffer(4096)
        check_name(library.ld_model_text(self.handle.pointer, coded(path), text, len(text),
                                         ctypes.byref(error)), error)
        return text_of(text.value)

    def key(self, path: str) -> Optional[Key]:
        """Unit, range and description of a key.

        `path`: of the key, "rocket.mass"; None: there is none.

        >>> scenario.key("rocket.mass").description
        'at ignition'
        """
        return key_of(path)

    # ---- as a whole

    @property
    def title(self) -> str:
        """What the scenario calls itself.

        >>> scenario.title
        'Reference launcher on a fixed base'
        """
        return str(self["title"])

    @property
    def has_launcher(self) -> bool:
        """Whether it is more than a flight alone.

        >>> scenario.has_launcher
        True
        """
        return bool(library.ld_model_has_launcher(self.handle.pointer))

    @property
    def has_vehicle(self) -> bool:
        """Whether its base is a vehicle.

        >>> scenario.has_vehicle, vehicle.has_vehicle
        (False, True)
        """
        return bool(library.ld_model_has_vehicle(self.handle.pointer))

    def to_yaml(self) -> str:
        """Every key with its value in SI, as a scenario that can be read again.

        >>> ld.Scenario.from_text(scenario.to_yaml())["rocket.mass"]
        60.0
        """
        return printed(lambda to: library.ld_model_print(self.handle.pointer, to))

    def describe(self) -> str:
        """What carries, guides, holds and drives the rocket, in words.

        >>> print(scenario.describe().splitlines()[0])
        # base: fixed; launcher 19.8 deg up
        """
        return printed(lambda to: library.ld_model_describe(self.handle.pointer, to))

    def notes(self) -> list[Message]:
        """What is allowed but implausible.

        >>> scenario.notes()
        []
        """
        messages = ld_messages()
        source = library.ld_model_source(self.handle.pointer)
        check_messages(library.ld_scenario_notes(source, 0, 0, ctypes.byref(messages)), messages)
        return take_messages(messages)

    @property
    def points(self) -> int:
        """Number of points of its sweep; 1 without.

        >>> scenario.points
        1
        """
        return int(library.ld_scenario_points(self.handle.pointer))

    def point(self, number: int) -> Scenario:
        """The scenario at a point of its sweep, from 1.

        `number`: of the point.

        >>> swept.point(2)["rocket.mass"]
        61.0
        """
        source = library.ld_model_source(self.handle.pointer)
        return Scenario(read_model(library.ld_scenario_read_source, source, number))

    def point_name(self, number: int) -> str:
        """Keys and values of a point of its sweep, from 1.

        `number`: of the point.

        >>> swept.point_name(2)
        'rocket.mass 61 kg'
        """
        text = ctypes.create_string_buffer(1024)
        library.ld_scenario_point_name(self.handle.pointer, number, text, len(text))
        return text_of(text.value)

    def __repr__(self) -> str:
        return f"<launchdyn.Scenario {self.title!r}>" if self._model else "<closed Scenario>"

    def _repr_html_(self) -> str:
        from html import escape
        words = self.describe().replace("# ", "")
        return f"<b>{escape(self.title)}</b><pre>{escape(words)}</pre>"

    # ---- run

    def simulation(self) -> Simulation:
        """What is computed from it once: modes, coefficients, tables. Runs may share it.

        >>> scenario.simulation() is scenario.simulation()
        True
        """
        if self._simulation is None:
            self._simulation = Simulation(self.handle)
        return self._simulation

    def run(self, out: Optional[PathLike] = None, csv: bool = False,
            progress: Progress = None, base: Optional[BaseFrame] = None) -> Result:
        """Runs from start to end; see Simulation.run().

        `out`: folder for results, with `csv` as CSV too; `progress` gets the share done;
        `base`: where an external base is at the start.

        >>> round(scenario.run().summary["rocket.1.exit_speed"], 1)
        37.8
        """
        return self.simulation().run(out, csv, progress, base)

    def begin(self, base: Optional[BaseFrame] = None, out: Optional[PathLike] = None,
              csv: bool = False) -> Run:
        """Begins a run that is stepped; see Simulation.begin().

        `base`: where an external base is; `out`: folder for results, with `csv` as CSV too.

        >>> with scenario.begin() as run:
        ...     run.time
        0.0
        """
        return self.simulation().begin(base, out, csv)

    # ---- examined without runs

    def response(self, slowest: float = math.nan, fastest: float = math.nan,
                 friction: bool = False) -> Response:
        """Its linear response (docs/response.md), of a vehicle at any speed from `slowest` to
        `fastest` [m/s], NaN: its own; `friction`: of the hinges, linearised for the motion on the
        road.

        >>> vehicle.response(slowest=5, fastest=10).speed
        8.333333333333334
        """
        return Response(self.handle, slowest, fastest, friction)

    def loop(self, hinge: str) -> Loop:
        """The loop that holds a hinge of its vehicle, "azimuth" or "elevation", opened.

        >>> vehicle.loop("azimuth").hinge
        'azimuth'
        """
        return Loop(self.handle, hinge)

    def response_view(self, *what: str, input: Optional[str] = None, start: float = math.nan,
                      end: float = math.nan, speeds: Optional[Sequence[float]] = None,
                      loop: Optional[str] = None, density: Optional[PathLike] = None,
                      exit: bool = False, friction: bool = False, draws: int = 0) -> View:
        """Its linear response as `launchdyn response` shows it: of columns `what` on the road, or
        to an `input`, from `start` to `end` [Hz], over `speeds` (slowest, fastest, step) [m/s];
        of a hinge's `loop`; with the `density` of a random input from a CSV file; of the `exit`.

        `friction` of the hinges is linearised; `draws`: launches of the exit.

        >>> print(str(scenario.response_view("tip.y", input="base.y")).splitlines()[2])
        Greatest amplitude                                            at [Hz]  phase [deg]
        """
        slowest, fastest, step = speeds or (math.nan,) * 3
        return View("response", self.handle, ld_response_wish(
            texts(what), len(what), _coded(input), start, end, slowest, fastest, step,
            _coded(loop), coded_path(density) if density else None, exit, friction, draws))

    def road_view(self, start: float = math.nan, end: float = math.nan,
                  step: float = math.nan) -> View:
        """Its vehicle's road as `launchdyn road` shows it, from x = `start` to `end` [m], `step`
        apart; NaN: the usual.

        >>> list(vehicle.road_view(start=0, end=20, step=0.1).tables)
        ['road-spectrum', 'road']
        """
        return View("road", self.handle, ld_stretch(start, end, step))

    def wind_view(self, height: float = 100, top: float = 2000, length: float = math.nan,
                  step: float = math.nan, rocket: int = 1) -> View:
        """Its wind as `launchdyn wind` shows it: the profile up to `top`, gusts and turbulence of
        a rocket at a `height` above ground, along a line of a `length`, `step` apart [m].

        >>> list(windy.wind_view(height=50, top=100, length=500, step=1).tables)
        ['wind-profile']
        """
        return View("wind", self.handle, ld_wind_section(height, top, length, step, rocket))

    def export_fmu(self, file: PathLike, part: str = "all", version: int = 3,
                   outputs: Optional[str] = None, parameters: Optional[str] = None,
                   arrays: bool = False) -> None:
        """Writes a Functional Mock-up Unit (docs/fmi.md) of the launch: `part` "all", "vehicle"
        or "launcher", `version` of FMI 2 or 3; `outputs` and `parameters` that it has, such as
        "tip.*,summary.*" and "rocket.*", None: all; `arrays`: vectors are one variable each (3).

        `file`: the FMU.

        >>> scenario.export_fmu(folder / "launch.fmu", outputs="tip.*", parameters="rocket.*")
        """
        error = ld_error()
        parts = ("all", "vehicle", "launcher")
        if part not in parts:
            raise ValueError(f"expected a part, one of {', '.join(parts)}; found {part!r}")
        options = ld_fmu_options(parts.index(part), version, _coded(outputs), _coded(parameters),
                                 arrays)
        check(library.ld_fmu_export(self.handle.pointer, ctypes.byref(options), coded_path(file),
                                    ctypes.byref(error)), error, self.handle.pointer)


def _coded(text: Optional[str]) -> Optional[bytes]:
    return None if text is None else coded(text)


def dict_text(values: Mapping[str, Any]) -> str:
    """A nested mapping as the text of a scenario."""
    return scenario_text({"launchdyn": 1, **values} if "include" not in values else values)
