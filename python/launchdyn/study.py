"""Studies: many samples of a scattered scenario, kept in a folder, and what they found."""

from __future__ import annotations

import ctypes
import os
import threading
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, NamedTuple, Optional, Union

import numpy as np
import numpy.typing as npt

from ._interrupt import Interrupt
from ._library import (COUNTS_TOLD, GO_ON, ld_error, ld_estimate, ld_report, ld_study_counts,
                       ld_study_cell, ld_study_footprint, ld_study_influence, ld_study_options,
                       ld_study_over, ld_study_statistics, ld_study_values,
                       ld_study_view, library)
from ._mapping import Executors, MappedStudy, _Keeper
from ._memory import Array, Handle, Held, coded, coded_path, printed, text_of, texts
from ._progress import Progress, followed
from ._values import Sets, set_texts
from .errors import Status, check, check_name, tell_renamed
from .result import data_set, pandas_here
from .scenario import Scenario, dict_text, read_model

if TYPE_CHECKING:
    import pandas
    import xarray

PathLike = Union[str, "os.PathLike[str]"]
#: How often, in seconds, the program that waits for a study looks up.
LOOK_UP = 0.1
_INDICES = ("total", "first", "morris")


class Counts(NamedTuple):
    """How far a study is.

    >>> study.run_shard(folder / "shards", 1, 4).now
    4
    """

    samples: int  #: that the scenario asks for, or that its stopping rule found enough
    done: int  #: that are kept, failed ones included
    failed: int
    now: int  #: of `done`, those of this run


class Estimate(NamedTuple):
    """A number with its interval of 95 %, NaN where none can be stated.

    >>> mean = data.statistics("range").mean
    >>> mean.low < mean.value < mean.high
    True
    """

    value: float
    low: float
    high: float


@dataclass(frozen=True)
class Statistics:
    """Statistics of a column, in SI (docs/study.md).

    >>> data.statistics("range").count
    8
    """

    count: int  #: values
    groups: int  #: independent ones
    mean: Estimate
    deviation: Estimate  #: of all values
    skewness: float
    least: float
    greatest: float
    quantiles: tuple[Estimate, Estimate, Estimate]  #: 5 %, 50 %, 95 %


@dataclass(frozen=True)
class Footprint:
    """For range safety: the region in which a share of landings lies (docs/study.md).

    >>> landings.footprint(0.95).stated
    False
    """

    share: float  #: of further landings that lie within, on average
    needed: float  #: independent landings that it requires
    independent: float  #: how many tell the share as well as those that are there
    stated: bool  #: there are as many as are needed; else what follows is NaN
    content: Estimate  #: share of further landings that lie within
    area: Estimate  #: [m2]
    distance: Estimate  #: [m] from the launch point to the farthest point


@dataclass(frozen=True)
class Influence:
    """What a factor does to a result (docs/study.md); what the plan of the samples does not give is
    NaN. Effects in SI.

    >>> data.influences("range")[0].factor
    'rocket.mass_error'
    """

    factor: str  #: its path
    first: Estimate  #: first-order index; of other plans than saltelli a regression's
    total: Estimate  #: total index, plan saltelli
    together: Estimate  #: total less first: the share that it makes with other factors
    mu_star: Estimate  #: mean magnitude of its elementary effects, plan morris
    mu: Estimate  #: their mean
    sigma: float  #: their deviation
    count: int  #: rows or effects, of each rocket
    groups: int  #: independent ones


@dataclass(frozen=True)
class Cell:
    """A value of a swept key, or a pair of values of two, pooled over the other swept keys
    (docs/study.md).

    >>> data.over("range", "rocket.mass")[0].values
    ('60 kg',)
    """

    values: tuple[str, ...]  #: of the keys, as in the scenario
    numbers: tuple[float, ...]  #: in the keys' units; NaN where they are no numbers of one kind
    estimate: Estimate  #: in SI; of differences that of the means, or ratio of the deviations
    count: int  #: rockets, or pairs of them
    groups: int  #: independent ones
    points: int  #: that have them
    reference: bool  #: what differences are from: the estimate is NaN


class Cells(list[Cell]):
    """Cells in the order of the sweep, the first key varying most slowly.

    >>> data.over("range", "rocket.mass").keys
    ('rocket.mass',)
    """

    def __init__(self, cells: Iterable[Cell], keys: tuple[str, ...], units: tuple[str, ...],
                 result: str) -> None:
        """Of keys with their units, and what the estimates are of."""
        super().__init__(cells)
        self.keys, self.units, self.result = keys, units, result

    def to_pandas(self) -> pandas.DataFrame:
        """A row for each cell: the keys' values, numbers where they are, then `value`, `low`,
        `high` in SI, `count`, `groups`, `points`, `reference`.

        >>> list(data.over("range", "rocket.mass").to_pandas())[:2]
        ['rocket.mass [kg]', 'value']
        """
        pandas = pandas_here()
        rows = [[*(number if unit or number == number else text for text, number, unit
                   in zip(c.values, c.numbers, self.units)), *c.estimate, c.count, c.groups,
                 c.points, c.reference] for c in self]
        names = [f"{key} [{unit}]" if unit else key for key, unit in zip(self.keys, self.units)]
        return pandas.DataFrame(rows, columns=[*names, "value", "low", "high", "count", "groups",
                                               "points", "reference"])


@dataclass(frozen=True)
class StudyColumn:
    """A number of each rocket, or of each sample.

    >>> data.columns["rocket.mass_error"].factor
    True
    """

    name: str  #: of a result, or path of a factor
    unit: str  #: SI; "" without
    factor: bool  #: drawn; else a result
    per_rocket: bool  #: else one for all rockets of a sample
    seed: bool  #: a factor that is another seed in each sample


@dataclass(frozen=True)
class Point:
    """A point of the sweep; a study without one has a single point.

    >>> data.points[1].number, data.points[1].values
    (2, {'rocket.mass': '61 kg'})
    """

    number: int  #: from 1
    values: dict[str, str]  #: of each swept key, as in the scenario
    asked: int  #: samples; of all, `done` are kept, of which `failed`
    done: int
    failed: int


class Study:
    """A scenario with all points of its sweep, whose samples are run into a folder. A context
    manager; it need not be closed.

    >>> with ld.Study.of(swept) as asked:
    ...     asked.run(folder / "mass").points[0].done
    8
    """

    def __init__(self, handle: Handle) -> None:
        """Of a study's handle: use read(), from_text(), from_dict() or of()."""
        self._handle: Optional[Handle] = handle

    @classmethod
    def read(cls, path: PathLike, sets: Sets = None) -> Study:
        """Reads a file; `sets` override it.

        `path`: of the file. None in `sets` takes a key or block away.

        >>> salvo = ld.Study.read(examples / "salvo.yaml", {"scatter.samples": 2})
        >>> salvo.sample(2)["scatter.samples"]
        '2'
        """
        items = texts(set_texts(sets))
        return cls(_read_study(library.ld_study_read, coded_path(path), items, len(items)))

    @classmethod
    def from_text(cls, text: str, sets: Sets = None, name: str = "text",
                  folder: PathLike = ".") -> Study:
        """Reads a text, as Scenario.from_text().

        `sets`: values by path that override it; None takes a key or block away. `name`
        stands for the file in messages, `folder` is where files that it names are searched.

        >>> ld.Study.from_text(swept.to_yaml()).sample(1).has_launcher
        False
        """
        items, given = texts(set_texts(sets)), coded(text)
        return cls(_read_study(library.ld_study_read_text, given, len(given), coded(name),
                               coded_path(folder), items, len(items)))

    @classmethod
    def from_dict(cls, values: Mapping[str, Any], sets: Sets = None, name: str = "dict",
                  folder: PathLike = ".") -> Study:
        """Of nested mappings, as Scenario.from_dict().

        `sets`: values by path that override it; None takes a key or block away. `name`
        stands for the file in messages.

        >>> scatter = {"samples": 2, "factors": {"rocket.mass_error": {"normal": "0.1 kg"}}}
        >>> values = {"include": "flight.yaml", "scatter": scatter}
        >>> ld.Study.from_dict(values, folder=examples).sample(1).title
        'Reference rocket, flight alone'
        """
        return cls.from_text(dict_text(values), sets, name, folder)

    @classmethod
    def of(cls, scenario: Scenario) -> Study:
        """Of a scenario as it is now, with its scatter and sweep.

        >>> ld.Study.of(swept.derive({"scatter.samples": 3})).run(folder / "three").points[0].asked
        3
        """
        source = library.ld_model_source(scenario.handle.pointer)
        return cls(_read_study(library.ld_study_read_source, source))

    def run(self, folder: PathLike, threads: int = 1, progress: Progress = None,
            join: bool = False) -> StudyData:
        """Runs the samples that the folder does not hold yet, and opens what it then holds. With
        `join` any number of programs, on any machines, share a folder: they may come, go or be
        killed (docs/study.md).

        `progress` gets the Counts now and then, on the caller's thread; True: a line in a
        terminal or a notebook. Ctrl-C, or whatever
        `progress` raises, stops the study, which keeps what it has: run again, it continues. The
        results have the same bits for any number of threads and any interruption.

        >>> study.run(folder / "study", threads=2).points[0].done
        8
        """
        self._run(_Work(self.handle, folder, threads, join=join), progress)
        return StudyData(folder)

    def run_shard(self, folder: PathLike, shard: int, shards: int, threads: int = 1,
                  progress: Progress = None) -> Counts:
        """Runs the samples shard, shard + shards, ... alone, for merge_shards(): several programs,
        on one machine or on many, share a folder so. Else as run().

        `threads` run samples side by side; `progress` gets the Counts.

        >>> study.run_shard(folder / "two", shard=2, shards=2).done
        8
        """
        return self._run(_Work(self.handle, folder, threads, shard, shards), progress)

    def map(self, executor: Executors, folder: PathLike, progress: Progress = None,
            ahead: int = 256) -> StudyData:
        """Runs the samples that the folder does not hold yet on an executor of concurrent.futures,
        as of Dask (`client.get_executor()`), Parsl or Ray, and opens what it then holds. Else as
        run(): the same bits.

        A task is a range of samples of about half a second; `ahead` tasks are submitted at a time.
        A range whose worker is killed runs again. A ProcessPoolExecutor takes no more work
        then: give a function that makes one. Where the executor runs, the package must be there,
        but no file and no folder.

        `progress` gets the Counts.

        >>> from concurrent.futures import ThreadPoolExecutor
        >>> with ThreadPoolExecutor(2) as executor:
        ...     study.map(executor, folder / "mapped").points[0].failed
        0
        """
        done, last, went = -1, time.monotonic(), False
        with Interrupt() as interrupt, followed(progress) as told, \
                _Keeper(self.handle, folder) as keeper:
            mapping = MappedStudy(self, keeper, executor, ahead)
            try:
                while not interrupt.asked and mapping.step():
                    counts = keeper.counts
                    if told and counts.done != done and time.monotonic() - last >= LOOK_UP:
                        done, last = counts.done, time.monotonic()
                        told(_counts(counts))
                went = not interrupt.asked
            finally:
                mapping.end(went)
            if went and told:
                told(_counts(keeper.counts))
        return StudyData(folder)

    def _run(self, work: _Work, progress: Progress) -> Counts:
        with Interrupt() as interrupt, followed(progress) as told:
            work.start()
            try:
                done = -1
                while work.goes_on(LOOK_UP) and not interrupt.asked:
                    if told and work.done != done:
                        done = work.done
                        told(_counts(work.latest))
            finally:
                work.end()
            if not interrupt.asked:
                check(work.status, work.error)
                if told:
                    told(_counts(work.counts))
        return _counts(work.counts)

    def sample(self, number: int) -> Scenario:
        """A sample, from 1, as a scenario to look at and to run, with what was sampled for it.

        `number`: of the sample.

        >>> study.sample(3)["rocket.mass_error"] != study.sample(5)["rocket.mass_error"]
        True
        """
        error, pointer = ld_error(), ctypes.c_void_p()
        check(library.ld_study_sample(self.handle.pointer, number, ctypes.byref(pointer),
                                      ctypes.byref(error)), error)
        sample = Handle(pointer.value, library.ld_sample_free, self.handle)
        drawn = Scenario(Handle(library.ld_sample_model(sample.pointer), _keep, sample))
        drawn._drawn = True
        return drawn

    @property
    def handle(self) -> Handle:
        """The library's object.

        >>> study.handle is not None
        True
        """
        if self._handle is None:
            raise ValueError("the study is closed")
        return self._handle

    def close(self) -> None:
        """Gives it up.

        >>> ld.Study.of(swept).close()
        """
        self._handle = None

    def __repr__(self) -> str:
        return f"<launchdyn.Study {self.sample(1).title!r}>" if self._handle else "<closed Study>"

    def _repr_html_(self) -> str:
        return self.sample(1)._repr_html_() if self._handle else escape(repr(self))

    def __enter__(self) -> Study:
        return self

    def __exit__(self, *error: Any) -> None:
        self.close()


def _keep(_: int) -> None:
    pass  # what it is part of is freed


def _read_study(read: Callable[..., int], *arguments: Any) -> Handle:
    return read_model(read, *arguments, free=library.ld_study_free)


def _counts(counts: ld_study_counts) -> Counts:
    return Counts(counts.samples, counts.done, counts.failed, counts.now)


class _Work:
    """A study on a thread of its own, so that the one that began it hears Ctrl-C."""

    def __init__(self, study: Handle, folder: PathLike, threads: int, shard: int = 0,
                 shards: int = 0, join: bool = False) -> None:
        self.latest, self.counts, self.error = ld_study_counts(), ld_study_counts(), ld_error()
        self.status = int(Status.OK)
        self.done = -1  # nothing has been reported
        self._stopped = False

        def told(_: Any, counts: Any) -> None:
            latest = ld_study_counts()
            ctypes.pointer(latest)[0] = counts[0]
            self.latest, self.done = latest, latest.done

        def may_continue(_: Any) -> bool:
            return not self._stopped

        self._options = ld_study_options(threads=threads, shard=shard, shards=shards,
                                         progress=COUNTS_TOLD(told), go_on=GO_ON(may_continue))
        run = library.ld_study_join if join else library.ld_study_run
        self._thread = threading.Thread(target=self._run, args=(run, study, coded_path(folder)))

    def _run(self, run: Callable[..., int], study: Handle, folder: bytes) -> None:
        self.status = run(study.pointer, folder, ctypes.byref(self._options),
                          ctypes.byref(self.counts), ctypes.byref(self.error))

    def start(self) -> None:
        self._thread.start()

    def goes_on(self, patience: float) -> bool:
        self._thread.join(patience)
        return self._thread.is_alive()

    def end(self) -> None:
        """Stops it where it still runs, and waits until it has."""
        self._stopped = True
        self._thread.join()


class StudyData(Held):
    """A snapshot of what a study's folder holds, which may still be running. A context manager; it
    need not be closed. One thread at a time: others wait.

    >>> data["range"].shape
    (8,)
    """

    _over = "the study's data are closed"

    def __init__(self, folder: PathLike) -> None:
        """Opens the folder of a study."""
        error, pointer = ld_error(), ctypes.c_void_p()
        check(library.ld_study_data_open(coded_path(folder), ctypes.byref(pointer),
                                         ctypes.byref(error)), error)
        self.folder = Path(folder)
        super().__init__(Handle(pointer.value, library.ld_study_data_close))

    # ---- what is there

    @property
    def columns(self) -> dict[str, StudyColumn]:
        """Results, then factors, by their names.

        >>> data.columns["range"].unit
        'm'
        """
        found: dict[str, StudyColumn] = {}
        while column := library.ld_study_data_column(self._pointer, len(found)):
            c = column[0]
            found[text_of(c.name)] = StudyColumn(text_of(c.name), text_of(c.unit), c.factor,
                                                 c.per_rocket, c.seed)
        return found

    @property
    def results(self) -> list[str]:
        """Names of the results.

        >>> "range" in data.results
        True
        """
        return [name for name, column in self.columns.items() if not column.factor]

    @property
    def factors(self) -> list[str]:
        """Paths of the factors that are drawn.

        >>> data.factors
        ['rocket.mass_error']
        """
        return [name for name, column in self.columns.items() if column.factor]

    @property
    def swept(self) -> list[str]:
        """Paths of the swept keys.

        >>> data.swept
        ['rocket.mass']
        """
        found: list[str] = []
        while path := library.ld_study_data_swept(self._pointer, len(found)):
            found.append(text_of(path))
        return found

    @property
    def points(self) -> list[Point]:
        """Points of the sweep.

        >>> len(data.points)
        2
        """
        swept = self.swept
        found: list[Point] = []
        while point := library.ld_study_data_point(self._pointer, len(found) + 1):
            p = point[0]
            values = {path: text_of(p.text[axis]) for axis, path in enumerate(swept)}
            found.append(Point(p.number, values, p.asked, p.done, p.failed))
        return found

    # ---- numbers

    def values(self, *names: str, point: int = 1) -> dict[str, npt.NDArray[Any]]:
        """Columns by name, in SI, of the samples of a point that went well, with "sample" and
        "rocket" (both from 1); rockets that lack one of the values are left out. Copies.

        `names`: results or factors.

        >>> sorted(data.values("range", point=2))
        ['range', 'rocket', 'sample']
        """
        error = ld_error()
        found = ctypes.POINTER(ld_study_values)()
        with self._lock:
            check_name(library.ld_study_data_values(self._pointer, point, texts(names),
                                                    len(names), ctypes.byref(found),
                                                    ctypes.byref(error)), error)
            v, count = found[0], found[0].count
            taken: dict[str, npt.NDArray[Any]] = {
                "sample": _copy(v.sample, count, np.int64),
                "rocket": _copy(v.rocket, count, np.intc)}
            for column, name in enumerate(names):
                taken[name] = _copy(v.value[column], count, np.float64)
        tell_renamed(*names)
        return taken

    def __getitem__(self, name: str) -> Array:
        """A column at the first point, in SI."""
        return self.values(name)[name]

    def statistics(self, name: str, point: int = 1) -> Statistics:
        """Statistics of a column at a point, in SI.

        `name`: of a result or factor.

        >>> data.statistics("range", point=2).deviation.value > 0
        True
        """
        error = ld_error()
        found = ctypes.POINTER(ld_study_statistics)()
        tell_renamed(name)
        with self._lock:
            check_name(library.ld_study_data_statistics(self._pointer, point, coded(name),
                                                        ctypes.byref(found),
                                                        ctypes.byref(error)), error)
            s = found[0]
            low, middle, high = map(_estimate, s.quantile)
            return Statistics(s.count, s.groups, _estimate(s.mean), _estimate(s.deviation),
                              s.skewness, s.least, s.greatest, (low, middle, high))

    def sensitivity(self, result: str, factor: str, point: int = 1) -> Estimate:
        """What share of the variance of a result a factor explains alone; NaN where the result
        does not scatter, or with too few samples.

        `point`: of the sweep, from 1.

        >>> data.sensitivity("range", "rocket.mass_error").value <= 1
        True
        """
        error, share = ld_error(), ld_estimate()
        tell_renamed(result)
        with self._lock:
            check_name(library.ld_study_data_sensitivity(
                self._pointer, point, coded(result), coded(factor), ctypes.byref(share),
                ctypes.byref(error)), error)
        return _estimate(share)

    def influences(self, result: str, point: int = 1) -> list[Influence]:
        """What each factor does to a result, the greatest first: Sobol indices of the plan
        saltelli, elementary effects of the plan morris, else first-order indices.

        >>> [influence.factor for influence in data.influences("range", point=2)]
        ['rocket.mass_error']
        """
        error, count = ld_error(), ctypes.c_size_t()
        found = ctypes.POINTER(ld_study_influence)()
        tell_renamed(result)
        with self._lock:
            check_name(library.ld_study_data_influences(
                self._pointer, point, coded(result), ctypes.byref(found), ctypes.byref(count),
                ctypes.byref(error)), error)
            return [Influence(text_of(f.factor), _estimate(f.first), _estimate(f.total),
                              _estimate(f.together), _estimate(f.mu_star), _estimate(f.mu),
                              f.sigma, f.count, f.groups) for f in found[:count.value]]

    def footprint(self, share: float, point: int = 1) -> Footprint:
        """The footprint of a point's landings, of a share of 0.95, 0.99 or 0.999.

        >>> landings.footprint(0.95).share
        0.95
        """
        error, found = ld_error(), ctypes.POINTER(ld_study_footprint)()
        with self._lock:
            check(library.ld_study_data_footprint(self._pointer, point, share, ctypes.byref(found),
                                                  ctypes.byref(error)), error)
            f = found[0]
            return Footprint(f.share, f.needed, f.independent, f.stated, _estimate(f.content),
                             _estimate(f.area), _estimate(f.distance))

    def over(self, result: Optional[str], *keys: str, against: Optional[str] = None,
             statistic: str = "mean") -> Cells:
        """A result over the values of one swept key or two (without: the first), pooled over the
        others. `statistic` as of `launchdyn study plot`: "mean", "deviation", "quantile:0.95",
        "share:>20 mrad/s", "footprint" (of no result); `against` a point: paired differences.

        `keys`: the swept keys.

        >>> [round(cell.estimate.value, 1) for cell in data.over("range", "rocket.mass")]
        [8642.2, 8566.5]
        """
        error, count = ld_error(), ctypes.c_size_t()
        found = ctypes.POINTER(ld_study_cell)()
        asked = ld_study_over(result=coded(result) if result else None,
                              over=coded(",".join(keys)) if keys else None,
                              against=coded(against) if against else None,
                              statistic=coded(statistic))
        swept = keys or tuple(self.swept[:1])
        if result:
            tell_renamed(result)
        with self._lock:
            check(library.ld_study_data_pool(self._pointer, ctypes.byref(asked),
                                             ctypes.byref(found), ctypes.byref(count),
                                             ctypes.byref(error)), error)
            cells = [found[i] for i in range(count.value)]
            units = tuple(text_of(unit) for unit in cells[0].unit[:len(swept)])
            return Cells((_cell(c, len(swept)) for c in cells), swept, units, result or statistic)

    def to_pandas(self, *names: str) -> pandas.DataFrame:
        """Columns (all, without names) of all points as a data frame, in SI: swept keys as texts,
        sample, rocket, then the columns, NaN where a rocket lacks a value; units in
        `attrs["units"]`.

        >>> list(data.to_pandas("range"))
        ['rocket.mass', 'sample', 'rocket', 'range']
        """
        pandas, wanted = pandas_here(), names or tuple(self.columns)
        frames = []
        for point in self.points:
            columns = [pandas.DataFrame(self.values(name, point=point.number))
                       .set_index(["sample", "rocket"]) for name in wanted]
            frame = pandas.concat(columns, axis=1).sort_index().reset_index()
            for at, (path, text) in enumerate(point.values.items()):
                frame.insert(at, path, text)
            frames.append(frame)
        whole = pandas.concat(frames, ignore_index=True)
        whole.attrs["units"] = {name: self.columns[name].unit for name in wanted}
        return whole

    def to_xarray(self, *names: str) -> xarray.Dataset:
        """Columns (all, without names) as a data set over `point`, `sample`, `rocket`, each from 1,
        in SI, with `units`; of what is one for all rockets over point and sample; NaN where there
        is not a value. The k-th samples of all points have the same draws; `number` is the one that
        each has in the study. Swept keys are coordinates of the points, as texts.

        >>> data.to_xarray("range")["range"].dims
        ('point', 'sample', 'rocket')
        """
        columns, points = self.columns, self.points
        found = [(at, name, self.values(name, point=point.number))
                 for at, point in enumerate(points) for name in names or columns]
        samples = max((int(v["sample"][-1] - 1) // len(points) + 1 for _, _, v in found
                       if len(v["sample"])), default=0)
        rockets = max((int(v["rocket"].max(initial=0)) for _, _, v in found), default=0)
        shape = {"point": len(points), "sample": samples, "rocket": rockets}
        dimensions = {name: tuple(shape)[:3 if columns[name].per_rocket else 2]
                      for _, name, _ in found}
        arrays = {name: np.full([shape[d] for d in dims], np.nan)
                  for name, dims in dimensions.items()}
        for at, name, v in found:
            places = at, (v["sample"] - 1) // len(points), v["rocket"] - 1
            arrays[name][places[:len(dimensions[name])]] = v[name]
        numbers = np.arange(1, samples * len(points) + 1).reshape(samples, len(points)).T
        counted = {d: np.arange(1, count + 1) for d, count in shape.items()}
        swept = {path: ("point", [point.values[path] for point in points]) for path in self.swept}
        return data_set({name: (dimensions[name], array, {"units": columns[name].unit})
                         for name, array in arrays.items()},
                        {**counted, "number": (("point", "sample"), numbers), **swept})

    # ---- to look at

    def show(self, what: Optional[str] = None, sensitivity: Union[bool, str] = False,
             measured: Optional[PathLike] = None, against: Optional[str] = None,
             over: Union[str, Sequence[str], None] = None,
             statistic: Optional[str] = None) -> str:
        """The tables that `launchdyn study show` prints, of results by name or "all"; compared with
        the `measured` launches of a CSV file; how far points of the sweep are from one, `against`;
        or a row for each value of one swept key or two, `over`, pooled over the others, of means
        and deviations or of one `statistic`. `sensitivity` may name what the plan of the samples
        gives: "total", "first", "morris".

        >>> "range" in data.show("range")
        True
        """
        if isinstance(sensitivity, str) and sensitivity not in _INDICES:
            raise ValueError(f"sensitivity: found {sensitivity!r}, expected one of {_INDICES}")
        index = 1 + _INDICES.index(sensitivity) if isinstance(sensitivity, str) else 0
        error, view = ld_error(), ld_study_view(
            what=coded(what) if what else None, sensitivity=bool(sensitivity), index=index,
            measured=coded_path(measured) if measured else None,
            against=coded(against) if against else None,
            over=coded(over if isinstance(over, str) else ",".join(over)) if over else None)
        status = []
        text = printed(lambda to: status.append(library.ld_study_show_statistic(
            coded_path(self.folder), coded(statistic) if statistic else None, ctypes.byref(view),
            to, ctypes.byref(error))))
        named = what and not (measured or against or over or statistic)
        check_name(status[0], error) if named else check(status[0], error)
        return text

    def export(self, csv: Optional[PathLike] = None, hdf5: Optional[PathLike] = None,
               footprint: Optional[PathLike] = None) -> None:
        """Writes all rockets with their factors and results, in full precision, as a CSV file, as
        an HDF5 file, or as both; the footprints of their landings as a `footprint` file that ends
        in .csv, .kml or .geojson.

        `csv`, `hdf5`, `footprint`: files.

        >>> data.export(csv=folder / "all.csv")
        """
        if not csv and not hdf5 and not footprint:
            raise ValueError("no file given: csv, hdf5, footprint")
        error = ld_error()
        if csv or hdf5:
            check(library.ld_study_export(coded_path(self.folder),
                                          coded_path(csv) if csv else None,
                                          coded_path(hdf5) if hdf5 else None,
                                          ctypes.byref(error)), error)
        if footprint:
            check(library.ld_study_export_footprint(coded_path(self.folder),
                                                    coded_path(footprint),
                                                    ctypes.byref(error)), error)

    def plot(self, *names: str, over: Union[str, Sequence[str], None] = None,
             against: Optional[str] = None, statistic: Optional[str] = None,
             sensitivity: bool = False, ax: Any = None, **style: Any) -> Any:
        """Draws, by matplotlib, how results scatter: histograms, a colour for each point of the
        sweep; `over` a factor as points. `over` one swept key or two: over()'s estimates with
        their intervals, a curve for each value of the second key. `sensitivity`: influences() as
        bars. Returns the axes, or a list of them.

        `names`: results; `against` and `statistic` as in over(); `ax`: axes to draw on;
        `style`: options of their plot().

        >>> axes = data.plot("range", over="rocket.mass_error")
        """
        from .plotting import plot_influences, plot_over, plot_study
        if sensitivity:
            return plot_influences(self, names, ax, style)
        keys = (over,) if isinstance(over, str) else tuple(over or ())
        if against or statistic or len(keys) > 1 or set(keys) & set(self.swept):
            return plot_over(self, names, keys, against, statistic or "mean", ax, style)
        return plot_study(self, names, keys[0] if keys else None, ax, style)

    def write_report(self, file: PathLike) -> None:
        """Writes one HTML file that shows the study in any browser, offline.

        >>> data.write_report(folder / "study.html")
        """
        error, report = ld_error(), ld_report()
        check(library.ld_report_write_studies(texts([str(self.folder)]), 1, coded_path(file),
                                              ctypes.byref(report), ctypes.byref(error)), error)

    def __repr__(self) -> str:
        points = self.points
        return (f"<launchdyn.StudyData {str(self.folder)!r}: points {len(points)}, samples "
                f"{sum(p.done for p in points)} of {sum(p.asked for p in points)}>")

    def _repr_html_(self) -> str:
        return f"<pre>{escape(self.show())}</pre>"


def _copy(pointer: Any, count: int, kind: Any) -> npt.NDArray[Any]:
    return np.array(pointer[:count], kind) if count else np.empty(0, kind)


def _cell(c: ld_study_cell, keys: int) -> Cell:
    return Cell(tuple(text_of(text) for text in c.text[:keys]), tuple(c.number[:keys]),
                _estimate(c.estimate), c.count, c.groups, c.points, c.reference)


def _estimate(e: ld_estimate) -> Estimate:
    return Estimate(e.value, e.low, e.high)


def merge_shards(folder: PathLike) -> StudyData:
    """Joins what the shards of a study have kept in a folder, and opens it. Harmless however
    often, and while shards run, but not while StudyData of the folder is open: FileError.
    Study.run() then runs what is still missing.

    >>> sorted(folder.glob("shards/*")) != []
    True
    >>> ld.merge_shards(folder / "shards").points[0].done
    4
    """
    error, status = ld_error(), []
    printed(lambda to: status.append(library.ld_study_merge(coded_path(folder), to,
                                                            ctypes.byref(error))))
    check(status[0], error)
    return StudyData(folder)


def write_report(folder: PathLike, file: Optional[PathLike] = None) -> Path:
    """Writes one HTML file that shows the run in a folder in any browser, offline: report.html
    there, or `file`.

    >>> ld.write_report(folder / "student", folder / "student.html").name
    'student.html'
    """
    error, report = ld_error(), ld_report()
    check(library.ld_report_write(coded_path(folder), coded_path(file) if file else None,
                                  ctypes.byref(report), ctypes.byref(error)), error)
    return Path(file) if file else Path(folder) / "report.html"
