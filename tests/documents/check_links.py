#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Follows every link of the documents to a file or a heading of this repository, and every path in
backquotes to a file or folder of its sources. Fails for those that lead nowhere.

    tests/documents/check_links.py [--source DIR] [--links-only]
"""
import argparse
import pathlib
import re
import sys

from check_documents import documents_of, files_of

_LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
_FENCE = re.compile(r"^ *```.*?^ *```", re.MULTILINE | re.DOTALL)
_PATH = re.compile(r"`((?:[a-z_]+/)+[a-z0-9_.]*)`")
_MADE_BY_THE_BUILD = ("build/", "camway/members.h")


def anchors_of(text):
    """The names under which the headings of a document can be linked."""
    names = set()
    for heading in re.findall(r"^#+ +(.*)$", _FENCE.sub("", text), re.MULTILINE):
        plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "")
        name = re.sub(r"[^\w\- ]", "", plain.lower()).replace(" ", "-")
        count = 1
        while name in names:
            name = f"{name.removesuffix(f'-{count - 1}')}-{count}"
            count += 1
        names.add(name)
    return names


def faults_of(source, document):
    text = (source / document).read_text()
    for link in _LINK.findall(_FENCE.sub("", text)):
        if re.match(r"[a-z]+:", link):
            continue
        target, _, anchor = link.partition("#")
        file = (source / document).parent / target if target else source / document
        if not file.exists():
            yield f"{document}: {link}: there is no such file"
        elif anchor and anchor not in anchors_of(file.read_text()):
            yield f"{document}: {link}: there is no such heading"


def places_of(source):
    """The files of the repository, without and with their extensions, and its folders, each by every end
    of its path: `collision/detect` names `daemon/collision/detect.cpp`."""
    places = set()
    for file in map(pathlib.PurePosixPath, files_of(source, "*")):
        for place in [file, file.with_suffix(""), *file.parents]:
            places.update("/".join(place.parts[i:]) for i in range(len(place.parts)))
    return places


def lost_paths(source, document, places):
    """A path in backquotes begins with the name of a folder of the repository."""
    for path in _PATH.findall(_FENCE.sub("", (source / document).read_text())):
        is_ours = path.split("/")[0] in places and not path.startswith(_MADE_BY_THE_BUILD)
        if is_ours and path.rstrip("/") not in places:
            yield f"{document}: {path}: there is no such file or folder"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--source", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2])
    parser.add_argument("--links-only", action="store_true", help="DIR has the documents, not the sources")
    arguments = parser.parse_args()
    source = arguments.source
    places = set() if arguments.links_only else places_of(source)
    faults = []
    for document in documents_of(source):
        faults += [*faults_of(source, document), *lost_paths(source, document, places)]
    for fault in faults:
        print(f"FAULT {fault}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
