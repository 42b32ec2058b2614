"""Ctrl-C while the library runs."""

from __future__ import annotations

import signal
import threading
from types import FrameType
from typing import Any, Callable, Optional


class Interrupt:
    """While it lasts, Ctrl-C on the main thread is recorded, and raised at its end: an exception in
    the midst of a function that the library calls would be lost. A handler of the program's own
    is left alone; what it raises is kept likewise."""

    def __init__(self) -> None:
        self.asked = False
        self._raised: Optional[BaseException] = None
        self._mine = False

    def _note(self, number: int, frame: Optional[FrameType]) -> None:
        self.asked = True

    def __enter__(self) -> Interrupt:
        if threading.current_thread() is threading.main_thread() and \
                signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            signal.signal(signal.SIGINT, self._note)
            self._mine = True
        return self

    def __exit__(self, *error: Any) -> None:
        if self._mine:
            signal.signal(signal.SIGINT, signal.default_int_handler)
        if error[0] is None and self.asked:
            raise self._raised or KeyboardInterrupt

    def asking(self, progress: Optional[Callable[[float], Any]] = None) -> Callable[..., bool]:
        """A function for the library that calls `progress` and says whether to continue."""
        def may_continue(_: Any, share: float = 0) -> bool:
            try:
                if progress:
                    progress(share)
            except BaseException as raised:  # to be raised once the library has returned
                self._raised = raised
                self.asked = True
            return not self.asked
        return may_continue
