"""Results over swept keys: pooled numbers against those computed here from the study's database, by
name; pictures' axes read back; what is refused."""

import csv
import json
import math
import re
import sqlite3
import subprocess
import tempfile
import unittest
from pathlib import Path

import launchdyn as ld
import numpy as np
from support import FIXED, Case, command

try:
    from matplotlib import pyplot
except ImportError:
    pyplot = None

ELEVATIONS, MASSES, SAMPLES, ROCKETS = ["15 deg", "20 deg", "25 deg"], ["59 kg", "61 kg"], 12, 2


def study():
    return ld.Study.of(ld.Scenario.read(FIXED, {
        "firing": {"order": [1, 2], "interval": "0.3 s"}, "run.tolerance": "1e-3",
        "sweep": {"base.elevation": ELEVATIONS, "rocket.mass": MASSES},
        "scatter": {"samples": SAMPLES, "factors": {
            "rocket.mass_error": {"normal": "0.2 kg"},
            "rocket.motor.thrust_scale": {"normal": "1 %"},
            "base.azimuth": {"normal": "1 mrad"}}}}))


def student(probability, freedom):
    """Quantile of Student's t, by its density."""
    x = np.linspace(0, 60, 600001)
    density = (1 + x * x / freedom) ** (-(freedom + 1) / 2)
    density /= math.gamma(freedom / 2) * math.sqrt(freedom * math.pi)
    density *= math.gamma((freedom + 1) / 2)
    steps = (density[1:] + density[:-1]) / 2 * (x[1] - x[0])
    below = 0.5 + np.concatenate([[0], np.cumsum(steps)])
    return float(np.interp(probability, below, x))


def jackknife(statistic, groups):
    """Value and half an interval, each group left out in turn, all recomputed."""
    left = np.array([statistic([g for g in range(groups) if g != k]) for k in range(groups)])
    error = math.sqrt((groups - 1) / groups * np.sum((left - left.mean()) ** 2))
    return statistic(range(groups)), student(0.975, groups - 1) * error


class TestNumbers(Case):
    @classmethod
    def setUpClass(cls):
        cls.held = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.held.cleanup)
        cls.where = Path(cls.held.name) / "study"
        cls.data = study().run(cls.where, threads=2)

    def table(self, name):
        """The values by (elevation, mass): an array over samples and rockets."""
        with sqlite3.connect(self.where / "study.db") as base:
            points = base.execute(
                'SELECT point, "base.elevation", "rocket.mass" FROM point').fetchall()
            rows = base.execute(
                f'SELECT sample.point, sample.sample, rocket.rocket, rocket."{name}" '
                "FROM sample JOIN rocket USING (sample)").fetchall()
        found = {(elevation, mass): np.full((SAMPLES, ROCKETS), np.nan)
                 for _, elevation, mass in points}
        keys = {point: (elevation, mass) for point, elevation, mass in points}
        for point, sample, rocket, value in rows:
            found[keys[point]][(sample - 1) // len(points), rocket - 1] = value
        return found

    def test_means_and_deviations(self):
        for name in ("exit_speed", "pitch_rate"):
            table = self.table(name)
            means = self.data.over(name, "base.elevation")
            deviations = self.data.over(name, "base.elevation", statistic="deviation")
            self.assertEqual([c.values for c in means], [(e,) for e in ELEVATIONS])
            self.assertEqual([c.numbers for c in means], [(15,), (20,), (25,)])
            self.assertEqual((means.units, means.keys), (("deg",), ("base.elevation",)))
            for mean, deviation in zip(means, deviations):
                own = [table[mean.values[0], mass] for mass in MASSES]
                expected, half = jackknife(
                    lambda g: np.mean([v[list(g)].mean() for v in own]), SAMPLES)
                np.testing.assert_allclose(
                    mean.estimate, (expected, expected - half, expected + half), rtol=1e-9)
                spread, half = jackknife(lambda g: 0.5 * math.log(np.mean(
                    [v[list(g)].var(ddof=1) for v in own])), SAMPLES)
                self.assertAlmostEqual(deviation.estimate.value / math.exp(spread), 1, 12)
                # the interval is a bootstrap's: of the size of the jackknife's
                size = math.log(deviation.estimate.high / deviation.estimate.low) / 2 / half
                self.assertTrue(0.6 < size < 2, size)
                self.assertEqual((mean.count, mean.groups, mean.points),
                                 (SAMPLES * ROCKETS * len(MASSES), SAMPLES, len(MASSES)))

    def test_shares_and_quantiles(self):
        table = self.table("exit_speed")
        limit = float(np.median(np.concatenate([v.ravel() for v in table.values()])))
        shares = self.data.over("exit_speed", "rocket.mass", statistic=f"share:>{limit:.17g} m/s")
        quantiles = self.data.over("exit_speed", "rocket.mass", statistic="quantile:0.5")
        for share, quantile, mass in zip(shares, quantiles, MASSES):
            own = np.concatenate([table[e, mass].ravel() for e in ELEVATIONS])
            self.assertAlmostEqual(share.estimate.value, np.mean(own > limit), 12)
            value, low, high = share.estimate
            self.assertTrue(0 <= low <= value <= high <= 1)
            self.assertAlmostEqual(quantile.estimate.value / np.median(own), 1, 12)

    def test_differences(self):
        for name in ("exit_speed", "yaw_rate"):
            table = self.table(name)
            differences = self.data.over(name, "rocket.mass", against="rocket.mass=59 kg")
            ratios = self.data.over(name, "rocket.mass", against="1", statistic="deviation")
            self.assertTrue(differences[0].reference and ratios[0].reference)
            self.assertTrue(math.isnan(differences[0].estimate.value))
            pairs = [(table[e, "61 kg"], table[e, "59 kg"]) for e in ELEVATIONS]
            expected, half = jackknife(
                lambda g: np.mean([(a[list(g)] - b[list(g)]).mean() for a, b in pairs]), SAMPLES)
            np.testing.assert_allclose(differences[1].estimate,
                                       (expected, expected - half, expected + half), rtol=1e-9)

            def log_ratio(g):
                a, b = (np.mean([pair[k][list(g)].var(ddof=1) for pair in pairs]) for k in (0, 1))
                return 0.5 * math.log(a / b)

            expected, half = jackknife(log_ratio, SAMPLES)
            self.assertAlmostEqual(ratios[1].estimate.value / math.exp(expected), 1, 11)
            found = math.log(ratios[1].estimate.high / ratios[1].estimate.low) / 2
            self.assertAlmostEqual(found / half, 1, 1)
            self.assertEqual(ratios[1].count, SAMPLES * ROCKETS * len(ELEVATIONS))

    def test_two_keys_are_the_points(self):
        cells = self.data.over("exit_speed", "rocket.mass", "base.elevation")
        for cell in cells:
            number = 1 + ELEVATIONS.index(cell.values[1]) * 2 + MASSES.index(cell.values[0])
            self.assertEqual(cell.estimate, self.data.statistics("exit_speed", number).mean)

    def test_printed(self):
        text = self.data.show("exit_speed", over="base.elevation")
        mean = self.data.over("exit_speed", "base.elevation")[1].estimate
        self.assertIn("pooled over rocket.mass (2 values); 95 % intervals", text)
        row = next(line for line in text.splitlines() if line.startswith("20 deg"))
        self.assertAlmostEqual(float(row.split()[2]), mean.value, 3)
        self.assertEqual(text, command("study", "show", self.where, "--over", "base.elevation",
                                       "--what", "exit_speed"))

    def rows(self, *words):
        """The rows of `study show --json` and, the same, those of --csv."""
        show = ("study", "show", self.where, "--what", "exit_speed", *words)
        printed = json.loads(command(*show, "--json"))
        file = self.folder / "rows.csv"
        command(*show, "--csv", file)
        with file.open() as stream:
            lines = list(csv.DictReader(stream))
        found = printed["results"][0]
        self.assertEqual(found["of"], ["exit_speed"])
        self.assertEqual(len(lines), len(found["rows"]))
        for line, row in zip(lines, found["rows"]):
            self.assertEqual([line["result"], line["unit"]], ["exit_speed", found["unit"]])
            for name, value in {**row, **row["swept"]}.items():
                if isinstance(value, dict) and name != "swept":
                    for part, end in (("value", ""), ("low", "_low"), ("high", "_high")):
                        self.assertEqual(line[name + end],
                                         "" if value[part] is None else line[name + end])
                        if value[part] is not None:
                            self.assertEqual(float(line[name + end]), value[part])
                elif name != "swept":
                    self.assertEqual(line[name], str(value))
        return found["rows"]

    def test_rows_in_full(self):
        for words, name, asked in (
                ((), "mean", {}), ((), "deviation", {"statistic": "deviation"}),
                (("--statistic", "mean"), "mean", {}),
                (("--statistic", "quantile:0.5"), "quantile", {"statistic": "quantile:0.5"}),
                (("--statistic", "share:>38 m/s"), "share", {"statistic": "share:>38 m/s"}),
                (("--against", "1"), "difference", {"against": "1"}),
                (("--against", "1"), "ratio", {"against": "1", "statistic": "deviation"}),
                (("--against", "1", "--statistic", "share:>38 m/s"), "difference",
                 {"against": "1", "statistic": "share:>38 m/s"})):
            rows = self.rows("--over", "base.elevation", *words)
            cells = [cell for cell in self.data.over("exit_speed", "base.elevation", **asked)
                     if not cell.reference]
            self.assertEqual(len(rows), len(cells))
            for row, cell in zip(rows, cells):
                self.assertEqual(row["swept"], {"base.elevation": cell.values[0]})
                self.assertEqual([row[name][part] for part in ("value", "low", "high")],
                                 list(cell.estimate), (words, name))
        self.assertEqual([row["points"] for row in self.rows("--statistic", "mean")], [1] * 6)

    def refusal(self, *words):
        with self.assertRaises(subprocess.CalledProcessError) as found:
            command(*words)
        return found.exception

    def test_refused(self):
        for keys, more, said in (
                (("base.elevtion",), {}, "did you mean base.elevation"),
                (("base.elevation",), {"against": "9"}, "no point 9; they go from 1 to 6"),
                (("base.elevation",), {"statistic": "men"}, "expected mean, deviation")):
            with self.assertRaisesRegex(ld.InputError, said):
                self.data.over("exit_speed", *keys, **more)
        with self.assertRaisesRegex(ld.InputError, 'did you mean "exit_speed"'):
            self.data.over("exit_sped", "base.elevation")
        for words, said in ((("--over", "base.elevtion"), "swept are base.elevation, rocket.mass"),
                            (("--over", "base.elevation", "--what", "exit_sped"), "exit_speed"),
                            (("--against", "9"), "they go from 1 to 6")):
            done = self.refusal("study", "plot", self.where, *words)
            self.assertEqual(done.returncode, 2)
            self.assertEqual(len(done.stderr.splitlines()), 1)
            self.assertIn(said, done.stderr)
        done = self.refusal("plot", self.where, "-o", self.folder / "x.svg")
        self.assertEqual(done.returncode, 2)
        self.assertIn(f"launchdyn study plot {self.where}", done.stderr)

    # ---- pictures

    def picture(self, *words):
        file = self.folder / "over.svg"
        command("study", "plot", self.where, "-o", file, *words)
        return file.read_text()

    def axes(self, svg):
        """Lines from pixels to numbers, fitted to the ticks' marks and texts."""
        mark = re.compile(r"d='M([\d.]+),([\d.]+) L([\d.]+),([\d.]+)  '/>\s*<g transform=[^>]*>\s*"
                          r"<text>(-?[\d.]+)</text>")
        ticks = [(*map(float, found),) for found in mark.findall(svg)]
        x = np.array([(t[0], t[4]) for t in ticks if t[0] == t[2]])
        y = np.array([(t[1], t[4]) for t in ticks if t[1] == t[3]])
        for axis in (x, y):
            line = np.polyfit(axis[:, 0], axis[:, 1], 1)
            self.assertLess(np.abs(np.polyval(line, axis[:, 0]) - axis[:, 1]).max(),
                            0.02 * abs(line[0]))  # within 0.02 pixels
            yield line

    def test_dots_and_intervals_stand_at_their_values(self):
        svg = self.picture("--over", "base.elevation", "--what", "pitch_rate")
        x, y = self.axes(svg)
        dots = [(float(a), float(b)) for a, b in re.findall(
            r"translate\(([\d.]+),([\d.]+)\) scale\(3\.15\)", svg)]
        cells = self.data.over("pitch_rate", "base.elevation")
        self.assertEqual(len(dots), len(cells))
        for (left, top), cell in zip(dots, cells):
            self.assertLess(abs(np.polyval(x, left) - cell.numbers[0]), 0.03 * abs(x[0]))
            self.assertLess(abs(np.polyval(y, top) - 1e3 * cell.estimate.value), 0.03 * abs(y[0]))
        ends = {round(float(v), 2) for v in re.findall(r"[ML][\d.]+,([\d.]+)", svg)}
        for cell in cells:
            for end in (cell.estimate.low, cell.estimate.high):
                pixel = (1e3 * end - y[1]) / y[0]
                self.assertTrue(any(abs(pixel - at) < 0.03 for at in ends), (pixel, sorted(ends)))
        for text in ("base.elevation [deg]", "mean [mrad/s]", "mean of pitch_rate; pooled over "
                     "rocket.mass (2 values); 95 % intervals"):
            self.assertIn(text, svg)

    def test_a_map_has_values_and_a_bar(self):
        svg = self.picture("--over", "base.elevation", "--and", "rocket.mass", "--map", "--what",
                           "exit_speed", "--against", "rocket.mass=59 kg")
        for cell in self.data.over("exit_speed", "base.elevation", "rocket.mass",
                                   against="rocket.mass=59 kg"):
            text = 0 if cell.reference else cell.estimate.value
            self.assertTrue(any(abs(float(found) - text) <= 0.01 * abs(text)
                                for found in re.findall(r"<text>(-?[\d.]+)</text>", svg)))
        for text in ("rocket.mass [kg]", "difference [m/s]", "against rocket.mass 59 kg"):
            self.assertIn(text, svg)

    def test_every_kind(self):
        for words in (("--statistic", "deviation", "--over", "rocket.mass"),
                      ("--statistic", "quantile:0.5", "--over", "rocket.mass", "--and",
                       "base.elevation", "--what", "exit_speed"),
                      ("--statistic", "share:<37 m/s", "--what", "exit_speed"), ()):
            self.assertIn("95 % intervals", self.picture(*words))

    @unittest.skipUnless(pyplot, "matplotlib is not here")
    def test_matplotlib(self):
        axes = self.data.plot("exit_speed", over=("base.elevation", "rocket.mass"))
        self.assertEqual([t.get_text() for t in axes.get_legend().get_texts()],
                         ["rocket.mass 59 kg", "rocket.mass 61 kg"])
        self.assertEqual(axes.get_xlabel(), "base.elevation [deg]")
        cells = self.data.over("exit_speed", "base.elevation", "rocket.mass")
        drawn = axes.containers[1].lines[0].get_xydata()
        np.testing.assert_allclose(drawn, [(*c.numbers[:1], c.estimate.value)
                                           for c in cells if c.values[1] == "61 kg"])
        one, other = self.data.plot("exit_speed", "pitch_rate", over="rocket.mass",
                                    against="rocket.mass=59 kg", statistic="deviation")
        self.assertEqual(one.containers[0].lines[0].get_ydata()[0], 1)
        self.assertIn("against rocket.mass=59 kg", other.get_ylabel())
        pyplot.close("all")

    def test_frame(self):
        try:
            frame = self.data.over("exit_speed", "base.elevation").to_pandas()
        except ld.MissingError:
            self.skipTest("pandas is missing")
        self.assertEqual(list(frame)[:4], ["base.elevation [deg]", "value", "low", "high"])
        self.assertEqual(list(frame["base.elevation [deg]"]), [15, 20, 25])


if __name__ == "__main__":
    unittest.main()
