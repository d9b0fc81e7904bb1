# SPDX-License-Identifier: MIT
"""Completions of a program for bash: a table of its commands and options, and the code that reads it."""

_HEAD = """\
# Completions of {name} for bash. Made from its help: do not edit.
# shellcheck shell=bash

# The commands and the flags that may follow a command, by its path.
declare -gA _{name}_commands=(
{commands})
declare -gA _{name}_flags=(
{flags})
# The values of flags, and of the words of a command ("PATH WORD"): words, or <file>, <folder>, <named_file>
# (NAME=FILE), <any>. A flag with "..." takes several.
declare -gA _{name}_values=(
{values})
"""

# The words before the cursor give the command and the flag whose value is due. bash has divided
# --flag=value in three, unless the user took = out of COMP_WORDBREAKS: then the flag, and the name in
# NAME=FILE, are the beginning of each completion.
_CODE = r"""
_NAME_complete_files() {
  local begin=$1 current=$2
  shift 2
  mapfile -t COMPREPLY < <(compgen "$@" -- "$current")
  if [[ -z $begin ]]; then
    # Names as readline takes them where there are none of these, such as ~/file.
    compopt -o filenames -o default 2>/dev/null
  elif [[ ${#COMPREPLY[@]} -eq 1 && -d ${COMPREPLY[0]} ]]; then
    COMPREPLY[0]+=/
    compopt -o nospace 2>/dev/null
  fi
}

_NAME_complete_value() {
  local kind=$1 begin=$2 current=$3 has_name=$4
  if [[ $kind == *"<named_file>"* ]]; then
    if [[ $current == *=* ]]; then
      begin+=${current%%=*}=
      current=${current#*=}
    elif [[ -z $has_name ]]; then
      return
    fi
  fi
  case $kind in
    *"file>"*) _NAME_complete_files "$begin" "$current" -f ;;
    *"<folder>"*) _NAME_complete_files "$begin" "$current" -d ;;
    *"<any>"*) ;;
    *) mapfile -t COMPREPLY < <(compgen -W "$kind" -- "$current") ;;
  esac
  COMPREPLY=("${COMPREPLY[@]/#/$begin}")
}

_NAME_complete() {
  local current=${COMP_WORDS[COMP_CWORD]} path=NAME flag="" begin="" has_name="" word kind index
  COMPREPLY=()
  for ((index = 1; index < COMP_CWORD; index++)); do
    word=${COMP_WORDS[index]}
    if [[ $word == = ]]; then
      continue
    elif [[ $word == -* ]]; then
      flag=""
      [[ -z ${_NAME_values[$path $word]:-} ]] || flag=$word
    elif [[ -n $flag ]]; then
      [[ ${_NAME_values[$path $flag]} == *...* ]] || flag=""
    elif [[ " ${_NAME_commands[$path]:-} " == *" $word "* ]]; then
      path+=" $word"
    fi
  done
  index=$COMP_CWORD
  if [[ $current == = ]]; then
    current=""
  else
    index=$((index - 1))
  fi
  [[ ${COMP_WORDS[index]} != = || ${COMP_WORDS[index - 1]} == -* ]] || has_name=yes
  if [[ $current == --*=* ]]; then
    flag=${current%%=*}
    [[ -n ${_NAME_values[$path $flag]:-} ]] || return
    begin=$flag=
    current=${current#*=}
  fi
  if [[ $current == -* && -z $begin ]]; then
    mapfile -t COMPREPLY < <(compgen -W "${_NAME_flags[$path]:-}" -- "$current")
  elif [[ -n $flag ]]; then
    kind=${_NAME_values[$path $flag]}
    _NAME_complete_value "${kind% ...}" "$begin" "$current" "$has_name"
  elif [[ -n ${_NAME_commands[$path]:-} ]]; then
    mapfile -t COMPREPLY < <(compgen -W "${_NAME_commands[$path]}" -- "$current")
  else
    _NAME_complete_value "${_NAME_values[$path WORD]:-<any>}" "" "$current" ""
  fi
}

complete -F _NAME_complete NAME
"""


def _value(option):
    words = " ".join(option.choices) or f"<{option.kind}>"
    return words + (" ..." if option.repeats and option.names else "")


def _rows(entries):
    return "".join(f'  ["{key}"]="{value}"\n' for key, value in entries if value)


def _values(command):
    for option in command.flags:
        if option.kind:
            for name in option.names:
                yield f"{command.path} {name}", _value(option)
    if command.positionals:
        yield f"{command.path} WORD", _value(command.positionals[0])


def bash_completion(program):
    commands = list(program.all())
    tables = _HEAD.format(
        name=program.name,
        commands=_rows((command.path, " ".join(sub.name for sub in command.commands)) for command in commands),
        flags=_rows((command.path, " ".join(name for option in command.flags for name in option.names))
                    for command in commands),
        values=_rows(entry for command in commands for entry in _values(command)))
    return tables + _CODE.replace("NAME", program.name)
