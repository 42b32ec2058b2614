"""Optimising: the command's numbers, its picture, and what is refused."""

import json
import unittest

import launchdyn as ld
from support import FIXED, Case, command

SETS = {"scatter": "{samples: 8, factors: {rocket.mass_error: {normal: 0.5 kg}, "
                   "rocket.eccentricity.y: {normal: 1 mm}}}",
        "tubes.modes.bending": 1, "run.tolerance": 1e-4, "run.max_step": "1 ms",
        "optimise": "{over: {tubes.supports.2.at: [1.2 m, 2.6 m]}, evaluations: 8, "
                    "least: {take: deviation, of: pitch_rate}}"}


class TestOptimise(Case):
    def test_the_numbers_of_the_command(self):
        scenario = ld.Scenario.read(FIXED, SETS)
        found = ld.optimise(scenario, self.folder / "own", threads=2)
        words = [word for key, value in SETS.items() for word in ("--set", f"{key}={value}")]
        command("optimise", FIXED, "-q", "--out", self.folder / "theirs", *words)
        theirs = json.loads((self.folder / "theirs/optimise.json").read_text())
        self.assertEqual(found.document, theirs)
        key = found.keys["tubes.supports.2.at"]
        self.assertEqual((key.value, key.before, key.unit), (theirs["keys"][0]["found"], 1.8, "m"))
        self.assertEqual(found.least.value, theirs["least"]["found_others"]["value"])
        self.assertTrue(found.gain.low < found.gain.value < found.gain.high)
        self.assertTrue(found.holds)
        self.assertIn("tubes.supports.2.at [m]", str(found))
        found.plot(self.folder / "course.svg")
        self.assertIn("candidates", (self.folder / "course.svg").read_text())
        best = ld.Scenario.read(self.folder / "own/optimised.yaml")
        self.assertEqual(best["tubes.supports.2.at"], key.value)

    def test_what_is_refused(self):
        with self.assertRaisesRegex(ld.InputError, "no block optimise"):
            ld.optimise(ld.Scenario.read(FIXED))
        with self.assertRaisesRegex(ld.InputError, "which is no aim"):
            ld.Scenario.read(FIXED, {"run.end": "landing", "optimise": "{over: {rocket.mass: "
                                     "[50 kg, 70 kg]}, least: {of: drift}}"})


if __name__ == "__main__":
    unittest.main()
