"""Fits: the command's numbers, and what is refused."""

import json
import unittest

import launchdyn as ld
import numpy as np
from support import FIXED, Case, command

OVER = {"rocket.motor.thrust_scale": (0.9, 1.1), "rocket.lock.release_force": ("2 kN", (10, "kN"))}


class TestFit(Case):
    def setUp(self):
        super().setUp()
        self.launches = self.folder / "launches.csv"
        self.launches.write_text("t_front [ms],t_front_u [ms],t_rear [ms],t_rear_u [ms]\n"
                                 "95.0,0.1,157.5,0.1\n95.2,0.1,157.7,0.1\n")
        self.scenario = ld.Scenario.read(FIXED)

    def test_the_numbers_of_the_command(self):
        found = ld.fit(self.scenario, self.launches, OVER, folder=self.folder / "own", threads=2,
                       starts=1)
        command("fit", FIXED, self.launches, "-q", "--out", self.folder / "theirs",
                "--starts", "1",
                "--over", "rocket.motor.thrust_scale=0.9..1.1",
                "--over", "rocket.lock.release_force=2 kN..10 kN")
        theirs = json.loads((self.folder / "theirs/fit.json").read_text())
        self.assertEqual(found.document, theirs)
        key = found.keys["rocket.lock.release_force"]
        self.assertEqual((key.value, key.unit), (theirs["keys"][1]["value"], "N"))
        self.assertTrue(key.low < key.value < key.high)
        self.assertAlmostEqual(np.sqrt(found.covariance[1, 1]) / key.deviation, 1, 12)
        self.assertIn("rocket.lock.release_force [kN]", str(found))
        fitted = ld.Scenario.read(self.folder / "own/fitted.yaml")
        self.assertEqual(fitted["rocket.lock.release_force"], key.value)

    def test_a_prior(self):
        prior = {"rocket.motor.thrust_scale": (1, 1e-6)}
        found = ld.fit(self.scenario, [self.launches], OVER, prior, starts=1)
        self.assertAlmostEqual(found.keys["rocket.motor.thrust_scale"].value, 1, 4)
        self.assertLess(found.keys["rocket.motor.thrust_scale"].deviation, 1.1e-6)

    def test_what_is_refused(self):
        with self.assertRaisesRegex(ld.InputError, "rising order"):
            ld.fit(self.scenario, self.launches, {"rocket.mass": (61, 60)})
        with self.assertRaisesRegex(ValueError, "not fitted: rocket.mass"):
            ld.fit(self.scenario, self.launches, OVER, {"rocket.mass": (61, 1)})
        with self.assertRaisesRegex(ld.InputError, "1 to 32 keys"):
            ld.fit(self.scenario, self.launches, {})


if __name__ == "__main__":
    unittest.main()
