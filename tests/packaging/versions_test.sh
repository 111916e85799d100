#!/bin/bash
# versions_test.sh BUILD SOURCES: every program there is, built, Python or shell, tells the same version, and those
# that were built the same commit, and what option was meant by a mistyped one.
set -euo pipefail
build=$1 sources=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

fail() {
  echo "FAILED: $*" >&2
  exit 1
}

version=$("$build/bin/nextview" --version)
version=${version#nextview }
[[ $version =~ ^[0-9]+\.[0-9]+(\ [0-9a-f]{12}\+?)?$ ]] || fail "nextview --version: $version"

# What is part of the tests only, or a benchmark, which a build of the rest leaves as it was.
is_of_tests() {
  case "$1" in
    nextview_bench* | *_test | fuzz_cases_* | vector_clones_* | noise_* | driver | forgetful_recorder) true ;;
    *) false ;;
  esac
}

built=0
for program in "$build"/bin/*; do
  name=${program##*/}
  [ -f "$program" ] && [ -x "$program" ] || continue
  ! is_of_tests "$name" || continue
  said=$("$program" --version 2>&1) || fail "$name --version: status $?: $said"
  [ "$said" = "$name $version" ] || fail "$name --version: $said, where nextview says $version"
  ! "$program" --version > /dev/full 2> "$folder/said" || fail "$name says that all is well to a full disk"
  grep -q "^$name: .*standard output" "$folder/said" || fail "$name: a full disk: $(cat "$folder/said")"
  # All but those that have no others name the option that a mistyped one was meant to be.
  said=$("$program" --vershion 2>&1) && fail "$name takes --vershion"
  case "$name" in
    nextview | nextview_cad_reader | file_driver) ;;
    *) [[ $said == *"No option --vershion; did you mean --version?"* ]] || fail "$name --vershion: $said" ;;
  esac
  built=$((built + 1))
done
[ "$built" -ge 14 ] || fail "only $built programs in $build/bin"

# Of the sources, whose commit may be another by now.
lcm-gen -p --ppath "$folder/types" "$sources"/lcmtypes/*.lcm > /dev/null
scripts=0
says_version() {
  local said
  said=$(PYTHONPATH="$folder/types" "$@" --version 2>&1) || fail "$* --version: $said"
  [[ $said =~ ^[a-z_./]+\ ${version%% *}(\ [0-9a-f]{12}\+?)?$ ]] || fail "$* --version: $said"
  scripts=$((scripts + 1))
}
for script in "$sources"/{examples,runner,reports,exporter,bench,viewer}/{,*/}*.py; do
  [ -f "$script" ] && grep -q '__main__' "$script" || continue
  says_version python3 -B "$script"
done
for script in "$sources"/{logplayer,package,spy,test,bench/run,bench/refusals}; do
  says_version "$script"
done
[ "$scripts" -ge 11 ] || fail "only $scripts scripts"
echo "$built programs and $scripts scripts tell $version"
