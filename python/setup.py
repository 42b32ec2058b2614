"""Puts the library of the build folder beside it, where there is one, into the package."""

import shutil
from pathlib import Path

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py

LIBRARY = Path(__file__).resolve().parents[1] / "build/liblaunchdyn.so.1"


class WithLibrary(build_py):
    def run(self):
        super().run()
        if LIBRARY.exists() and not self.editable_mode:  # which finds it in the tree
            shutil.copy2(LIBRARY, Path(self.build_lib, "launchdyn"))


class OfThisMachine(Distribution):
    def has_ext_modules(self):
        return LIBRARY.exists()


setup(cmdclass={"build_py": WithLibrary}, distclass=OfThisMachine)
