#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tests lcmtypes/wire/generate_layout.py on small files: generate_layout_test.py GENERATOR."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

GENERATOR = sys.argv.pop(1)


def generate(**files):
    """Runs the generator for a_t on files named after their struct; returns exit code, errors and all outputs."""
    with tempfile.TemporaryDirectory() as folder:
        paths = []
        for name, members in files.items():
            path = Path(folder) / f"{name}.lcm"
            path.write_text(f"package camway;\n\nstruct {name}\n{{\n{members}\n}}\n")
            paths.append(str(path))
        outputs = Path(folder) / "layout.cpp", Path(folder) / "limits.h", Path(folder) / "members.h"
        run = subprocess.run([sys.executable, GENERATOR, "--source", outputs[0], "--limits", outputs[1],
                              "--members", outputs[2], "--types", "a_t", "--files", *paths], capture_output=True, text=True)
        return run.returncode, run.stderr, *(o.read_text() if o.exists() else "" for o in outputs)


class GenerateLayout(unittest.TestCase):
    def fields_of(self, **files):
        code, errors, source, *_ = generate(**files)
        self.assertEqual((code, errors), (0, ""))
        body = source[source.index("kA[] = {") + len("kA[] = {"):]
        return body[:body.index("};")].split("\n")[1:-1]

    def test_numbers_and_arrays_have_their_size(self):
        fields = self.fields_of(a_t="  int8_t x;  // a remark; with a semicolon\n  double y[3];\n  byte z[2][4];")
        self.assertEqual([f.strip() for f in fields], ['fixed("x", 1),', 'fixed("y", 24),', 'fixed("z", 8),'])

    def test_constants_are_no_members(self):
        fields = self.fields_of(a_t="  const int32_t A = 1, B = 2;\n  int64_t x;")
        self.assertEqual([f.strip() for f in fields], ['fixed("x", 8),'])

    def test_a_count_belongs_to_its_list(self):
        fields = self.fields_of(a_t="  int32_t n;\n  double p[n][3];")
        self.assertEqual([f.strip() for f in fields], ['list("p", 24),'])

    def test_structs_of_one_size_are_one_field(self):
        fields = self.fields_of(a_t="  b_t b;\n  int32_t n;\n  b_t all[n];", b_t="  double x;\n  boolean y;")
        self.assertEqual([f.strip() for f in fields], ['fixed("b", 9),', 'list("all", 9),'])

    def test_structs_of_many_sizes_are_unfolded(self):
        fields = self.fields_of(a_t="  b_t b;\n  int32_t n;\n  b_t all[n];", b_t="  string s;  // [max 7]")
        self.assertEqual([f.strip() for f in fields], ['text("b.s", 7),', 'list_of("all", kB),'])

    def test_limits_are_constants(self):
        self.assertIn("a_s = 7;", generate(a_t="  string s;  // [max 7] a word")[3])

    def test_members_have_their_limits_counts_and_columns(self):
        members = generate(a_t="  int8_t x;\n  string s;  // [max 7]\n  int32_t n;\n  double p[n][3];\n  b_t all[n];",
                           b_t="  double y[3];")[4]
        for expected in ('Plain{"x", &a_t::x}', 'Text{"s", &a_t::s, 7}', 'List{"p", &a_t::p, &a_t::n, 3}',
                         'List{"all", &a_t::all, &a_t::n, 0}', 'Plain{"y", &b_t::y}'):
            self.assertIn(expected, members)
        self.assertNotIn('"n"', members)

    def test_flags_mark_members(self):
        members = generate(a_t="  boolean has_x;\n  double x;\n  boolean has_y;\n  double y_m;\n  double y_s;\n  boolean has_z;"
                               "\n  double z_m;\n  double x_too;")[4]
        for expected in ("Mark{&a_t::has_x, &a_t::x}", "Mark{&a_t::has_y, &a_t::y_m}", "Mark{&a_t::has_y, &a_t::y_s}",
                         "mark(message.has_x, other.x);", "mark(message.has_y, other.y);", "mark(message.has_z, other.z_m);",
                         "visit(message.y_m, part->m);"):
            self.assertIn(expected, members)
        self.assertNotIn("&a_t::x_too}", members.replace('"x_too", &a_t::x_too}', ""))

    def test_refuses_with_file_and_line(self):
        for members, reason in (("  string s;", "the string s needs a limit"),
                                ("  double p[n];\n  int32_t n;", "the count of p"),
                                ("  int64_t n;\n  double p[n];", "has to be an int32_t"),
                                ("  int32_t n;\n  int32_t m;\n  double p[n];\n  double q[m];", "the count of p"),
                                ("  unknown_t x;", "there is no type unknown_t"),
                                ("  double;", "this is no member")):
            with self.subTest(members):
                code, errors, source, *_ = generate(a_t=members)
                self.assertEqual((code, source), (1, ""))
                self.assertIn(reason, errors)
                self.assertRegex(errors, r"a_t\.lcm:\d+: ")


if __name__ == "__main__":
    unittest.main()
