#!/usr/bin/env bash
# man_page.sh TAUT VERSION OUT: writes the manual page of the command, compressed, from what its
# commands say of themselves with --help.
set -euo pipefail
taut=$1 version=$2 out=$3

# format_help PART < HELP: PART is own (all but the common options) or common (these only).
format_help() {
  sed -e 's/\\/\\e/g' -e 's/-/\\-/g' | awk -v part="$1" '
    function wanted() { return (group == "Common options:") == (part == "common") }
    # No line is a request by accident.
    function show(text) { print (text ~ /^[.\047]/ ? "\\&" : "") text }
    # The names of an option are bold, what stands for its value is in italics.
    function item(name,    words, count, i, text) {
      count = split(name, words, " ")
      for (i = 1; i <= count; i++) {
        if (words[i] ~ /^\\-/) {
          gsub(/,/, "\\fR, \\fB", words[i])
          text = text " \\fB" words[i] "\\fR"
        } else text = text " \\fI" words[i] "\\fR"
      }
      return substr(text, 2)
    }
    /^[A-Z][A-Za-z ]*:$/ {
      group = $0
      if (part == "common") next
      if (group == "Examples:") print ".PP\n" group "\n.PP\n.RS 4\n.nf"
      else if (wanted()) print ".PP\n" group
      next
    }
    !wanted() { next }
    /^Usage: / { print ".PP\n" $0; next }
    /^$/ {
      if (group == "Examples:") { print ".fi\n.RE"; group = "" }
      else if (group == "") print ".PP"
      next
    }
    group == "Examples:" { show(substr($0, 3)); next }
    /^  [^ ]/ {
      name = substr($0, 3)
      text = ""
      if (match(name, /   */)) {
        text = substr(name, RSTART + RLENGTH)
        name = substr(name, 1, RSTART - 1)
      }
      print ".TP\n" item(name)
      if (text != "") show(text)
      next
    }
    { sub(/^ +/, ""); show($0) }'
}

commands=$("$taut" --help | awk '/^Commands:/ { list = 1; next } list && /^  [a-z]/ { print $1 }')
[[ -n $commands ]] || { echo "man_page.sh: $taut --help names no command" >&2; exit 1; }

{
  cat <<END
.TH TAUT 1 "" "Taut $version" "User Commands"
.SH NAME
taut \- convex hulls of freeform models
.SH SYNOPSIS
.B taut
.I COMMAND
.RI [ OPTIONS ]
.RI [ INPUT ]...
.SH DESCRIPTION
Taut computes convex hulls of NURBS and Bezier surfaces and curves themselves, not of a
tessellation of them. The meshes that it writes are closed, exactly convex, and come with a proven
bound of their distance from the true hull.
.PP
Results go to the standard output, messages to the standard error. A file that is written appears
whole or not at all.
.SH COMMANDS
END
  for command in $commands; do
    printf '.SS taut %s\n' "$command"
    "$taut" "$command" --help | format_help own
  done
  printf '.SH OPTIONS\nThese are understood by every command.\n'
  "$taut" "${commands%%$'\n'*}" --help | format_help common
  cat <<'END'
.SH EXIT STATUS
.TP
0
done
.TP
1
a check failed
.TP
2
wrong usage
.TP
3
a file cannot be read or written, or is not what its format says
.TP
4
the numbers of a file are no valid geometry
.TP
5
the tolerance was not reached; the best result is still written
.TP
6
a limit of time or memory was met
.TP
130
interrupted
.SH AUTHORS
The Taut authors. Licence: Apache\-2.0.
END
} | gzip -9 -n >"$out"
