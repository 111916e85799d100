#!/bin/bash
# installed_tree.sh CMAKE BUILD SOURCES COMPILER: installs the build into a folder of its own and uses it there.
set -euo pipefail
cmake=$1 build=$2 sources=$3 compiler=$4
if grep -q 'CMAKE_CXX_FLAGS.*-fsanitize' "$build/CMakeCache.txt"; then
  echo "skipped: an outside project is not built with the sanitizers that the archives are"
  exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
prefix=$folder/usr

fail() {
  echo "FAILED: $*" >&2
  exit 1
}

"$cmake" --install "$build" --prefix "$prefix" > "$folder/install.log" || fail "$(cat "$folder/install.log")"
[ -e "$prefix/share/nextview/lcmtypes/nextview_run_config_t.lcm" ] || fail "no message types"
[ -e "$prefix/include/nextview/planner/view_planner.h" ] || fail "no headers"

# Every program tells the same version, `nextview` starts them, and help reaches the program itself.
version=$("$prefix/bin/nextview" --version)
version=${version#nextview }
for program in "$prefix"/bin/nextview_*; do
  name=${program##*/nextview_}
  [ "$("$program" --version)" = "nextview_$name $version" ] || fail "$program --version: $("$program" --version)"
  # cad_reader is only for the other programs.
  [ "$name" = cad_reader ] || "$prefix/bin/nextview" --help | grep -q "^  $name " || fail "nextview does not know $name"
  case "$name" in
    cad_reader | mapper | planner | base_sim | sensor_sim) ;;
    *) [ -e "$prefix/share/bash-completion/completions/nextview_$name" ] || fail "no completion of nextview_$name" ;;
  esac
done
"$prefix/bin/nextview" replay --help | grep -q 'Replays a run' || fail "nextview replay --help"
if "$prefix/bin/nextview" rum 2> "$folder/err"; then fail "nextview rum"; fi
grep -q "no command 'rum'.*run" "$folder/err" || fail "nextview rum: $(cat "$folder/err")"

# A run finds its programs and scenes in the installed tree, also when the sources are not named.
(cd "$folder" && env -u NEXTVIEW_SCENES "$prefix/bin/nextview" run boxes --views 3 --no-coverage --out run > run.out) ||
  fail "$(cat "$folder/run.out")"
"$prefix/bin/nextview" replay "$folder/run" | grep -q '^3 views replayed' || fail "replay of the installed run"
if "$prefix/bin/nextview" run nowhere 2> "$folder/err"; then fail "nextview run nowhere"; fi
grep -q "scenes in $prefix/share/nextview/scenes" "$folder/err" ||
  fail "the scenes are not the installed ones"

# Projects of one's own: every one of the examples, outside of the sources.
examples=0
for example in "$sources"/examples/*/CMakeLists.txt; do
  name=$(basename "$(dirname "$example")")
  cp -r "$(dirname "$example")" "$folder/$name"
  "$cmake" -S "$folder/$name" -B "$folder/$name/build" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_BUILD_TYPE=Release > "$folder/outside.log" 2>&1 &&
    "$cmake" --build "$folder/$name/build" >> "$folder/outside.log" 2>&1 || fail "$(cat "$folder/outside.log")"
  [ "$("$folder/$name/build/$name" --version)" = "$name $version" ] || fail "$name --version"
  examples=$((examples + 1))
done
[ "$examples" -ge 3 ] || fail "only $examples examples"
"$folder/embedded_planner/build/embedded_planner" | tee "$folder/outside.out"
grep -q '^nothing_left after' "$folder/outside.out" || fail "the outside planner did not come to its end"
# The floor, the ceiling and the walls: 6 x 5 and 22 x 2.8 m2; a voxel map counts the outer faces of none.
awk '/m2 of surface/ { found = 1; if ($1 < 115 || $1 > 130) exit 1 } END { exit !found }' "$folder/outside.out" ||
  fail "not the area of the room"

(cd "$folder" && "$prefix/bin/nextview" run boxes --views 3 --no-coverage --out frontiers \
  --planner frontier_planner/build/frontier_planner > run.out) || fail "$(cat "$folder/run.out")"
"$prefix/bin/nextview" replay "$folder/frontiers" | grep -q '^3 views replayed' || fail "the planner of the example"

# Completion in bash.
completed=$(bash -c "source '$prefix/share/bash-completion/completions/nextview'
  PATH='$prefix/bin':\$PATH
  COMP_WORDS=(nextview run --stra) COMP_CWORD=2
  compopt() { :; }
  _nextview && echo \"\${COMPREPLY[@]}\"")
[ "$completed" = --strategy ] || fail "completion of --stra: '$completed'"
echo "the installed tree works"
