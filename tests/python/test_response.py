"""Linear response, loops, roads and winds: the bits of the command, and what holds between them."""

import math
import os
import signal
import unittest
from unittest import mock

import launchdyn as ld
import numpy as np
from launchdyn._library import GO_ON
from support import EXAMPLES, FIXED, Case, command, written

REFERENCE = EXAMPLES / "reference.yaml"
FREQUENCIES = np.array([0.3, 1.8, 12.0])


def amplitudes(table, name):
    """A column of the command's frequency response as complex numbers."""
    return table[f"{name}.amplitude"] * np.exp(1j * table[f"{name}.phase"])


class TestViews(Case):
    def compare(self, view, *words):
        """A view prints, writes and draws what the command does."""
        theirs, ours = self.folder / "command", self.folder / "package"
        drawn = self.folder / "command.svg", self.folder / "package.svg"
        printed = command(*words, "--out", theirs, "--plot", drawn[0])
        self.assertEqual(str(view), printed)
        view.write(ours)
        view.draw(drawn[1])
        files = sorted(path.name for path in theirs.iterdir())
        self.assertEqual([f"{name}.csv" for name in view.tables], files)
        for name in files:
            self.assertEqual((ours / name).read_bytes(), (theirs / name).read_bytes())
        self.assertEqual(*(file.read_bytes() for file in drawn))
        self.assertIn("<pre>", view._repr_html_())
        return view.tables

    def test_roads(self):
        view = ld.Scenario.read(REFERENCE).road_view(-20, 30, 0.5)
        road = self.compare(view, "road", REFERENCE, "--from", -20, "--to", 30, "--step", 0.5)
        np.testing.assert_allclose(road["road"]["x"], np.arange(-20, 30.1, 0.5), atol=1e-12)
        np.testing.assert_array_equal(road["road"]["left"], road["road"]["right"])
        with self.assertRaisesRegex(ld.InputError, "vehicle"):
            ld.Scenario.read(FIXED).road_view()

    def test_winds(self):
        view = ld.Scenario.read(EXAMPLES / "salvo.yaml").wind_view(50, 400, 60, 2, rocket=3)
        wind = self.compare(view, "wind", EXAMPLES / "salvo.yaml", "--height", 50, "--top", 400,
                            "--length", 60, "--step", 2, "--rocket", 3)
        self.assertEqual({len(column) for column in wind["wind-turbulence"].values()}, {31})
        self.assertEqual(str(ld.Scenario.read(EXAMPLES / "salvo.yaml").wind_view()),
                         command("wind", EXAMPLES / "salvo.yaml"))
        with self.assertRaisesRegex(ld.InputError, "no wind"):
            ld.Scenario.read(FIXED).wind_view()

    def test_responses(self):
        read = ld.Scenario.read(REFERENCE)
        names = "chassis.vy,tip.y"
        speeds = self.compare(read.response_view(*names.split(","), speeds=(5, 7.5, 1.25)),
                              "response", REFERENCE, "--what", names, "--speeds", "18:27:4.5")
        for name in names.split(","):
            with read.response(5, 7.5) as response:
                found = [response.on_road(name, speed=v)[name].rms for v in (5, 6.25, 7.5)]
            np.testing.assert_array_equal(speeds["response-rms"][name], found)
        drawn = read.response_view("pitch_rate", exit=True, draws=2).tables["response-exit"]
        scatter = read.response(friction=True).exit("pitch_rate", draws=2)["pitch_rate"]
        self.assertEqual([drawn["pitch_rate.mean"][0], drawn["pitch_rate.deviation"][0]],
                         list(scatter))


    def test_a_view_keeps_what_it_was_asked(self):
        view = ld.Scenario.read(REFERENCE).response_view(loop="".join(("eleva", "tion")))
        others = ["".join(("other", "tion")).encode() for _ in range(100)]  # where it might be
        self.assertIn("Loop of the elevation", str(view))
        self.assertEqual(len(others), 100)


    def test_what_has_no_value_is_nan(self):
        view = ld.Scenario.read(FIXED).response_view("since_ignition.pitch_rate", "tip.y",
                                                     input="base.y", start=1, end=3)
        view.write(self.folder)
        self.assertNotIn("-nan", (self.folder / "response-frequency.csv").read_text())
        table = view.tables["response-frequency"]
        self.assertTrue(np.isnan(table["since_ignition.pitch_rate.amplitude"]).all())
        self.assertFalse(np.isnan(table["tip.y.amplitude"]).any())
        np.testing.assert_allclose(table["frequency"][[0, -1]], (1, 3))


class TestInterrupted(Case):
    def press_at(self, module, call):
        """Ctrl-C is pressed as the library asks so often whether to continue."""
        told, calls = GO_ON, []

        def pressing(ask):
            def asked(self_):
                calls.append(1)
                if len(calls) == call:
                    os.kill(os.getpid(), signal.SIGINT)
                return ask(self_)
            return told(asked)
        patch = mock.patch(f"launchdyn.{module}.GO_ON", pressing)
        patch.start()
        self.addCleanup(patch.stop)
        return calls

    def test_the_scatter_of_the_exit(self):
        read = ld.Scenario.read(REFERENCE)
        calls = self.press_at("response", 3)
        with read.response() as response:
            with self.assertRaises(KeyboardInterrupt):
                response.exit("pitch_rate")
            self.assertEqual(len(calls), 3)
            found = response.exit("pitch_rate", draws=2)["pitch_rate"]
        self.assertEqual(len(calls), 6)  # from rest and two
        self.assertIs(signal.getsignal(signal.SIGINT), signal.default_int_handler)
        self.assertLess(abs(found.mean + 0.245), 0.015)
        calls = self.press_at("views", 2)
        with self.assertRaises(KeyboardInterrupt):
            read.response_view("pitch_rate", exit=True)
        self.assertEqual(len(calls), 2)


class TestResponse(Case):
    @classmethod
    def setUpClass(cls):
        cls.read = ld.Scenario.read(REFERENCE)
        cls.response = cls.read.response()

    def test_the_numbers_of_the_command(self):
        command("response", REFERENCE, "-q", "--input", "road", "--what", "chassis.vy,tip.y",
                "--from", 0.5, "--to", 5, "--out", self.folder)
        theirs = written(self.folder / "response-frequency.csv")
        gain = self.response.gain("road", "tip.y", "chassis.vy", frequency=theirs["frequency"])
        self.assertEqual(list(gain), ["tip.y", "chassis.vy"])
        for name, values in gain.items():
            expected = amplitudes(theirs, name)
            self.assertLess(abs(values - expected).max() / abs(expected).max(), 1e-15, name)

    def test_a_random_input_is_its_density_times_the_gain(self):
        frequency = np.linspace(0.5, 3, 20001)
        gain = self.response.gain("chassis.force_y", "chassis.vy", frequency=frequency)
        expected = math.sqrt(np.trapz(4 * abs(gain["chassis.vy"]) ** 2, frequency))
        found = self.response.random("chassis.force_y", "chassis.vy", frequency=(0.5, 3),
                                     density=(4, 4))["chassis.vy"]
        self.assertAlmostEqual(found.rms / expected, 1, 6)
        self.assertAlmostEqual(found.strongest,
                               frequency[abs(gain["chassis.vy"]).argmax()], 2)

    def test_densities(self):
        table = self.read.response_view("tip.y", "chassis.vy").tables["response-spectrum"]
        some = slice(None, None, 100)
        found = self.response.density("tip.y", "chassis.vy", frequency=table["frequency"][some])
        for name, values in found.items():
            np.testing.assert_array_equal(values, table[name][some])

    def test_a_base_that_stands(self):
        response = ld.Scenario.read(FIXED).response()
        self.assertEqual((response.speed, response.inputs["base.y"].unit), (0, "m"))
        slow = response.gain("base.y", "tip.y", frequency=1e-3)["tip.y"]
        self.assertLess(abs(slow[0]), 1e-6)  # the tip goes along
        with self.assertRaisesRegex(ld.InputError, "no road"):
            response.on_road("tip.y")

    def test_what_is_wrong(self):
        gain = self.response.gain
        for wrong, near in ((("roda", "tip.y"), "road"), (("road", "tip.yy"), "tip.y")):
            with self.assertRaises(ld.UnknownName) as caught:
                gain(*wrong, frequency=1)
            self.assertEqual(caught.exception.suggestion, near)
        for frequency, speed in ((-1, None), (1, 100)):
            with self.assertRaises(ld.InputError):
                gain("road", "tip.y", frequency=frequency, speed=speed)
        for wrong in (lambda: gain("road", frequency=1), self.response.exit,
                      lambda: gain("road", "tip.y", frequency=[[1, 2]]),
                      lambda: self.response.random("road", "tip.y", frequency=[1, 2],
                                                   density=1)):
            with self.assertRaises(ValueError):
                wrong()
        with self.read.response(0, 10) as response, \
                self.assertRaisesRegex(ld.InputError, "requires a speed above 0"):
            response.on_road("tip.y", speed=0)
        with ld.Scenario.read(FIXED).response() as closed:
            pass
        with self.assertRaisesRegex(ValueError, "closed"):
            closed.gain("base.y", "tip.y", frequency=1)

    def test_loops(self):
        loop = self.read.loop("elevation")
        table = self.read.response_view(loop="elevation").tables["response-loop"]
        some = slice(None, None, 60)
        points = loop.points(table["frequency"][some])
        for name, values in (*zip(points._fields, points),
                             ("rejection", loop.rejection(table["frequency"][some]))):
            expected = amplitudes(table, name)[some]
            self.assertLess((abs(values - expected) / abs(expected)).max(), 1e-15, name)
        np.testing.assert_allclose(points.sensitivity * (1 + points.open), 1, rtol=1e-9)
        margins = loop.margins
        at_crossover = loop.points(margins.crossover).open[0]
        self.assertAlmostEqual(abs(at_crossover), 1, 6)
        self.assertAlmostEqual(math.pi - abs(np.angle(at_crossover)), margins.phase, 6)
        self.assertAlmostEqual(margins.delay * 2 * math.pi * margins.crossover, margins.phase, 6)
        lowered = margins.lower * loop.points(margins.lower_at).open[0]
        self.assertAlmostEqual(lowered, -1, 4)
        self.assertAlmostEqual(abs(loop.points(margins.bandwidth).tracking[0]), 0.5**0.5, 6)
        self.assertEqual((margins.raise_, margins.peak), (math.inf, 1))
        with self.assertRaises(ld.InputError) as caught:
            self.read.loop("elvation")
        self.assertEqual(caught.exception.suggestion, "elevation")


if __name__ == "__main__":
    unittest.main()
