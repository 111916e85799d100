#!/bin/bash
# Whether .ci/set-up.sh waits for another apt, and says so: set_up_test.sh REPOSITORY. apt works in a folder
# of its own here, without a source, so that nothing is fetched or installed, and who runs this needs no rights.
# 77: there is no apt.
set -euo pipefail
repository=$1
command -v apt-get > /dev/null && command -v perl > /dev/null || {
  echo "skipped: there is no apt-get, or no perl to hold its locks"
  exit 77
}
folder=$(mktemp -d)
mkdir -p "$folder"/{.ci,bin,dpkg,etc,state/lists/partial,cache/archives/partial}
touch "$folder/dpkg/status" "$folder/etc/sources.list"
cat > "$folder/apt.conf" << END
Dir::State "$folder/state";
Dir::State::status "$folder/dpkg/status";
Dir::Cache "$folder/cache";
Dir::Etc::SourceList "$folder/etc/sources.list";
Dir::Etc::SourceParts "$folder/etc";
END
export APT_CONFIG="$folder/apt.conf"
# The real one would ask for a password, and not hand on where apt is to work.
printf '#!/bin/sh\nexec "$@"\n' > "$folder/bin/sudo"
chmod +x "$folder/bin/sudo"
export PATH="$folder/bin:$PATH"
echo nextview-package-that-is-not-there > "$folder/.ci/packages"

die() {
  echo "$*" >&2
  cat "$folder/said" >&2
  exit 1
}

# hold FILE SECONDS: takes a lock as apt does, and returns when it is held.
hold() {
  coproc perl -e 'use Fcntl; $| = 1; open(my $file, "+>>", $ARGV[0]) or die "$ARGV[0]: $!";
    my $whole = pack("s s x4 q q i x4", F_WRLCK, 0, 0, 0, 0);
    fcntl($file, F_SETLK, $whole) or die "$ARGV[0]: $!"; print "held\n"; sleep $ARGV[1];' "$1" "$2"
  read -r _ <&"${COPROC[0]}"
}

# install PATIENCE_S: as ./run would; what it said is in $folder/said.
install() {
  (
    root=$folder
    source "$repository/.ci/set-up.sh"
    apt_patience_s=$1
    install_missing packages
  ) > "$folder/said" 2>&1 && die "a package that is not there was installed"
  return 0
}

install 5
grep -q 'Unable to locate package' "$folder/said" || die "apt was not asked"
grep -q 'Another apt' "$folder/said" && die "there is no other apt"

for lock in state/lists/lock dpkg/lock-frontend; do
  hold "$folder/$lock" 3
  holder=$COPROC_PID
  install 60
  ! kill -0 "$holder" 2> /dev/null || die "$lock: not waited for"
  grep -q "Another apt is at work, waiting up to 60 s for it: lock $folder/$lock" "$folder/said" ||
    die "$lock: not said"
  grep -q 'Unable to locate package' "$folder/said" || die "$lock: not gone on when it was free"
done

hold "$folder/state/lists/lock" 60
holder=$COPROC_PID
install 2
grep -q 'If another apt is still at work, wait for it; then type: apt-get install nextview-package' \
  "$folder/said" || die "not said what to do"
kill "$holder"
wait "$holder" 2> /dev/null || true
rm -r "$folder"
