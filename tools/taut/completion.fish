# Completion of the command taut: its commands and options are read from its own help.

# What can stand where the cursor is; nothing where that is a file.
function __taut_candidates
    set -l before (commandline -opc)
    set -l word (commandline -ct)
    if test (count $before) -eq 1
        $before[1] --help 2>/dev/null | awk '
            /^  -/ { count = split($1, names, ","); for (i = 1; i <= count; i++) print names[i] }
            /^Commands:/ { list = 1; next }
            list && /^  [a-z]/ { name = $1; sub(/^ *[^ ]+ +/, ""); print name "\t" $0 }'
        return
    end
    # The value of an option: one of several words, or a file, or free.
    set -l values ($before[1] $before[2] --help 2>/dev/null | awk -v option="$before[-1]" '/^  -/ {
        count = split($1, names, ",")
        sub(/^  [^ ]+/, "")
        for (i = 1; i <= count; i++) if (names[i] == option && /^ [^ ]/) { print $1; exit }
    }')
    if test -n "$values"
        string match -q '*|*' -- $values; and string split '|' -- $values
    else if string match -q -- '-*' $word
        $before[1] $before[2] --help 2>/dev/null | awk '/^  -/ {
            count = split($1, names, ",")
            for (i = 1; i <= count; i++) print names[i]
        }'
    end
end

complete -c taut -n 'test (count (commandline -opc)) -eq 1' -f
complete -c taut -a '(__taut_candidates)'
