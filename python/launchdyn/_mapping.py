"""A study on executors of concurrent.futures: a process hands out ranges of samples and keeps what
comes back; those that run them need the package alone."""

from __future__ import annotations

import ctypes
import time
from collections import deque
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from types import TracebackType
from typing import TYPE_CHECKING, Callable, Optional, Union

from ._interrupt import Interrupt
from ._library import GO_ON, ld_error, ld_study_counts, ld_study_options, ld_study_range, library
from ._memory import Handle, PathLike, coded_path
from .errors import LaunchdynError, check
from .scenario import read_model

if TYPE_CHECKING:
    from .study import Study

Range = tuple[int, int]  #: numbers of the first sample and the last
Part = Future[tuple[bytes, float]]
#: An executor, or what makes one, again where its workers are gone.
Executors = Union[Executor, Callable[[], Executor]]
#: How often, in seconds, the program that waits for the parts looks up.
LOOK_UP = 0.1
#: What a task is to take, in seconds: ranges that take less are put together, up to MOST_RANGES.
TASK, MOST_RANGES = 0.5, 64
#: How often a range is lost, or an executor breaks between two parts, before the study gives up.
MOST_LOST = 5
#: How long, in seconds, a pool of processes may be silent one of which is dead: killed in the midst
#: of its answer, it leaves the pool waiting for the rest.
SILENCE = 3.0
#: What engines raise where the worker of a task is gone: Dask, Ray, Parsl, or a task cancelled.
LOST = {"KilledWorker", "WorkerCrashedError", "WorkerLost", "ManagerLost", "CancelledError"}

_latest: tuple[bytes, Optional[Study]] = (b"", None)  # that this process has read


def pack_study(study: Study) -> bytes:
    """The whole of a study: the texts that it was read from."""
    error, packed, size = ld_error(), ctypes.c_void_p(), ctypes.c_size_t()
    check(library.ld_study_pack(study.handle.pointer, ctypes.byref(packed), ctypes.byref(size),
                                ctypes.byref(error)), error)
    return _taken(packed, size)


def _taken(memory: ctypes.c_void_p, size: ctypes.c_size_t) -> bytes:
    taken = ctypes.string_at(memory.value or 0, size.value)
    library.ld_free(memory)
    return taken


def run_range(packed: bytes, first: int, last: int) -> tuple[bytes, float]:
    """Runs some samples of a study on one thread of any process: what its keeper gets, and how long
    it took."""
    global _latest
    from .study import Study
    began = time.monotonic()
    study = _latest[1] if _latest[0] == packed else None
    if study is None:
        study = Study(read_model(library.ld_study_unpack, packed, len(packed),
                                 free=library.ld_study_free))
        _latest = (packed, study)
    error, part, size = ld_error(), ctypes.c_void_p(), ctypes.c_size_t()
    asked = ld_study_range(first, last)
    with Interrupt() as interrupt:
        options = ld_study_options(go_on=GO_ON(lambda _: not interrupt.asked))
        check(library.ld_study_run_range(study.handle.pointer, ctypes.byref(asked),
                                         ctypes.byref(options), ctypes.byref(part),
                                         ctypes.byref(size), ctypes.byref(error)), error)
    return _taken(part, size), time.monotonic() - began


class _Keeper:
    """The folder of a study whose ranges run elsewhere."""

    def __init__(self, study: Handle, folder: PathLike) -> None:
        error, self._keeper = ld_error(), ctypes.c_void_p()
        self._study = study
        check(library.ld_study_keeper_open(study.pointer, coded_path(folder),
                                           ctypes.byref(self._keeper), ctypes.byref(error)), error)

    def next(self) -> Optional[Range]:
        found = ld_study_range()
        there = library.ld_study_keeper_next(self._keeper, ctypes.byref(found))
        return (found.first, found.last) if there else None

    def put(self, part: bytes) -> None:
        error = ld_error()
        check(library.ld_study_keeper_put(self._keeper, part, len(part), ctypes.byref(error)),
              error)

    @property
    def counts(self) -> ld_study_counts:
        counts = ld_study_counts()
        library.ld_study_keeper_counts(self._keeper, ctypes.byref(counts))
        return counts

    def __enter__(self) -> _Keeper:
        return self

    def __exit__(self, kind: Optional[type[BaseException]], raised: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        error = ld_error()
        status = library.ld_study_keeper_close(self._keeper, ctypes.byref(error))
        if raised is None:
            check(status, error)


class _Pool:
    """An executor that is made again where it breaks."""

    def __init__(self, executors: Executors) -> None:
        self._make = None if isinstance(executors, Executor) else executors
        self._executor = executors if isinstance(executors, Executor) else executors()

    def submit(self, packed: bytes, asked: Range) -> Part:
        return self._executor.submit(run_range, packed, *asked)

    def renew(self, why: BaseException) -> None:
        if self._make is None:
            raise LaunchdynError(
                f"the executor has lost a worker and takes no more work ({why}): what came back "
                "is kept; give map() a function that makes the executor") from why
        self._executor.shutdown(wait=False)
        self._executor = self._make()

    def has_dead(self) -> bool:
        """Whether a process of a ProcessPoolExecutor has ended."""
        processes = getattr(self._executor, "_processes", None) or {}
        return any(not process.is_alive() for process in list(processes.values()))

    def release(self) -> None:
        """Ends a pool that waits for an answer cut short: its end comes once no one can write."""
        for process in list((getattr(self._executor, "_processes", None) or {}).values()):
            process.kill()
        writer = getattr(getattr(self._executor, "_result_queue", None), "_writer", None)
        if writer is not None:
            writer.close()

    def close(self, patient: bool) -> None:
        if self._make is not None:
            self._executor.shutdown(wait=patient)


class MappedStudy:
    """The ranges of a study on their way."""

    def __init__(self, study: Study, keeper: _Keeper, executors: Executors,
                 ahead: int) -> None:
        """At most `ahead` tasks at a time."""
        self._packed, self._ahead = pack_study(study), ahead
        self._keeper, self._pool = keeper, _Pool(executors)
        self._again: deque[Range] = deque()
        self._lost: dict[Range, int] = {}
        self._broken = 0
        self._away: dict[Part, Range] = {}
        self._heard = time.monotonic()  # when a part came back
        self._next: Optional[Range] = None  # handed out, not yet part of a task
        self._samples = 1  # that take TASK

    def _next_task(self) -> Optional[Range]:
        if self._again:
            return self._again.popleft()
        task, self._next = self._next or self._keeper.next(), None
        for _ in range(1, MOST_RANGES):
            if task is None:
                return None
            more = self._next = self._keeper.next()
            if more is None or more[0] != task[1] + 1 or more[1] - task[0] >= self._samples:
                return task
            task, self._next = (task[0], more[1]), None
        return task

    def _submit(self) -> None:
        while len(self._away) < self._ahead:
            asked = self._next_task()
            if asked is None:
                return
            try:
                self._away[self._pool.submit(self._packed, asked)] = asked
            except BrokenExecutor as why:
                self._again.append(asked)
                self._renew(why)

    def _renew(self, why: BaseException) -> None:
        """All that is away is lost, apart from what has come back just now."""
        self._broken += 1
        for part in [part for part in self._away if part.done() and not part.exception()]:
            self._take(part)
        self._again.extend(self._away.values())
        self._away.clear()
        if self._broken > MOST_LOST:
            raise LaunchdynError(f"executors broke {self._broken} times without a range of "
                                 f"samples in between ({why})") from why
        self._pool.renew(why)

    def _lose(self, asked: Range, why: BaseException) -> None:
        self._lost[asked] = self._lost.get(asked, 0) + 1
        if self._lost[asked] > MOST_LOST:
            raise LaunchdynError(f"samples {asked[0]} to {asked[1]} have cost {MOST_LOST + 1} "
                                 f"workers ({why})") from why
        self._again.append(asked)

    def _take(self, part: Part) -> None:
        asked = self._away.pop(part)
        try:
            records, seconds = part.result()
            self._keeper.put(records)
            self._broken = 0
            self._samples = int((asked[1] - asked[0] + 1) * TASK / max(seconds, 1e-9))
        except BrokenExecutor as why:
            self._again.append(asked)
            self._renew(why)
        except BaseException as why:
            if type(why).__name__ not in LOST:
                raise
            self._lose(asked, why)

    def step(self) -> bool:
        """Waits a little for what comes back; whether there is more."""
        self._submit()
        done, _ = wait(self._away, LOOK_UP, FIRST_COMPLETED)
        now = time.monotonic()
        if done or not self._pool.has_dead():
            self._heard = now
        for part in done:
            if part in self._away:
                self._take(part)
        if now - self._heard > SILENCE:
            self._heard = now
            self._pool.release()
            self._renew(BrokenExecutor("a process was killed while it answered"))
        self._submit()  # a stopping rule may want more now
        return bool(self._away or self._again or self._next)

    def end(self, patient: bool) -> None:
        """Gives up what is not done."""
        for part in self._away:
            part.cancel()
        self._pool.close(patient)
