# fish completion for wingspread. Commands, options and types of values are read from --help.
function __wingspread_candidates
    set -l words (commandline -opc)
    set -l word (commandline -ct)
    if test (count $words) -eq 1
        $words[1] --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\)  *\(.*\)/\1\t\2/p'
    end
    set -l help ($words[1..2] --help 2>/dev/null)
    set -l type
    if string match -q -- '--*' $words[-1]
        set type (printf '%s\n' $help | sed -n '/^Options:/,/^$/s/^  \(-[a-z],\)\?'$words[-1]' \([^ ][^ ]*\).*/\2/p')
    end
    if test -z "$type"; and string match -q -- '-*' $word
        printf '%s\n' $help | sed -n '/^Options:/,/^$/s/^  \(-[a-z],\)\?\(--[a-z-]*\)\(.*  \)\?/\2\t/p'
        return
    end
    if test -z "$type"; and test (count $words) -gt 1
        set type (printf '%s\n' $help | sed -n '/^Positionals:/,/^$/{s/^  [a-z]* \([^ ]*\).*/\1/p;T;q}')
    end
    switch "$type"
        case TEXT 'FILE*' 'DIR*'
            __fish_complete_path $word
        case '*|*' # event|smoothed:EPS
            string split '|' $type | string match -v -r '[A-Z]'
    end
end
complete -c wingspread -f -a '(__wingspread_candidates)'
