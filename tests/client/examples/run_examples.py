#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the programs of client/examples with a daemon and a door, and compares what they print.

    tools/scripts/netns.sh tests/client/examples/run_examples.py --programs BIN --examples BUILT --source DIR

Exit codes: 0, or 1 for failures.
"""
import argparse
import pathlib
import re
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "documents"))
from session import Session  # noqa: E402

_PROVED = r"[^\n]*proved free of collision[^\n]*\n"
_POSES = r"(  at \d+\.\d\d s:( -?\d+\.\d{3}){3}\n?){5}"
# Each program with its arguments, and all that it prints.
_EXPECTED = {
    "plan_c office": rf"Camway \d+\.\d+\.\d+, ABI \d+\n({_PROVED}{_POSES}){{2}}",
    "watch_c office": rf"answer 1: {_PROVED}broken from \d+\.\d\d s on\nanswer 2: [^\n]*proved free[^\n]*",
    "plan_cpp office": rf"({_PROVED}  in the middle:( [-\d.e]+){{3}}\n?){{3}}",
}
_DOOR = r"planned: ok, \d+ segments\ndragged: ok"


def run(session, command, expected):
    """Whether the command succeeded and printed that."""
    code, output = session.run(command)
    if code == 0 and re.fullmatch(expected, output):
        return True
    print(f"{command}: exit code {code}, printed:\n{output}\nexpected:\n{expected}", file=sys.stderr)
    return False


def run_door(session, source):
    if shutil.which("node") is None:
        print("door.mjs: not run, there is no node")
        return True
    code, output = session.run("camway view --scene scenes/office.obj --port 0")
    door = re.search(r"http://\S+token=\S+", output)
    if code != 0 or not door:
        print(f"camway view: {output}", file=sys.stderr)
        return False
    return run(session, f"node --no-warnings --experimental-websocket {source}/client/examples/door.mjs "
                        f"'{door[0]}' scenes/requests/office-graze-door.json", _DOOR)


def main():
    parser = argparse.ArgumentParser()
    for name in ("programs", "examples", "source"):
        parser.add_argument(f"--{name}", required=True, type=pathlib.Path)
    arguments = parser.parse_args()
    with Session(arguments.source, arguments.programs) as session:
        code, output = session.run("camwayd --scene office=scenes/office.obj")
        if code != 0:
            sys.exit(f"camwayd: {output}")
        results = [run(session, f"{arguments.examples}/{command}", expected)
                   for command, expected in _EXPECTED.items()]
        results.append(run_door(session, arguments.source))
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
