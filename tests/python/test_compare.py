"""A run beside a log, as the command has it."""

import json
import tempfile
import unittest
from pathlib import Path

import launchdyn as ld
import numpy as np
from support import EXAMPLES, command

LOG = EXAMPLES / "student-rocket/measured.csv"


class TestCompare(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.place.name) / "out"
        command("run", EXAMPLES / "student-rocket/student-rocket.yaml", "--set", "run.end=apogee",
                "--out", cls.folder, "--quiet")
        cls.compared = ld.compare(cls.folder, LOG)

    @classmethod
    def tearDownClass(cls):
        cls.place.cleanup()

    def test_the_numbers_of_the_command(self):
        printed = json.loads(command("compare", self.folder, LOG, "--json"))
        self.assertEqual(self.compared.offset, printed["clock"]["offset"])
        self.assertEqual(self.compared.offset_uncertainty, printed["clock"]["uncertainty"])
        series = self.compared.series["height"]
        [said] = printed["series"]
        for name in ("t", "measured", "simulated"):
            np.testing.assert_array_equal(getattr(series, name), said[name])
        np.testing.assert_array_equal(series.u_val, said["u"])
        self.assertEqual((series.of.error, series.of.u_data, series.of.verdict, series.largest),
                         (said["E_rms"], said["u_D"], said["verdict"], said["E_max"]))
        self.assertEqual([(r.name, r.measured, r.simulated, r.of.u_val)
                          for r in self.compared.results],
                         [(r["name"], r["measured"], r["simulated"], r["u_val"])
                          for r in printed["results"]])
        self.assertEqual(str(self.compared), command("compare", self.folder, LOG))

    def test_residuals_are_those_of_the_arrays(self):
        series = self.compared.series["height"]
        error = series.simulated - series.measured
        self.assertAlmostEqual(series.of.error, np.sqrt(np.mean(error**2)), delta=1e-12)
        self.assertAlmostEqual(series.mean, np.mean(error), delta=1e-12)
        self.assertEqual(series.t_largest, series.t[np.argmax(np.abs(error))])

    def test_what_is_wrong_is_said(self):
        with self.assertRaisesRegex(ld.InputError, "cannot be read"):
            ld.compare(self.folder, self.folder / "no.csv")
        with self.assertRaisesRegex(ld.InputError, "there is no rocket 2"):
            ld.compare(self.folder, LOG, rocket=2)

    def test_a_picture(self):
        picture = self.folder / "compared.svg"
        self.compared.draw(picture)
        self.assertIn("simulated less measured", picture.read_text())


if __name__ == "__main__":
    unittest.main()
