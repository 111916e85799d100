#!/bin/bash
# What ./spy and ./logplayer ask before they open a window of LCM: windows_test.sh REPOSITORY
set -euo pipefail
repository=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/bin"
export PATH="$folder/bin:$PATH"

die() {
  echo "FAILED: $*" >&2
  exit 1
}

# there_is PROCESS...: what pgrep finds, and nothing is no success.
there_is() {
  printf '#!/bin/sh\n' > "$folder/bin/pgrep"
  [ $# = 0 ] || printf 'echo "%s"\n' "$@" >> "$folder/bin/pgrep"
  [ $# != 0 ] || echo 'exit 1' >> "$folder/bin/pgrep"
  chmod +x "$folder/bin/pgrep"
}

# Under the settings of ./spy, which end it at the first command that fails.
url_in_progress() {
  bash -c 'set -euo pipefail; root=$1; source "$root/.ci/set-up.sh"; url=${2-$(url_of_run)}; echo "<$url>"' - "$repository"
}

there_is
[ "$(url_in_progress)" = '<>' ] || die "without a run: $(url_in_progress)"
there_is '12 lcm-logger --quiet --lcm-url=udpm://239.255.76.67:7701?ttl=0 -f /tmp/a' \
  '13 lcm-logger --lcm-url=udpm://239.255.76.67:7702?ttl=0 /tmp/b'
[ "$(url_in_progress)" = '<udpm://239.255.76.67:7701?ttl=0>' ] || die "with two: $(url_in_progress)"
there_is '12 lcm-logger /tmp/a'
[ "$(url_in_progress)" = '<>' ] || die "with one of somebody else: $(url_in_progress)"

# A run in a network of its own is joined, another is not.
joining() {
  bash -c 'set -euo pipefail; root=$1; source "$root/.ci/set-up.sh"; echo "<$(command_to_join "$2")>"' - "$repository" "$1"
}
url='udpm://239.255.76.67:7701?ttl=0'
there_is "$$ lcm-logger --lcm-url=$url -f /tmp/a"
[ "$(joining "$url")" = '<>' ] || die "in this network: $(joining "$url")"
[ "$(joining 'udpm://239.255.76.67:7702?ttl=0')" = '<>' ] || die "another run's: $(joining "$url")"
if unshare --net true 2> /dev/null; then
  unshare --net sleep 60 &
  apart=$!
  trap 'kill "$apart"; rm -rf "$folder"' EXIT
  until [ "$(readlink "/proc/$apart/ns/net")" != "$(readlink /proc/self/ns/net)" ]; do sleep 0.01; done
  there_is "$apart lcm-logger --lcm-url=$url -f /tmp/a"
  [[ "$(joining "$url")" == *nsenter*"$apart"*--net* ]] || die "in a network of its own: $(joining "$url")"
else
  echo "skipped: this user may not make a network, so ./spy was not seen to join one"
fi

# Nothing is installed or built for a window that has no screen.
log=$folder/run.lcmlog
touch "$log"
for command in "spy" "logplayer $log"; do
  # shellcheck disable=SC2086
  said=$(env -u DISPLAY "$repository"/$command 2>&1) && die "$command opened a window without a screen: $said"
  [[ $said == *"DISPLAY is not set"*"./view"* && $said != *Building* ]] || die "$command: $said"
done
