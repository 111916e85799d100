# Sourced by ./run, ./replay and ./test: installs what is missing and builds. Needs `root` set to the
# folder of the sources. When nothing is to be done it takes a fraction of a second and says nothing.

build="$root/build/release"

fail() {
  echo "$*" >&2
  exit 1
}

# tell_version NAME ARGUMENT...: when --version is what was typed, says what every program says, and that is all.
tell_version() {
  [ "${2-}" = --version ] || return 0
  local version commit
  version=$(sed -n 's/^project(nextview VERSION \([^ ]*\).*/\1/p' "$root/CMakeLists.txt")
  commit=$(git -C "$root" describe --always --dirty=+ --abbrev=12 --exclude='*' 2> /dev/null) || true
  echo "$1 $version${commit:+ $commit}"
  exit 0
}

# A freshly booted machine installs its updates first.
apt_patience_s=600

# install_missing LIST...: the packages of these lists, of which as a rule all are there.
install_missing() {
  local packages missing
  mapfile -t packages < <(grep -hv '^#' "${@/#/$root/.ci/}")
  if ! command -v dpkg-query > /dev/null; then
    return  # not Debian: cmake says what it does not find
  fi
  mapfile -t missing < <(comm -23 <(printf '%s\n' "${packages[@]}" | sort) \
    <(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "${packages[@]}" 2> /dev/null |
      sed -n 's/^installed //p' | sort))
  # Node.js from elsewhere brings an npm of its own, which Debian's package would be at odds with.
  if command -v npm > /dev/null; then
    mapfile -t missing < <(printf '%s\n' "${missing[@]}" | grep -vx npm | grep .)
  fi
  if [ "${#missing[@]}" = 0 ]; then
    return
  fi
  local as_root=()
  if [ "$(id -u)" != 0 ]; then
    command -v sudo > /dev/null ||
      fail "Packages are missing. As root, type: apt-get install ${missing[*]}"
    as_root=(sudo)
  fi
  echo "Installing ${missing[*]}"
  rm -f "$build/configured-with" # cmake may find more from now on
  when_free "${as_root[@]}" env LC_ALL=C apt-get -qq update &&
    when_free "${as_root[@]}" env LC_ALL=C DEBIAN_FRONTEND=noninteractive \
      apt-get -qq install --no-install-recommends "${missing[@]}" || {
    cat "$install_log" >&2
    fail "Packages could not be installed. If another apt is still at work, wait for it; then type:" \
      "apt-get install ${missing[*]}"
  }
}

# when_free APT_COMMAND...: again and again while another apt holds a lock. apt's own DPkg::Lock::Timeout
# would wait for dpkg's alone, and silently; those of the package lists and of the archive it does not know.
when_free() {
  local until=$((SECONDS + apt_patience_s)) said=
  until "$@" > "$install_log" 2>&1; do
    grep -q 'Could not get lock' "$install_log" && [ "$SECONDS" -lt "$until" ] || return 1
    [ -n "$said" ] || echo "Another apt is at work, waiting up to $apt_patience_s s for it: $(
      sed -n 's/.*Could not get lock/lock/p' "$install_log" | head -n 1)"
    said=yes
    sleep 1
  done
}
install_log=$(mktemp 2> /dev/null) ||
  fail "No file can be made in ${TMPDIR:-/tmp}: make that folder, or name another in TMPDIR"
trap 'rm -f "$install_log"' EXIT

# configure [OPTION...]: unless it has been done with these options.
configure() {
  # A user's compiler may warn of more than ours did.
  local options=("-DCMAKE_COMPILE_WARNING_AS_ERROR=${NEXTVIEW_WARNINGS_ARE_ERRORS:-OFF}" "$@")
  if command -v ccache > /dev/null; then
    options+=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  fi
  local done_with="$build/configured-with"
  if [ -e "$build/build.ninja" ] && [ "$(cat "$done_with" 2> /dev/null)" = "${options[*]}" ]; then
    return
  fi
  (cd "$root" && cmake --preset release -B "$build" "${options[@]}" > "$install_log" 2>&1) || {
    cat "$install_log" >&2
    fail "cmake failed"
  }
  echo "${options[*]}" > "$done_with"
}

# build_target TARGET: says nothing when it is up to date.
build_target() {
  # As a rule there is nothing to do but to ask for the commit. What takes longer, or fails, is shown.
  if timeout 3 ninja --quiet -C "$build" "$1" > "$install_log" 2>&1; then
    return
  fi
  echo "Building nextview in $build (the first time takes some minutes)"
  ninja -C "$build" "$1" || fail "The build failed."
}

# set_up_programs: what ./run and ./replay need.
set_up_programs() {
  install_missing packages-to-run
  # A folder configured for the tests will do as well.
  [ -e "$build/build.ninja" ] || configure -DNEXTVIEW_TESTS=OFF
  build_target programs
}

# set_up_viewer: what ./view and ./run --view need besides: the server, and its page.
set_up_viewer() {
  install_missing packages-to-run packages-to-view
  [ -e "$build/build.ninja" ] || configure -DNEXTVIEW_TESTS=OFF
  # A folder that was configured before Boost or npm was there.
  grep -q viewer-page/site "$build/build.ninja" || cmake "$build" > "$install_log" 2>&1 ||
    fail "$(cat "$install_log")"
  build_target programs
  build_target viewer_page
}

# set_up_java: what LCM's own windows need to decode our types.
set_up_java() {
  install_missing packages-to-run packages-to-spy
  [ -e "$build/build.ninja" ] || configure -DNEXTVIEW_TESTS=OFF
  # A folder that was configured before Java was there.
  grep -q nextview_types.jar "$build/build.ninja" || cmake "$build" > "$install_log" 2>&1 ||
    fail "$(cat "$install_log")"
  build_target lcm_spy_types
}

# need_screen: before much is installed for a window that nobody could see.
need_screen() {
  [ -n "${DISPLAY-}" ] ||
    fail "This opens a window, and there is no screen for one: DISPLAY is not set." \
      "Type it on a desktop, or over ssh -X. Without a screen ./view shows a run in a browser."
}

# url_of_run: the LCM URL of a run in progress, if there is one.
url_of_run() {
  { pgrep --list-full lcm-logger || true; } | sed -n '/--lcm-url=/{s/.*--lcm-url=\([^ ]*\).*/\1/p;q}'
}

# command_to_join LCM_URL: a line a word, what goes before a command that is to hear this run, if it is in a network of
# its own.
command_to_join() {
  local recorder
  recorder=$(pgrep --list-full lcm-logger | grep -F -- "--lcm-url=$1" | sed 's/ .*//;q') || true
  [ -n "$recorder" ] || return 0
  [ "$(readlink "/proc/$recorder/ns/net")" != "$(readlink /proc/self/ns/net)" ] || return 0
  printf '%s\n' nsenter --target "$recorder" --net
  [ "$(id -u)" = 0 ] || printf '%s\n' --user --preserve-credentials
}

# start_java [BEFORE...] -- CLASS [ARGUMENT...]: a window of LCM. Debian's own scripts ask Java for an option it no
# longer has.
start_java() {
  local before=()
  while [ "$1" != -- ]; do
    before+=("$1")
    shift
  done
  shift
  CLASSPATH="$build/nextview_types.jar" exec "${before[@]}" java -Djava.net.preferIPv4Stack=true -ea \
    -cp "/usr/share/java/lcm.jar:/usr/share/java/jchart2d.jar:$build/nextview_types.jar" "$@"
}
