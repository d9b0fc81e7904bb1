# SPDX-License-Identifier: MIT
"""The commands and options of a program, as `PROGRAM --help-tree` tells them."""

import dataclasses
import json
import re
import subprocess

# Forms of values, and words of positionals, that are names of files and of folders.
_FILES = {"FILE", "PATH", "LOG", "SESSION", "RESPONSE", "CAMWAY"}
_FOLDERS = {"DIR", "FOLDER"}
# The beginning of the form of a value that is a name and a file.
_NAMED_FILE = "NAME=FILE"


@dataclasses.dataclass
class Option:
    names: list          # ["-h", "--help"]; empty for a positional
    word: str            # the name of a positional
    form: str            # the form of its value; "" for a switch
    check: str           # the values that it takes
    description: str
    default: str
    group: str
    required: bool
    repeats: bool
    needs: list
    excludes: list

    @property
    def choices(self):
        """The words that the option takes; empty if it takes others as well."""
        words = self.check.split("|")
        return words if len(words) > 1 and all(re.fullmatch(r"[\w-]+", word) for word in words) else []

    @property
    def kind(self):
        """The kind of the option's value: "file", "folder", "named_file", "choice", "any"; "" without a value."""
        if self.choices:
            return "choice"
        form = self.word.upper() if not self.names and self.form == "TEXT" else self.form
        if not form:
            return ""
        if form.startswith(_NAMED_FILE):
            return "named_file"
        return "file" if form in _FILES else "folder" if form in _FOLDERS else "any"

    @property
    def short_description(self):
        """The first clause of the description, for lists."""
        return re.split(r"[;.] | [(\[]", self.description)[0].strip()


@dataclasses.dataclass
class Command:
    path: str            # "camway scene load"
    description: str
    footer: str
    options: list
    commands: list

    @property
    def name(self):
        return self.path.split()[-1]

    @property
    def flags(self):
        return [option for option in self.options if option.names]

    @property
    def positionals(self):
        return [option for option in self.options if not option.names]

    def all(self):
        """This command and those below it, this one first."""
        yield self
        for command in self.commands:
            yield from command.all()


def _command(tree, above=""):
    path = f"{above} {tree['name']}".strip()
    return Command(path, tree["description"], tree["footer"], [Option(**option) for option in tree["options"]],
                   [_command(command, path) for command in tree["commands"]])


def read(program):
    """Asks a program. Raises subprocess.CalledProcessError if it cannot be run."""
    said = subprocess.run([program, "--help-tree"], check=True, stdout=subprocess.PIPE).stdout
    return _command(json.loads(said))
