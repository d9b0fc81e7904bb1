#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Completes words in the shells that are there: bash always, zsh and fish if they are installed.

    completion_test.py --made DIR     the folder that make_manual.py wrote
"""

import argparse
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from typed_shell import TypedShell

MADE = None  # set by main

# A line without its last word's end, and the words that may follow there. Files are in `folder`.
CASES = [
    ("camway pl", {"plan"}),
    ("camway scene de", {"describe"}),
    ("camway scene l", {"load", "list"}),
    ("camway plan --up ", {"as-in-file", "z-to-y", "y-to-z"}),
    ("camway plan --method k", {"keyframe_insertion"}),
    ("camway plan --respon", {"--response", "--response-dir"}),
    ("camway plan --request re", {"request.json", "results/"}),
    ("camway plan --no-timing --response-dir re", {"results/"}),
    ("camway state show re", {"request.json", "results/"}),
    ("camway replay re", {"request.json", "results/"}),
    ("camway replay --baseline re", {"request.json", "results/"}),
    ("camway unpack re", {"request.json", "results/"}),
    ("camway pack re", {"request.json", "results/"}),
    ("camway session re", {"request.json", "results/"}),
    ("camway load --he", {"--help"}),
    ("camway scene load --up", {"--up", "--upload"}),
    ("camwayd --role ", {"alone", "front", "planner"}),
    ("camwayd --log-level wa", {"warn"}),
    ("camwayd --state re", {"request.json", "results/"}),
    ("camwayd --scene-roots re", {"results/"}),
]
# Cases of bash alone: the other shells offer more words for these lines.
ONLY_BASH = [
    ("camway plan --up=z", {"z-to-y"}),
    ("camway plan --request request.json re", {"request.json", "results/"}),  # takes several
    ("camway plan --scale 2 --up y", {"y-to-z"}),
    ("camway plan --scale ", set()),
    ("camway plan --request=re", {"request.json", "results/"}),
    ("camway plan --request=", {"request.json", "results/"}),
    ("camway plan --response-dir=re", {"results/"}),
    ("camway plan --no-timing --request=results/../req", {"results/../request.json"}),
    ("camway plan --request=request.json --up=y", {"y-to-z"}),
    ("camway replay --scene office=re", {"request.json", "results/"}),
    ("camway replay --scene=office=re", {"request.json", "results/"}),
    ("camway replay --scene office=", {"request.json", "results/"}),
    ("camway replay --scene re", set()),
    ("camway replay --scene=re", set()),
    ("camwayd --scene office=req", {"request.json"}),
]
# Cases of a bash whose user took = out of COMP_WORDBREAKS: words are whole, and so are completions.
UNDIVIDED = [
    ("camway plan --request=re", {"--request=request.json", "--request=results"}),
    ("camway plan --request=req", {"--request=request.json"}),
    ("camway plan --response-dir=re", {"--response-dir=results/"}),
    ("camway plan --up=z", {"--up=z-to-y"}),
    ("camway plan --scale=", set()),
    ("camway plan --nothing=", set()),
    ("camway plan --request=request.json --up y", {"y-to-z"}),
    ("camway replay --scene office=req", {"office=request.json"}),
    ("camway replay --scene=office=req", {"--scene=office=request.json"}),
    ("camway replay --scene re", set()),
]


# Cases of fish alone, whose completions are whole words.
ONLY_FISH = [
    ("camway plan --request=re", {"--request=request.json", "--request=results/"}),
    ("camway replay --scene office=re", {"office=request.json", "office=results/"}),
]


def folder_of_files():
    folder = pathlib.Path(tempfile.mkdtemp())
    (folder / "request.json").write_text("{}")
    (folder / "results").mkdir()
    return folder


class Completion(unittest.TestCase):
    def setUp(self):
        self.folder = folder_of_files()
        self.addCleanup(shutil.rmtree, self.folder)

    def test_bash_offers_commands_flags_values_and_files(self):
        for line, expected in CASES + ONLY_BASH:
            with self.subTest(line):
                self.assertEqual(self.offered_by_bash(line, re.split(r" |(=)", line)), expected)

    def test_bash_completes_words_that_it_does_not_divide(self):
        for line, expected in UNDIVIDED:
            with self.subTest(line):
                self.assertEqual(self.offered_by_bash(line, line.split(" ")), expected)

    def offered_by_bash(self, line, words):
        words = [word for word in words if word is not None]
        if line.endswith("=") and words[-1] == "":
            words.pop()  # bash completes the sign itself, as an empty word
        program = words[0]
        script = (f'source "{MADE}/bash/{program}"; COMP_WORDS=({" ".join(repr(word) for word in words)}); '
                  f"COMP_CWORD={len(words) - 1}; _{program}_complete; printf '%s\\n' \"${{COMPREPLY[@]}}\"")
        said = subprocess.run(["bash", "--norc", "-u", "-c", script], cwd=self.folder, check=True, text=True,
                              capture_output=True)
        self.assertEqual(said.stderr, "")
        return {word + "/" if (self.folder / word).is_dir() else word for word in said.stdout.split()}

    def test_bash_completes_on_a_terminal(self):
        shell = TypedShell(["bash", "--norc", "--noprofile", "-i"], f"PS1=; source {MADE}/bash/camway", self.folder,
                           {"HOME": str(self.folder)})
        self.addCleanup(shell.close)
        shell.completed("camway pl", "plan ")
        shell.completed("camway plan --up=z", "--up=z-to-y ")
        shell.completed("camway plan --request req", "request.json ")
        shell.completed("camway plan --request=req", "--request=request.json ")
        shell.completed("camway replay --scene office=req", "office=request.json ")
        shell.completed("camway plan --request=~/req", "request.json ")

    def test_bash_without_the_sign_as_a_break_completes_on_a_terminal(self):
        setup = f"PS1=; COMP_WORDBREAKS=${{COMP_WORDBREAKS//=}}; source {MADE}/bash/camway"
        shell = TypedShell(["bash", "--norc", "--noprofile", "-i"], setup, self.folder, {})
        self.addCleanup(shell.close)
        shell.completed("camway plan --request=req", "--request=request.json ")
        shell.completed("camway plan --response-dir=res", "--response-dir=results/")
        shell.completed("camway plan --up=z", "--up=z-to-y ")
        shell.completed("camway replay --scene office=req", "office=request.json ")

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not installed")
    def test_zsh_completes_on_a_terminal(self):
        setup = (f"PS1=; unsetopt zle_bracketed_paste 2>/dev/null; fpath=({MADE}/zsh $fpath); autoload -U compinit; "
                 "compinit -u -D")
        shell = TypedShell(["zsh", "-f", "-i"], setup, self.folder, {})
        self.addCleanup(shell.close)
        for line, end in [("camway pl", "plan "), ("camway scene des", "describe "),
                          ("camway plan --up=z", "--up=z-to-y "), ("camway plan --meth", "--method="),
                          ("camway plan --request=req", "request.json "), ("camway state show res", "results/"),
                          ("camwayd --role=fr", "front "), ("camwayd --state=res", "results/"),
                          ("camway replay --scene=office=req", "request.json "), ("camway replay req", "request.json "),
                          ("camway pack --scene office=req", "office=request.json ")]:
            with self.subTest(line):
                shell.completed(line, end)

    @unittest.skipUnless(shutil.which("fish"), "fish is not installed")
    def test_fish_offers_commands_flags_values_and_files(self):
        script = [f"source {MADE}/fish/camway.fish; source {MADE}/fish/camwayd.fish"]
        script += [f"complete -C '{line}' | string replace -r '\\t.*' ''; echo ---" for line, _ in CASES + ONLY_FISH]
        home = {"HOME": str(self.folder), "XDG_CONFIG_HOME": str(self.folder / "results"), "PATH": "/usr/bin:/bin"}
        said = subprocess.run(["fish", "--no-config", "-c", "\n".join(script)], cwd=self.folder, check=True, text=True,
                              capture_output=True, env=home)
        self.assertEqual(said.stderr, "")
        for (line, expected), offered in zip(CASES + ONLY_FISH, said.stdout.split("---\n")):
            with self.subTest(line):
                self.assertEqual(set(offered.split()), expected)


class Texts(unittest.TestCase):
    """A colon within a text has a meaning to zsh, and is no end of it."""

    def test_texts_go_on_behind_a_colon(self):
        self.assertIn("'gl: looks along -Z, +Y up'", (MADE / "fish/camway.fish").read_text())
        self.assertIn("[gl\\: looks along -Z, +Y up]", (MADE / "zsh/_camway").read_text())


def main():
    global MADE
    parser = argparse.ArgumentParser()
    parser.add_argument("--made", type=pathlib.Path, required=True)
    options, rest = parser.parse_known_args()
    MADE = options.made.resolve()
    unittest.main(argv=["completion_test.py", *rest])


if __name__ == "__main__":
    main()
