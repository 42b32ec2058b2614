"""The lines of docs/python.md: every block of Python runs, in order, one after the other."""

import ast
import contextlib
import io
import os
import re
import unittest

import launchdyn as ld
from support import EXAMPLES, FIXED, SOURCE, Case, resting_frame

try:
    from matplotlib import pyplot
except ImportError:
    pyplot = None

DOCUMENT = SOURCE / "docs" / "python.md"


def blocks():
    """The blocks of Python, each with the number of its first line."""
    text = DOCUMENT.read_text()
    for found in re.finditer(r"^```python\n(.*?)^```$", text, re.DOTALL | re.MULTILINE):
        yield text.count("\n", 0, found.start(1)) + 1, found.group(1)


def run(block, line, names):
    """Runs statement by statement; what requires a package that is not here is left out."""
    for statement in ast.parse("\n" * (line - 1) + block).body:
        code = compile(ast.Module([statement], []), DOCUMENT.name, "exec")
        try:
            exec(code, names)
        except ld.MissingError as missing:
            print(missing)


class TestDocument(Case):
    def in_a_folder_like_the_readers(self):
        """Examples, of which the study is short; the fixed launcher; a scenario with a fault."""
        examples = self.folder / "examples"
        examples.mkdir()
        for path in EXAMPLES.iterdir():
            if path.name != "salvo.yaml":
                (examples / path.name).symlink_to(path)
        (examples / "salvo.yaml").write_text(
            f"include: {EXAMPLES / 'salvo.yaml'}\nscatter:\n  samples: 3\n")
        (self.folder / "fixed.yaml").write_text(FIXED.read_text())
        (self.folder / "mine.yaml").write_text(f"include: {FIXED}\nrocket:\n  mas: 60 kg\n")
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)

    @unittest.skipUnless(pyplot, "matplotlib is not here")
    def test_every_block_runs(self):
        self.in_a_folder_like_the_readers()
        self.addCleanup(pyplot.close, "all")
        base = resting_frame()
        names = {"text": FIXED.read_text(), "position": (0, 0, 0),
                 "quaternion": base.quaternion, "velocity": (0, 0, 0), "rate": (0, 0, 0)}
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            for line, block in blocks():
                if "BaseFrame" in block:
                    names["scenario"] = ld.Scenario.read(
                        FIXED, {"base.kind": "external", "base.elevation": None})
                run(block, line, names)
        for said in ("37.", "mine.yaml:3:3: rocket.mas", "3 rocket.mas mass", "range"):
            self.assertIn(said, printed.getvalue())


if __name__ == "__main__":
    unittest.main()
