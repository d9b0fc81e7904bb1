#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the picture of the README with the built `camway`: one request of scenes/, before and after.

  docs/images/draw.py --programs build/dev/bin            writes docs/images/demo.svg
  docs/images/draw.py --programs build/dev/bin --check    fails if the committed picture is another one

Coordinates are rounded to a hundredth of a pixel. The check allows two hundredths between them, which is
what rounding and versions of cairo may change.
"""

import argparse
import re
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
REQUEST = HERE.parents[1] / "scenes/requests/office-wall-tour.json"
PICTURE = HERE / "demo.svg"
TITLE = "A path through four rooms of an office, before and after its correction"
NUMBER = re.compile(r"-?\d+\.\d+")
TOLERANCE_PX = 0.02


def drawn(programs):
    """Plans the request, draws the answer, and returns the picture as text."""
    with tempfile.TemporaryDirectory() as folder:
        answer, picture = f"{folder}/answer.json", f"{folder}/picture.svg"
        camway = Path(programs).resolve() / "camway"
        subprocess.run([camway, "plan", "--request", REQUEST, "--response", answer],
                       check=True, stderr=subprocess.DEVNULL)
        subprocess.run([camway, "draw", "--request", REQUEST, "--response", answer, "--side-by-side",
                        "--picture", picture], check=True)
        text = Path(picture).read_text()
    head, end, body = text.partition('version="1.1">')
    head = re.sub(r'(width|height)="(\d+)(\.\d+)?pt"', r'\1="\2"', head)
    body = NUMBER.sub(lambda number: f"{float(number[0]):.2f}".rstrip("0").rstrip("."), body)
    return f"{head}{end}\n<title>{TITLE}</title>{body}"


def is_same(one, other):
    """Whether two pictures differ in nothing but the rounding of their numbers."""
    number = re.compile(r"-?\d+(?:\.\d+)?")
    if number.sub("", one) != number.sub("", other):
        return False
    return all(abs(float(a) - float(b)) <= TOLERANCE_PX
               for a, b in zip(number.findall(one), number.findall(other)))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--programs", required=True, help="folder of the built programs")
    parser.add_argument("--check", action="store_true", help="compare, and write nothing")
    flags = parser.parse_args()
    picture = drawn(flags.programs)
    if not flags.check:
        PICTURE.write_text(picture)
        return 0
    if not PICTURE.exists() or not is_same(PICTURE.read_text(), picture):
        print(f"draw.py: {PICTURE.name} is not what `camway draw` draws; "
              "run docs/images/draw.py --programs build/dev/bin", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
