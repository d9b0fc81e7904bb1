#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the archive that Blender installs of the modules of the add-on.

    make_archive.py ARCHIVE FOLDER

FOLDER has the package `camway`. The same modules give the same bytes: times and modes of files are not kept, as a
file has those of its checkout.
"""
import pathlib
import sys
import zipfile

TIME = (2000, 1, 1, 0, 0, 0)
MODE = 0o644


def make_archive(archive, folder):
    """Writes `archive` with the modules of the package in `folder`, in the order of their names."""
    with zipfile.ZipFile(archive, "w") as made:
        for module in sorted((folder / "camway").glob("*.py")):
            entry = zipfile.ZipInfo(module.relative_to(folder).as_posix(), TIME)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = MODE << 16
            made.writestr(entry, module.read_bytes(), compresslevel=9)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    make_archive(sys.argv[1], pathlib.Path(sys.argv[2]))
