# shellcheck shell=bash
# Completion of the command taut: its commands and options are read from its own help.

_taut() {
  local taut=$1 word=$2 previous=$3 help values
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    help=$("$taut" --help 2>/dev/null) || return
    mapfile -t COMPREPLY < <(compgen -W "$(_taut_commands <<<"$help") $(_taut_options <<<"$help")" \
      -- "$word")
    return
  fi
  help=$("$taut" "${COMP_WORDS[1]}" --help 2>/dev/null) || return
  values=$(_taut_values "$previous" <<<"$help")
  if [[ -n $values ]]; then
    [[ $values != *\|* ]] || mapfile -t COMPREPLY < <(compgen -W "${values//|/ }" -- "$word")
  elif [[ $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(_taut_options <<<"$help")" -- "$word")
  fi
}

# What a help on the standard input names: its commands, its options, and what stands for the value
# of the option $1 ("FILE", "auto|plain|never"; nothing if it takes none).
_taut_commands() { awk '/^Commands:/ { list = 1; next } list && /^  [a-z]/ { print $1 }'; }
_taut_options() { awk '/^  -/ { gsub(/,/, " ", $1); print $1 }'; }
_taut_values() {
  awk -v option="$1" '/^  -/ {
    count = split($1, names, ",")
    sub(/^  [^ ]+/, "")
    for (i = 1; i <= count; i++) if (names[i] == option && /^ [^ ]/) { print $1; exit }
  }'
}

# File names where there is nothing else to say.
complete -o default -F _taut taut
