#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs every code block of the documents, and the examples of the programs' help.

    tools/scripts/netns.sh tests/documents/check_documents.py --programs BIN [--source DIR] [FILE.md...]

Commands ("$ ...") have to succeed and to print what is shown below them, where "..." stands for
anything; a `camwayd` and a `camway view` stay until the next one or the document's end. Requests are planned, other
JSON is parsed; JavaScript is run by node, if it is there; Python is run behind the document's earlier Python; C++ is compiled against the
client; C is compiled, linked with the library and run; TOML is read by `camwayd --check-config`. What is not run bears a mark that says why
(blocks.py); a block of any other kind without one is a failure. Exit codes: 0, or 1 for failures.
"""
import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys

from blocks import Block, blocks_of
from help_examples import help_examples
from session import Session


class Documents:
    def __init__(self, source, programs):
        self.source = pathlib.Path(source).resolve()
        self.programs = pathlib.Path(programs).resolve()
        self.faults = []
        self.not_run = []
        self.count = 0

    def check(self, file):
        try:
            blocks = blocks_of(str(file), (self.source / file).read_text())
        except ValueError as error:
            self.faults.append(str(error))
            return
        with Session(self.source, self.programs) as session:
            earlier_python = []
            for block in blocks:
                self.check_block(session, block, earlier_python)

    def check_block(self, session, block, earlier_python):
        if "not run" in block.marks:
            self.not_run.append(f"{block.place()}: {block.marks['not run']}")
            if block.kind() == "python":
                compile(block.text, block.place(), "exec")
            return
        self.count += 1
        checks = {"shell": self.check_shell, "json": self.check_json, "cpp": self.check_cpp,
                  "toml": self.check_toml, "javascript": self.check_javascript, "c": self.check_c}
        if "run first" in block.marks:
            self.expect_success(session, block, block.marks["run first"])
        if block.kind() == "python":
            earlier_python += [block.marks.get("python before", ""), block.text]
            session.write("block.py", "\n".join(earlier_python))
            self.expect_success(session, block, f"'{sys.executable}' block.py")
        elif block.kind() in checks:
            checks[block.kind()](session, block)
        else:
            self.faults.append(f"{block.place()}: nobody knows how to run this; "
                               "write `<!-- not run: REASON -->` before it, or `$ ` before commands")

    def check_shell(self, session, block):
        for index, (command, shown) in enumerate(block.commands()):
            meanwhile = block.marks.get("interrupted after") if index == 0 else None
            self.expect_success(session, block, command, shown, meanwhile)

    def check_json(self, session, block):
        try:
            value = json.loads(block.text)
        except ValueError as error:
            self.faults.append(f"{block.place()}: {error}")
            return
        if isinstance(value, dict) and "keyframes" in value and "segments" not in value:
            session.write("scenes/requests/documented.json", block.text)
            self.expect_success(session, block,
                                "camway plan --request scenes/requests/documented.json")

    def check_cpp(self, session, block):
        file = session.write("block.cpp", block.text)
        self.expect_success(session, block,
                            f"c++ -std=c++17 -fsyntax-only -I'{self.source}/client/include' '{file}'")

    def check_c(self, session, block):
        file = session.write("block.c", block.text)
        libraries = self.programs.parent
        self.expect_success(session, block,
                            f"cc -std=c11 -Wall -Wextra -Wpedantic -Werror -I'{self.source}/client/include' '{file}' "
                            f"-o block -L'{libraries}' -lcamway_c -Wl,-rpath,'{libraries}' && ./block")

    def check_javascript(self, session, block):
        if shutil.which("node") is None:
            self.not_run.append(f"{block.place()}: there is no node")
            return
        session.write("block.mjs", block.text)
        # Versions before 22 have a WebSocket only if asked to; later ones take the flag, too.
        self.expect_success(session, block, "node --experimental-websocket block.mjs")

    def check_toml(self, session, block):
        session.write("block.toml", block.text)
        self.expect_success(session, block, "camwayd --config block.toml --scene-roots scenes --check-config")

    def expect_success(self, session, block, command, shown="", meanwhile=None):
        exit_code, output = (session.interrupt(command, meanwhile) if meanwhile
                             else session.run(command))
        if exit_code != 0:
            self.faults.append(f"{block.place()}: {command}: exit code {exit_code}: {output}")
        elif shown and not re.fullmatch(re.escape(shown).replace(r"\.\.\.", ".*"), output, re.DOTALL):
            self.faults.append(f"{block.place()}: {command}: prints\n{output}\nand not\n{shown}")


def files_of(source, pattern):
    """All that git knows of; in a tree without git, all beside build folders."""
    listed = subprocess.run(["git", "-C", source, "ls-files", pattern], capture_output=True, text=True)
    if listed.returncode == 0 and listed.stdout:
        return listed.stdout.split("\n")[:-1]
    root = pathlib.Path(source)
    return sorted(str(file.relative_to(root)) for file in root.rglob(pattern)
                  if "build" not in file.relative_to(root).parts)


def documents_of(source):
    return files_of(source, "*.md")


def check_help(documents):
    """The examples of `--help`, each as if it were a block of a document."""
    with Session(documents.source, documents.programs) as session:
        try:
            examples = help_examples(session)
        except ValueError as error:
            documents.faults.append(str(error))
            return
        for place, command, marks in examples:
            documents.check_block(session, Block(place, 1, "shell", "$ " + command, marks), [])


def main():
    parser = argparse.ArgumentParser(description="Runs what the documents show.")
    parser.add_argument("--source", default=pathlib.Path(__file__).parents[2])
    parser.add_argument("--programs", required=True, help="folder of the built programs")
    parser.add_argument("files", nargs="*", help="documents, relative to the source folder")
    flags = parser.parse_args()
    documents = Documents(flags.source, flags.programs)
    for file in flags.files or documents_of(flags.source):
        documents.check(file)
    if not flags.files:
        check_help(documents)
    print(f"{documents.count} blocks were run; not run:")
    for line in documents.not_run:
        print(f"  {line}")
    for fault in documents.faults:
        print(f"FAULT {fault}")
    return 1 if documents.faults else 0


if __name__ == "__main__":
    sys.exit(main())
