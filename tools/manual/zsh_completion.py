# SPDX-License-Identifier: MIT
"""Completions of a program for zsh: a function for each command, by `_arguments`."""

_ACTIONS = {"file": "_files", "folder": "_files -/", "named_file": '{compset -P "*=" && _files}', "any": " "}


def _quoted(text):
    return "'" + text.replace("'", "'\\''") + "'"


def _escaped(text):
    """Text in a specification, where these characters have a meaning."""
    for letter in "\\[]:":
        text = text.replace(letter, "\\" + letter)
    return text


def _function(command):
    return "_" + command.path.replace(" ", "_").replace("-", "_")


def _action(option):
    return f"({' '.join(option.choices)})" if option.choices else _ACTIONS[option.kind]


def _flag(option):
    """The specifications of a flag, one for each of its names."""
    others = [] if option.repeats else [*option.names, *option.excludes]
    for name in option.names:
        excludes = "" if option.repeats else f"({' '.join(others)})"
        repeats = "*" if option.repeats else ""
        value = f":{_escaped(option.form)}:{_action(option)}" if option.kind else ""
        equals = "=" if option.kind and name.startswith("--") else ""
        yield f"{excludes}{repeats}{name}{equals}[{_escaped(option.short_description)}]{value}"


def _specifications(command):
    for option in command.flags:
        yield from _flag(option)
    for option in command.positionals:
        place = "*" if option.repeats else ""
        yield f"{place}:{_escaped(option.word)}:{_action(option)}"


def _with_commands(command):
    """A command that has others: its first word says which."""
    names = "\n".join(f"    {_quoted(_escaped(sub.name) + ':' + sub.description)}" for sub in command.commands)
    cases = "\n".join(f"        {sub.name}) {_function(sub)} ;;" for sub in command.commands)
    flags = "\n".join(f"    {_quoted(text)} \\" for text in _specifications(command))
    return f"""\
{_function(command)}() {{
  local curcontext=$curcontext state line
  local -a commands=(
{names}
  )
  _arguments -C \\
{flags}
    '1:command:->command' '*::argument:->argument'
  case $state in
    command) _describe command commands ;;
    argument)
      case $line[1] in
{cases}
      esac
      ;;
  esac
}}
"""


def _without_commands(command):
    specifications = " \\\n".join(f"    {_quoted(text)}" for text in _specifications(command))
    return f"{_function(command)}() {{\n  _arguments \\\n{specifications}\n}}\n"


def zsh_completion(program):
    functions = [_with_commands(command) if command.commands else _without_commands(command)
                 for command in program.all()]
    return (f"#compdef {program.name}\n# Completions of {program.name} for zsh. Made from its help: do not edit.\n\n"
            + "\n".join(functions) + f'\n{_function(program)} "$@"\n')
