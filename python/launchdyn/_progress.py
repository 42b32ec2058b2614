"""How far the library is, as a line that is written over until all is done."""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Callable, Optional, TextIO, Union

if TYPE_CHECKING:
    from .study import Counts

#: What callers may give: a function that gets how far it is; True: a bar on a terminal.
Progress = Union[Callable[[Any], Any], bool, None]
#: Between two lines, in seconds.
PATIENCE = 0.2
WIDTH = 40


class Bar:
    """A line about a run's share, or a study's counts, with the time that is left."""

    def __init__(self, stream: TextIO, clock: Callable[[], float] = time.monotonic) -> None:
        self._stream, self._clock = stream, clock
        self._begun = self._latest = clock()
        self._length = 0

    def __call__(self, told: Union[float, Counts]) -> None:
        now = self._clock()
        if now - self._latest < PATIENCE:
            return
        self._latest, past = now, now - self._begun
        if isinstance(told, (int, float)):
            bar = ("#" * int(told * WIDTH)).ljust(WIDTH, ".")
            self._write(f"[{bar}] {100 * told:3.0f} %{_left(told, 1, past)}")
        else:
            failed = f", {told.failed} failed" if told.failed else ""
            left = _left(told.now, told.now + told.samples - told.done, past)
            self._write(f"{told.done} of {told.samples} samples{failed}{left}")

    def _write(self, text: str) -> None:
        self._stream.write("\r" + text.ljust(self._length))
        self._stream.flush()
        self._length = len(text)

    def end(self) -> None:
        """Takes the line away."""
        if self._length:
            self._write("")
            self._stream.write("\r")


def _left(done: float, whole: float, past: float) -> str:
    return f", {past * (whole - done) / done:.0f} s left" if done > 0 else ""


def _seen() -> Optional[TextIO]:
    """Where somebody sees a line that is written over: a notebook, a terminal."""
    if "ipykernel" in sys.modules:
        return sys.stdout
    return sys.stderr if sys.stderr and sys.stderr.isatty() else None


@contextlib.contextmanager
def followed(progress: Progress) -> Iterator[Optional[Callable[[Any], Any]]]:
    """The function that gets how far it is; None: none."""
    stream = _seen() if progress is True else None
    if not stream:
        yield progress if callable(progress) else None
        return
    bar = Bar(stream)
    try:
        yield bar
    finally:
        bar.end()
