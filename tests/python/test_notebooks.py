"""The notebooks of examples/notebooks: every cell runs, in order, without Jupyter."""

import contextlib
import io
import json
import os
import unittest

from support import EXAMPLES

try:
    from matplotlib import pyplot
except ImportError:
    pyplot = None


class TestNotebooks(unittest.TestCase):
    def cells(self, name):
        """The code of a notebook, whose outputs are stripped."""
        with (EXAMPLES / "notebooks" / f"{name}.ipynb").open() as file:
            for number, cell in enumerate(json.load(file)["cells"], 1):
                if cell["cell_type"] == "code":
                    self.assertEqual((cell["outputs"], cell["execution_count"]), ([], None))
                    yield compile("".join(cell["source"]), f"{name}, cell {number}", "exec")

    @unittest.skipUnless(pyplot, "matplotlib is not here")
    def run_cells(self, name):
        before = os.getcwd()
        self.addCleanup(os.chdir, before)
        self.addCleanup(pyplot.close, "all")
        os.chdir(EXAMPLES / "notebooks")
        names, printed = {}, io.StringIO()
        with contextlib.redirect_stdout(printed):
            for code in self.cells(name):
                exec(code, names)
                for number in pyplot.get_fignums():
                    pyplot.figure(number).canvas.draw()
        return printed.getvalue()

    def test_first_launch(self):
        self.assertIn("meant: mass", self.run_cells("first-launch"))

    def test_clearances(self):
        self.assertIn("24 of 24", self.run_cells("clearances"))

    def test_own_vehicle(self):
        self.assertIn("hard springs", self.run_cells("own-vehicle"))

    def test_fitting(self):
        self.assertIn("thrust, scale: 1.0", self.run_cells("fitting"))

    def test_all_are_here(self):
        tested = {name.removeprefix("test_").replace("_", "-") for name in dir(self)}
        for path in (EXAMPLES / "notebooks").iterdir():
            self.assertIn(path.stem, tested)


if __name__ == "__main__":
    unittest.main()
