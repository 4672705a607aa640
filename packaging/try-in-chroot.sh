#!/bin/sh
# try-in-chroot.sh PACKAGES [CHROOT]: installs the packages of a folder (build/package) in a bare Debian 12, as root, and
# works with them as a user would: help and manual, first case, picture, two ranks, a program of the library, Python. A CHROOT that is
# there is used as it is, and kept; without one it is made by debootstrap and removed. MIRROR: where packages come from.
set -eu
packages=$(cd "$1" && pwd)
source=$(cd "$(dirname "$0")/.." && pwd)
chroot=${2:-$(mktemp -d)/debian}
[ "$(id -u)" -eq 0 ] || { echo "try-in-chroot.sh: needs root, for debootstrap and chroot" >&2; exit 2; }

leave() {
  umount "$chroot/proc" "$chroot/sys" "$chroot/dev/shm" 2>/dev/null || :
  [ -n "${KEEP:-}" ] || { rm -rf --one-file-system "$chroot" && rmdir "$(dirname "$chroot")"; }
}
KEEP=${2:-}
trap 'leave' EXIT
if [ ! -x "$chroot/usr/bin/apt-get" ]; then
  echo "a bare Debian in $chroot"
  debootstrap --variant=minbase bookworm "$chroot" ${MIRROR:-} >"$packages/debootstrap.log"
fi
mount -t proc proc "$chroot/proc"
mount -t sysfs -o ro sysfs "$chroot/sys" # MPI asks it for cores
mkdir -p "$chroot/dev/shm"
mount -t tmpfs tmpfs "$chroot/dev/shm"
cp /etc/resolv.conf "$chroot/etc/" 2>/dev/null || :

rm -rf "$chroot/packages" && mkdir "$chroot/packages"
cp "$packages"/*.deb "$source/packaging/try.sh" "$chroot/packages/"
inside() { env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 ${http_proxy:+http_proxy=$http_proxy} chroot "$chroot" "$@"; }
inside apt-get -q update >"$packages/apt.log" 2>&1 || { tail "$packages/apt.log"; exit 1; }
echo "before: $(inside dpkg-query -W | wc -l) packages"
# What a user would: apt and the files; man, a compiler and numpy's like come as dependencies or beside them.
inside sh -c 'apt-get install -q -y --no-install-recommends /packages/*.deb gnuplot-nox gmsh man-db gcc pkg-config cmake make libc6-dev' \
  >>"$packages/apt.log" 2>&1 || { tail -n 30 "$packages/apt.log"; exit 1; }
echo "after: $(inside dpkg-query -W | wc -l) packages"
inside useradd -m stranger 2>/dev/null || :
inside su - stranger -c 'sh /packages/try.sh'
# Nothing is left behind.
inside sh -c 'dpkg -P $(cd /packages && for f in *.deb; do dpkg-deb -f $f Package; done)' >>"$packages/apt.log" 2>&1 || { tail "$packages/apt.log"; exit 1; }
left=$(inside sh -c 'find / -xdev -name "*talus*" ! -path "/packages*" ! -path "/home/*" ! -path "/tmp/*" ! -path "/proc/*" ! -path "/var/log/*" ! -path "/var/cache/*"')
[ -z "$left" ] || { echo "removed, and there is still: $left"; exit 1; }
echo "removed without a trace"
