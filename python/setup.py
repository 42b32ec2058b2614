"""Puts the library of the build folder beside it into the package; without one it says so and fails."""

import shutil
import sys
from pathlib import Path

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py

LIBRARY = Path(__file__).resolve().parents[1] / "build/liblaunchdyn.so.1"


class WithLibrary(build_py):
    def run(self):
        super().run()
        if self.editable_mode:  # which finds it in the tree
            return
        if not LIBRARY.exists():
            sys.exit(
                f"launchdyn: {LIBRARY} is missing, without which the package is of no use; "
                f"build it first: cmake -S {LIBRARY.parents[1]} -B {LIBRARY.parent} && "
                f"cmake --build {LIBRARY.parent}"
            )
        shutil.copy2(LIBRARY, Path(self.build_lib, "launchdyn"))


class OfThisMachine(Distribution):
    def has_ext_modules(self):
        return LIBRARY.exists()


setup(cmdclass={"build_py": WithLibrary}, distclass=OfThisMachine)
