"""Runs in one go: the bits of the command, columns, numbers, what ends them early."""

import json
import math
import os
import re
import signal
import sys
import threading
import unittest
import warnings
from unittest import mock

import launchdyn as ld
import numpy as np
from launchdyn._library import library
from support import EXAMPLES, FIXED, Case, command, external, needs, written


class TestBits(Case):
    def compare(self, example, *sets):
        """The same launch by the command and by the package, in memory and in files."""
        theirs, ours = self.folder / "command", self.folder / "package"
        options = [word for text in sets for word in ("--set", text)]
        command("run", EXAMPLES / example, "--csv", "-q", "--out", theirs, *options)
        result = ld.Scenario.read(EXAMPLES / example, sets).run(out=ours, csv=True)
        self.assertEqual(sorted(os.listdir(theirs)), sorted(os.listdir(ours)))
        for file in ("history.csv", "history.h5"):
            self.assertEqual((theirs / file).read_bytes(), (ours / file).read_bytes())
        expected = written(theirs / "history.csv")
        if expected:
            self.assertEqual(list(expected), list(result.history))
            for name, values in expected.items():
                np.testing.assert_array_equal(result[name], values, name)
        return result, json.loads((theirs / "summary.json").read_text())

    def test_a_launch(self):
        result, summary = self.compare("fixed.yaml", "run.end=tip")
        rocket = summary["rockets"][0]
        self.assertEqual(result.summary["rocket.1.exit_speed"], rocket["exit_speed"])
        self.assertGreater(len(result["t"]), 1000)
        self.assertEqual(len(result.history), len(result.history.columns))

    def test_a_vehicle_and_its_rocket_to_the_ground(self):
        result, summary = self.compare("reference.yaml", "run.output_step=1 ms",
                                       "run.lead_in=0.1 s")
        flight = result.flight(1)
        self.assertEqual(list(result.flights), [1])
        expected = written(self.folder / "command/flights.csv")
        for name in flight:
            np.testing.assert_array_equal(flight[name], expected[name], name)
        self.assertEqual(result.summary["rocket.1.range"], summary["rockets"][0]["flight"]["range"])

    def test_columns_are_shown_in_groups(self):
        result = ld.Scenario.read(EXAMPLES / "fixed.yaml", {"run.end": "tip"}).run()
        columns = result.history.columns
        shown = repr(columns)
        self.assertRegex(shown, rf"^<{len(columns)} names: t, .*; tip\.{{y, z, .*>$")
        self.assertLess(len(shown), 3000)
        # each name stands in it once
        names = [prefix + last for prefix, several, one in
                 re.findall(r"(?:; |: |, )((?:[^;{}]*\.)?)(?:{([^}]*)}|([^;{}.>]+))", shown)
                 for last in (several or one).split(", ")]
        self.assertEqual(sorted(names), sorted(columns))
        self.assertEqual(columns["tip.y"].unit, "m")
        self.assertIsInstance(columns, dict)

    def test_where_a_column_of_the_flight_is(self):
        result = ld.Scenario.read(EXAMPLES / "reference.yaml", {"run.output_step": "5 ms",
                                                                "run.lead_in": "0 s"}).run()
        for ask in (lambda: result["altitude"], lambda: result.plot("altitude"),
                    lambda: result.plot("tip.y", over="altitude")):
            with self.assertRaisesRegex(ld.UnknownName,
                                        r'"altitude" is a column of the flight: flight\(1\)'):
                ask()
        with self.assertRaisesRegex(ld.UnknownName, 'did you mean "tip.y"'):
            result.plot("tip.yy")

    def test_none_takes_away_what_another_base_has(self):
        with self.assertRaisesRegex(ld.InputError, "base.elevation: is not allowed with"):
            ld.Scenario.read(FIXED, {"base.kind": "external"})
        for example, keys in (("fixed", ()), ("reference", ("platform",)),
                              ("salvo", ("platform", "scatter")), ("ship-sea", ("scatter",)),
                              ("marching/ramp", ("platform", "measures"))):
            changes = {"base": None, "base.kind": "external"} | dict.fromkeys(keys)
            scenario = ld.Scenario.read(EXAMPLES / f"{example}.yaml", changes)
            with scenario.begin(ld.BaseFrame((0, 0, 0), (1, 0, 0, 0))) as run:
                self.assertEqual(len(run.wrench()), 2)

    def test_a_flight_alone(self):
        result = ld.Scenario.read(EXAMPLES / "flight.yaml").run()
        self.assertEqual(result.rockets, 1)
        self.assertIs(type(result["altitude"]), np.ndarray)
        self.assertAlmostEqual(result["altitude"].max(), result.summary["rocket.1.apogee"], 0)


class TestResult(Case):
    @classmethod
    def setUpClass(cls):
        cls.result = ld.Scenario.read(FIXED).run()

    def test_columns_are_the_librarys_memory(self):
        one, two = self.result["tip.y"], self.result["tip.y"]
        self.assertTrue(np.shares_memory(one, two))
        self.assertFalse(one.flags.writeable or one.flags.owndata)
        column = self.result.history.columns["tip.y"]
        self.assertEqual((column.name, column.unit), ("tip.y", "m"))
        self.assertGreater(len(column.description), 10)

    def test_arrays_outlive_what_they_are_of(self):
        with ld.Scenario.read(FIXED).run() as result:
            tip = result["tip.y"]
            expected = tip.copy()
        for _ in range(3):  # what was freed would be theirs
            ld.Scenario.read(FIXED, {"rocket.mass": 50}).run()
        np.testing.assert_array_equal(tip, expected)
        np.testing.assert_array_equal(tip, self.result["tip.y"])
        with self.assertRaises(AttributeError):
            result["tip.y"]

    def test_names_that_are_not_there(self):
        for get, name, near in ((self.result.__getitem__, "tip.yy", "tip.y"),
                                (self.result.summary.__getitem__, "rocket.1.exit_sped",
                                 "rocket.1.exit_speed"),
                                (self.result.__getitem__, "nothing of the kind", None)):
            with self.assertRaises(ld.UnknownName) as caught:
                get(name)
            self.assertEqual(caught.exception.suggestion, near)
        with self.assertRaisesRegex(KeyError, "rocket 1 has not flown"):
            self.result.flight(1)
        self.assertNotIn("nothing", self.result.summary)
        self.assertIn("tip.y", self.result.history)

    def test_former_names_are_told(self):
        summary = self.result.summary
        with self.assertWarnsRegex(FutureWarning, '"aim.yaw" is called "since_ignition.yaw"'):
            np.testing.assert_array_equal(self.result["aim.yaw"],
                                          self.result["since_ignition.yaw"])
        with self.assertWarnsRegex(FutureWarning, 'is called "rocket.1.exit_speed" now'):
            self.assertEqual(summary["rocket.1.muzzle_speed"], summary["rocket.1.exit_speed"])
        with ld.Scenario.read(FIXED).begin() as run:
            with self.assertWarns(FutureWarning):
                self.assertEqual(run["aim.vy"], run["since_ignition.vy"])
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.result["since_ignition.yaw"]

    def test_summary_is_a_mapping(self):
        summary = self.result.summary
        self.assertEqual(set(summary), set(summary.quantities))
        for name, quantity in summary.quantities.items():
            np.testing.assert_equal(summary[name], quantity.value)
        self.assertEqual(summary.quantities["rocket.1.exit_speed"].unit, "m/s")
        self.assertAlmostEqual(summary["mode.1.frequency"],
                               ld.Scenario.read(FIXED).simulation().tube_modes()[0].frequency)

    def test_shown(self):
        self.assertIn("exit speed", str(self.result))
        self.assertIn("<pre>", self.result._repr_html_())
        self.assertEqual(repr(self.result),
                         f"<launchdyn.Result: rockets 1, rows {len(self.result['t'])}>")
        with mock.patch.object(library, "ld_summary_note",
                               lambda _, number: [b"one", b"two", None][number]):
            self.assertEqual(self.result.notes, ["one", "two"])
        self.assertIn("bores", ld.Scenario.read(FIXED)._repr_html_())

    def test_modes(self):
        modes, poles = ld.Scenario.read(FIXED).simulation().system_modes()
        self.assertGreater(len(modes), 5)
        self.assertTrue(all(pole.real <= 0 for pole in poles))
        frequencies = [mode.frequency for mode in modes]
        for mode in modes:
            self.assertAlmostEqual(mode.real, -2 * math.pi * mode.frequency * mode.damping, 3)
        self.assertEqual(frequencies, sorted(frequencies))
        flight = ld.Scenario.read(EXAMPLES / "flight.yaml").simulation()
        self.assertEqual(flight.tube_modes(), [])
        with self.assertRaisesRegex(ld.InputError, "a scenario of flight only has no launcher"):
            flight.system_modes()


class TestTables(Case):
    @classmethod
    def setUpClass(cls):
        cls.result = ld.Scenario.read(FIXED).run()

    @needs("pandas")
    def test_a_data_frame(self):
        frame = self.result.to_pandas()
        self.assertEqual((frame.index.name, list(frame)),
                         ("t", [name for name in self.result.history if name != "t"]))
        np.testing.assert_array_equal(frame.index, self.result["t"])
        for name in frame:
            np.testing.assert_array_equal(frame[name], self.result[name], name)
        self.assertEqual(frame.attrs["units"]["tip.y"], "m")
        within = (self.result["t"] >= 0.01) & (self.result["t"] <= 0.02)
        self.assertEqual(len(frame.loc[0.01:0.02]), within.sum())
        frame["tip.y"] = 0.0
        frame.iloc[0, 1] = 1.0
        self.assertNotEqual(self.result["tip.y"].min(), 0)
        self.assertNotEqual(self.result[frame.columns[1]][0], 1)

    @needs("xarray")
    def test_a_data_set(self):
        result = ld.Scenario.read(FIXED).run()
        data = result.to_xarray()
        self.assertTrue(np.shares_memory(data["tip.y"].values, result["tip.y"]))
        del result
        for name in self.result.history:
            np.testing.assert_array_equal(data[name], self.result[name], name)
            self.assertEqual(data[name].dims, ("t",))
            column = self.result.history.columns[name]
            self.assertEqual(data[name].attrs,
                             {"units": column.unit, "long_name": column.description})
        nearest = np.abs(self.result["t"] - 0.05).argmin()
        self.assertEqual(data["tip.y"].sel(t=0.05, method="nearest"), self.result["tip.y"][nearest])
        with self.assertRaises(ValueError):
            data["tip.y"][:] = 0

    @needs("h5netcdf")
    @needs("xarray")
    def test_the_file_is_a_data_set(self):
        import xarray
        scenario = ld.Scenario.read(FIXED, {"run.end": "apogee"})
        result = scenario.run(out=self.folder / "out")
        for group, table in (("history", result.history), ("rockets/1/flight", result.flight())):
            with xarray.open_dataset(self.folder / "out/history.h5", engine="h5netcdf",
                                     group=group) as data:
                self.assertEqual([*data.variables][0], "t")
                self.assertEqual(set(data.variables), set(table))
                for name, column in table.columns.items():
                    np.testing.assert_array_equal(data[name], table[name], name)
                    self.assertEqual(data[name].dims, ("t",))
                    self.assertEqual(data[name].attrs, {"units": column.unit,
                                                        "long_name": column.description})
        with xarray.open_dataset(self.folder / "out/history.h5", engine="h5netcdf") as whole:
            self.assertEqual(whole.attrs["complete"], 1)
            self.assertIn("rocket:", whole["scenario"].values[0].decode())

    def test_without_them_it_says_so(self):
        for name, to in (("pandas", self.result.to_pandas), ("xarray", self.result.to_xarray)):
            with mock.patch.dict(sys.modules, {name: None}), \
                    self.assertRaisesRegex(ld.MissingError, f"python3-{name}"):
                to()


class TestEarlyEnds(Case):
    def test_a_launch_that_fails_leaves_what_it_had(self):
        stuck = ld.Scenario.read(FIXED, {"rocket.lock.release_force": "100 kN",
                                         "run.stuck_time": "0.3 s"})
        with self.assertRaises(ld.LaunchError) as caught:
            stuck.run(out=self.folder / "out")
        error = caught.exception
        self.assertIn("the lock never released", str(error))
        self.assertEqual(error.code, ld.Status.LAUNCH)
        self.assertGreater(error.result["t"][-1], 0.1)
        self.assertIn("the lock never released", error.result.stopped)
        self.assertTrue((self.folder / "out/summary.json").exists())

    def test_so_does_one_whose_numerics_fail(self):
        run = library.ld_simulation_run

        def fail(*arguments):
            return run(*arguments) or ld.Status.NUMERIC
        with mock.patch.object(library, "ld_simulation_run", fail), \
                self.assertRaises(ld.NumericError) as caught:
            ld.Scenario.read(FIXED).run(out=self.folder / "out")
        self.assertGreater(caught.exception.result["t"][-1], 0.1)
        self.assertTrue((self.folder / "out/summary.json").exists())

    def test_a_launch_that_cannot_begin_leaves_nothing(self):
        for start in (external().run, external().begin):
            with self.assertRaises(ld.InputError):
                start(out=self.folder / "out")
            self.assertEqual(os.listdir(self.folder), [])

    def test_what_progress_raises_comes_back(self):
        shares = []

        def progress(share):
            shares.append(share)
            if len(shares) == 3:
                raise ZeroDivisionError
        with self.assertRaises(ZeroDivisionError):
            ld.Scenario.read(FIXED).run(progress=progress)
        self.assertEqual(len(shares), 3)
        shares.append(None)
        ld.Scenario.read(FIXED).run(progress=progress)
        self.assertEqual(shares[4:], sorted(shares[4:]))

    def test_interrupted(self):
        def progress(share):
            if share > 0.5:
                os.kill(os.getpid(), signal.SIGINT)
        before = signal.getsignal(signal.SIGINT)
        with self.assertRaises(KeyboardInterrupt):
            ld.Scenario.read(FIXED).run(out=self.folder / "out", progress=progress)
        self.assertIs(signal.getsignal(signal.SIGINT), before)
        self.assertIn('"complete": false', (self.folder / "out/summary.json").read_text())
        self.assertFalse([name for name in os.listdir(self.folder / "out") if "part" in name])

    def test_a_handler_of_the_programs_own_is_left_alone(self):
        heard = []
        before = signal.signal(signal.SIGINT, lambda *_: heard.append(1))
        self.addCleanup(signal.signal, signal.SIGINT, before)
        result = ld.Scenario.read(FIXED).run(
            progress=lambda share: heard or os.kill(os.getpid(), signal.SIGINT))
        self.assertEqual((heard, result.stopped), ([1], None))

    def test_runs_on_other_threads_go_on(self):
        results = []
        read = ld.Scenario.read(FIXED)
        thread = threading.Thread(target=lambda: results.append(read.run()))
        thread.start()
        thread.join()
        self.assertIsNone(results[0].stopped)


if __name__ == "__main__":
    unittest.main()
