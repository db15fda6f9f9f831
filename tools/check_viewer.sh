#!/usr/bin/env bash
# Looks at a run as others do: with Foxglove's own client and MCAP's own reader (packages of npm, by the
# lock file in tests/viewer/foxglove_client), and in headless Chromium. Exit status 0 when all is as it
# should be or the tools are not there; then a line says so.
#
#   tools/check_viewer.sh PROGRAM SEQUENCE FOLDER
#
# FOLDER takes the packages, results and screenshots (page_*.png).
set -euo pipefail
program=$(realpath "$1")
sequence=$(realpath "$2")
mkdir -p "$3"
folder=$(realpath "$3")
cd "$(dirname "$0")/.."
status=0

ClientOfFoxglove() {
  mkdir -p "$folder/client"
  cp tests/viewer/foxglove_client/{package.json,package-lock.json,check.mjs} "$folder/client"
  (cd "$folder/client" && npm ci --ignore-scripts --no-audit --no-fund --silent)
  "$program" run "$sequence" --to 40 --quiet --record "$folder/run.mcap" --out "$folder/recorded"
  local port=18765
  "$program" run "$sequence" --to 100 --quiet --view "$port" --out "$folder/seen" &
  local run=$!
  until (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do
    kill -0 "$run" || return 1
    sleep 0.1
  done
  node "$folder/client/check.mjs" "ws://127.0.0.1:$port" "$folder/run.mcap" || return 1
  wait "$run"
}

if command -v npm >/dev/null && command -v node >/dev/null; then
  ClientOfFoxglove || status=1
else
  echo "check_viewer.sh: npm is not installed; Foxglove's client is left out" >&2
fi
page=0
/usr/bin/python3 tests/viewer/page_test.py "$program" "$sequence" "$folder" || page=$?
if [[ $page == 77 ]]; then
  echo "check_viewer.sh: no Chromium with its driver and selenium; the page is left out" >&2
elif [[ $page != 0 ]]; then
  status=1
fi
exit "$status"
