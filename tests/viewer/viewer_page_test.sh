#!/bin/bash
# viewer_page_test.sh BUILD SCRIPT: builds the page of nextview_viewer and leads Chromium through it, on runs made
# here. 77: what is needed for that is not here.
set -euo pipefail
build=$1 script=$2
skip() {
  echo "skipped: $*"
  exit 77
}
for command in node npm; do
  command -v "$command" > /dev/null || skip "the page needs $command: apt-get install nodejs npm"
done
command -v chromium > /dev/null || skip "a browser is needed to draw the page: apt-get install chromium"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export HOME=$folder # Chromium and npm want one, which continuous integration may lack
if ! ninja -C "$build" viewer_page > "$folder/build.log" 2>&1; then
  cat "$folder/build.log"
  [ -d "$build/viewer-page/node_modules/playwright-core" ] || skip "npm could not fetch what the page is made of"
  exit 1
fi
PROGRAMS=$build/bin PAGE=$build/viewer-page FOLDER=$folder CHROMIUM=$(command -v chromium) node "$script"
