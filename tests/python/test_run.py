"""Runs that are stepped: the bits of runs in one go, inputs, saving, vehicles alone."""

import io
import math
import os
import signal
import sys
import unittest
from unittest import mock

import launchdyn as ld
import numpy as np
from launchdyn import _progress
from launchdyn._library import library
from support import EXAMPLES, FIXED, Case, external, flights, resting_frame


class TestRun(Case):
    def test_steps_change_no_bit(self):
        read = ld.Scenario.read(FIXED)
        whole = read.run()
        with read.begin() as run:
            while not run.finished:
                run.advance(run.time + 7.3e-3)
            stepped = run.end()
        for name in whole.history:
            np.testing.assert_array_equal(stepped[name], whole[name], name)
        self.assertEqual(stepped.summary["rocket.1.pitch_rate"],
                         whole.summary["rocket.1.pitch_rate"])

    def test_events(self):
        with ld.Scenario.read(FIXED).begin() as run:
            events = list(run.events())
            self.assertEqual([e.kind.name for e in events],
                             ["IGNITION", "RELEASE", "CORNER", "EXIT", "EXIT", "EXIT", "END"])
            self.assertEqual([e.part for e in events][3:6], [3, 2, 1])
            self.assertIsNone(run.advance_to_event())
            result = run.end()
        self.assertEqual(events[5].t, result.summary["rocket.1.t_rear"])

    def test_an_event_beyond_the_time_does_not_come(self):
        with ld.Scenario.read(FIXED).begin() as run:
            self.assertEqual(run.advance_to_event(1e-3).kind, ld.EventKind.IGNITION)
            self.assertIsNone(run.advance_to_event(1e-3))
            self.assertEqual(run.time, 1e-3)

    def test_looked_at(self):
        read = ld.Scenario.read(FIXED)
        whole = read.run()
        with read.begin() as run:
            run.advance(0.05)
            row = dict(zip(run.simulation.columns, run.row()))
            at = np.flatnonzero(whole["t"] == row["t"])[0]
            for name in ("tip.y", "rocket.s", "contact.rear.force"):
                self.assertEqual(run[name], row[name])
                self.assertEqual(run[name], whole[name][at])
            with self.assertRaises(ld.UnknownName):
                run["tip.yy"]
            self.assertIn("rocket.1.t_front", run.quantities())
            self.assertEqual(len(run.wrench().force), 3)
            self.assertEqual(run.simulation.columns["tip.y"].unit, "m")

    def test_ignited_later(self):
        with ld.Scenario.read(FIXED, {"run.lead_in": 0.05}).begin() as run:
            run.ignite(0.02)
            run.advance()
            result = run.end()
        first = ld.Scenario.read(FIXED).run()
        self.assertAlmostEqual(result["t"][-1] - first["t"][-1], 0.02, 6)
        with ld.Scenario.read(FIXED).begin() as run:
            run.advance(0.01)
            with self.assertRaisesRegex(ld.InputError, "no rocket waits"):
                run.ignite(0.02)
            with self.assertRaises(ld.InputError):
                run.advance(0.005)

    def test_saved_and_loaded(self):
        read = ld.Scenario.read(FIXED)
        simulation = read.simulation()
        with simulation.begin() as run:
            run.advance(0.03)
            saved = run.save()
            run.advance()
            whole = run.end()
        with simulation.load(saved) as run:
            self.assertEqual(run.time, 0.03)
            run.advance()
            rest = run.end()
        for name in ("tip.y", "rocket.s", "q1_dot"):
            np.testing.assert_array_equal(rest[name], whole[name][-len(rest[name]):], name)
        with self.assertRaisesRegex(ld.InputError, "."):
            simulation.load(saved[:-1])
        with self.assertRaises(ld.InputError):
            read.derive({"rocket.mass": 61}).simulation().load(saved)

    def test_given_up_and_ended_early(self):
        read = ld.Scenario.read(FIXED)
        with read.begin(out=self.folder / "given up") as run:
            run.advance(0.01)
        with self.assertRaisesRegex(ValueError, "has ended"):
            run.advance(0.02)
        del run
        self.assertFalse((self.folder / "given up").exists())
        run = read.begin(out=self.folder / "early")
        run.advance(0.01)
        result = run.end()
        self.assertTrue(result.stopped)
        self.assertTrue((self.folder / "early/history.h5").exists())
        with self.assertRaisesRegex(ValueError, "has ended"):
            run.end()


class TestInterrupted(Case):
    """Ctrl-C while the library continues; it comes at a call of it, however fast that is."""

    def press_at(self, name, call):
        """Ctrl-C is pressed at that call of a function of the library."""
        function, calls = getattr(library, name), []

        def pressed(*arguments):
            calls.append(1)
            status = function(*arguments)
            if len(calls) == call:
                os.kill(os.getpid(), signal.SIGINT)
            return status
        patch = mock.patch.object(library, name, pressed)
        patch.start()
        self.addCleanup(patch.stop)
        return patch

    def test_it_stops_a_long_way_and_can_go_on(self):
        read = ld.Scenario.read(FIXED)
        whole = read.run()
        patch = self.press_at("ld_run_advance", 3)
        with read.begin() as run:
            with self.assertRaises(KeyboardInterrupt):
                run.advance()
            patch.stop()
            self.assertLess(run.time, 0.04)
            self.assertGreater(run.time, 0.015)
            run.advance()
            result = run.end()
        for name in whole.history:
            np.testing.assert_array_equal(result[name], whole[name], name)

    def test_no_event_is_lost(self):
        read, heard = ld.Scenario.read(FIXED), []
        with read.begin() as run:
            expected = list(run.events())
        for call in range(1, 16):
            patch, interrupted = self.press_at("ld_run_advance_to_event", call), 0
            with read.begin() as run:
                heard.clear()
                for _ in range(2):
                    try:
                        for event in run.events():
                            heard.append(event)
                    except KeyboardInterrupt:
                        interrupted += 1
            patch.stop()
            self.assertEqual((heard, interrupted), (expected, 1), call)

    def test_it_stops_flights(self):
        shares = []

        def progress(share):
            shares.append(share)
            if share > 0.3:
                os.kill(os.getpid(), signal.SIGINT)
        flight = ld.Scenario.read(EXAMPLES / "flight.yaml")
        run = flight.begin(out=self.folder / "out")
        with self.assertRaises(KeyboardInterrupt):
            run.end(progress)
        self.assertLess(shares[-1], 0.4)
        self.assertIs(signal.getsignal(signal.SIGINT), signal.default_int_handler)
        self.assertIn('"complete": false', (self.folder / "out/summary.json").read_text())
        with self.assertRaisesRegex(ValueError, "has ended"):
            run.end()
        with self.assertRaises(ZeroDivisionError):
            flight.begin().end(lambda share: 1 / 0)
        heard = []
        self.assertIsNone(flight.begin().end(heard.append).stopped)
        self.assertGreater(heard[-1], 0.99)


class TestProgress(Case):
    def bar(self):
        """A bar with its text and with a clock that is set."""
        stream, now = io.StringIO(), [0.0]
        return _progress.Bar(stream, lambda: now[0]), stream, now

    def test_of_a_share(self):
        bar, stream, now = self.bar()
        for now[0], share in ((0.1, 0.1), (1.0, 0.25), (1.1, 0.3), (2.0, 0.8)):
            bar(share)
        self.assertEqual(stream.getvalue().split("\r"), [
            "", f"[{'#' * 10}{'.' * 30}]  25 %, 3 s left",
            f"[{'#' * 32}{'.' * 8}]  80 %, 0 s left"])
        bar.end()
        self.assertRegex(stream.getvalue(), "\r {50,60}\r$")

    def test_of_counts(self):
        bar, stream, now = self.bar()
        now[0] = 2.0
        bar(ld.Counts(samples=100, done=60, failed=1, now=10))
        self.assertEqual(stream.getvalue(), "\r60 of 100 samples, 1 failed, 8 s left")

    def test_nobody_sees_it_but_in_terminals_and_notebooks(self):
        read = ld.Scenario.read(FIXED)
        for names, modules in (((), {}), (("stderr",), {}), (("stdout",), {"ipykernel": math})):
            streams = {"stdout": io.StringIO(), "stderr": io.StringIO()}
            for name in names:
                streams[name].isatty = lambda: True
            with mock.patch.multiple(sys, **streams), mock.patch.dict(sys.modules, modules), \
                    mock.patch("launchdyn._progress.PATIENCE", 0):
                read.run(progress=True)
                with read.begin() as run:
                    run.advance()
                    run.end(True)
                ld.Study.of(flights(2)).run(self.folder / f"study{len(names)}{len(modules)}",
                                            progress=True)
            shown = [name for name, stream in streams.items() if stream.getvalue()]
            self.assertEqual(shown, list(names))
            for name in names:
                self.assertIn("%, ", streams[name].getvalue())
                self.assertIn("2 of 2 samples", streams[name].getvalue())


class TestExternalBase(Case):
    def test_a_base_at_rest_is_a_fixed_one(self):
        fixed = ld.Scenario.read(FIXED).run()
        with external().begin(resting_frame()) as run:
            while not run.finished:
                run.advance(run.time + 1e-3)
                if not run.finished:
                    run.set_base(resting_frame())
            told = run.end()
        for name in ("pitch_rate", "yaw_rate", "exit_speed"):
            apart = told.summary[f"rocket.1.{name}"] - fixed.summary[f"rocket.1.{name}"]
            self.assertLess(abs(apart), 2e-5, name)  # within the tolerance of 1e-5

    def test_it_must_be_told_at_the_start(self):
        for start in (external().begin, external().run):
            with self.assertRaises(ld.InputError):
                start()

    def test_wrong_frames(self):
        with external().begin(resting_frame()) as run:
            with self.assertRaises(ld.InputError):
                run.set_base(ld.BaseFrame((0, 0, 0), (2, 0, 0, 0)))
            with self.assertRaises(ld.InputError):
                run.set_base(ld.BaseFrame((math.nan, 0, 0)))
            with self.assertRaises((TypeError, ValueError, RuntimeError)):
                run.set_base(ld.BaseFrame((0, 0, 0, 0)))
        with ld.Scenario.read(FIXED).begin() as run:
            with self.assertRaises(ld.InputError):
                run.set_base(resting_frame())

    def test_our_vehicle_beside_our_launcher(self):
        """docs/coupling.md: every 1 ms exit rates within 0.13 mrad/s of all together."""
        whole = ld.Scenario.read(EXAMPLES / "reference.yaml",
                                 {"run.end": "tip", "run.lead_in": "0.1 s"})
        together = whole.run()
        vehicle = whole.simulation().begin_vehicle()
        launcher = ld.Scenario.read(EXAMPLES / "fixed.yaml", {
            "base.kind": "external", "base.elevation": None, "run.lead_in": "0.1 s"})
        with vehicle, launcher.begin(vehicle.frame()) as run:
            self.assertEqual(vehicle.time, run.time)
            while not run.finished:
                vehicle.set_wrench(run.wrench())
                t = run.time + 1e-3
                run.advance(t)
                if run.finished:
                    break
                vehicle.advance(t)
                run.set_base(vehicle.frame())
            apart = run.end()
            self.assertEqual(len(vehicle.row()), len(vehicle.columns))
        for name in ("pitch_rate", "yaw_rate"):
            difference = apart.summary[f"rocket.1.{name}"] - together.summary[f"rocket.1.{name}"]
            self.assertLess(abs(difference), 0.13e-3, name)
        with self.assertRaisesRegex(ValueError, "has ended"):
            vehicle.advance(10)


if __name__ == "__main__":
    unittest.main()
