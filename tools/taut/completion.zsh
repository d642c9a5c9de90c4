#compdef taut
# Completion of the command taut: its commands and options are read from its own help.

# What a help on the standard input names: its commands, its options, and what stands for the value
# of the option $1 ("FILE", "auto|plain|never"; nothing if it takes none).
_taut_commands() { awk '/^Commands:/ { list = 1; next } list && /^  [a-z]/ { print $1 }' }
_taut_options() { awk '/^  -/ { gsub(/,/, "\n", $1); print $1 }' }
_taut_values() {
  awk -v option="$1" '/^  -/ {
    count = split($1, names, ",")
    sub(/^  [^ ]+/, "")
    for (i = 1; i <= count; i++) if (names[i] == option && /^ [^ ]/) { print $1; exit }
  }'
}

_taut() {
  local help values
  if ((CURRENT == 2)); then
    help=$($words[1] --help 2>/dev/null) || return 1
    compadd -- ${(f)"$(_taut_commands <<<$help)"} ${(f)"$(_taut_options <<<$help)"}
    return
  fi
  help=$($words[1] $words[2] --help 2>/dev/null) || return 1
  values=$(_taut_values $words[CURRENT-1] <<<$help)
  if [[ $values == *\|* ]]; then
    compadd -- ${(s:|:)values}
  elif [[ -z $values && $PREFIX == -* ]]; then
    compadd -- ${(f)"$(_taut_options <<<$help)"}
  else
    _files
  fi
}

_taut "$@"
