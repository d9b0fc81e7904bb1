# SPDX-License-Identifier: MIT
"""The examples run, and print their results."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import support

_EXAMPLES = support.SOURCE / "client" / "python" / "examples"
_REQUESTS = support.SCENES / "requests"


def setUpModule():
    unittest.enterModuleContext(support.Daemon())


class ExamplesTest(unittest.TestCase):
    def run_example(self, name, *arguments):
        with tempfile.TemporaryDirectory() as folder:
            command = [sys.executable, "-B", "-W", "error", _EXAMPLES / name, *map(str, arguments)]
            done = subprocess.run(command, cwd=folder, text=True, capture_output=True, timeout=60, check=False)
            self.assertIn(done.returncode, (0, 3), done.stderr)
            self.assertEqual(done.stderr, "")
            return done.stdout, sorted(pathlib.Path(folder).iterdir())

    def test_plan(self):
        text, _ = self.run_example("plan.py", _REQUESTS / "office-graze-column.json")
        self.assertRegex(text, "^ok: 1 collision at first")
        self.assertIn("free: proved", text)
        text, _ = self.run_example("plan.py", _REQUESTS / "office-impossible-safe.json")
        self.assertRegex(text, "^infeasible: no path exists")

    def test_scenes(self):
        text, _ = self.run_example("scenes.py")
        for line in ("crate: box, 12 triangles", "occupied: [ True False]", "1 collision at first",
                     "no collision to correct", "revision 3: move crate"):
            self.assertIn(line, text)

    def test_watch(self):
        text, _ = self.run_example("watch.py")
        for line in (r"^revision 1: .*proved", "\nrevision 2: the path collides at ", "\nrevision 2: .*proved"):
            self.assertRegex(text, line)

    def test_plot(self):
        text, files = self.run_example("plot.py", _REQUESTS / "office-graze-slalom.json", "path.svg")
        self.assertIn("moved by up to", text)
        if "no picture" not in text:
            self.assertEqual([file.name for file in files], ["path.svg"])


if __name__ == "__main__":
    unittest.main()
