# SPDX-License-Identifier: MIT
"""The types of the package: its stubs are complete, and the package and its examples keep to them."""
import ast
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import support

import camway
from camway import _native

_OPERATORS = {"__len__", "__eq__", "__reduce__"}
_PACKAGE = pathlib.Path(camway.__file__).parent
_EXAMPLES = support.SOURCE / "client" / "python" / "examples"


def run_mypy(module, *arguments):
    with tempfile.TemporaryDirectory() as folder:
        path = f"{_PACKAGE.parent}"
        return subprocess.run([sys.executable, "-m", module, *arguments], cwd=folder, text=True, capture_output=True,
                              env=os.environ | {"MYPYPATH": path, "PYTHONPATH": path}, check=False)


@unittest.skipIf(subprocess.run([sys.executable, "-c", "import mypy"], capture_output=True, check=False).returncode,
                 "mypy is not installed")
class TypesTest(unittest.TestCase):
    def test_the_package_and_the_examples_keep_to_the_types(self):
        files = sorted(map(str, _EXAMPLES.glob("*.py")))
        done = run_mypy("mypy", "--strict", "--no-error-summary", "--cache-dir", os.devnull, "--scripts-are-modules",
                        *files, *map(str, sorted(_PACKAGE.glob("*.py"))))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


class StubsTest(unittest.TestCase):
    """The stub of the module in C++ has the names and arguments that are there, all of them."""

    def test_the_package_has_the_version_of_the_command(self):
        told = subprocess.run([support.PROGRAMS / "camway", "--version"], text=True, capture_output=True, check=True)
        self.assertIn(camway.__version__, told.stdout)

    def test_stubs_are_of_what_is_there(self):
        stub = ast.parse((_PACKAGE / "_native.pyi").read_text())
        self.compare(stub.body, _native)

    def compare(self, body, there):
        written = {node.name: node for node in body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
        names = {name for name, value in vars(there).items()
                 if (callable(value) or isinstance(value, (property, staticmethod)))
                 and (not name.startswith("_") or name in _OPERATORS & set(written))}
        self.assertEqual(set(written), names | (set(written) & {"__init__"}), there)
        for name, node in written.items():
            if isinstance(node, ast.ClassDef):
                self.compare(node.body, getattr(there, name))
            elif not isinstance(vars(there)[name], property) and name not in _OPERATORS:
                arguments = [each.arg for each in node.args.args + node.args.kwonlyargs if each.arg != "self"]
                signature = re.match(r"[^(]*\((.*)\) ->", getattr(there, name).__doc__).group(1)
                found = [each for each in re.findall(r"(\w+): ", signature) if each != "self"]
                self.assertEqual(arguments, found, f"{there.__name__}.{name}")


if __name__ == "__main__":
    unittest.main()
