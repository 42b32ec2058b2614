"""Memory of the library: handles that live as long as anything needs them, arrays, texts."""

from __future__ import annotations

import ctypes
import os
import threading
import weakref
from typing import Any, Callable, Iterable, Optional, TypeVar, Union

import numpy as np
import numpy.typing as npt

from ._library import library

Array = npt.NDArray[np.float64]
PathLike = Union[str, "os.PathLike[str]"]


def _free(free: Callable[[int], Any], pointer: int, parents: tuple[Handle, ...]) -> None:
    free(pointer)  # while `parents`, held by the caller, still are


class Handle:
    """An object of the library: freed once nothing refers to it, before those it is made of."""

    def __init__(self, pointer: Optional[int], free: Callable[[int], Any],
                 *parents: Handle) -> None:
        if not pointer:
            raise MemoryError("no memory for an object of launchdyn")
        self.pointer = pointer
        self._freed = weakref.finalize(self, _free, free, pointer, parents)
        self._freed.atexit = False  # the end of the program frees what is left

    def __reduce__(self) -> Any:
        raise TypeError("objects of launchdyn stay in their process; pass a scenario as text "
                        "(to_yaml()), results as arrays")

    def __deepcopy__(self, _: Any) -> Handle:
        return self  # what may be copied does not change

    def let_go(self) -> int:
        """The pointer, which somebody else frees from now on."""
        self._freed.detach()
        return self.pointer


Itself = TypeVar("Itself", bound="Held")


class Held:
    """Holds an object of the library until it is closed. A context manager; it need not be closed.
    One thread at a time: others wait."""

    _over = "it is closed"  #: said where it is used nevertheless

    def __init__(self, handle: Handle) -> None:
        self._handle: Optional[Handle] = handle
        self._lock = threading.Lock()

    @property
    def _pointer(self) -> int:
        if self._handle is None:
            raise ValueError(self._over)
        return self._handle.pointer

    def close(self) -> None:
        """Gives it up."""
        with self._lock:
            self._handle = None

    def __enter__(self: Itself) -> Itself:
        return self

    def __exit__(self, *error: Any) -> None:
        self.close()


class _Memory:
    """Some doubles of the library, kept by `owner`: what an array of them refers to."""

    def __init__(self, address: int, count: int, owner: Any) -> None:
        self.owner = owner
        self.__array_interface__ = {"shape": (count,), "typestr": np.dtype(np.float64).str,
                                    "data": (address, True), "version": 3}


def array_at(address: Optional[int], count: int, owner: Any) -> Array:
    """A read-only array over the library's memory, without a copy; it keeps `owner`."""
    if not address:
        return np.empty(0)
    return np.asarray(_Memory(address, count, owner))


def text_of(text: Optional[bytes]) -> str:
    """A text of the library; "" for NULL."""
    return text.decode("utf-8", "replace") if text else ""


def coded(text: str) -> bytes:
    """A text for the library. Raises TypeError for what is not text, ValueError for one with a NUL
    character, at which it would end there."""
    if not isinstance(text, str):
        raise TypeError(f"expected a text (str), found {type(text).__name__}")
    if "\0" in text:
        raise ValueError(f"a text with a NUL character: {text[:60]!r}")
    return text.encode()


def coded_path(path: PathLike) -> bytes:
    """The name of a file or folder for the library; ValueError for one with a NUL character."""
    name = os.fsencode(path)
    if b"\0" in name:
        raise ValueError(f"a file's name with a NUL character: {name[:60]!r}")
    return name


def texts(items: Iterable[str]) -> Any:
    """An array of C strings."""
    encoded = [coded(item) for item in items]
    return (ctypes.c_char_p * len(encoded))(*encoded)


def printed(write: Callable[[int], Any]) -> str:
    """What `write` prints to the FILE that it is given."""
    text, size = ctypes.c_void_p(), ctypes.c_size_t()
    stream = library.ld_text_open(ctypes.byref(text), ctypes.byref(size))
    if not stream:
        raise MemoryError("no memory for a text")
    try:
        write(stream)
    finally:
        status = library.ld_text_close(stream)
        whole = ctypes.string_at(text.value, size.value) if text.value else b""
        library.ld_free(text)
    if status:
        raise MemoryError("no memory for a text")
    return text_of(whole)


