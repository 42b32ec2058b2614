"""Figures by matplotlib, which is asked for when the first one is drawn."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional

from .errors import MissingError

if TYPE_CHECKING:
    from .result import History
    from .study import Cell, Cells, StudyData


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


def _what(name: str, statistic: str, against: Optional[str], unit: str) -> tuple[str, str]:
    """What the estimates are, and their unit."""
    kind = statistic.partition(":")[0]
    if kind == "footprint":
        return "area of the footprint", "m2"
    text = f"{name}: {statistic}"
    if not against:
        return text, "" if kind == "share" else unit
    return f"{text}, against {against}", unit if kind == "mean" else ""


def _curve(at: Any, cells: Sequence[Cell], places: Sequence[float], same: float,
           style: Mapping[str, Any]) -> None:
    """Dots with their intervals; cells of reference are what is the same."""
    drawn = sorted(zip(places, cells), key=lambda one: one[0])
    y = [same if c.reference else c.estimate.value for _, c in drawn]
    known = [c.estimate.low == c.estimate.low for _, c in drawn]
    below = [c.estimate.value - c.estimate.low if k else 0 for (_, c), k in zip(drawn, known)]
    above = [c.estimate.high - c.estimate.value if k else 0 for (_, c), k in zip(drawn, known)]
    at.errorbar([x for x, _ in drawn], y, yerr=[below, above], capsize=3, **style)


def _draw_over(at: Any, cells: Cells, against: Optional[str], statistic: str,
               style: Mapping[str, Any]) -> None:
    """A curve, or one for each value of the second key; words stand beside each other."""
    same = 1.0 if statistic == "deviation" else 0.0
    numeric = all(c.numbers[0] == c.numbers[0] for c in cells)
    words = list(dict.fromkeys(c.values[0] for c in cells))
    family = list(dict.fromkeys(c.values[1:] for c in cells))
    for k, values in enumerate(family):
        own = [c for c in cells if c.values[1:] == values]
        aside = 0.6 / len(family) * (k - (len(family) - 1) / 2)
        places = [c.numbers[0] if numeric else words.index(c.values[0]) + aside for c in own]
        label = f"{cells.keys[1]} {values[0]}" if values else None
        _curve(at, own, places, same, {"fmt": "o-" if numeric else "o", "label": label, **style})
    if against:
        at.axhline(same, color="0.6", linewidth=1)
    if not numeric:
        at.set_xticks(range(len(words)), words)
    if len(family) > 1:
        at.legend()
    at.grid(alpha=0.3)


def plot_influences(data: StudyData, names: Sequence[str], ax: Any,
                    style: Mapping[str, Any]) -> Any:
    """StudyData.plot() of sensitivities: a bar for each factor, the greatest on top."""
    if not names:
        raise ValueError("no results given; `results` lists them")
    axes, columns = _axes(len(names), ax, share=False), data.columns
    for at, name in zip(axes, names):
        found = data.influences(name)
        kinds = [("mu*", "mu_star")] if any(f.mu_star.value == f.mu_star.value for f in found) \
            else [("total", "total"), ("first order", "first")]
        for k, (label, kind) in enumerate(kinds):
            bars = [(i, getattr(f, kind)) for i, f in enumerate(found)]
            bars = [(i, e) for i, e in bars if e.value == e.value]
            ends = [[e.value - e.low for _, e in bars], [e.high - e.value for _, e in bars]]
            if bars:
                at.barh([i + (k - 0.5) * 0.4 * (len(kinds) - 1) for i, _ in bars],
                        [e.value for _, e in bars], 0.8 / len(kinds), xerr=ends, label=label,
                        **style)
        at.set_yticks(range(len(found)), [f.factor for f in found])
        at.invert_yaxis()
        _label(at.xaxis, *((f"mu* of {name}", columns[name].unit) if len(kinds) == 1
                           else (f"share of the variance of {name}", "")))
        at.legend()
    return axes[0] if len(axes) == 1 else axes


def plot_over(data: StudyData, names: Sequence[str], keys: Sequence[str], against: Optional[str],
              statistic: str, ax: Any, style: Mapping[str, Any]) -> Any:
    """StudyData.plot() over swept keys."""
    footprint = statistic.startswith("footprint")
    if not names and not footprint:
        raise ValueError("no results given; `results` lists them")
    of = [data.over(name, *keys, against=against, statistic=statistic)
          for name in (names or (None,))]
    axes, columns = _axes(len(of), ax, share=True), data.columns
    for at, cells in zip(axes, of):
        unit = "" if footprint else columns[cells.result].unit
        _draw_over(at, cells, against, statistic, style)
        _label(at.yaxis, *_what(cells.result, statistic, against, unit))
        at.set_xlabel(f"{cells.keys[0]} [{cells.units[0]}]" if cells.units[0] else cells.keys[0])
    return axes[0] if len(axes) == 1 else axes
