"""What the package believes of the C interface is what the headers say."""

import ctypes
import re
import unittest

from launchdyn import _library
from launchdyn.errors import KINDS, Status
from launchdyn.simulation import EventKind
from support import SOURCE

HEADERS = "\n".join(path.read_text() for path in sorted((SOURCE / "include/launchdyn").glob("*.h")))
PLAIN = re.sub(r"//.*", "", HEADERS)
POINTER = "pointer"
SCALARS = {"double": ctypes.c_double, "int": ctypes.c_int, "ld_status": ctypes.c_int,
           "ld_fmu_part": ctypes.c_int, "ld_event_kind": ctypes.c_int,
           "ld_verdict": ctypes.c_int, "ld_hinge": ctypes.c_int, "size_t": ctypes.c_size_t,
           "bool": ctypes.c_bool, "int64_t": ctypes.c_int64,
           "unsigned char": ctypes.c_ubyte, "void": None}


def kind_in_c(declared):
    """What passes for a C type: a scalar of ctypes, a text, or a pointer to something."""
    words = declared.replace("const ", "").strip()
    if words == "char *":
        return ctypes.c_char_p if "const" in declared else POINTER
    return POINTER if "*" in words else SCALARS.get(words, words)


def kind_in_ctypes(declared):
    if declared is ctypes.c_void_p or hasattr(declared, "contents") or \
            (isinstance(declared, type) and issubclass(declared, ctypes._CFuncPtr)):
        return POINTER
    if isinstance(declared, type) and issubclass(declared, ctypes.Structure):
        return declared.__name__
    return declared


def without_name(declared):
    return re.sub(r"\w+(\[\w*\])?$", r"*" if declared.endswith("]") else "",
                  declared.strip()).strip()


def signature(name):
    """What a function of the headers returns and takes."""
    found = re.search(r"^([\w ]+[ *])\b" + name + r"\(((?:[^()]|\([^()]*\))*)\);", PLAIN, re.M)
    if not found:
        return None
    inside = re.sub(r"void \(\*\w+\)\([^)]*\)", "void *taker", " ".join(found[2].split()))
    taken = [] if inside == "void" else [kind_in_c(without_name(part))
                                         for part in inside.split(",")]
    return kind_in_c(found[1].strip()), taken


class TestInterface(unittest.TestCase):
    def test_functions_are_those_of_the_headers(self):
        listed = (SOURCE / "cmake/symbols").read_text().split()
        for name, (result, arguments) in _library.FUNCTIONS.items():
            with self.subTest(name):
                self.assertIn(name, listed)
                returned, taken = signature(name)
                self.assertEqual(kind_in_ctypes(result), returned)
                if name not in ("ld_scenario_keys", "ld_summary_each"):
                    self.assertEqual([kind_in_ctypes(a) for a in arguments], taken)

    def test_structs_have_the_sizes_that_the_compiler_holds(self):
        sizes = dict(re.findall(r"^SIZE\((\w+), (\d+)\);",
                                (SOURCE / "tests/base/test_public_structs.c").read_text(), re.M))
        structs = [s for s in vars(_library).values()
                   if isinstance(s, type) and issubclass(s, ctypes.Structure) and
                   s is not ctypes.Structure]
        self.assertGreater(len(structs), 20)
        for struct in structs:
            with self.subTest(struct.__name__):
                self.assertEqual(ctypes.sizeof(struct), int(sizes[struct.__name__]))

    def test_members_have_the_order_of_the_headers(self):
        for struct in vars(_library).values():
            if not (isinstance(struct, type) and issubclass(struct, ctypes.Structure)) or \
                    struct is ctypes.Structure:
                continue
            name = struct.__name__
            with self.subTest(name):
                body = re.search(r"typedef struct " + name + r" \{(.*?)\n\} " + name + ";", PLAIN,
                                 re.S)[1]
                body = re.sub(r"union \{[^}]*?(\w+ \w+);\s*\}", r"\1", body)  # the last of it
                members = []
                for line in body.split(";"):
                    line = re.sub(r"\(\*(\w+)\)\(.*\)", r"\1", " ".join(line.split()))
                    line = re.sub(r"\[\w+\]", "", line)
                    if line:
                        first, *rest = line.split(",")
                        members += [re.findall(r"\w+", part)[-1] for part in (first, *rest)]
                self.assertEqual([field[0] for field in struct._fields_], members)

    def test_numbers_have_the_values_of_the_headers(self):
        statuses = re.search(r"typedef enum ld_status \{(.*?)\}", PLAIN, re.S)[1]
        names = [name.removeprefix("LD_ERR_") for name in re.findall(r"LD_\w+", statuses)]
        self.assertEqual(["LD_" + names[0].removeprefix("LD_"), *names[1:]],
                         ["LD_OK", *[status.name for status in Status][1:]])
        self.assertEqual(set(KINDS), set(Status) - {Status.OK})
        events = re.search(r"typedef enum ld_event_kind \{(.*?)\}", PLAIN, re.S)[1]
        self.assertEqual(re.findall(r"LD_EVENT_(\w+)", events), [kind.name for kind in EventKind])

    def test_versions_agree(self):
        major, minor, patch = re.findall(r"define LD_VERSION_\w+ (\d+)", HEADERS)
        project = (SOURCE / "python/pyproject.toml").read_text()
        self.assertEqual(_library.VERSION, f"{major}.{minor}.{patch}")
        self.assertIn(f'version = "{_library.VERSION}"', project)

    def test_another_version_is_refused(self):
        number = _library.library.ld_version_number()
        _library.check_version(number + 1, "another patch")
        with self.assertRaisesRegex(ImportError, "requires launchdyn"):
            _library.check_version(number + 100, "another minor version")


if __name__ == "__main__":
    unittest.main()
