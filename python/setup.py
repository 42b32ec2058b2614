"""Puts the library of the build folder beside it into the package; without one it says so and fails. scripts/wheel puts
in what it links for all machines (LAUNCHDYN_WHEEL): library, command, licences."""

import os
import shutil
import sys
from pathlib import Path

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py

try:
    from setuptools.command.bdist_wheel import bdist_wheel
except ImportError:
    from wheel.bdist_wheel import bdist_wheel

LIBRARY = Path(__file__).resolve().parents[1] / "build/liblaunchdyn.so.1"
WHEEL = os.environ.get("LAUNCHDYN_WHEEL")
FILES = [Path(WHEEL, name) for name in ("liblaunchdyn.so.1", "launchdyn", "LICENSES.txt")] if WHEEL else [LIBRARY]


class WithLibrary(build_py):
    def run(self):
        super().run()
        if self.editable_mode:  # which finds it in the tree
            return
        if not WHEEL and not LIBRARY.exists():
            sys.exit(
                f"launchdyn: {LIBRARY} is missing, without which the package is of no use; "
                f"build it first: cmake -S {LIBRARY.parents[1]} -B {LIBRARY.parent} && "
                f"cmake --build {LIBRARY.parent}"
            )
        for file in FILES:
            shutil.copy2(file, Path(self.build_lib, "launchdyn"))


class OfThisMachine(Distribution):
    def has_ext_modules(self):
        return all(file.exists() for file in FILES)


class ForEveryPython(bdist_wheel):
    def get_tag(self):
        return "py3", "none", "manylinux_2_28_x86_64" if WHEEL else super().get_tag()[2]


setup(cmdclass={"build_py": WithLibrary, "bdist_wheel": ForEveryPython}, distclass=OfThisMachine)
