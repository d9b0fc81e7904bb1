# SPDX-License-Identifier: MIT
"""The examples that the programs' help shows, with the marks that a document would have for them."""
import re

# A logger that has just started may miss messages, so requests go on until it has one.
_RECORDING = ("lcm-logger --quiet session.lcmlog & until grep -qs PLAN_REQUEST session.lcmlog; do "
              "camway load --scene office=scenes/office.obj --request "
              "scenes/requests/office-graze-door.json --seconds 1; done; kill -INT $!; wait")
_MARKS = {
    "camway state": {"not run": "it needs the folder of a daemon"},
    "camway doctor": {"not run": "it looks at this machine's own configuration"},
    "camway replay": {"run first": _RECORDING},
    "camway status": {"interrupted after": "sleep 2"},
    "camway watch": {"interrupted after": "sleep 2"},
    "camway view": {"interrupted after": "sleep 2"},
}


def help_examples(session):
    """Place, command and marks of each example, in an order in which they work. Raises ValueError
    for a command without one."""
    commands = ["camwayd"] + [f"camway {name}" for name in _subcommands(session)]
    return [(command + " --help", _example(session, command), _MARKS.get(command, {}))
            for command in commands]


def _subcommands(session):
    text = session.run("camway --help")[1]
    names = re.findall(r"^  ([a-z]+) ", text.partition("Subcommands:")[2], re.MULTILINE)
    if not names:
        raise ValueError(f"camway --help: names no subcommands: {text}")
    return names


def _example(session, command):
    help_text = session.run(f"{command} --help")[1]
    found = re.search(r"^Example: (.*)$", help_text, re.MULTILINE)
    if not found:
        raise ValueError(f"{command} --help: shows no example")
    return found[1]
