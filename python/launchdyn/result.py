"""What came of a run: columns over time, numbers by name."""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any, Optional

from ._library import QUANTITY_TAKER, ld_error, library
from ._memory import Array, Handle, array_at, coded, printed, text_of, texts
from .errors import MissingError, UnknownName, check_name, tell_renamed

if TYPE_CHECKING:
    import pandas
    import xarray


@dataclass(frozen=True)
class Column:
    """A column of a history.

    >>> result.history.columns["tip.y"].unit
    'm'
    """

    name: str  #: e.g. "tip.y"
    unit: str  #: SI, e.g. "m"
    description: str  #: one line, with frame


class Columns(dict[str, Column]):
    """Columns by their names, shown in groups: "tip.{y, z, pitch}"."""

    def __repr__(self) -> str:
        groups: dict[str, list[str]] = {}
        for name in self:
            group, dot, last = name.rpartition(".")
            groups.setdefault(group + dot, []).append(last)
        shown = (group + (names[0] if len(names) == 1 else f"{{{', '.join(names)}}}")
                 for group, names in groups.items() if group)
        return f"<{len(self)} names: {'; '.join((', '.join(groups.get('', [])), *shown))}>"


@dataclass(frozen=True)
class Quantity:
    """A number of a summary.

    >>> result.summary.quantities["rocket.1.exit_speed"].unit
    'm/s'
    """

    name: str  #: e.g. "rocket.1.exit_speed"
    unit: str  #: SI; "" or "1": none
    description: str  #: one line, with frame
    value: float  #: NaN where there is none


def pandas_here() -> Any:
    """The module pandas."""
    try:
        import pandas
    except ImportError:
        raise MissingError("data frames require pandas (Debian: python3-pandas)") from None
    return pandas


def data_set(variables: Mapping[str, Any], coordinates: Mapping[str, Any]) -> xarray.Dataset:
    """A data set of xarray."""
    try:
        import xarray
    except ImportError:
        raise MissingError("data sets require xarray (Debian: python3-xarray)") from None
    return xarray.Dataset(variables, coordinates)


def nearest(name: str, names: list[str]) -> Optional[str]:
    """The one of some names that is nearest to `name`; None if none is near."""
    return text_of(library.ld_nearest_name(coded(name), texts(names), len(names))) or None


def _table(caption: str, head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table for a notebook, folded."""
    def line(kind: str, cells: Sequence[str]) -> str:
        return f"<tr>{''.join(f'<{kind}>{escape(cell)}</{kind}>' for cell in cells)}</tr>"
    body = "".join(line("td", row) for row in rows)
    return (f"<details><summary>{escape(caption)}</summary><table><thead>{line('th', head)}"
            f"</thead><tbody>{body}</tbody></table></details>")


class History(Mapping[str, Array]):
    """Columns of a launch or of a flight over time, by their names (docs/quantities.md), in SI;
    NaN where a row has no value. The arrays are the library's memory, read-only and not copied.

    >>> result.history["t"].shape == result["tip.y"].shape
    True
    """

    def __init__(self, handle: Handle, pointer: int) -> None:
        self._handle, self._pointer = handle, pointer

    @functools.cached_property
    def columns(self) -> Columns:
        """Name, unit and description of each column, in order.

        >>> result.history.columns["rocket.s"].description
        "travel: rear adaptor's station in the tube"
        """
        count = ctypes.c_size_t()
        columns = library.ld_history_columns(self._pointer, ctypes.byref(count))
        found = (Column(text_of(c.name), text_of(c.unit), text_of(c.description))
                 for c in columns[:count.value])
        return Columns((column.name, column) for column in found)

    def __getitem__(self, name: str) -> Array:
        rows = ctypes.c_size_t()
        found = library.ld_history_column(self._pointer, coded(name), ctypes.byref(rows))
        if not found and name not in self.columns:
            near = nearest(name, list(self.columns))
            raise UnknownName(f'there is no column "{name}"'
                              + (f', did you mean "{near}"?' if near else ""))
        tell_renamed(name)
        return array_at(found, rows.value, self._handle)

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __len__(self) -> int:
        return len(self.columns)

    @property
    def rows(self) -> int:
        """Number of rows, one for each instant of `t`.

        >>> result.history.rows == len(result["t"])
        True
        """
        return int(library.ld_history_rows(self._pointer))

    def to_pandas(self) -> pandas.DataFrame:
        """A data frame over t [s], a copy; units in `attrs["units"]`.

        >>> result.history.to_pandas().index.name
        't'
        """
        frame = pandas_here().DataFrame(dict(self))
        frame.attrs["units"] = {name: column.unit for name, column in self.columns.items()}
        return frame.set_index("t")

    def to_xarray(self) -> xarray.Dataset:
        """A data set over t [s], not copied, whose variables have `units` and `long_name`.

        >>> result.history.to_xarray()["tip.y"].units
        'm'
        """
        told = {name: {"units": column.unit, "long_name": column.description}
                for name, column in self.columns.items()}
        values = {name: ("t", self[name], told[name]) for name in self if name != "t"}
        return data_set(values, {"t": ("t", self["t"], told["t"])})

    def plot(self, *names: str, over: str = "t", ax: Any = None, **style: Any) -> Any:
        """Draws columns by matplotlib over another one: `history.plot("tip.y", "tip.z")`.

        Columns of one unit share axes, others get axes of their own, one below the other.
        Returns the axes, or a list of them where units differ.

        `names`: columns to draw; `ax`: axes to draw on; `style`: options of their plot().

        >>> axes = result.history.plot("tip.y", "tip.z", over="rocket.s", color="black")
        """
        from .plotting import plot_columns
        return plot_columns(self, names, over, ax, style)

    def __repr__(self) -> str:
        return f"<launchdyn.History: {len(self)} columns, {self.rows} rows>"

    def _repr_html_(self) -> str:
        return _table(f"{len(self)} columns, {self.rows} rows", ("column", "unit", ""),
                      ((c.name, c.unit, c.description) for c in self.columns.values()))


class Summary(Mapping[str, float]):
    """Numbers of a run by their names (docs/quantities.md), in SI: "rocket.1.exit_speed",
    "energy.residual_relative", "mode.1.frequency"; NaN where there is none.

    >>> round(result.summary["rocket.1.exit_speed"], 1)
    37.8
    """

    def __init__(self, handle: Handle) -> None:
        self._handle = handle

    @functools.cached_property
    def quantities(self) -> dict[str, Quantity]:
        """Name, unit, description and value of each number.

        >>> result.summary.quantities["rocket.1.exit_speed"].description
        's_dot at t_rear, relative to the tube'
        """
        return {quantity.name: quantity for quantity in quantities_at(self._handle.pointer)}

    def __getitem__(self, name: str) -> float:
        error, value = ld_error(), ctypes.c_double()
        check_name(library.ld_summary_number(self._handle.pointer, coded(name),
                                             ctypes.byref(value), ctypes.byref(error)), error)
        tell_renamed(name)
        return value.value

    def __iter__(self) -> Iterator[str]:
        return iter(self.quantities)

    def __len__(self) -> int:
        return len(self.quantities)

    def __repr__(self) -> str:
        return f"<launchdyn.Summary: {len(self)} numbers>"

    def _repr_html_(self) -> str:
        return _table(f"{len(self)} numbers in SI", ("number", "value", "unit", ""),
                      ((q.name, f"{q.value:.6g}", q.unit, q.description)
                       for q in self.quantities.values()))


def quantities_at(pointer: int) -> list[Quantity]:
    """The numbers of the library's summary."""
    found: list[Quantity] = []

    def take(_: Any, offered: Any) -> None:
        q = offered[0]
        found.append(Quantity(text_of(q.name), text_of(q.unit), text_of(q.description), q.value))

    library.ld_summary_each(pointer, QUANTITY_TAKER(take), None)
    return found


class Result:
    """What came of a run. `result["tip.y"]` is a column, `result.summary["rocket.1.exit_speed"]`
    a number, `result.flight(1)` a rocket's flight; of a flight alone the columns are those of the
    flight. A context manager; it need not be closed.

    >>> result
    <launchdyn.Result: rockets 1, rows 1599>
    """

    def __init__(self, model: Handle, summary: Handle, history: Handle) -> None:
        self._model, self._handle, self._rows = model, summary, history
        self.summary = Summary(summary)
        #: Columns of the launch, or of a flight alone.
        self.history = History(history, history.pointer)

    @property
    def rockets(self) -> int:
        """Number of rockets fired.

        >>> result.rockets
        1
        """
        return int(library.ld_summary_rockets(self._handle.pointer))

    @property
    def stopped(self) -> Optional[str]:
        """Why the run ended early; None: it did not.

        >>> result.stopped is None
        True
        """
        return text_of(library.ld_summary_stopped(self._handle.pointer)) or None

    @property
    def notes(self) -> list[str]:
        """Remarks that the user should see.

        >>> result.notes
        []
        """
        found: list[str] = []
        while note := library.ld_summary_note(self._handle.pointer, len(found)):
            found.append(text_of(note))
        return found

    @property
    def flights(self) -> dict[int, History]:
        """Columns of the flights, by the number of the rocket in the order of firing.

        >>> list(flown.flights)
        [1]
        """
        found = {}
        for rocket in range(1, self.rockets + 1):
            pointer = library.ld_history_flight(self._rows.pointer, rocket)
            if pointer:
                found[rocket] = History(self._rows, pointer)
        return found

    def flight(self, rocket: int = 1) -> History:
        """Columns of the flight of a rocket, from 1. Raises KeyError where it has not flown.

        >>> flown.flight(1)["altitude"].max() > 100
        True
        """
        flights = self.flights
        if rocket not in flights:
            raise KeyError(f"rocket {rocket} has not flown")
        return flights[rocket]

    def _check_columns(self, *names: str) -> None:
        """Raises where a name is a column of a flight alone."""
        for name in names:
            if name in self.history.columns:
                continue
            for rocket, flight in self.flights.items():
                if name in flight.columns:
                    raise UnknownName(f'"{name}" is a column of the flight: flight({rocket})')

    def __getitem__(self, name: str) -> Array:
        self._check_columns(name)
        return self.history[name]

    def to_pandas(self) -> pandas.DataFrame:
        """The columns as a data frame over t [s], in SI; see History.to_pandas().

        >>> result.to_pandas().attrs["units"]["tip.y"]
        'm'
        """
        return self.history.to_pandas()

    def to_xarray(self) -> xarray.Dataset:
        """The columns as a data set over t [s], in SI; see History.to_xarray().

        >>> dict(result.to_xarray().sizes) == {"t": result.history.rows}
        True
        """
        return self.history.to_xarray()

    def plot(self, *names: str, over: str = "t", ax: Any = None, **style: Any) -> Any:
        """Draws columns; see History.plot().

        `names`: columns to draw; `ax`: axes to draw on; `style`: options of their plot().

        >>> axes = result.plot("tip.y", over="rocket.s")
        """
        self._check_columns(over, *names)
        return self.history.plot(*names, over=over, ax=ax, **style)

    def close(self) -> None:
        """Gives it up; arrays that are still used keep their memory.

        >>> scenario.run().close()
        """
        del self._model, self._handle, self._rows, self.summary, self.history

    def __enter__(self) -> Result:
        return self

    def __exit__(self, *error: Any) -> None:
        self.close()

    def __str__(self) -> str:
        """The table that the command prints."""
        return printed(lambda to: library.ld_summary_print(self._model.pointer,
                                                           self._handle.pointer, to))

    def __repr__(self) -> str:
        stopped = f", stopped: {self.stopped}" if self.stopped else ""
        return f"<launchdyn.Result: rockets {self.rockets}, rows {self.history.rows}{stopped}>"

    def _repr_html_(self) -> str:
        return f"<pre>{escape(str(self))}</pre>"
