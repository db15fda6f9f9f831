#!/usr/bin/env bash
# Formats all C++ of the repository in place; with --check only reports what is not formatted and exits
# with 1. The version is pinned: another one formats differently.
set -euo pipefail
cd "$(dirname "$0")/.."
readonly wanted=14

program=$(command -v "clang-format-$wanted" || command -v clang-format || true)
if [[ -z $program ]]; then
  echo "format.sh: clang-format $wanted is not installed (tools/install_packages.sh)" >&2
  exit 1
fi
version=$("$program" --version | sed -E 's/.*version ([0-9]+).*/\1/')
if [[ $version != "$wanted" ]]; then
  echo "format.sh: clang-format $wanted is needed, $program is $version" >&2
  exit 1
fi

mapfile -t files < <(find plumbline worlds lab apps python tests fuzz examples ros -name '*.h' -o -name '*.cc' | LC_ALL=C sort)
case ${1:-} in
  '') "$program" -i "${files[@]}" ;;
  --check) "$program" --dry-run -Werror "${files[@]}" ;;
  *)
    echo "usage: tools/format.sh [--check]" >&2
    exit 2
    ;;
esac
