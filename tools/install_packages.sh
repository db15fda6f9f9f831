#!/usr/bin/env bash
# Installs the Debian packages of tools/apt_packages.txt that are missing, and any named as arguments.
# Asks nothing; uses sudo when not run by root. Does nothing when all are there.
set -euo pipefail
cd "$(dirname "$0")"

if ! command -v apt-get > /dev/null; then
  echo "install_packages.sh: this is not a Debian system; install what tools/apt_packages.txt lists" >&2
  exit 1
fi

missing=()
while read -r package; do
  status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2> /dev/null || true)
  [[ $status == installed ]] || missing+=("$package")
done < <(sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' apt_packages.txt; printf '%s\n' "$@" | sed '/^$/d')
((${#missing[@]})) || exit 0

echo "Installing ${missing[*]}"
root=()
if [[ $(id -u) != 0 ]]; then
  if ! command -v sudo > /dev/null; then
    echo "install_packages.sh: needs root or sudo to install ${missing[*]}" >&2
    exit 1
  fi
  root=(sudo)
fi
"${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q update
"${root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get -q install -y --no-install-recommends "${missing[@]}"
