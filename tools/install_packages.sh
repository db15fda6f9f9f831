#!/usr/bin/env bash
# Installs the Debian packages that are missing of those Plumbline needs; asks nothing, uses sudo when
# not run by root, does nothing when all are there.
#
#   tools/install_packages.sh                        to build and run (apt_packages.txt, apt_packages_worlds.txt)
#   tools/install_packages.sh --product              the same without the renderer (apt_packages.txt)
#   tools/install_packages.sh --python               the package for Python as well (apt_packages_python.txt)
#   tools/install_packages.sh --ros                  the node of ROS 1 as well (apt_packages_ros.txt)
#   tools/install_packages.sh --ros2                 the node of ROS 2 as well (apt_packages_ros2.txt)
#   tools/install_packages.sh --tests [PACKAGE]...   to test as well (apt_packages_test.txt), and others
set -euo pipefail
cd "$(dirname "$0")"

lists=(apt_packages.txt apt_packages_worlds.txt)
case ${1:-} in
  --product)
    lists=(apt_packages.txt)
    shift
    ;;
  --python)
    lists+=(apt_packages_python.txt)
    shift
    ;;
  --ros)
    lists+=(apt_packages_ros.txt)
    shift
    ;;
  --ros2)
    lists+=(apt_packages_ros2.txt)
    shift
    ;;
  --tests)
    lists+=(apt_packages_python.txt apt_packages_test.txt)
    shift
    ;;
esac
if ! command -v apt-get > /dev/null || ! command -v dpkg-query > /dev/null; then
  echo "install_packages.sh: apt is not here; install what tools/apt_packages*.txt list yourself" >&2
  exit 1
fi

mapfile -t packages < <(sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' "${lists[@]}")
missing=()
for package in "${packages[@]}" "$@"; do
  status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2> /dev/null || true)
  [[ $status == installed ]] || missing+=("$package")
done
((${#missing[@]})) || exit 0

echo "Installing ${missing[*]}"
as_root=()
if [[ $(id -u) != 0 ]]; then
  if ! command -v sudo > /dev/null; then
    echo "install_packages.sh: run as root, or install yourself: ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq update
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get -qq install -y --no-install-recommends "${missing[@]}"
