# To be sourced by scripts that try things in a bare Debian 12, as root, with `chroot` its folder and `logs` a folder for what is long.
# A chroot that is there is used as it is, and kept; one that is not is made by debootstrap, and removed at the end unless KEEP is set.
# MIRROR: where packages come from. Afterwards `inside COMMAND...` runs there, with nothing of our environment but the proxy.
[ "$(id -u)" -eq 0 ] || { echo "$0: needs root, for debootstrap and chroot" >&2; exit 2; }

leave_chroot() {
  umount "$chroot/proc" "$chroot/sys" "$chroot/dev/shm" "$chroot/dev/pts" 2>/dev/null || :
  [ -n "${KEEP:-}" ] || rm -rf --one-file-system "$chroot"
}
trap leave_chroot EXIT
if [ -x "$chroot/usr/bin/apt-get" ]; then
  KEEP=yes
else
  command -v debootstrap >/dev/null || { echo "$0: there is no debootstrap: apt install debootstrap" >&2; exit 2; }
  echo "a bare Debian in $chroot"
  debootstrap --variant=minbase bookworm "$chroot" ${MIRROR:-} >"$logs/debootstrap.log" || { tail "$logs/debootstrap.log"; exit 1; }
fi
mkdir -p "$chroot/dev/shm" "$chroot/dev/pts"
mount -t proc proc "$chroot/proc"
mount -t sysfs -o ro sysfs "$chroot/sys" # MPI asks it for cores
mount -t tmpfs tmpfs "$chroot/dev/shm"
mount -t devpts -o ptmxmode=0666 devpts "$chroot/dev/pts"
# every machine has it, a minimal debootstrap has not: MPI would ask the network who localhost is, 5 s at each start
[ -e "$chroot/etc/hosts" ] || echo "127.0.0.1 localhost" >"$chroot/etc/hosts"
cp /etc/resolv.conf "$chroot/etc/" 2>/dev/null || :

inside() {
  env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 ${http_proxy:+http_proxy=$http_proxy} \
    chroot "$chroot" "$@"
}
inside apt-get -q update >"$logs/apt.log" 2>&1 || { tail "$logs/apt.log"; exit 1; }
echo "before: $(inside dpkg-query -W | wc -l) packages"
