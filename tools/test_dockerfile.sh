#!/usr/bin/env bash
# Runs the steps of the Dockerfile in a bare Debian 12 made by debootstrap, with what is committed, and then the
# program on a rendered sequence: what `docker build` and `docker run` do, where there is no Docker.
#
#   tools/test_dockerfile.sh
#
# Needs root, debootstrap and Debian's packages from where apt has them on this machine; says what is missing and does
# nothing. Exit status: 0 all that could be done passed, 1 a failure.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
readonly here name=test_dockerfile
# shellcheck source=tools/bare_system.sh
source "$here/tools/bare_system.sh"

# RunStep ROOT INSTRUCTION ARGUMENTS: one line of the Dockerfile. An instruction of another kind is a failure, since it
# would not be tried.
RunStep() {
  case $2 in
    FROM) [[ $3 == debian:$suite-slim ]] || Fail "expected FROM debian:$suite-slim, found FROM $3" ;;
    WORKDIR) workdir=$3 && mkdir -p "$1$workdir" ;;
    COPY)
      [[ $3 == '. .' ]] || Fail "expected COPY . ., found COPY $3"
      git -C "$here" archive HEAD | tar -x -C "$1$workdir"
      ;;
    RUN)
      Step "$3"
      InRoot "$1" sh -c "cd $workdir && $3" > "$1.log" 2>&1 || { tail -20 "$1.log" >&2; Fail "failed: $3"; }
      ;;
    ENTRYPOINT) [[ $3 == '["plumbline"]' ]] || Fail "expected ENTRYPOINT [\"plumbline\"], found $3" ;;
    *) Fail "expected an instruction that this script can try, found $2" ;;
  esac
}

Main() {
  OwnMounts "${BASH_SOURCE[0]}"
  local folder root instruction arguments workdir=/
  folder=$(mktemp -d "${TMPDIR:-/tmp}/plumbline_dockerfile.XXXXXX")
  root=$folder/root
  # shellcheck disable=SC2064  # the folder of now
  trap "umount '$root/proc' 2> /dev/null; rm -rf --one-file-system '$folder'" EXIT
  MakeBareSystem "$root" || return 0
  while read -r instruction arguments; do
    [[ -z $instruction || $instruction == '#'* ]] || RunStep "$root" "$instruction" "$arguments"
  done < "$here/Dockerfile"
  Step "plumbline"
  InRoot "$root" plumbline synth room --set frames=8 --set scale=0.5 --out /tmp/room > /dev/null
  InRoot "$root" plumbline run /tmp/room --out /tmp/out --quiet
  InRoot "$root" test -s /tmp/out/trajectory.txt || Fail "the run has no trajectory"
  Step "done"
}

Main
