"""What can go wrong, as exceptions that carry code, place and suggestion."""

from __future__ import annotations

import ctypes
import enum
import os
import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Optional, Sequence

from ._library import ld_error, ld_messages, library
from ._memory import text_of

if TYPE_CHECKING:
    from .result import Result


class Status(enum.IntEnum):
    """What came of a call; the values are those of the C interface (status.h).

    >>> ld.Status(2).name
    'FILE'
    """

    OK = 0
    INPUT = 1  #: an argument, the scenario or a file that is read is wrong or not there
    FILE = 2  #: a file cannot be written
    MEMORY = 3  #: no memory
    NUMERIC = 4  #: the numerics failed: NaN, singular matrix, no convergence
    LAUNCH = 5  #: the launch cannot continue: stuck, jammed, never released
    INTERRUPTED = 6  #: stopped on request
    MISSING = 7  #: a program or a feature needed is not there


@dataclass(frozen=True)
class Message:
    """One thing wrong with a scenario, or implausible.

    >>> print(error.messages[0])
    mine.yaml:3:3: rocket.mas: unknown key, did you mean "mass"?
    """

    file: str  #: that holds the key; "--set" for a value set by its path
    line: int  #: from 1; 0 where there is none; of a value set by its path, its number from 1
    column: int  #: from 1, in characters
    key: str  #: full path, e.g. "rocket.adaptors.rear.clearance"
    text: str  #: what was found, what is allowed
    source: str  #: the line of text that it is about; "" where there is none
    suggestion: Optional[str]  #: the name that was probably meant

    def __str__(self) -> str:
        if self.file == "--set":  # a value set by its path, which no file holds
            return f"{self.key or self.source}: {self.text}"
        place = f"{self.file}:{self.line}:{self.column}" if self.line > 0 else self.file
        return f"{place}: {self.key + ': ' if self.key else ''}{self.text}"


class LaunchdynError(Exception):
    """Base of all errors of the library: `code`, the sentence `text`, and the `messages` with
    their places where it is about a scenario. `file`, `line`, `column`, `key` and `suggestion`
    are those of the first message; None where there is none.

    >>> error.code.name, error.key, error.suggestion
    ('INPUT', 'rocket.mas', 'mass')
    """

    code = Status.OK
    result: Optional[Result] = None  #: of a run that ended early: what it had until then

    def __init__(self, text: str, messages: Sequence[Message] = ()) -> None:
        super().__init__(text, messages)
        self.text = text
        self.messages = tuple(messages)

    def __str__(self) -> str:
        return "\n".join(map(str, self.messages)) if self.messages else self.text

    @property
    def file(self) -> Optional[str]:
        """Of the first message: the file that holds the key.

        >>> error.file
        'mine.yaml'
        """
        return self.messages[0].file if self.messages else None

    @property
    def line(self) -> Optional[int]:
        """Of the first message: the line, from 1.

        >>> error.line
        3
        """
        return self.messages[0].line if self.messages else None

    @property
    def column(self) -> Optional[int]:
        """Of the first message: the column, from 1, in characters.

        >>> error.column
        3
        """
        return self.messages[0].column if self.messages else None

    @property
    def key(self) -> Optional[str]:
        """Of the first message: the key's full path.

        >>> error.key
        'rocket.mas'
        """
        return self.messages[0].key if self.messages else None

    @property
    def suggestion(self) -> Optional[str]:
        """The name that was probably meant.

        >>> error.suggestion
        'mass'
        """
        return self.messages[0].suggestion if self.messages else suggested(self.text)


class InputError(LaunchdynError, ValueError):
    """An argument, the scenario or a file that is read is wrong or not there.

    >>> try:
    ...     scenario.derive({"rocket.mass": "61 m"})
    ... except ld.InputError as wrong:
    ...     print(wrong)
    rocket.mass: found "61 m", a unit of the wrong dimension; expected
    a number with a unit of kg, > 0 kg
    """

    code = Status.INPUT


class UnknownName(InputError, KeyError):
    """There is no such key, column or number; `suggestion` is the nearest one.

    >>> try:
    ...     result["tip.x"]
    ... except ld.UnknownName as wrong:
    ...     print(wrong)
    there is no column "tip.x", did you mean "tip.y"?
    """

    __str__ = LaunchdynError.__str__


class FileError(LaunchdynError):
    """A file cannot be written, or the system refuses to read it.

    >>> ld.FileError.code.name
    'FILE'
    """

    code = Status.FILE


class OutOfMemory(LaunchdynError, MemoryError):
    """There is no memory.

    >>> issubclass(ld.OutOfMemory, MemoryError)
    True
    """

    code = Status.MEMORY


class NumericError(LaunchdynError, ArithmeticError):
    """The numerics failed: NaN, a singular matrix, no convergence.

    >>> issubclass(ld.NumericError, ArithmeticError)
    True
    """

    code = Status.NUMERIC


class LaunchError(LaunchdynError):
    """The launch cannot continue: stuck, jammed, never released, beyond a table.

    >>> try:
    ...     scenario.derive({"rocket.lock.release_force": "1 MN"}).run()
    ... except ld.LaunchError as stuck:
    ...     print(stuck.result.stopped is not None)
    True
    """

    code = Status.LAUNCH


class Interrupted(LaunchdynError):
    """It was stopped on request.

    >>> ld.Interrupted.code.name
    'INTERRUPTED'
    """

    code = Status.INTERRUPTED


class MissingError(LaunchdynError):
    """A program or a feature that is needed is not there.

    >>> ld.MissingError.code.name
    'MISSING'
    """

    code = Status.MISSING


KINDS = {kind.code: kind for kind in (InputError, FileError, OutOfMemory, NumericError,
                                      LaunchError, Interrupted, MissingError)}


def tell_renamed(*names: str) -> None:
    """Warns of former names of columns and results, which the library accepts."""
    text = ctypes.create_string_buffer(256)
    for name in names:
        now = text_of(library.ld_current_name(name.encode(), text, len(text)))
        if now:
            warnings.warn(f'"{name}" is called "{now}" now', FutureWarning, stacklevel=3)


def suggested(text: str) -> Optional[str]:
    """The name that an error's text suggests."""
    name = ctypes.create_string_buffer(256)
    return text_of(library.ld_suggested_name(text.encode(), name, len(name))) or None


def take_messages(messages: ld_messages) -> list[Message]:
    """The messages of the library, which are freed."""
    taken = []
    for m in messages.item[:messages.count]:
        text = text_of(m.text)
        taken.append(Message(os.fsdecode(m.file), m.line, m.column, text_of(m.path), text,
                             text_of(m.source), suggested(text)))
    library.ld_messages_free(ctypes.byref(messages))
    return taken


def check_messages(status: int, messages: ld_messages) -> None:
    """Raises what reading a scenario said."""
    if status:
        taken = take_messages(messages)
        raise KINDS[Status(status)]("\n".join(map(str, taken)) or "no memory", taken)


def failure(status: int, error: ld_error, model: Optional[int] = None) -> LaunchdynError:
    """The exception for a status and its sentence, with its place in the model's scenario where
    it is about a key."""
    messages = ld_messages()
    taken = []
    if model and library.ld_scenario_explain(model, ctypes.byref(error), ctypes.byref(messages)):
        taken = take_messages(messages)
    return KINDS[Status(status)](text_of(error.text), taken)


def check(status: int, error: ld_error, model: Optional[int] = None) -> None:
    """Raises the exception for a status that is not OK."""
    if status:
        raise failure(status, error, model)


def check_name(status: int, error: ld_error) -> None:
    """Raises UnknownName where a name was refused, else what check() does."""
    if status == Status.INPUT:
        raise UnknownName(text_of(error.text))
    check(status, error)
