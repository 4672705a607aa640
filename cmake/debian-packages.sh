#!/bin/sh
# debian-packages.sh GROUP...: installs the Debian packages of the groups that are missing. Silent where all are there.
set -eu

packages_of() {
  case $1 in
    build)
      echo build-essential cmake ninja-build pkg-config
      echo petsc-dev libopenmpi-dev openmpi-bin libhdf5-openmpi-dev libopenblas-dev
      echo libfyaml-dev zlib1g-dev libcmocka-dev gmsh gnuplot-nox
      echo python3-numpy python3-h5py python3-mpi4py
      ;;
    # The site: pages and theme, formulas set at build time, the reference of the header.
    docs) echo python3-sphinx python3-myst-parser furo katex doxygen ;;
    format) echo clang-format ;;
    tidy) echo clang-tidy ;;
    fuzz) echo clang libclang-rt-dev ;;
    *) echo "debian-packages.sh: unknown group '$1'" >&2; exit 2 ;;
  esac
}

wanted=$(for group in "$@"; do packages_of "$group"; done)

if ! command -v dpkg-query >/dev/null; then
  echo "This is not Debian: talus needs what these packages hold:" $wanted >&2
  exit 0
fi

missing=
for package in $wanted; do
  case $(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true) in
    'install ok installed') ;;
    *) missing="$missing $package" ;;
  esac
done
[ -n "$missing" ] || exit 0

sudo=
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "Packages are missing, and neither root nor sudo is here to install them. As root, run:" >&2
    echo "  apt-get update && apt-get install --no-install-recommends$missing" >&2
    exit 1
  fi
  sudo=sudo
fi

echo "Installing Debian packages:$missing"
apt="$sudo env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300"
# Old package lists name files that the mirrors no longer have; a broken third-party source must not stop us.
$apt update || echo "apt-get update had trouble; going on with the lists there are" >&2
if ! $apt install -y --no-install-recommends $missing; then
  echo "apt could not install:$missing" >&2
  exit 1
fi
