"""The package's own text: every public thing is described and typed, lines are short."""

import ast
import re
import unittest

from support import SOURCE

FILES = sorted((SOURCE / "python/launchdyn").glob("*.py"))
ALL = [*FILES, *sorted((SOURCE / "tests/python").glob("*.py"))]


def public(tree):
    """Public classes and functions, and the methods of the classes."""
    for node in tree.body:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)) and not node.name.startswith("_"):
            yield node
            if isinstance(node, ast.ClassDef):
                yield from (inner for inner in node.body if isinstance(inner, ast.FunctionDef))


class TestSource(unittest.TestCase):
    def test_lines(self):
        for path in ALL:
            for number, line in enumerate(path.read_text().splitlines(), 1):
                with self.subTest(f"{path.name}:{number}"):
                    self.assertLessEqual(len(line), 100)
                    self.assertFalse(re.search(r"\s$|\t", line))

    def test_public_things_are_described(self):
        for path in FILES:
            tree = ast.parse(path.read_text())
            self.assertTrue(ast.get_docstring(tree) or not tree.body, path.name)
            for node in public(tree):
                known = node.name.startswith("_") or \
                    path.name == "_library.py" and isinstance(node, ast.ClassDef)
                with self.subTest(f"{path.name}: {node.name}"):
                    self.assertTrue(known or ast.get_docstring(node))

    def test_everything_is_typed(self):
        for path in FILES:
            for node in ast.walk(ast.parse(path.read_text())):
                if not isinstance(node, ast.FunctionDef):
                    continue
                taken = [a for a in (*node.args.args, *node.args.kwonlyargs, node.args.vararg,
                                     node.args.kwarg) if a and a.arg not in ("self", "cls")]
                with self.subTest(f"{path.name}: {node.name}"):
                    self.assertIsNotNone(node.returns)
                    self.assertTrue(all(a.annotation for a in taken))

    def test_what_is_imported_is_used(self):
        for path in (path for path in ALL if path.name != "__init__.py"):
            text = path.read_text()
            for node in ast.walk(ast.parse(text)):
                if isinstance(node, (ast.Import, ast.ImportFrom)) and \
                        getattr(node, "module", "") != "__future__":
                    for name in (a.asname or a.name.split(".")[0] for a in node.names):
                        with self.subTest(f"{path.name}: {name}"):
                            self.assertGreater(len(re.findall(rf"\b{name}\b", text)), 1)


if __name__ == "__main__":
    unittest.main()
