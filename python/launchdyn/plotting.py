"""Figures by matplotlib, which is asked for when the first one is drawn."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional

from .errors import MissingError

if TYPE_CHECKING:
    from .result import History
    from .study import StudyData


def _pyplot() -> Any:
    try:
        from matplotlib import pyplot
    except ImportError:
        raise MissingError("figures require matplotlib (Debian: python3-matplotlib)") from None
    return pyplot


def _axes(count: int, ax: Any, share: bool) -> list[Any]:
    """Axes one below the other, or those that the caller gave."""
    if ax is None:
        height = max(3.2, 2.2 * count)
        _, made = _pyplot().subplots(count, 1, sharex=share, squeeze=False, figsize=(7, height),
                                     constrained_layout=True)
        return [axes for row in made for axes in row]
    given = list(ax) if isinstance(ax, (list, tuple)) or hasattr(ax, "flat") else [ax]
    if len(given) != count:
        raise ValueError(f"these columns have {count} units and require as many axes; found "
                         f"{len(given)}")
    return given


def _label(axis: Any, name: str, unit: str) -> None:
    """A label with the unit, and ticks with its prefixes where they are said before it."""
    from matplotlib.ticker import EngFormatter
    if re.match(r"(m|N|Pa|J|W|rad|Hz|s)(?![0-9a-z])", unit):
        axis.set_major_formatter(EngFormatter(unit=unit.replace(".", " ")))
        axis.set_label_text(name)
    else:
        axis.set_label_text(f"{name} [{unit}]" if unit not in ("", "1") else name)


def plot_columns(history: History, names: Sequence[str], over: str, ax: Any,
                 style: Mapping[str, Any]) -> Any:
    """History.plot()."""
    if not names:
        raise ValueError("no columns given; `columns` lists them")
    values = {name: history[name] for name in (over, *names)}
    units: dict[str, list[str]] = {}
    for name in names:
        units.setdefault(history.columns[name].unit, []).append(name)
    axes = _axes(len(units), ax, share=True)
    for at, (unit, together) in zip(axes, units.items()):
        for name in together:
            at.plot(values[over], values[name], **{"label": name, **style})
        _label(at.yaxis, together[0] if len(together) == 1 else "", unit)
        at.grid(alpha=0.3)
        if len(together) > 1:
            at.legend()
    _label(axes[-1].xaxis, over, history.columns[over].unit)
    return axes[0] if len(axes) == 1 else axes


def plot_study(data: StudyData, names: Sequence[str], over: Optional[str], ax: Any,
               style: Mapping[str, Any]) -> Any:
    """StudyData.plot()."""
    if not names:
        raise ValueError("no results given; `results` lists them")
    axes = _axes(len(names), ax, share=over is not None)
    columns, points = data.columns, data.points
    for at, name in zip(axes, names):
        for point in points:
            label = ", ".join(f"{path} {text}" for path, text in point.values.items())
            wanted = {"label": label, "alpha": 0.6, **style}
            values = data.values(name, *([over] if over else []), point=point.number)
            if over:
                at.plot(values[over], values[name], ".", **wanted)
            else:
                at.hist(values[name], bins="auto", **wanted)
        _label(at.yaxis if over else at.xaxis, name, columns[name].unit)
        at.grid(alpha=0.3)
        if over:
            _label(at.xaxis, over, columns[over].unit)
        else:
            at.set_ylabel("rockets")
        if len(points) > 1:
            at.legend()
    return axes[0] if len(axes) == 1 else axes
