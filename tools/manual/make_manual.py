#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the pages of the manual and the completions of shells, from the help of the programs.

    make_manual.py --programs DIR --sample FILE --version V --out DIR

`camway --help-tree` gives the help as JSON: the structure that its text has lost, such as which value of a
flag is a file. OUT gets man/manN/*, bash/*, zsh/* and fish/*. The pages have the date SOURCE_DATE_EPOCH where
the environment has it.
"""

import argparse
import datetime
import os
import pathlib
import time

import help_tree
from bash_completion import bash_completion
from command_pages import command_page, file_name, import_page
from configuration_page import configuration_page
from fish_completion import fish_completion
from zsh_completion import zsh_completion

_IMPORTERS = {"camway-import": "all formats but those below",
              "camway-import-inventor": "Open Inventor and VRML",
              "camway-import-cad": "STEP and IGES"}


def _date():
    seconds = int(os.environ.get("SOURCE_DATE_EPOCH", time.time()))
    return datetime.datetime.fromtimestamp(seconds, datetime.timezone.utc).date().isoformat()


def _pages(camway, camwayd, sample, version):
    """Pairs of the name of a file and its lines."""
    date = _date()
    for command in [camway, *camway.commands]:
        yield f"man/man1/{file_name(command)}.1", command_page(command, 1, date, version)
    yield "man/man8/camwayd.8", command_page(camwayd, 8, date, version)
    yield "man/man5/camwayd.toml.5", configuration_page(sample, date, version)


def _completions(program):
    yield f"bash/{program.name}", bash_completion(program)
    yield f"zsh/_{program.name}", zsh_completion(program)
    yield f"fish/{program.name}.fish", fish_completion(program)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--programs", type=pathlib.Path, required=True)
    parser.add_argument("--sample", type=pathlib.Path, required=True)
    parser.add_argument("--version", required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    options = parser.parse_args()
    camway, camwayd = (help_tree.read(options.programs / name) for name in ("camway", "camwayd"))
    version = f"Camway {options.version}"
    files = dict(_pages(camway, camwayd, options.sample.read_text(), version))
    for name, formats in _IMPORTERS.items():
        files[f"man/man8/{name}.8"] = import_page(name, formats, _date(), version)
    texts = {name: "\n".join(lines) + "\n" for name, lines in files.items()}
    for program in (camway, camwayd):
        texts.update(_completions(program))
    for name, text in texts.items():
        path = options.out / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


if __name__ == "__main__":
    main()
