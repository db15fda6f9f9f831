#!/usr/bin/env bash
# Makes the Debian packages of a build, checks them with lintian, and uses them in a bare Debian 12 made by
# debootstrap: the program runs, a program that uses the library is built and runs, Python imports the
# module, and nothing is left when they are gone.
#
#   tools/test_packages.sh BUILD     BUILD: a complete build folder, for instance build/release
#
# Needs root, lintian, debootstrap and Debian's packages from where apt has them on this machine; says what
# is missing and does that part not. Exit status: 0 all that could be done passed, 1 a failure.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
readonly here name=test_packages
# shellcheck source=tools/bare_system.sh
source "$here/tools/bare_system.sh"

# MakePackages BUILD FOLDER
MakePackages() {
  Step "packages"
  mkdir -p "$2"
  cpack --config "$1/CPackConfig.cmake" -B "$2" > "$2/cpack.log" 2>&1 ||
    { cat "$2/cpack.log" >&2; Fail "cpack failed"; }
  rm -rf "$2/_CPack_Packages"
  for package in "$2"/*.deb; do
    dpkg-deb --show --showformat '${Package} ${Version} ${Installed-Size} kB, needs ${Depends}\n' "$package"
  done
}

# CheckByLintian FOLDER
CheckByLintian() {
  if ! command -v lintian > /dev/null; then
    Skip "lintian is not installed, so the packages are not checked by it"
    return
  fi
  Step "lintian"
  # No bug of Debian's tracker asks for these packages, and the maintainer's address is the builder's affair.
  lintian --allow-root --fail-on error,warning --suppress-tags bogus-mail-host,bogus-mail-host-in-debian-changelog \
    "$1"/*.deb || Fail "lintian found something"
}

# InstallInRoot ROOT PACKAGE...
InstallInRoot() {
  local root=$1
  shift
  InRoot "$root" apt-get -qq install -y --no-install-recommends "$@" > "$root/tmp/apt.log" 2>&1 ||
    { tail -20 "$root/tmp/apt.log" >&2; Fail "$* cannot be installed"; }
}

# UseProgram ROOT
UseProgram() {
  Step "plumbline"
  InstallInRoot "$1" /packages/plumbline.deb
  InRoot "$1" plumbline --version
  InRoot "$1" test -s /usr/share/man/man1/plumbline.1.gz || Fail "there is no manual page"
  InRoot "$1" plumbline synth room --set frames=8 --set scale=0.5 --out /tmp/room > /dev/null
  InRoot "$1" plumbline run /tmp/room --out /tmp/out --quiet
  InRoot "$1" test -s /tmp/out/trajectory.txt || Fail "the run has no trajectory"
}

# UseLibrary ROOT
UseLibrary() {
  Step "libplumbline-dev"
  InstallInRoot "$1" /packages/libplumbline-dev.deb cmake g++ make
  cp -r "$here/examples/consumer" "$1/tmp/consumer"
  InRoot "$1" cmake -S /tmp/consumer -B /tmp/consumer/build -DCMAKE_BUILD_TYPE=Release > /dev/null
  InRoot "$1" cmake --build /tmp/consumer/build > /dev/null
  [[ $(InRoot "$1" /tmp/consumer/build/consumer /tmp/room | wc -l) -eq 8 ]] ||
    Fail "the consumer of the library does not give a pose for each frame"
}

# UsePython ROOT
UsePython() {
  [[ -e $1/packages/python3-plumbline.deb ]] || { Skip "python3-plumbline is not built"; return; }
  Step "python3-plumbline"
  InstallInRoot "$1" /packages/python3-plumbline.deb
  InRoot "$1" python3 -c 'import plumbline; print("import plumbline", plumbline.__version__)'
}

# UseRos2Node ROOT
UseRos2Node() {
  [[ -e $1/packages/plumbline-ros2.deb ]] || { Skip "plumbline-ros2 is not built"; return; }
  Step "plumbline-ros2"
  InstallInRoot "$1" /packages/plumbline-ros2.deb
  InRoot "$1" timeout --signal INT 3 plumbline-ros2 -p camera:=euroc || [[ $? -eq 124 ]] ||
    Fail "plumbline-ros2 does not run"
  InRoot "$1" plumbline-ros2 -p sensor:=radar 2> /dev/null && Fail "a wrong parameter was taken"
  return 0
}

# PurgeAll ROOT: no file of the packages may stay.
PurgeAll() {
  Step "purge"
  local names=()
  mapfile -t names < <(InRoot "$1" dpkg-query -W -f '${Package}\n' '*plumbline*')
  local files="$1/tmp/files"
  InRoot "$1" dpkg -L "${names[@]}" | grep plumbline | sort -u > "$files"
  InRoot "$1" apt-get -qq purge -y "${names[@]}" > /dev/null 2>&1
  local left
  left=$(while read -r file; do [[ ! -e $1$file ]] || echo "$file"; done < "$files")
  [[ -z $left ]] || Fail "left after purge: $left"
}

# UseInBareSystem FOLDER
UseInBareSystem() {
  local root=$1/root
  MakeBareSystem "$root" || return 0
  mkdir "$root/packages"
  for package in "$1"/*.deb; do
    cp "$package" "$root/packages/$(dpkg-deb --field "$package" Package).deb"
  done
  UseProgram "$root"
  UseLibrary "$root"
  UsePython "$root"
  UseRos2Node "$root"
  PurgeAll "$root"
}

Main() {
  [[ $# -eq 1 && -e $1/CPackConfig.cmake ]] || { echo "usage: tools/test_packages.sh BUILD" >&2; exit 2; }
  local build folder
  build=$(realpath "$1")
  OwnMounts "${BASH_SOURCE[0]}" "$build"
  folder=$(mktemp -d "${TMPDIR:-/tmp}/plumbline_packages.XXXXXX")
  # shellcheck disable=SC2064  # the folder of now
  trap "umount '$folder/root/proc' 2> /dev/null; rm -rf --one-file-system '$folder'" EXIT
  MakePackages "$build" "$folder"
  CheckByLintian "$folder"
  UseInBareSystem "$folder"
  Step "done"
}

Main "$@"
