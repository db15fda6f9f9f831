#!/usr/bin/env bash
# Runs every fuzzer of the preset fuzz, starting from fuzz/corpus, and stops at the first that finds a fault:
# what it was given is left in build/fuzz/faults then. Exit status: 0 none found.
#
#   tools/run_fuzzers.sh [SECONDS [NAME...]]   for each (default 20); only those named, such as "camera"
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:-20}
shift || true
names=("$@")
if [[ ${#names[@]} -eq 0 ]]; then
  for program in build/fuzz/fuzz/*_fuzz; do names+=("$(basename "$program" _fuzz)"); done
fi

TMPDIR=$(mktemp -d)
export TMPDIR
trap 'rm -rf "$TMPDIR"' EXIT
faults=build/fuzz/faults
mkdir -p "$faults"
for name in "${names[@]}"; do
  program=build/fuzz/fuzz/${name}_fuzz
  mkdir "$TMPDIR/$name"
  echo "fuzzing $name"
  if ! "$program" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=1024 -malloc_limit_mb=512 \
    -print_final_stats=1 -artifact_prefix="$faults/$name-" "$TMPDIR/$name" "fuzz/corpus/$name" \
    > "$TMPDIR/log" 2>&1; then
    cat "$TMPDIR/log" >&2
    exit 1
  fi
  grep number_of_executed_units "$TMPDIR/log"
done
