#!/bin/bash
# What .ci/set-up.sh says of a build: set_up_build_test.sh REPOSITORY. Nothing when only the commit had to be asked
# for, as in a second ./run; that it builds when it takes longer; the reason when it fails.
set -euo pipefail
repository=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder/build/release"
cat > "$folder/build/release/build.ninja" << END
rule command
  command = \$do
build asked: command
  do = echo asked >> $folder/asked
build programs: phony asked
build slow: command
  do = sleep 4 && echo slow > $folder/slow
build broken: command
  do = echo no such header && false
END

fail() {
  echo "FAILED: $*" >&2
  cat "$folder/said" >&2
  exit 1
}

# builds TARGET: as ./run would; what it said is in $folder/said.
builds() {
  (
    root=$folder
    source "$repository/.ci/set-up.sh"
    build_target "$1"
  ) > "$folder/said" 2>&1
}

for time in 1 2; do
  builds programs || fail "time $time"
  [ ! -s "$folder/said" ] || fail "time $time: not silent"
  [ "$(wc -l < "$folder/asked")" = "$time" ] || fail "time $time: the commit was not asked for"
done

builds slow || fail "slow"
grep -q '^Building nextview in' "$folder/said" || fail "not said that it builds"
[ -e "$folder/slow" ] || fail "not built"

if builds broken; then fail "a build that fails did not"; fi
grep -q 'no such header' "$folder/said" && grep -q 'The build failed' "$folder/said" || fail "not said why"
TMPDIR=$folder/nowhere builds programs && fail "nothing can be written, and it went on"
[ "$(cat "$folder/said")" = "No file can be made in $folder/nowhere: make that folder, or name another in TMPDIR" ] ||
  fail "not said what is wrong with TMPDIR"
echo "silent when there is nothing to do"
