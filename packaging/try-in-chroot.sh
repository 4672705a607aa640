#!/bin/sh
# try-in-chroot.sh PACKAGES [CHROOT]: installs the packages of a folder (build/package) in a bare Debian 12, as root, and
# works with them as a user would: help and manual, first case, picture, two ranks, a program of the library, Python. A CHROOT that is
# there is used as it is, and kept; without one it is made by debootstrap and removed. MIRROR: where packages come from.
set -eu
packages=$(cd "$1" && pwd)
source=$(cd "$(dirname "$0")/.." && pwd)
chroot=${2:-$(mktemp -d)/debian}
logs=$packages
. "$source/packaging/bare-debian.sh"

rm -rf "$chroot/packages" && mkdir "$chroot/packages"
cp "$packages"/*.deb "$source/packaging/try.sh" "$chroot/packages/"
# What a user would: apt and the files; man, a compiler and numpy's like come as dependencies or beside them.
inside sh -c 'apt-get install -q -y --no-install-recommends /packages/*.deb gnuplot-nox gmsh man-db gcc pkg-config cmake make libc6-dev' \
  >>"$packages/apt.log" 2>&1 || { tail -n 30 "$packages/apt.log"; exit 1; }
echo "after: $(inside dpkg-query -W | wc -l) packages"
inside useradd -m stranger 2>/dev/null || :
inside su - stranger -c 'sh /packages/try.sh'
# Nothing is left behind.
inside sh -c 'dpkg -P $(cd /packages && for f in *.deb; do dpkg-deb -f $f Package; done)' >>"$packages/apt.log" 2>&1 || { tail "$packages/apt.log"; exit 1; }
left=$(inside sh -c 'find /bin /etc /lib /opt /sbin /srv /usr /var/lib -xdev -name "*talus*"')
[ -z "$left" ] || { echo "removed, and there is still: $left"; exit 1; }
echo "removed without a trace"
