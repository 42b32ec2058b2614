"""Values on their way into a scenario: numbers take the SI unit of their key, texts stay as they
are."""

from __future__ import annotations

import functools
import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from numbers import Integral, Real
from typing import Any, Optional, Union

import numpy as np

from ._library import KEY_TAKER, library
from ._memory import text_of

Sets = Union[Mapping[str, Any], Sequence[str], None]


@dataclass(frozen=True)
class Key:
    """A key of the scenario language that has a value.

    >>> scenario.key("rocket.mass").unit
    'kg'
    """

    path: str  #: "rocket.mass"; N stands for the name or number of a list's member
    unit: str  #: SI, "" without
    description: str
    expected: str  #: what its value looks like
    low: float  #: what a number may be, in SI
    high: float
    required: bool  #: has no default

    @property
    def components(self) -> str:
        """Names of a vector's components, "xyz"; "" of all else.

        >>> scenario.key("rocket.center").components
        'xyz'
        """
        found = re.match("(two|three|four) numbers", self.expected)
        return {"two": "yz", "three": "xyz", "four": "wxyz"}[found[1]] if found else ""

    def column_units(self, columns: int) -> list[str]:
        """SI units of a table's columns; empty where a table of so many is none of this key.

        >>> scenario.key("rocket.motor.thrust").column_units(2)
        ['s', 'N']
        """
        for row in re.findall(r"\[([^]]*)\]", self.expected):
            names = row.split(", ")
            if len(names) == columns:
                return [name.partition(" in ")[2].split(" or ")[-1] for name in names]
        return []


@functools.lru_cache(maxsize=None)
def keys() -> tuple[Key, ...]:
    """Every key of the scenario language, with its unit, range and description.

    >>> ld.keys()[0].path
    'launchdyn'
    """
    found: list[Key] = []

    def take(_: Any, pointer: Any) -> None:
        k = pointer[0]
        found.append(Key(text_of(k.path), text_of(k.unit), text_of(k.description),
                         text_of(k.expected), k.low, k.high, bool(k.required)))

    library.ld_scenario_keys(KEY_TAKER(take), None)
    return tuple(found)


@functools.lru_cache(maxsize=None)
def _tree() -> dict[str, Any]:
    tree: dict[str, Any] = {}
    for key in keys():
        at = tree
        for part in key.path.split("."):
            at = at.setdefault(part, {})
        at[""] = key
    return tree


def _find(tree: dict[str, Any], parts: list[str]) -> Optional[Key]:
    if not parts:
        return tree.get("")
    for name in (parts[0], "N"):
        found = _find(tree[name], parts[1:]) if name in tree else None
        if found:
            return found
    return None


@functools.lru_cache(maxsize=4096)
def key_of(path: str) -> Optional[Key]:
    """The key that a path leads to, or that of a vector whose component it is."""
    if not isinstance(path, str):
        raise TypeError(f"expected the path of a key (str), found {type(path).__name__}")
    parts = path.removeprefix("sweep.").split(".")  # whose keys are paths themselves
    found = _find(_tree(), parts)
    if not found and parts[-1] in ("w", "x", "y", "z"):
        found = _find(_tree(), parts[:-1])
    return found


# ---- as texts

_PLAIN = re.compile(r"(?!- |-$)[\w.+-][\w.+/*%-]*( [\w.+/*%-]+)*", re.ASCII)


def _number(value: Real) -> str:
    text = str(int(value)) if isinstance(value, Integral) else repr(float(value))
    if not np.isfinite(float(value)):
        raise ValueError(f"a scenario has no number {text}")
    return text


def _with_unit(value: Real, unit: str) -> str:
    return f"{_number(value)} {unit}" if unit else _number(value)


def _is_number(value: Any) -> bool:
    return isinstance(value, Real) and not isinstance(value, (bool, np.bool_))


def _is_list(value: Any) -> bool:
    return isinstance(value, (Sequence, np.ndarray)) and not isinstance(value, (str, bytes))


def _are_numbers(value: Any) -> bool:
    return _is_list(value) and len(value) > 0 and all(map(_is_number, value))


def _quoted(text: str) -> str:
    if "\0" in text:
        raise ValueError(f"a text with a NUL character: {text[:60]!r}")
    return text if _PLAIN.fullmatch(text) else json.dumps(text, ensure_ascii=False)


def _table_row(key: Key, row: Any) -> str:
    units = key.column_units(len(row)) or [""] * len(row)
    return ", ".join(_with_unit(item, unit) if _is_number(item) else _quoted(str(item))
                     for item, unit in zip(row, units))


def _list(path: str, items: Any) -> str:
    key = key_of(path)
    if key and key.components and _are_numbers(items) and not path.startswith("sweep."):
        return " ".join(map(_number, items)) + (f" {key.unit}" if key.unit else "")
    if key and "rows [" in key.expected and len(items) > 0 and all(map(_is_list, items)):
        return "[" + ", ".join(f"[{_table_row(key, row)}]" for row in items) + "]"
    inner = path if path.startswith("sweep.") else f"{path}.N"
    return "[" + ", ".join(_flow(inner, item) for item in items) + "]"


def _flow(path: str, value: Any) -> str:
    """A value within YAML's lists and blocks."""
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, Mapping):
        inner = (f"{path}.{name}" if path else str(name) for name in value)
        return "{" + ", ".join(f"{_quoted(str(name))}: {_flow(at, item)}"
                               for at, (name, item) in zip(inner, value.items())) + "}"
    return value_text(path, value)


def value_text(path: str, value: Any) -> str:
    """A value as --set has it: a text as it is; a number, or several, in the SI unit of its key;
    (value, "unit") in that unit; None takes the key away."""
    if value is None:
        return ""
    if isinstance(value, str):
        return value
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if _is_number(value):
        key = key_of(path)
        return _with_unit(value, key.unit if key else "")
    if isinstance(value, Mapping):
        return _flow(path, value)
    if isinstance(value, tuple) and len(value) == 2 and isinstance(value[1], str) \
            and (_is_number(value[0]) or _are_numbers(value[0])):
        numbers = value[0] if _are_numbers(value[0]) else [value[0]]
        return " ".join(map(_number, numbers)) + f" {value[1]}"
    if _is_list(value):
        return _list(path, value)
    raise TypeError(f"{path}: a {type(value).__name__} is not a value of a scenario")


def set_texts(sets: Sets) -> list[str]:
    """Overrides as "path=value"."""
    if isinstance(sets, str):
        raise TypeError("expected overrides as a mapping of paths to values, or as a list of "
                        "PATH=VALUE")
    if isinstance(sets, Mapping):
        return [f"{path}={value_text(path, value)}" for path, value in sets.items()]
    return list(sets or [])


def scenario_text(values: Mapping[str, Any], path: str = "", indent: str = "") -> str:
    """A nested mapping as the text of a scenario, a key on a line."""
    lines = []
    for name, value in values.items():
        at = f"{path}.{name}" if path else str(name)
        if isinstance(value, Mapping) and value:
            lines.append(f"{indent}{_quoted(str(name))}:\n"
                         + scenario_text(value, at, indent + "  "))
        else:
            lines.append(f"{indent}{_quoted(str(name))}: {_flow(at, value)}\n")
    return "".join(lines)
