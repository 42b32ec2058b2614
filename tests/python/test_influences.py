"""What factors do to results: indices and effects against the values themselves, pictures."""

import unittest

import launchdyn as ld
import numpy as np
from support import EXAMPLES, Case, needs

FACTORS = {"rocket.mass_error": "0.2 kg", "environment.density_scale": "1 %",
           "rocket.motor.thrust_scale": "1 %"}


class TestInfluences(Case):
    def study(self, plan, name):
        sets = {"scatter.samples": 64, "scatter.plan": plan, "scatter.factors": {
            path: {"normal": deviation} for path, deviation in FACTORS.items()}}
        with ld.Study.read(EXAMPLES / "flight.yaml", sets) as study:
            return study.run(self.folder / name)

    def test_indices_are_those_of_the_values(self):
        data = self.study("saltelli", "saltelli")
        found = data.influences("downrange")
        self.assertEqual({f.factor for f in found}, set(data.factors))
        self.assertEqual([f.total.value for f in found],
                         sorted((f.total.value for f in found), reverse=True))
        rows = data.values("downrange")["downrange"].reshape(64, 5)
        rows = rows - rows[:, :2].mean()
        a, b = rows[:, 0], rows[:, 1]
        variance = (a ** 2 + b ** 2).mean() / 2
        for number, factor in enumerate(FACTORS):
            one = next(f for f in found if f.factor == factor)
            swapped = rows[:, 2 + number]
            self.assertAlmostEqual(one.total.value, ((a - swapped) ** 2).mean() / 2 / variance, 9)
            slope = np.cov(a * b, b * swapped)[0, 1] / np.var(a * b, ddof=1)
            first = (b * (swapped - slope * a)).mean() / variance
            self.assertAlmostEqual(one.first.value, first, 9)
            self.assertAlmostEqual(one.together.value, one.total.value - first, 9)
            self.assertTrue(np.isnan(one.mu_star.value) and np.isnan(one.sigma))
            self.assertEqual((one.count, one.groups), (64, 64))
        self.assertIn("% of its variance", data.show("downrange", sensitivity="total"))
        self.assertRaises(ld.InputError, data.show, "downrange", sensitivity="morris")
        self.assertRaises(ValueError, data.show, "downrange", sensitivity="all")

    def test_effects(self):
        data = self.study("morris", "morris")
        for found in data.influences("downrange"):
            self.assertEqual((found.count, found.groups), (64, 64))
            self.assertAlmostEqual(abs(found.mu.value), found.mu_star.value, 6)
            self.assertLess(found.sigma, 0.2 * found.mu_star.value)

    def test_of_a_plan_without_rows(self):
        data = self.study("random", "random")
        for found in data.influences("downrange"):
            share = data.sensitivity("downrange", found.factor)
            self.assertEqual(found.first, share)
            self.assertTrue(np.isnan(found.total.value))

    @needs("matplotlib")
    def test_bars(self):
        import matplotlib
        matplotlib.use("Agg")
        for plan, bars in (("saltelli", 6), ("morris", 3), ("random", 3)):
            axes = self.study(plan, plan).plot("downrange", sensitivity=True)
            self.assertEqual(len(axes.patches), bars)
            self.assertEqual(len(axes.get_yticks()), 3)
            matplotlib.pyplot.close(axes.figure)


if __name__ == "__main__":
    unittest.main()
