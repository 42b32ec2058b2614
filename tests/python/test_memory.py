"""Nothing leaks, and threads do not disturb each other."""

import copy
import ctypes
import gc
import pickle
import threading
import unittest
from unittest import mock

import launchdyn as ld
import numpy as np
from launchdyn import _memory
from support import EXAMPLES, FIXED, Case, external, resting_frame, scattered


REFERENCE = EXAMPLES / "reference.yaml"


class Heap(ctypes.Structure):
    _fields_ = [(name, ctypes.c_size_t) for name in
                ("arena", "ordblks", "smblks", "hblks", "hblkhd", "usmblks", "fsmblks",
                 "uordblks", "fordblks", "keepcost")]


libc = ctypes.CDLL(None)
libc.mallinfo2.restype = Heap
libc.mallopt(-8, 1)  # M_ARENA_MAX: threads under load would spread over heaps that are not counted


def in_use():
    """Bytes that are allocated now, of the main thread's heap and of mapped blocks."""
    gc.collect()
    heap = libc.mallinfo2()
    return heap.uordblks + heap.hblkhd


@unittest.skipUnless(in_use(), "a sanitizer's memory is not counted")
class TestLeaks(Case):
    def grows(self, work, repeats=15):
        """Bytes that a repeat leaves behind: the median of the last ones, since the first ones
        fill caches."""
        used = []
        for _ in range(repeats):
            work()
            used.append(in_use())
        grown = np.median(np.diff(used[-repeats // 2:]))
        print(f"{self.id().rpartition('.')[2]}: {grown:.0f} bytes a repeat")
        return grown

    def test_launches(self):
        read = ld.Scenario.read(FIXED, {"run.output_step": "1 ms"})

        def work():
            read["rocket.mass"] = 61
            result = read.run()
            str(result), read.to_yaml()
            return result["tip.y"].sum() + result.summary["rocket.1.exit_speed"]
        self.assertLess(self.grows(work, 60), 100)

    def test_steps(self):
        moved = external()

        def work():
            with moved.begin(resting_frame()) as run:
                run.advance(1e-3)
                run.set_base(resting_frame())
                moved.simulation().load(run.save())
        self.assertLess(self.grows(work), 100)

    def test_refusals(self):
        read = ld.Scenario.read(FIXED)

        def work():
            for wrong in ({"rocket.mas": 1}, {"rocket.mass": "1 m"}):
                with self.assertRaises(ld.InputError):
                    read.set(wrong)
            with self.assertRaises(ld.InputError):
                external().begin()
        self.assertLess(self.grows(work), 100)

    def test_studies(self):
        study = ld.Study.of(scattered(2, **{"run.output_step": "1 ms"}))
        study.run(self.folder / "study")

        def work():
            with study.run(self.folder / "study") as data:
                data.statistics("exit_speed")
        self.assertLess(self.grows(work, 60), 100)  # each on a thread with caches of its own

    def test_an_array_keeps_its_memory_and_no_more(self):
        def arrays(count):
            return [ld.Scenario.read(FIXED).run()["tip.y"] for _ in range(count)]
        arrays(2)
        before = in_use()
        kept = arrays(2)
        self.assertGreater(in_use() - before, 2 * kept[0].nbytes)
        del kept
        self.assertLess(in_use() - before, 10000)


class TestOrder(Case):
    def freed(self, make):
        """What goes while of all that is made a handle is left; what goes with that."""
        free, freed = _memory._free, []

        def noting(function, *arguments):
            freed.append(function.__name__.removeprefix("ld_").removesuffix("_free"))
            free(function, *arguments)
        with mock.patch("launchdyn._memory._free", noting):
            handle = make()
            gc.collect()
            before = len(freed)
            del handle
            gc.collect()
        return freed[:before], freed[before:]

    def test_what_is_made_of_others_keeps_them_and_goes_first(self):
        fixed, marching = (lambda: ld.Scenario.read(FIXED)), (lambda: ld.Scenario.read(REFERENCE))
        launch = ["simulation", "model"]
        for make, before, after in (
                (lambda: fixed().simulation().handle, [], launch),
                (lambda: fixed().begin()._handle, ["summary"], ["_give_up", "history", *launch]),
                (lambda: marching().simulation().begin_vehicle()._handle, [],
                 ["vehicle_run_end", *launch]),
                (lambda: fixed().run()._handle, ["simulation", "history"], ["summary", "model"]),
                (lambda: fixed().response()._handle, [], ["response", "model"]),
                (lambda: marching().loop("elevation")._handle, [], ["loop", "model"]),
                (lambda: marching().road_view()._handle, [], ["road_view", "model"]),
                (lambda: ld.Study.of(scattered(2)).sample(1).handle, ["model"],
                 ["_keep", "sample", "study"])):
            with self.subTest(str(after)):
                self.assertEqual(self.freed(make), (before, after))


class TestCopies(Case):
    def test_what_stands_in_the_librarys_memory_cannot_leave_the_process(self):
        read = ld.Scenario.read(FIXED)
        result = read.run()
        for thing in (read, read.simulation(), result, result.history, result.summary):
            with self.assertRaisesRegex(TypeError, "stay in their process"):
                pickle.dumps(thing)
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(result["tip.y"])), result["tip.y"])

    def test_a_copy_of_a_scenario_is_one_of_its_own(self):
        read = ld.Scenario.read(FIXED, {"rocket.mass": 61})
        for copied in (copy.copy(read), copy.deepcopy(read)):
            copied["rocket.mass"] = 62
            self.assertEqual((read["rocket.mass"], copied["rocket.mass"]), (61, 62))
        result = copy.deepcopy(read.run())
        del read
        gc.collect()
        self.assertEqual(len(result["tip.y"]), result.history.rows)


class TestThreads(Case):
    def test_two_threads_over_one_simulation(self):
        simulation = ld.Scenario.read(FIXED).simulation()
        expected = simulation.run()
        found, failed = [], []

        def work(number):
            try:
                for repeat in range(2):
                    found.append(simulation.run(out=self.folder / f"{number}-{repeat}"))
            except BaseException as error:
                failed.append(error)
        threads = [threading.Thread(target=work, args=(i,)) for i in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual((failed, len(found)), ([], 4))
        for result in found:
            for name in expected.history:
                np.testing.assert_array_equal(result[name], expected[name], name)

    def test_two_threads_over_one_run(self):
        read = ld.Scenario.read(FIXED)
        expected, failed = read.run(), []
        with read.begin() as run:
            def work():
                try:
                    while not run.finished:
                        try:
                            run.advance(run.time + 1e-3)
                        except ld.InputError:
                            pass  # the other one has been faster
                        run["tip.y"], run.row(), run.wrench()
                except BaseException as error:
                    failed.append(error)
            threads = [threading.Thread(target=work) for _ in range(2)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            self.assertEqual(failed, [])
            result = run.end()
        np.testing.assert_array_equal(result["tip.y"], expected["tip.y"])


if __name__ == "__main__":
    unittest.main()
