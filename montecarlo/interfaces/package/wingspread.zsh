#compdef wingspread
# zsh completion for wingspread. Commands, options and types of values are read from --help.
_wingspread() {
  local help type
  local -a found
  if (( CURRENT == 2 )); then
    help="$($words[1] --help 2>/dev/null)"
    found=(${(f)"$(sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\)  *\(.*\)/\1:\2/p' <<<"$help")"})
    _describe command found
  else
    help="$($words[1] $words[2] --help 2>/dev/null)"
    [[ $words[CURRENT-1] == --* ]] &&
      type=$(sed -n '/^Options:/,/^$/s/^  \(-[a-z],\)\?'$words[CURRENT-1]' \([^ ][^ ]*\).*/\2/p' <<<"$help")
    if [[ -z $type && $PREFIX != -* ]]; then
      type=$(sed -n '/^Positionals:/,/^$/{s/^  [a-z]* \([^ ]*\).*/\1/p;T;q}' <<<"$help")
    fi
  fi
  case $type in
    "")
      found=(${(f)"$(sed -n '/^Options:/,/^$/s/^  \(-[a-z],\)\?\(--[a-z-]*\)\(.*  \)\?/\2:/p' <<<"$help")"})
      [[ $PREFIX == -* ]] && _describe option found ;;
    TEXT|FILE*|DIR*) _files ;;
    *\|*) found=(${(s:|:)type}); compadd -- ${found:#*[A-Z]*} ;; # event|smoothed:EPS
  esac
}
_wingspread "$@"
