"""Where the library is searched, and what is said where it is not."""

import os
import shutil
import subprocess
import sys
import sysconfig
import unittest
import zipfile

from support import BUILD, SOURCE, Case, needs


def python(code, **environment):
    """A program of its own: its end code, what it prints and complains."""
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True,
                         env={**os.environ, **environment}, check=False)
    return ran.returncode, ran.stdout.strip(), ran.stderr


FOUND = "import launchdyn; print(launchdyn._library.library._name)"


class TestLibrary(Case):
    def package(self, *above):
        """A copy of the package below some folders."""
        home = self.folder.joinpath(*above)
        shutil.copytree(SOURCE / "python/launchdyn", home / "launchdyn",
                        ignore=shutil.ignore_patterns("__pycache__"))
        return home

    def test_the_variable_comes_first_and_alone(self):
        code, _, said = python(FOUND, LAUNCHDYN_LIBRARY="/nowhere/liblaunchdyn.so.1")
        self.assertEqual(code, 1)
        self.assertIn("ImportError: the library of launchdyn was not found", said)
        self.assertIn("/nowhere/liblaunchdyn.so.1", said)

    def test_beside_the_package(self):
        home = self.package("site")
        library = home / "launchdyn/liblaunchdyn.so.1"
        library.symlink_to(BUILD / "liblaunchdyn.so.1")
        code, found, said = python(FOUND, LAUNCHDYN_LIBRARY="", PYTHONPATH=str(home))
        self.assertEqual((code, found), (0, str(library)), said)

    def test_in_the_installation_that_holds_it(self):
        home = self.package("usr", "lib", "python3", "dist-packages")
        library = self.folder / "usr/lib/liblaunchdyn.so.1"
        library.symlink_to(BUILD / "liblaunchdyn.so.1")
        code, found, said = python(FOUND, LAUNCHDYN_LIBRARY="", PYTHONPATH=str(home))
        self.assertEqual((code, found), (0, str(library)), said)

    def test_where_the_system_finds_it(self):
        home = self.package("site")
        code, found, said = python(FOUND, LAUNCHDYN_LIBRARY="", PYTHONPATH=str(home),
                                   LD_LIBRARY_PATH=str(BUILD))
        self.assertEqual((code, found), (0, "liblaunchdyn.so.1"), said)

    @needs("setuptools")
    @needs("wheel")
    def test_a_wheel_has_the_library_of_the_build_folder(self):
        shutil.copytree(SOURCE / "python", self.folder / "python",
                        ignore=shutil.ignore_patterns("__pycache__", "build", "*.egg-info"))
        (self.folder / "build").mkdir()
        library = self.folder / "build/liblaunchdyn.so.1"
        modules = {path.name for path in (SOURCE / "python/launchdyn").glob("*.py")}
        build = [sys.executable, "-c",
                 "from setuptools import build_meta; build_meta.build_wheel('../out')"]
        ran = subprocess.run(build, cwd=self.folder / "python", check=False, capture_output=True,
                             text=True)
        self.assertNotEqual(ran.returncode, 0)
        self.assertIn(f"launchdyn: {library} is missing, without which the package is of no use; "
                      "build it first: cmake -S ", ran.stderr)
        library.write_bytes(b"the library")
        subprocess.run(build, cwd=self.folder / "python", check=True, capture_output=True)
        tag = "-py3-none-" + sysconfig.get_platform().replace("-", "_")
        wheel, = (self.folder / "out").glob("*.whl")
        self.assertTrue(wheel.name.endswith(f"{tag}.whl"), wheel.name)
        with zipfile.ZipFile(wheel) as package:
            held = {name.removeprefix("launchdyn/") for name in package.namelist()
                    if name.startswith("launchdyn/")}
            self.assertEqual(held, modules | {"py.typed", library.name})
            self.assertEqual(package.read(f"launchdyn/{library.name}"), b"the library")

    def test_another_library_is_refused(self):
        code, _, said = python(FOUND, LAUNCHDYN_LIBRARY="libc.so.6")
        self.assertEqual(code, 1)
        self.assertIn("libc.so.6 has no ld_version", said)


if __name__ == "__main__":
    unittest.main()
