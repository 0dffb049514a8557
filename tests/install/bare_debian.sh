#!/usr/bin/env bash
# usage: bare_debian.sh PACKAGE.deb [FOLDER]. Installs the package by apt into a bare Debian 12 that
# debootstrap makes in FOLDER (else a temporary one), and runs there, without a compiler: the program,
# the first steps of README, the demo's run, the Python module, the manual and the completion. Prints
# the duration of each. Needs root and a Debian mirror (MIRROR); exits with 77 where they are missing.
set -euo pipefail
if [ ! -e "$1" ]; then
  echo "skipped: there is no $1 (./package.sh makes it)"
  exit 77
fi
package=$(realpath "$1")
mirror=${MIRROR:-http://deb.debian.org/debian}
if [ "$(id -u)" != 0 ] || ! command -v debootstrap >/dev/null; then
  echo "skipped: needs root and debootstrap (./setup.sh --package)"
  exit 77
fi
root=${2:-$(mktemp -d)}
finish() {
  umount "$root/proc" "$root/dev" 2>/dev/null || true
  [ "${keep:-}" ] || rm -rf --one-file-system "$root"
}
[ $# -lt 2 ] || keep=yes
trap finish EXIT
timed() {
  local begin=$SECONDS
  "${@:2}"
  echo "$1: $((SECONDS - begin)) s"
}
[ -x "$root/usr/bin/apt-get" ] ||
  timed "debootstrap" debootstrap --variant=minbase bookworm "$root" "$mirror" >"$root.log" 2>&1 || {
  tail -3 "$root.log"
  exit 77
}
mount -t proc proc "$root/proc"
mount --bind /dev "$root/dev"
cp /etc/resolv.conf "$root/etc/resolv.conf"
inside() {
  chroot "$root" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive \
    bash -euo pipefail -c "$*"
}
rm -rf "$root"/tmp/*
cp "$package" "$root/tmp/"
name=$(basename "$package")
install_package() {
  inside "apt-get -qq update && apt-get -qq install -y --no-install-recommends /tmp/$name" >"$root/tmp/apt.log" 2>&1 ||
    { tail -20 "$root/tmp/apt.log"; exit 1; }
}
timed "apt install" install_package
inside "! command -v g++"
inside "simwright --version" >"$root/tmp/version.txt"
[ "$(sed -n 1p "$root/tmp/version.txt")" = "simwright $(dpkg-deb -f "$package" Version)" ]
timed "doctor" inside "simwright doctor"
timed "demo's run" inside "cd /tmp && simwright run /usr/share/doc/simwright/examples/apple.jpg \
  --category apple --minutes 2 --episodes 100 -o apple_run --quiet"
inside "test -s /tmp/apple_run/index.html && test -s /tmp/apple_run/trajectory.yaml"
inside "cd /tmp && simwright import /usr/share/doc/simwright/examples/chair.obj --category chair -o imported --quiet"
inside "cd /tmp && simwright check imported/chair >/dev/null"
timed "python" inside "cd /tmp && python3 -c \"
import simwright
print('python module', simwright.__version__)
mesh = simwright.mesh([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
                      [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
assert abs(simwright.geometry.mass_properties(mesh, density=6.0).mass - 1.0) < 1e-12
simwright.skills.load('open_drawer')
\""
inside "test -s /usr/share/man/man1/simwright.1.gz && test -s /usr/share/man/man1/simwright-scene-generate.1.gz"
inside "source /usr/share/bash-completion/completions/simwright; COMP_WORDS=(simwright lif); COMP_CWORD=1; \
  _simwright; test \"\${COMPREPLY[0]}\" = lift"
inside "apt-get -qq purge -y simwright >/dev/null 2>&1"
left=$(inside "ls -d /usr/bin/simwright /usr/share/simwright /usr/lib/python3/dist-packages/simwright 2>/dev/null || true")
[ -z "$left" ] || { echo "error: purged, but left: $left"; exit 1; }
echo "bare Debian: all passed"
