"""Figures by matplotlib."""

import sys
import unittest
from unittest import mock

import launchdyn as ld
import numpy as np
from support import FIXED, Case, command, scattered

try:
    from matplotlib import pyplot
except ImportError:
    pyplot = None


class TestWithout(unittest.TestCase):
    def test_without_matplotlib_it_says_so(self):
        result = ld.Scenario.read(FIXED).run()
        with mock.patch.dict(sys.modules, {"matplotlib": None, "matplotlib.pyplot": None}), \
                self.assertRaisesRegex(ld.MissingError, "python3-matplotlib") as caught:
            result.plot("tip.y")
        self.assertEqual(caught.exception.code, ld.Status.MISSING)


class TestGnuplot(Case):
    def test_the_figures_of_the_command(self):
        runs = []
        for name, mass in (("light", 58), ("heavy", 62)):
            runs.append(self.folder / name)
            ld.Scenario.read(FIXED, {"rocket.mass": mass}).run(out=runs[-1])
        theirs, ours = self.folder / "command.svg", self.folder / "package.svg"
        command("plot", *runs, "--what", "tip,travel", "-o", theirs, "--from", 10, "--to", 120,
                "--style", "paper", "--width", 120)
        ld.draw(ours, *runs, figures=["tip", "travel"], start=0.01, end=0.12, style="paper",
                width=0.12)
        self.assertEqual(ours.read_bytes(), theirs.read_bytes())
        command("plot", runs[0], "-o", theirs)
        ld.draw(ours, runs[0])
        self.assertEqual(ours.read_bytes(), theirs.read_bytes())
        (runs[0] / "summary.json").unlink()
        with self.assertWarnsRegex(UserWarning, "summary.json is missing"):
            ld.draw(ours, runs[0])
        with self.assertRaisesRegex(ld.InputError, "did you mean tip"):
            ld.draw(ours, *runs, figures=["tp"])
        with self.assertRaises(ld.InputError):
            ld.draw(ours)
        self.assertEqual(ld.figures()["tip"], "Tip of the tube against the undeformed tube")


@unittest.skipUnless(pyplot, "matplotlib is not here")
class TestPlot(Case):
    def tearDown(self):
        pyplot.close("all")

    def test_a_column_in_one_line(self):
        result = ld.Scenario.read(FIXED).run()
        axes = result.plot("tip.y", color="black")
        line, = axes.lines
        np.testing.assert_array_equal(line.get_ydata(), result["tip.y"])
        np.testing.assert_array_equal(line.get_xdata(), result["t"])
        self.assertEqual((line.get_color(), axes.get_ylabel()), ("black", "tip.y"))
        axes.figure.canvas.draw()
        self.assertTrue(axes.get_yticklabels()[0].get_text().endswith("µm"))

    def test_units_apart(self):
        result = ld.Scenario.read(FIXED).run()
        tip, rate = result.plot("tip.y", "tip.pitch_rate", "tip.z")
        self.assertEqual((len(tip.lines), len(rate.lines)), (2, 1))
        self.assertEqual([text.get_text() for text in tip.get_legend().get_texts()],
                         ["tip.y", "tip.z"])
        again = result.plot("tip.y", over="rocket.s", ax=tip)
        self.assertIs(again, tip)
        self.assertEqual(len(tip.lines), 3)
        with self.assertRaisesRegex(ValueError, "2 units"):
            result.plot("tip.y", "tip.pitch_rate", ax=tip)
        with self.assertRaisesRegex(ValueError, "no columns given"):
            result.plot()
        with self.assertRaises(ld.UnknownName):
            result.plot("tip.yy")

    def test_studies(self):
        data = ld.Study.of(scattered(4, sweep={"base.elevation": ["10 deg", "20 deg"]})).run(
            self.folder / "study")
        axes = data.plot("exit_speed", over="rocket.mass")
        self.assertEqual([len(line.get_xdata()) for line in axes.lines], [4, 4])
        for point, line in enumerate(axes.lines, 1):
            np.testing.assert_array_equal(
                line.get_ydata(), data.values("exit_speed", point=point)["exit_speed"])
        self.assertEqual(axes.get_legend().get_texts()[1].get_text(), "base.elevation 20 deg")
        opaque = data.plot("exit_speed", over="rocket.mass", alpha=1)
        self.assertEqual(opaque.lines[0].get_alpha(), 1)
        histograms = data.plot("exit_speed", "pitch_rate")
        self.assertNotEqual(*(axes.get_xlim() for axes in histograms))
        self.assertEqual(sum(bar.get_height() for bar in histograms[0].patches), 8)


if __name__ == "__main__":
    unittest.main()
