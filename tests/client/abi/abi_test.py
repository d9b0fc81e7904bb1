#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Holds client/abi/abi.py to the policy: each kind of difference to a release is found, with the version that it needs."""
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "client/abi"))
import abi  # noqa: E402
from c_headers import Declared  # noqa: E402

RELEASED = ("0.1.0", "1.0")
STRUCTS = {"camway_grows": {"struct_size": "uint32_t", "a": "int"}, "camway_fixed": {"a": "int"}}
LINES = {"c camway_f": "libcamway_c.so.1 CAMWAY_C_1.0 int32_t(void)", "c camway_grows": "size 16",
         "c camway_fixed": "size 16", "c CAMWAY_BUSY": "is 104", "c++ camway::Path::end()const": "libcamway.so.0.1",
         "wire status_t": "0123456789abcdef"}


class Policy(unittest.TestCase):
    def words(self, change, now=RELEASED, released=RELEASED, new=()):
        """Returns the words about the lines of a release after `change`."""
        listed = abi.List("client/abi/none.txt")
        listed.released, listed.lines, listed.new = released, dict(LINES), set(new)
        found = {key: value for key, value in {**LINES, **change}.items() if value is not None}
        return "\n".join(words for _, words, _ in abi.differences(listed, found, now, STRUCTS))

    def test_says_nothing_without_a_difference(self):
        self.assertEqual(self.words({}), "")

    def test_a_function_of_c_that_goes_or_changes_needs_a_major_version(self):
        for after in (None, "libcamway_c.so.1 CAMWAY_C_1.0 int64_t(void)"):
            self.assertIn("needs a higher CAMWAY_ABI_MAJOR", self.words({"c camway_f": after}))
            self.assertIn("needs a higher CAMWAY_ABI_MAJOR", self.words({"c camway_f": after}, ("0.2.0", "1.1")))
            self.assertIn("list it", self.words({"c camway_f": after}, ("0.1.1", "2.0")))

    def test_a_constant_keeps_its_value(self):
        self.assertIn("needs a higher CAMWAY_ABI_MAJOR", self.words({"c CAMWAY_BUSY": "is 105"}))

    def test_a_new_function_of_c_needs_a_minor_version_even_when_it_is_listed(self):
        added = {"c camway_g": "libcamway_c.so.1 CAMWAY_C_1.0 void(void)"}
        self.assertIn("needs a higher CAMWAY_ABI_MINOR", self.words(added))
        self.assertIn("list it", self.words(added, ("0.1.1", "1.1")))
        self.assertIn("needs a higher CAMWAY_ABI_MINOR", self.words({}, new=["c camway_f"]))
        self.assertEqual(self.words({}, ("0.1.1", "1.1"), new=["c camway_f"]), "")

    def test_only_a_struct_with_its_size_may_grow(self):
        self.assertIn("needs a higher CAMWAY_ABI_MINOR", self.words({"c camway_grows": "size 24"}))
        self.assertIn("list it", self.words({"c camway_grows": "size 24"}, ("0.1.1", "1.1")))
        self.assertIn("needs a higher CAMWAY_ABI_MAJOR", self.words({"c camway_grows": "size 8"}, ("0.1.1", "1.1")))
        self.assertIn("needs a higher CAMWAY_ABI_MAJOR", self.words({"c camway_fixed": "size 24"}, ("0.1.1", "1.1")))

    def test_cxx_and_messages_change_with_a_minor_version(self):
        for key in ("c++ camway::Path::end()const", "wire status_t"):
            for after in (None, "other"):
                self.assertIn("needs a new minor version", self.words({key: after}, ("0.1.1", "1.0")))
                self.assertIn("list it", self.words({key: after}, ("0.2.0", "1.0")))
        self.assertIn("needs a new minor version", self.words({"wire more_t": "0"}))

    def test_before_a_release_everything_may_change(self):
        for key in LINES:
            self.assertIn("list it", self.words({key: None}, released=None))


class Headers(unittest.TestCase):
    def test_reads_structs_functions_and_constants(self):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "a.h").write_text("""
                /* int camway_commented(void); */
                typedef int32_t camway_status;
                enum { CAMWAY_A = 0, /**< first */ CAMWAY_B = -1 };
                typedef struct camway_s { uint32_t struct_size; double a[3]; /**< two, in a remark */
                  const char *b; double c, d; void (*on_it)(void *user, int x); } camway_s;
                typedef void (*camway_handler)(void *user, const camway_s *event);
                camway_status camway_f(const camway_s *s, const double size_m[3],
                                       size_t count, char **text);
                const char *camway_g(void);""")
            declared = Declared(pathlib.Path(folder))
        self.assertEqual(declared.structs, {"camway_s": {
            "struct_size": "uint32_t", "a": "double [3]", "b": "const char *", "c": "double", "d": "double",
            "on_it": "void(void *, int)"}})
        self.assertEqual(declared.constants, ["CAMWAY_A", "CAMWAY_B"])
        self.assertEqual(declared.functions, {
            "camway_f": "camway_status(const camway_s *, const double [3], size_t, char **)",
            "camway_g": "const char *(void)"})
        self.assertEqual(declared.handlers, {"camway_handler": "void(void *, const camway_s *)"})


if __name__ == "__main__":
    unittest.main()
