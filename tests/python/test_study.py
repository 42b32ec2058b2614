"""Studies: the bits of the command, interruption, values and statistics."""

import csv
import os
import signal
import threading
import unittest
from unittest import mock

import launchdyn as ld
import numpy as np
from launchdyn import study
from support import EXAMPLES, FIXED, Case, command, flights, needs, scattered


def data_files(folder):
    return [path for path in folder.iterdir() if path.suffix != ".lock"]


class TestStudy(Case):
    def hold_the_third_sample(self):
        """Lets studies wait after two samples until they are stopped, however fast they are."""
        ended, end, told = threading.Event(), study._Work.end, study.COUNTS_TOLD

        def stop_first(work):
            work._stopped = True
            ended.set()
            end(work)

        def waiting(tell):
            def wait(self, counts):
                tell(self, counts)
                if counts[0].done == 2:
                    ended.wait(60)
            return told(wait)
        for name, other in (("_Work.end", stop_first), ("COUNTS_TOLD", waiting)):
            patch = mock.patch(f"launchdyn.study.{name}", other)
            patch.start()
            self.addCleanup(patch.stop)

    def test_the_bits_of_the_command(self):
        scenario = self.folder / "study.yaml"
        scenario.write_text(scattered(6, **{"run.output_step": "1 ms"}).to_yaml())
        command("study", scenario, "-q", "--out", self.folder / "command")
        command("study", "export", self.folder / "command", "--csv", self.folder / "export.csv")
        with (self.folder / "export.csv").open() as file:
            head, *rows = csv.reader(file)
        with ld.Study.read(scenario) as study:
            data = study.run(self.folder / "package", threads=2)
        values = data.values("exit_speed", "pitch_rate", "rocket.mass")
        np.testing.assert_array_equal(values["sample"], np.arange(1, 7))
        np.testing.assert_array_equal(values["rocket"], 1)
        for name in ("exit_speed", "pitch_rate", "rocket.mass"):
            column = next(i for i, text in enumerate(head) if text.split(" [")[0] == name)
            np.testing.assert_array_equal(values[name], [float(row[column]) for row in rows], name)
        self.assertEqual(data.show("exit_speed"),
                         command("study", "show", self.folder / "command", "--what",
                                 "exit_speed"))

    def test_statistics_are_of_the_values(self):
        data = ld.Study.of(scattered(8)).run(self.folder / "study")
        speed, mass = data["exit_speed"], data["rocket.mass"]
        found = data.statistics("exit_speed")
        self.assertEqual((found.count, found.groups), (8, 8))
        self.assertAlmostEqual(found.mean.value, speed.mean(), 12)
        self.assertAlmostEqual(found.deviation.value, speed.std(ddof=1), 12)
        self.assertEqual((found.least, found.greatest), (speed.min(), speed.max()))
        self.assertAlmostEqual(found.quantiles[1].value, np.median(speed), 12)
        self.assertLess(found.quantiles[0].value, found.quantiles[1].value)
        self.assertLess(found.quantiles[1].value, found.quantiles[2].value)
        cubes = ((speed - speed.mean()) ** 3).mean() / speed.std() ** 3
        self.assertAlmostEqual(found.skewness, cubes * 56 ** 0.5 / 6, 9)  # of eight, without bias
        self.assertLess(found.mean.low, found.mean.value)
        self.assertLess(np.corrcoef(mass, speed)[0, 1], -0.99)
        self.assertGreater(data.sensitivity("exit_speed", "rocket.mass").value, 0.98)
        self.assertEqual(data.factors, ["rocket.mass"])
        self.assertEqual(data.columns["rocket.mass"].unit, "kg")
        self.assertTrue(data.columns["exit_speed"].per_rocket)
        self.assertFalse(data.columns["exit_speed"].seed)
        self.assertIn("exit_speed", data.results)
        self.assertIn("8 of 8 samples", data._repr_html_())
        self.assertIn("points 1, samples 8 of 8", repr(data))

    def test_a_sweep_has_points(self):
        swept = ld.Study.read(FIXED, {"sweep": {"rocket.mass": [58, 62]}})
        with swept.run(self.folder / "study") as data:
            self.assertEqual(data.swept, ["rocket.mass"])
            self.assertEqual([point.values for point in data.points],
                             [{"rocket.mass": "58 kg"}, {"rocket.mass": "62 kg"}])
            speeds = [data.values("exit_speed", point=i)["exit_speed"][0] for i in (1, 2)]
            self.assertGreater(*speeds)
            with self.assertRaises(ld.InputError):
                data.values("exit_speed", point=3)

    @needs("pandas")
    def test_a_data_frame(self):
        swept = scattered(3, sweep={"base.elevation": ["10 deg", "20 deg"]})
        with ld.Study.of(swept).run(self.folder / "study") as data:
            frame = data.to_pandas()
            self.assertEqual(list(frame), ["base.elevation", "sample", "rocket", *data.columns])
            for point, (_, part) in enumerate(frame.groupby("base.elevation"), 1):
                values = data.values("exit_speed", "rocket.mass", point=point)
                for name, expected in values.items():
                    np.testing.assert_array_equal(part[name], expected, name)
            self.assertTrue(frame["range"].isna().all())  # they fly no further than the tip
            self.assertEqual(frame.attrs["units"]["rocket.mass"], "kg")
            few = data.to_pandas("range", "exit_speed")
            np.testing.assert_array_equal(few["exit_speed"], frame["exit_speed"])
            with self.assertRaises(ld.UnknownName):
                data.to_pandas("exit_sped")

    @needs("xarray")
    def test_a_data_set(self):
        factors = {"rocket.lock.release_force": {"uniform": "1 25 kN"},
                   "base.elevation": {"normal": "1 deg"}}
        swept = ld.Scenario.read(FIXED, {"scatter.samples": 5, "scatter.factors": factors,
                                         "run.stuck_time": "0.2 s",
                                         "sweep": {"rocket.mass": ["58 kg", "62 kg"]}})
        with ld.Study.of(swept).run(self.folder / "study") as data:
            failed = data.points[0].failed
            self.assertEqual(failed, 2)  # the lock holds them
            whole, few = data.to_xarray(), data.to_xarray("exit_speed")
            self.assertEqual((list(whole), list(few)), (list(data.columns), ["exit_speed"]))
            self.assertEqual(list(whole["rocket.mass"].values), ["58 kg", "62 kg"])
            for point in (1, 2):
                at, values = whole.sel(point=point), data.values("exit_speed", "base.elevation",
                                                                 point=point)
                went = at["number"].isin(values["sample"])
                self.assertEqual(went.sum(), 5 - failed)
                for name, dims in (("exit_speed", ("sample", "rocket")),
                                   ("base.elevation", ("sample",))):
                    self.assertEqual(at[name].dims, dims)
                    np.testing.assert_array_equal(at[name][went].values.ravel(), values[name])
                    self.assertTrue(at[name][~went].isnull().all())
            lock = whole["rocket.lock.release_force"]
            np.testing.assert_array_equal(lock.sel(point=1), lock.sel(point=2))  # the same draws
            self.assertEqual(few["exit_speed"].attrs, {"units": "m/s"})
            self.assertTrue(whole["range"].isnull().all())  # they fly no further than the tip
            with self.assertRaises(ld.UnknownName):
                data.to_xarray("exit_sped")

    def test_interrupted_it_goes_on(self):
        samples = ld.Study.of(flights(40))
        self.hold_the_third_sample()

        def interrupt(counts):
            if counts.done >= 2:
                os.kill(os.getpid(), signal.SIGINT)
        with self.assertRaises(KeyboardInterrupt):
            samples.run(self.folder / "study", progress=interrupt)
        self.assertIs(signal.getsignal(signal.SIGINT), signal.default_int_handler)
        kept = ld.StudyData(self.folder / "study").points[0].done
        self.assertIn(kept, (2, 3))
        mock.patch.stopall()
        counts = []
        with mock.patch("launchdyn.study.LOOK_UP", 1e-4):  # before there is something to report
            data = samples.run(self.folder / "study", threads=2, progress=counts.append)
        self.assertEqual((counts[-1].done, counts[-1].now), (40, 40 - kept))
        self.assertEqual({told.samples for told in counts}, {40})
        whole = samples.run(self.folder / "whole", threads=2)
        np.testing.assert_array_equal(data["range"], whole["range"])

    def test_what_progress_raises_stops_it(self):
        def fail(counts):
            raise ZeroDivisionError
        self.hold_the_third_sample()
        threads = threading.active_count()
        with self.assertRaises(ZeroDivisionError):
            ld.Study.of(flights(40)).run(self.folder / "study", progress=fail)
        self.assertEqual(threading.active_count(), threads)
        self.assertLess(ld.StudyData(self.folder / "study").points[0].done, 40)

    def test_shards(self):
        samples = ld.Study.of(flights(5))
        whole = samples.run(self.folder / "whole")
        halves = [samples.run_shard(self.folder / "parts", i, 2) for i in (1, 2)]
        self.assertEqual([counts.done for counts in halves], [3, 2])
        with ld.merge_shards(self.folder / "parts") as data:
            for name in ("range", "rocket.mass"):
                np.testing.assert_array_equal(data[name], whole[name])
            data.export(self.folder / "parts.csv", self.folder / "parts.h5")
        command("study", "export", self.folder / "whole", "--csv", self.folder / "whole.csv")
        self.assertEqual((self.folder / "parts.csv").read_text(),
                         (self.folder / "whole.csv").read_text())
        self.assertTrue((self.folder / "parts.h5").exists())
        for wrong in (lambda: samples.run_shard(self.folder / "parts", 3, 2),
                      lambda: ld.merge_shards(self.folder / "nowhere"), whole.export):
            with self.assertRaises(ValueError):
                wrong()

    def test_joined(self):
        samples = ld.Study.of(flights(60))
        whole = samples.run(self.folder / "whole")
        others = [threading.Thread(target=samples.run, args=(self.folder / "joined",),
                                   kwargs={"join": True}) for _ in range(2)]
        for other in others:
            other.start()
        for other in others:
            other.join()
        with samples.run(self.folder / "joined", join=True) as data:
            np.testing.assert_array_equal(data["range"], whole["range"])
        self.assertEqual(len(data_files(self.folder / "joined")), 1)

    def test_a_sample_by_itself(self):
        samples = ld.Study.of(flights(3))
        data = samples.run(self.folder / "study")
        third = samples.sample(3)
        with self.assertRaises(ld.InputError):
            samples.sample(4)
        del samples
        self.assertEqual(third["rocket.mass"], data["rocket.mass"][2])
        self.assertEqual(third.run().summary["rocket.1.range"], data["range"][2])
        for change in (third.set, third.derive):
            with self.assertRaisesRegex(ValueError, "a sample cannot be changed"):
                change({"rocket.spin": 0})
        again = ld.Scenario.from_text(third.to_yaml(), {"title": "again"})
        self.assertEqual(again.run().summary["rocket.1.range"], data["range"][2])

    def test_written_study_has_the_same_samples(self):
        # propellant, time to leave, ground, the empty rocket follow from what is sampled
        study = scattered(3, **{"rocket.empty": None, "scatter.factors": {
            "rocket.center.x": {"normal": "1 cm"}, "rocket.motor.time_scale": {"normal": 0.01}}})
        written = ld.Scenario.from_text(study.to_yaml())
        self.assertEqual(written.to_yaml(), study.to_yaml())
        for number in 1, 2:
            samples = [ld.Study.of(of).sample(number) for of in (study, written)]
            for key in "rocket.empty.center.x", "run.stuck_time", "rocket.propellant":
                self.assertEqual(*(sample[key] for sample in samples))
            self.assertNotEqual(samples[0]["run.stuck_time"], study["run.stuck_time"])
            self.assertEqual(samples[0]["rocket.empty.center.x"], samples[0]["rocket.center.x"])

    def test_written_sweep_has_the_same_samples(self):
        swept = ld.Scenario.read(FIXED, {"sweep": {"rocket.motor.time_scale": [1, 1.5]}})
        written = ld.Scenario.from_text(swept.to_yaml())
        self.assertEqual(written.to_yaml(), swept.to_yaml())
        late, same = (ld.Study.of(of).sample(2)["run.stuck_time"] for of in (swept, written))
        self.assertEqual(late, same)
        self.assertNotEqual(late, swept["run.stuck_time"])

    def test_points_beside_each_other(self):
        with ld.Study.of(scattered(6, sweep={"base.elevation": ["10 deg", "20 deg"]})).run(
                self.folder / "study") as data:
            launches = self.folder / "launches.csv"
            launches.write_text("exit_speed [m/s]\n38.1\n37.9\n38.0\n")
            self.assertEqual(data.show(measured=launches),
                             command("study", "show", data.folder, "--measured", launches))
            for words in ({"against": "1"}, {"sensitivity": True}, {}):
                options = [word for name, value in words.items()
                           for word in (f"--{name}", value) if value is not True] or \
                    [f"--{name}" for name in words]
                self.assertEqual(data.show("exit_speed", **words),
                                 command("study", "show", data.folder, "--what", "exit_speed",
                                         *options))

    def test_errors(self):
        with self.assertRaises(ld.InputError):
            ld.StudyData(self.folder / "nowhere")
        with self.assertRaises(ld.InputError) as caught:
            ld.Study.read(FIXED, {"scatter.samples": 3, "scatter.factors": {
                "rocket.mas": {"normal": "1 kg"}}})
        self.assertEqual(caught.exception.suggestion, "mass")
        with self.assertRaises(ld.InputError):
            ld.Study.read(FIXED).run(self.folder / "nothing varies")
        data = ld.Study.of(scattered(2)).run(self.folder / "study")
        with self.assertRaises(ld.UnknownName) as caught:
            data["exit_sped"]
        self.assertEqual(caught.exception.suggestion, "exit_speed")
        with self.assertRaises(ld.UnknownName):
            data.show("exit_sped")
        with self.assertRaisesRegex(ld.InputError, "."):
            ld.Study.of(scattered(2, **{"rocket.mass": 70})).run(self.folder / "study")
        data.close()
        with self.assertRaisesRegex(ValueError, "closed"):
            data["exit_speed"]

    def test_footprints(self):
        data = ld.Study.read(EXAMPLES / "range-safety.yaml", {"scatter.samples": 200}).run(
            self.folder / "safe", threads=2)
        found = data.footprint(0.95)
        self.assertTrue(found.stated)
        self.assertEqual((found.share, found.needed, found.independent), (0.95, 180, 200))
        self.assertLess(found.content.low, 0.95)
        self.assertLess(found.area.low, found.area.value)
        self.assertLess(found.distance.value, found.distance.high)
        data.export(footprint=self.folder / "safe.csv")
        with (self.folder / "safe.csv").open() as file:
            _, *rows = csv.reader(file)
        corners = [(float(row[10]), float(row[11])) for row in rows if row[2] == "0.95"]
        self.assertAlmostEqual(max(np.hypot(*corner) for corner in corners),
                               found.distance.value, places=6)
        none = data.footprint(0.999)
        self.assertEqual((none.stated, none.needed), (False, 9000))
        self.assertTrue(np.isnan(none.area.value))
        with self.assertRaisesRegex(ld.InputError, "0.95, 0.99 and 0.999"):
            data.footprint(0.5)
        with self.assertRaisesRegex(ld.InputError, "ends in .csv"):
            data.export(footprint=self.folder / "safe.shp")

    def test_reports(self):
        data = ld.Study.of(scattered(2)).run(self.folder / "study")
        data.write_report(self.folder / "study.html")
        ld.Scenario.read(FIXED).run(out=self.folder / "run")
        written = ld.write_report(self.folder / "run")
        named = ld.write_report(self.folder / "run", self.folder / "named.html")
        self.assertEqual((written, named),
                         (self.folder / "run/report.html", self.folder / "named.html"))
        for file in (self.folder / "study.html", written, named):
            self.assertIn("<html", file.read_text()[:500])
        with self.assertRaises(ld.InputError):
            ld.write_report(self.folder / "nowhere")


if __name__ == "__main__":
    unittest.main()
