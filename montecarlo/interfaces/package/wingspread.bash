# bash completion for wingspread. Commands, options and types of values are read from --help.
_wingspread() {
  local program=${COMP_WORDS[0]} before=${COMP_WORDS[COMP_CWORD - 1]} word=${COMP_WORDS[COMP_CWORD]} help type= words=
  local options='/^Options:/,/^$/' # a section of --help ends with an empty line
  if ((COMP_CWORD == 1)); then
    help=$("$program" --help 2>/dev/null)
    words=$(sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p' <<<"$help")
  else
    help=$("$program" "${COMP_WORDS[1]}" --help 2>/dev/null)
    [[ $before == --* ]] &&
      type=$(sed -n "$options"'s/^  \(-[a-z],\)\?'"$before"' \([^ ][^ ]*\).*/\2/p' <<<"$help")
    if [[ -z $type && $word != -* ]]; then
      type=$(sed -n '/^Positionals:/,/^$/{s/^  [a-z]* \([^ ]*\).*/\1/p;T;q}' <<<"$help")
    fi
  fi
  case $type in
    "") words+=" $(sed -n "$options"'s/^  \(-[a-z]\)\?,\?\(--[a-z-]*\).*/\1 \2/p' <<<"$help")" ;;
    TEXT | FILE* | DIR*)
      compopt -o filenames 2>/dev/null
      mapfile -t COMPREPLY < <(compgen -f -- "$word")
      return ;;
    *\|*) words=$(tr '|' '\n' <<<"$type" | grep -v '[A-Z]') ;; # event|smoothed:EPS
  esac
  mapfile -t COMPREPLY < <(compgen -W "${words//,/ }" -- "$word")
}
complete -F _wingspread wingspread
