# Sourced by scripts that try something in a bare Debian 12, made by debootstrap. Their messages begin with $name.
readonly suite=bookworm

Skip() { printf '%s: %s; skipped\n' "$name" "$*" >&2; }
Fail() { printf '%s: %s\n' "$name" "$*" >&2; exit 1; }
Step() { printf '== %s\n' "$*"; }

# OwnMounts SCRIPT ARGUMENTS...: runs the script again where its mounts are private and end with it.
OwnMounts() {
  if [[ $(id -u) == 0 && -z ${PLUMBLINE_OWN_MOUNTS:-} ]]; then
    PLUMBLINE_OWN_MOUNTS=1 exec unshare --mount --propagation private "$@"
  fi
}

# InRoot ROOT COMMAND...: with an environment that knows nothing of this machine.
InRoot() {
  local root=$1
  shift
  chroot "$root" env -i PATH=/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
    DEBIAN_FRONTEND=noninteractive "$@"
}

# MakeBareSystem ROOT: a Debian without packages beyond the smallest; says why there is none, and fails.
MakeBareSystem() {
  local mirror
  mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' "Codename: $suite" 2> /dev/null | head -1)
  if [[ $(id -u) != 0 ]]; then
    Skip "a bare system needs root"
    return 1
  elif ! command -v debootstrap > /dev/null; then
    Skip "debootstrap is not installed, so there is no bare system"
    return 1
  elif [[ -z $mirror ]]; then
    Skip "apt has no packages of $suite here, so there is no bare system"
    return 1
  fi
  Step "a bare system"
  if ! debootstrap --variant=minbase "$suite" "$1" "$mirror" > "$1.log" 2>&1; then
    tail -5 "$1.log" >&2
    Skip "debootstrap cannot make a bare system here"
    return 1
  fi
  # Packages come from where they come from here.
  rm -f "$1/etc/apt/sources.list"
  cp -a /etc/apt/sources.list* "$1/etc/apt/"
  cp -aL /etc/resolv.conf "$1/etc/resolv.conf" 2> /dev/null || true
  cp -a /etc/apt/apt.conf.d/. "$1/etc/apt/apt.conf.d/"
  mount -t proc proc "$1/proc"
  InRoot "$1" apt-get -qq update
}
