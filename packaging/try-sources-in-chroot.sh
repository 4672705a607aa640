#!/bin/sh
# try-sources-in-chroot.sh [CHROOT [TARGET...]]: a clone of this repository in a bare Debian 12 that has git and make and nothing else, and
# there `make run docs`, or other targets, one after the other, as its root would. Says the seconds and packages that each takes.
# With `test` as a target all tests, too: try-sources-in-chroot.sh "" run docs test.
# A CHROOT that is there is used as it is, and kept. MIRROR: where packages come from. PACKAGES: what else is installed there beforehand, so
# that no test is skipped: PACKAGES="paraview python3-paraview xvfb xauth ffmpeg".
set -eu
source=$(cd "$(dirname "$0")/.." && pwd)
made=
[ -n "${1:-}" ] || made=$(mktemp -d)
chroot=${1:-$made/debian}
[ $# -eq 0 ] || shift
logs=$(mktemp -d)
. "$source/packaging/bare-debian.sh"

inside apt-get install -q -y --no-install-recommends git make ca-certificates ${PACKAGES:-} >>"$logs/apt.log" 2>&1 || { tail "$logs/apt.log"; exit 1; }
rm -rf "$chroot/srv/talus" "$chroot/srv/talus.bundle"
git -C "$source" bundle create -q "$chroot/srv/talus.bundle" HEAD
inside git -c advice.detachedHead=false clone -q /srv/talus.bundle /srv/talus
echo "$(inside git -C /srv/talus log -1 --format='%h %s'); with git and make${PACKAGES:+, $PACKAGES}: $(inside dpkg-query -W | wc -l) packages"
for target in "${@:-run docs}"; do
  for one in $target; do
    began=$(date +%s)
    inside make -C /srv/talus "$one" >"$logs/$one.log" 2>&1 || { tail -n 40 "$logs/$one.log"; echo "FAILED: make $one; all of it is in $logs/$one.log"; exit 1; }
    { [ "$one" != test ] || grep -E 'tests passed|\*\*\*(Failed|Skipped)' "$logs/$one.log"; tail -n 3 "$logs/$one.log"; } | sed 's/^/  /'
    echo "make $one: $(($(date +%s) - began)) s, $(inside dpkg-query -W | wc -l) packages"
  done
done
leave_chroot # before its folder goes: /proc and /sys are still in it
rm -rf --one-file-system "$logs" ${made:+"$made"}
