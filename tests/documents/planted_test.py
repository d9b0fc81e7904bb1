#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Documents that are right and documents that are wrong, for check_documents.py."""
import argparse
import pathlib
import sys
import tempfile
import unittest

from blocks import blocks_of
from check_documents import Documents
from check_links import faults_of

_SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(_SOURCE / "docs"))
_PROGRAMS = None
_REQUEST = """{"scene": "../office.obj", "camera": {"fov_x_deg": 80, "fov_y_deg": 60, "near": 0.15},
 "keyframes": [{"position": [12.5, 1.6, 12.8], "orientation": [1, 0, 0, 0]},
               {"position": [12.5, 1.6, 13.8], "orientation": [1, 0, 0, 0]}]}"""


def indented(text):
    return "".join(f"    {line}\n" for line in text.splitlines())


class PlantedTest(unittest.TestCase):
    def faults(self, document):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "planted.md"
            file.write_text(document)
            documents = Documents(_SOURCE, _PROGRAMS)
            documents.check(file)
        return "\n".join(documents.faults)

    def assert_passes(self, document):
        self.assertEqual(self.faults(document), "")

    def assert_fails(self, document, reason):
        self.assertIn(reason, self.faults(document))

    def test_commands_have_to_succeed(self):
        self.assert_passes("    $ true\n    $ camway --version\n")
        self.assert_fails("    $ true\n    $ camway nothing\n", "exit code 2")
        self.assert_fails("```sh\n$ false\n```\n", "exit code 1")

    def test_shown_output_has_to_be_what_is_printed(self):
        self.assert_passes("    $ printf 'a b\\nc\\n'\n    a ...\n    c\n")
        self.assert_passes("    $ printf 'a b\\nc\\n'\n\nwithout output\n")
        self.assert_fails("    $ printf 'a b\\nc\\n'\n    a b\n", "and not")
        self.assert_fails("    $ echo 'a+b'\n    aab\n", "and not")

    def test_requests_have_to_be_complete(self):
        self.assert_passes(indented(_REQUEST))
        self.assert_passes("```json\n[1, 2]\n```\n")
        self.assert_fails(indented(_REQUEST.replace("1.6", "...")), "Expecting value")
        self.assert_fails(indented(_REQUEST.replace("fov_x_deg", "fov")), "exit code 2")

    def test_python_goes_on_from_the_blocks_before(self):
        self.assert_passes("```python\na = 1\n```\n```python\nassert a == 1\n```\n")
        self.assert_fails("```python\nassert a == 1\n```\n", "NameError")
        self.assert_passes("<!-- python before: a = 1 -->\n```python\nassert a == 1\n```\n")

    def test_cpp_has_to_compile(self):
        self.assert_passes("```cpp\n#include <camway/client.h>\ncamway::Client* client;\n```\n")
        self.assert_fails("    #include <camway/client.h>\n    camway::Nothing n;\n", "exit code 1")

    def test_c_has_to_compile_and_to_succeed(self):
        program = "```c\n#include <camway/camway.h>\nint main(void) { return camway_abi_version() < 1000; }\n```\n"
        self.assert_passes(program)
        self.assert_fails(program.replace("<", ">"), "exit code 1")
        self.assert_fails(program.replace("version()", "version(1)"), "exit code 1")

    def test_configurations_have_to_be_good(self):
        self.assert_passes("```toml\n[log]\nlevel = \"info\"\n```\n")
        self.assert_fails("```toml\n[log]\nlevels = \"info\"\n```\n", "levels")

    def test_other_blocks_need_a_reason(self):
        self.assert_fails("text\n\n    wire -> request\n", "nobody knows how to run this")
        self.assert_fails("```java\nint a;\n```\n", "nobody knows how to run this")
        self.assert_passes("text\n\n<!-- not run: a diagram -->\n\n    wire -> request\n")

    def test_marks_have_to_be_known_and_before_a_block(self):
        self.assert_fails("<!-- never run: a diagram -->\n\n    a -> b\n", "no such mark")
        self.assert_fails("<!-- not run: a diagram -->\n\ntext\n\n    a -> b\n", "before no code")
        self.assert_fails("    $ true\n\n<!-- not run: a diagram -->\n", "before no code")

    def test_preparations_and_interruptions(self):
        self.assert_passes("<!-- run first: touch file -->\n\n    $ ls file\n")
        self.assert_fails("<!-- run first: false -->\n\n    $ true\n", "exit code 1")
        self.assert_passes("<!-- interrupted after: true -->\n\n    $ sleep 1000\n")
        self.assert_fails("<!-- interrupted after: false -->\n\n    $ sleep 1000\n", "exit code 1")

    def test_daemons_stay_for_the_commands_behind_them(self):
        self.assert_passes("    $ camwayd --scene maze=scenes/maze.obj\n\n"
                           "    $ camway scene describe maze\n")
        self.assert_fails("    $ camwayd --scene maze=nothing.obj\n", "nothing.obj")

    def test_links_have_to_lead_somewhere(self):
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder)
            (source / "a.md").write_text("# A path, in `ten` lines\n\n[b](b.md) [c](b.md#c) [here](#a-path-in-ten-lines)\n")
            (source / "b.md").write_text("# B\n")
            self.assertEqual(list(faults_of(source, "a.md")), ["a.md: b.md#c: there is no such heading"])
            (source / "b.md").unlink()
            self.assertEqual(len(list(faults_of(source, "a.md"))), 2)

    def test_tables_of_members_follow_the_lcm_files(self):
        import wire_tables
        with tempfile.TemporaryDirectory() as folder:
            wire_tables.TYPES = pathlib.Path(folder)
            (wire_tables.TYPES / "camway_a_t.lcm").write_text("""package camway;

// What it is.
struct a_t
{
    const int8_t ON = 1, OFF = 0;  // a switch
    string client_id;  // [max 32] who asks
    // Sizes:
    int32_t num_points;
    double points_m[num_points][3];  // on the line that follows:
                                     // more | of it
}
""")
            table = wire_tables.members_of("a_t")
        self.assertIn("| `client_id` | `string` | who asks; at most 32 bytes |\n", table)
        self.assertIn("| | | *Sizes:* |\n| `num_points` | `int32_t` |  |\n", table)
        self.assertIn(r"| `points_m` | `double[num_points][3]` | on the line that follows: more \| of it |", table)
        self.assertIn("| `ON`, `OFF` | 1, 0 | a switch |\n", table)

    def test_indented_paragraphs_are_no_blocks(self):
        text = "- a list\n    goes on\n\n    $ code\n\n    of one block\n\ntext\n    goes on\n"
        self.assertEqual([block.text for block in blocks_of("f", text)],
                         ["$ code\n\nof one block"])


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--programs", required=True)
    flags, others = parser.parse_known_args()
    _PROGRAMS = flags.programs
    unittest.main(argv=[sys.argv[0], *others])
