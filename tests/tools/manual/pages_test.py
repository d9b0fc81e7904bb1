#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The pages of the manual are complete, and groff has nothing to say about them.

    pages_test.py --made DIR --programs DIR
"""

import argparse
import pathlib
import re
import shutil
import subprocess
import tomllib
import unittest

MADE = PROGRAMS = None  # set by main
SAMPLE = pathlib.Path(__file__).resolve().parents[3] / "daemon/process/camwayd.toml"


def shown(page):
    """The text of a page, and the warnings of groff."""
    said = subprocess.run(["groff", "-man", "-ww", "-Tutf8", "-P-cbou", "-rLL=400n", "-K", "utf8", page], check=True,
                          text=True, capture_output=True)
    return said.stdout, said.stderr


def flags_in(text):
    """The flags that a list of options begins its lines with."""
    lists = re.findall(r"^ +(?:-\w,)?(?:-\w, *)?(--[a-z][\w-]*)", text, re.MULTILINE)
    return set(lists)


@unittest.skipUnless(shutil.which("groff"), "groff is not installed")
class Pages(unittest.TestCase):
    def test_groff_warns_of_none(self):
        pages = sorted(MADE.glob("man/*/*"))
        self.assertGreater(len(pages), 20)
        for page in pages:
            self.assertEqual(shown(page)[1], "", page)

    def test_each_flag_of_the_help_is_in_the_page(self):
        for page in sorted(MADE.glob("man/man1/*")) + [MADE / "man/man8/camwayd.8"]:
            command = page.stem.split("-")
            command[0] = str(PROGRAMS / command[0])
            flags = set()
            for words in [command, *self.commands_below(command)]:
                help_text = subprocess.run([*words, "--help"], check=True, text=True, capture_output=True).stdout
                flags |= flags_in(help_text)
            self.assertGreater(len(flags), 0)
            self.assertLessEqual(flags, flags_in(shown(page)[0]), page)

    def commands_below(self, command):
        """The subcommands that have no page of their own."""
        if len(command) == 1:
            return []
        help_text = subprocess.run([*command, "--help"], check=True, text=True, capture_output=True).stdout
        names = re.findall(r"^  ([a-z]+) ", help_text.partition("Subcommands:")[2], re.MULTILINE)
        return [[*command, name] for name in names]

    def test_each_key_of_the_sample_is_in_the_page_with_its_value(self):
        text = shown(MADE / "man/man5/camwayd.toml.5")[0]
        for name, table in tomllib.loads(SAMPLE.read_text()).items():
            keys = table[0] if isinstance(table, list) else table
            # The table, up to the next one: other tables have keys of the same names.
            part = text.partition(f"   [{name}]\n" if isinstance(table, dict) else f"   [[{name}]]\n")[2]
            part = re.split(r"(?m)^   \[", part)[0]
            for key in keys:
                self.assertTrue(re.search(rf"(?m)^ +{key} = \S", part), f"[{name}] {key}")

    def test_each_page_has_its_parts(self):
        for page in sorted(MADE.glob("man/man1/*")):
            text = shown(page)[0]
            for part in ["NAME", "SYNOPSIS", "DESCRIPTION", "EXIT STATUS", "SEE ALSO"]:
                self.assertRegex(text, rf"(?m)^{part}$", page)


def main():
    global MADE, PROGRAMS
    parser = argparse.ArgumentParser()
    parser.add_argument("--made", type=pathlib.Path, required=True)
    parser.add_argument("--programs", type=pathlib.Path, required=True)
    options, rest = parser.parse_known_args()
    MADE, PROGRAMS = options.made.resolve(), options.programs.resolve()
    unittest.main(argv=["pages_test.py", *rest])


if __name__ == "__main__":
    main()
