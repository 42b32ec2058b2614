"""Derivatives: the command's numbers, and what is refused."""

import json
import unittest

import launchdyn as ld
from support import FIXED, Case, command


class TestSensitivity(Case):
    def test_the_numbers_of_the_command(self):
        scenario = ld.Scenario.read(FIXED)
        found = ld.sensitivity(scenario, {"rocket.mass": None, "base.azimuth": "0.01 deg"},
                               threads=2)
        theirs = json.loads(command("sensitivity", FIXED, "rocket.mass", "base.azimuth=0.01 deg",
                                    "--json", "-j", "2"))
        self.assertEqual(found.document, theirs)
        speed = found["exit_speed"]["rocket.mass"]
        self.assertAlmostEqual(speed.derivative, -0.30564235, delta=1e-7)
        self.assertTrue(speed.smooth)
        self.assertIn("exit_speed [m/s]", str(found))

    def test_results_by_name(self):
        found = ld.sensitivity(ld.Scenario.read(FIXED), ["rocket.mass"], ["t_rear"])
        self.assertEqual(list(found.of), ["t_rear"])

    def test_what_is_refused(self):
        scenario = ld.Scenario.read(FIXED)
        with self.assertRaisesRegex(ld.InputError, "did you mean"):
            ld.sensitivity(scenario, ["rocket.mas"])
        with self.assertRaisesRegex(ld.InputError, 'did you mean "t_rear"'):
            ld.sensitivity(scenario, ["rocket.mass"], ["t_reer"])


if __name__ == "__main__":
    unittest.main()
