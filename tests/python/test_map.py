"""Studies on executors: the bits of one process, workers killed, stopping rules, resumption."""

import os
import signal
import subprocess
import sys
import threading
import unittest
from concurrent.futures import Future, ProcessPoolExecutor, ThreadPoolExecutor
from unittest import mock

import launchdyn as ld
import numpy as np
from launchdyn import _mapping
from support import EXAMPLES, Case, flights, needs, scattered


class Counting(ThreadPoolExecutor):
    """Notes what it is given."""

    def __init__(self):
        super().__init__(2)
        self.asked = []

    def submit(self, work, /, *arguments):
        self.asked.append(arguments[-2:])
        return super().submit(work, *arguments)


class Losing(Counting):
    """Loses some tasks, as an engine does whose worker was killed."""

    def __init__(self, lost):
        super().__init__()
        self.lost = lost

    def submit(self, work, /, *arguments):
        part = super().submit(work, *arguments)
        if self.lost(len(self.asked), arguments[-2:]):
            part = Future()
            part.set_exception(type("KilledWorker", (Exception,), {})("gone"))
        return part


class TestMap(Case):
    def expect_same(self, data, name="range"):
        """The same table as one process has."""
        whole = self.study.run(self.folder / "one")
        for point in range(1, len(whole.points) + 1):
            found, expected = (d.values(name, *whole.factors, point=point) for d in (data, whole))
            for column, values in expected.items():
                np.testing.assert_array_equal(found[column], values, column)
        tables = [self.folder / f"{which}.csv" for which in ("one", "other")]
        whole.export(tables[0])
        data.export(tables[1])
        self.assertEqual(*(table.read_bytes() for table in tables))

    def test_threads(self):
        self.study = ld.Study.of(scattered(6, sweep={"base.elevation": ["10 deg", "20 deg"]}))
        told = []
        with ThreadPoolExecutor(2) as threads:
            data = self.study.map(threads, self.folder / "mapped", progress=told.append)
            self.assertEqual(told[-1], ld.Counts(12, 12, 0, 12))
        with Counting() as threads:
            again = self.study.map(threads, self.folder / "mapped", progress=told.append)
            self.assertEqual(threads.asked, [])
        self.assertEqual(told[-1].now, 0)
        self.expect_same(data, "exit_speed")
        self.assertEqual([p.done for p in again.points], [6, 6])

    def test_failed_samples_are_kept_with_their_reason(self):
        self.study = ld.Study.of(ld.Scenario.read(EXAMPLES / "fixed.yaml", {
            "scatter.samples": 6, "run.stuck_time": "0.2 s", "scatter.factors": {
                "rocket.lock.release_force": {"uniform": "1 25 kN"}}}))
        with ThreadPoolExecutor(1) as threads:
            data = self.study.map(threads, self.folder / "mapped")
        self.assertGreater(data.points[0].failed, 0)
        self.expect_same(data, "exit_speed")
        self.assertEqual(data.show(), self.study.run(self.folder / "one").show())

    def test_processes_killed(self):
        self.study = ld.Study.of(flights(10000))
        pools, killed = [], []

        def make():
            pools.append(ProcessPoolExecutor(2))
            return pools[-1]

        def kill(counts):
            due = 500 * (len(killed) + 1)
            if len(killed) < 4 and len(pools) > len(killed) and counts.done >= due:
                killed.append(next(iter(pools[-1]._processes)))
                os.kill(killed[-1], signal.SIGKILL)
        data = self.study.map(make, self.folder / "mapped", progress=kill)
        self.assertEqual((len(killed), len(pools)), (4, 5))
        self.expect_same(data)

    def test_a_process_killed_while_it_answers(self):
        self.study = ld.Study.of(flights(3000))
        pools, killed = [], []

        def make():
            pools.append(ProcessPoolExecutor(1))
            return pools[-1]

        def cut(counts):
            if not killed:  # once: what is left of an answer whose process was killed
                killed.extend(pools[0]._processes)
                os.write(pools[0]._result_queue._writer.fileno(), b"\0\0\x10\0half")
                os.kill(killed[0], signal.SIGKILL)
        with mock.patch.object(_mapping, "SILENCE", 1.0):
            data = self.study.map(make, self.folder / "mapped", progress=cut)
        self.assertEqual(len(pools), 2)
        self.expect_same(data)

    def test_processes_of_ones_own(self):
        self.study = ld.Study.of(flights(3000))
        with ProcessPoolExecutor(1) as processes:
            self.study.map(processes, self.folder / "mapped")
            # its processes live, and hold no lock
            data = self.study.run(self.folder / "mapped")
            self.expect_same(data)
            os.kill(next(iter(processes._processes)), signal.SIGKILL)
            with self.assertRaisesRegex(ld.LaunchdynError, "give map.. a function that makes"):
                self.study.map(processes, self.folder / "broken")

    def test_lost_ranges_run_again(self):
        self.study = ld.Study.of(flights(500))
        lost = set()

        def every_third(number, asked):  # but no range again and again: that ends the study
            if number % 3 or asked in lost:
                return False
            lost.add(asked)
            return True
        with Losing(every_third) as losing:
            data = self.study.map(losing, self.folder / "mapped")
        self.assertGreater(len(lost), 0)
        self.expect_same(data)
        with Losing(lambda _, asked: asked[0] <= 100 <= asked[1]) as losing, \
                self.assertRaisesRegex(ld.LaunchdynError, "have cost 6 workers"):
            self.study.map(losing, self.folder / "cursed")
        kept = ld.StudyData(self.folder / "cursed")
        self.assertNotIn(100, kept.values("range")["sample"])

    def test_ranges_are_put_together(self):
        self.study = ld.Study.of(flights(8100))
        with Counting() as counting:
            self.expect_same(self.study.map(counting, self.folder / "mapped", ahead=4))
        asked = sorted(counting.asked)
        self.assertEqual([first for first, _ in asked], [1, *(last + 1 for _, last in asked[:-1])])
        lengths = [last - first + 1 for first, last in asked]
        self.assertLessEqual(max(lengths), 3 * _mapping.MOST_RANGES)
        self.assertLess(len(asked), 500)

    def test_stopping_rules(self):
        rule = {"scatter.until": {"exit_speed.mean": "0.2 %"}}
        self.study = ld.Study.of(scattered(300, **rule))
        with Counting() as counting:
            data = self.study.map(counting, self.folder / "mapped")
        self.assertTrue(20 < data.points[0].done < 300)
        self.assertLessEqual(max(last for _, last in counting.asked), data.points[0].done)
        self.expect_same(data, "exit_speed")

    def test_interrupted_it_goes_on(self):
        self.study = ld.Study.of(flights(10000))

        def interrupt(counts):
            os.kill(os.getpid(), signal.SIGINT)
        with self.assertRaises(KeyboardInterrupt):
            self.study.map(lambda: ProcessPoolExecutor(2), self.folder / "mapped",
                           progress=interrupt)
        kept = ld.StudyData(self.folder / "mapped").points[0].done
        self.assertTrue(0 < kept < 10000)
        told = []
        data = self.study.map(lambda: ThreadPoolExecutor(2), self.folder / "mapped",
                              progress=told.append)
        self.assertEqual(told[-1], ld.Counts(10000, 10000, 0, 10000 - kept))
        self.expect_same(data)

    def test_errors(self):
        study = ld.Study.of(flights(50))
        threads = threading.active_count()
        part, _ = _mapping.run_range(_mapping.pack_study(study), 1, 3)
        other = ld.Study.of(flights(51).derive({"rocket.mass": "70 kg"}))
        with _mapping._Keeper(other.handle, self.folder / "other") as keeper:
            with self.assertRaisesRegex(ld.InputError, "another scenario, or another version"):
                keeper.put(part)
            with self.assertRaisesRegex(ld.InputError, "damaged"):
                keeper.put(part[:-8])
            self.assertEqual(keeper.counts.done, 0)
        with self.assertRaisesRegex(ld.InputError, "they go from 1 to 50"):
            _mapping.run_range(_mapping.pack_study(study), 50, 51)
        with self.assertRaises(ld.InputError), ThreadPoolExecutor(1) as pool:
            ld.Study.read(EXAMPLES / "fixed.yaml").map(pool, self.folder / "nothing varies")
        self.assertEqual(threading.active_count(), threads)

    @needs("distributed")
    def test_dask(self):
        script = self.folder / "dask_study.py"
        script.write_text(DASK.format(examples=EXAMPLES))
        done = subprocess.run([sys.executable, "-B", script, self.folder], capture_output=True,
                              text=True, timeout=3000,
                              env={**os.environ, "DASK_TEMPORARY_DIRECTORY": str(self.folder)})
        self.assertEqual(done.returncode, 0, done.stderr[-3000:])
        self.study = ld.Study.of(flights(10000))
        with ld.StudyData(self.folder / "mapped") as data:
            self.assertEqual(data.points[0].done, 10000)
            self.expect_same(data)
        killed = int(done.stdout.split()[-1])
        self.assertGreaterEqual(killed, 2)


#: A study on a cluster of Dask, of two processes, which are killed again and again.
DASK = """
import os, signal, sys
import launchdyn as ld
from distributed import Client, LocalCluster

killed = []

if __name__ == "__main__":
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True,
                      dashboard_address=None) as cluster, Client(cluster) as client:
        def kill(counts):
            if len(killed) < 3 and counts.done >= 1000 * (len(killed) + 1):
                worker = list(cluster.workers.values())[len(killed) % 2]
                if worker.pid:
                    killed.append(worker.pid)
                    os.kill(worker.pid, signal.SIGKILL)
        study = ld.Study.of(ld.Scenario.read("{examples}/flight.yaml", {{
            "scatter.samples": 10000,
            "scatter.factors": {{"rocket.mass": {{"normal": "0.1 kg"}}}}}}))
        study.map(client.get_executor(), sys.argv[1] + "/mapped", progress=kill)
        print(len(killed))
"""


if __name__ == "__main__":
    unittest.main()
