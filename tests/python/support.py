"""What the tests of the Python package share: places, the command, an external base."""

import csv
import importlib.util
import math
import os
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

import launchdyn as ld
import numpy as np

SOURCE = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("LAUNCHDYN_BUILD", SOURCE / "build"))
EXAMPLES = SOURCE / "examples"
FIXED = EXAMPLES / "fixed.yaml"

# Where it is started in the background, too, whose programs are deaf to Ctrl-C.
signal.signal(signal.SIGINT, signal.default_int_handler)

ELEVATION = math.radians(19.8)


def command(*arguments):
    """What the command prints. What Python was started with for a sanitized library is not for a
    program that brings its own sanitizer."""
    words = [str(BUILD / "launchdyn"), *map(str, arguments)]
    environment = {name: value for name, value in os.environ.items() if name != "LD_PRELOAD"}
    return subprocess.run(words, check=True, capture_output=True, text=True,
                          env=environment).stdout


def written(path):
    """The columns of a CSV file of results, whose numbers have all their digits."""
    with path.open() as file:
        rows = [row for row in csv.reader(file) if row and not row[0].startswith("#")]
    names = [name.split(" [")[0] for name in rows[0]]
    values = np.array([[float(x) if x else np.nan for x in row] for row in rows[1:]])
    return dict(zip(names, values.T))


def needs(name):
    """Skips a test where a module is missing."""
    return unittest.skipUnless(importlib.util.find_spec(name), f"{name} is missing")


def scattered(samples, **more):
    """The fixed launcher with a scattered mass."""
    return ld.Scenario.read(FIXED, {"scatter.samples": samples,
                                    "scatter.factors": {"rocket.mass": {"normal": "1 kg"}}, **more})


def flights(samples):
    """A flight alone with a scattered mass: a study of many samples in little time."""
    return ld.Scenario.read(EXAMPLES / "flight.yaml", {
        "scatter.samples": samples, "scatter.factors": {"rocket.mass": {"normal": "0.1 kg"}}})


def resting_frame(height=0.0):
    """A base that does not move, at the elevation of the fixed launcher."""
    half = ELEVATION / 2
    return ld.BaseFrame((0, height, 0), (math.cos(half), 0, 0, math.sin(half)))


def external():
    """The fixed launcher on an externally driven base."""
    return ld.Scenario.read(FIXED, {"base.kind": "external", "base.elevation": None})


class Case(unittest.TestCase):
    """A test with a folder of its own that goes with it."""

    def setUp(self):
        held = tempfile.TemporaryDirectory()
        self.addCleanup(held.cleanup)
        self.folder = Path(held.name)

    def near(self, what, found, expected, bound, relative=False):
        """Prints the largest difference, also relative to each number (to the largest one where
        that is 0), and holds it below its bound."""
        found, expected = np.atleast_1d(found), np.atleast_1d(expected).astype(float)
        self.assertEqual(found.shape, expected.shape)
        size = np.where(expected == 0, np.abs(expected).max(), np.abs(expected)) if relative else 1
        most = float(np.max(np.abs(found - expected) / size))
        print(f"    {what:60} {most:9.2e}  bound {bound:.2e}")
        self.assertLessEqual(most, bound)
