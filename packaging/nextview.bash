# Completion in bash of nextview and its programs: what --help names, the scenes, and files.
_nextview() {
  local word=${COMP_WORDS[COMP_CWORD]} command=("${COMP_WORDS[0]}") choices
  if [ "${COMP_WORDS[0]##*/}" = nextview ]; then
    if [ "$COMP_CWORD" = 1 ]; then
      choices="$("${command[0]}" --help 2> /dev/null | sed -n 's/^  \([a-z_]*\)  .*/\1/p') --help --version"
      mapfile -t COMPREPLY < <(compgen -W "$choices" -- "$word")
      return
    fi
    command+=("${COMP_WORDS[1]}")
  fi
  if [[ $word == -* ]]; then
    choices=$("${command[@]}" --help 2> /dev/null | grep -oE -- '(^|[ ,])--[a-z0-9-]+' | sort -u)
    mapfile -t COMPREPLY < <(compgen -W "$choices" -- "$word")
    return
  fi
  compopt -o filenames
  mapfile -t COMPREPLY < <(compgen -f -- "$word")
  case "${command[*]##*/}" in
    'nextview run' | 'nextview bound' | nextview_run | nextview_bound)
      mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -W 'boxes columns' -- "$word")
      ;;
  esac
}
complete -F _nextview nextview nextview_run nextview_bound nextview_replay nextview_picture nextview_report \
  nextview_export nextview_search nextview_viewer
