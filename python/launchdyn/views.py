"""Roads, winds, linear responses as the command shows them; its figures of runs."""

from __future__ import annotations

import csv
import ctypes
import math
import os
import tempfile
import warnings
from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np

from ._interrupt import Interrupt
from ._library import GO_ON, ld_error, ld_picture, ld_scene, ld_response_wish, ld_watch, library
from ._memory import Array, Handle, coded, coded_path, printed, text_of, texts
from .errors import check

PathLike = Union[str, "os.PathLike[str]"]


class View:
    """A road, a wind or a linear response to look at: str() is the table of the command,
    `tables` are its numbers, draw() makes a picture of it by gnuplot. Made by road_view(),
    wind_view(), response_view() of a scenario.

    >>> vehicle.road_view()
    <launchdyn.View of a road>
    """

    def __init__(self, kind: str, model: Handle, wish: Any) -> None:
        error, pointer = ld_error(), ctypes.c_void_p()
        self._kind, self._wish = kind, wish  # what it points to outlives the view
        with Interrupt() as interrupt:
            if isinstance(wish, ld_response_wish):
                wish.watch = ctypes.pointer(ld_watch(GO_ON(interrupt.asking())))
            status = self._function("create")(model.pointer, wish, ctypes.byref(pointer),
                                              ctypes.byref(error))
            if not status:
                self._handle = Handle(pointer.value, self._function("free"), model)
        check(status, error, model.pointer)

    def _function(self, what: str) -> Any:
        return getattr(library, f"ld_{self._kind}_view_{what}")

    @property
    def tables(self) -> dict[str, dict[str, Array]]:
        """The tables that write() writes, by their names, "road": columns by theirs, in SI.

        >>> vehicle.road_view(end=20).tables["road"]["left"].ndim
        1
        """
        with tempfile.TemporaryDirectory() as folder:
            self.write(folder)
            return {path.stem: _columns(path) for path in sorted(Path(folder).glob("*.csv"))}

    def write(self, folder: PathLike) -> None:
        """Writes its tables as CSV into a folder.

        >>> vehicle.road_view(end=20).write(folder / "road")
        """
        error = ld_error()
        check(self._function("write")(self._handle.pointer, coded_path(folder),
                                      ctypes.byref(error)), error)

    def draw(self, file: PathLike) -> None:
        """Draws it by gnuplot: file.svg, file.pdf or file.png.

        >>> vehicle.road_view(end=20).draw(folder / "road.svg")
        """
        error = ld_error()
        check(self._function("draw")(self._handle.pointer, coded_path(file),
                                     ctypes.byref(error)), error)

    def __str__(self) -> str:
        return printed(lambda to: self._function("print")(self._handle.pointer, to))

    def __repr__(self) -> str:
        return f"<launchdyn.View of a {self._kind}>"

    def _repr_html_(self) -> str:
        return f"<pre>{escape(str(self))}</pre>"


def _columns(path: Path) -> dict[str, Array]:
    """Columns of a CSV file of the library, "x [m]" as "x"."""
    with path.open() as file:
        head, *rows = csv.reader(file)
    return {name.split(" [")[0]: np.array([float(row[i]) for row in rows])
            for i, name in enumerate(head)}


def figures() -> dict[str, str]:
    """The figures that draw() knows, with a line on each.

    >>> ld.figures()["tip"]
    'Tip of the tube against the undeformed tube'
    """
    found: dict[str, str] = {}
    while figure := library.ld_figure_at(len(found)):
        found[text_of(figure[0].name)] = text_of(figure[0].description)
    return found


def draw(file: PathLike, *folders: PathLike, figures: Sequence[str] = (),
         start: float = math.nan, end: float = math.nan, style: Optional[str] = None,
         width: float = 0, magnify: Optional[float] = None,
         slower: Optional[float] = None) -> None:
    """Draws standard figures of the runs in some folders by gnuplot, several laid one over the
    other: file.svg, file.pdf or file.png; or writes one run's moving launcher for programs that
    draw in three dimensions: file.glb, with deflections `magnify` times, `slower` times as slow.

    `figures` are names of figures(), "all": all that there are columns for; none: a choice.
    `start` and `end` are times from ignition [s]; `style` is "screen", "dark" or "paper"; `width`
    is that of the picture [m], 0: as the style has it.

    >>> ld.draw(folder / "tip.svg", folder / "student", figures=["tip"], end=0.1, width=0.12)
    >>> ld.draw(folder / "launch.glb", folder / "student", magnify=50, slower=100)
    """
    error, note = ld_error(), ctypes.create_string_buffer(ld_error.text.size)
    wanted = [os.fsdecode(folder) for folder in folders]
    picture = ld_picture(texts(wanted), len(wanted), texts(figures), len(figures), start, end,
                         ctypes.addressof(note), coded(style) if style else None, width)
    if magnify is not None or slower is not None:
        picture.scene = ctypes.pointer(ld_scene(1 if magnify is None else magnify,
                                                1 if slower is None else slower))
    check(library.ld_plot(ctypes.byref(picture), coded_path(file), ctypes.byref(error)), error)
    if note.value:
        warnings.warn(text_of(note.value), stacklevel=2)
