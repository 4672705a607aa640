#!/bin/sh
# test_install.sh CMAKE SOURCE BUILD PYTHON: the package under a prefix finds the library there, in whichever Python looks; pip makes
# the same of the sources, without a network.
set -eu
cmake=$1 source=$2 build=$3 python=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "FAILED: $*" >&2; exit 1; }
unset TALUS_LIBRARY TALUS_PROGRAM PYTHONPATH
cd "$work"

# try NAME PACKAGES: from there the library of the same prefix is loaded, and a case becomes a run.
try() {
  PYTHONPATH=$2 "$python" -B - "$source/tests/api/block.yaml" "$2" "$1" <<'END' || fail "$1"
import sys, talus
from talus._library import library
assert talus.__file__.startswith(sys.argv[2] + "/talus/"), talus.__file__
print(sys.argv[3], talus.__version__, library()._dll._name)
assert talus.Case(sys.argv[1]).run(sys.argv[3] + "-run").outcome == "done"
END
}

DESTDIR= "$cmake" --install "$build/python" --prefix "$work/local" >log || { cat log; fail "cmake --install"; }
packages=$(dirname "$(cd "$work/local" && find . -type d -path '*-packages/talus')")
case $packages in ./lib/python3.*-packages) ;; *) fail "it went to $packages" ;; esac
"$cmake" --install "$build/python" --prefix "$work/usr" >log
if [ "${packages%/dist-packages}" != "$packages" ]; then [ -f usr/lib/python3/dist-packages/talus/talus.h ] || fail "/usr"; fi
cp -P "$build"/libtalus.so* local/lib/
(try prefix "$work/local/${packages#./}") | tee out.txt
grep -q "$work/local/.*/lib/libtalus.so\|$work/local/lib/libtalus.so" out.txt || fail "another library than that of the prefix"
PYTHONPATH=$work/local/${packages#./} "$python" -c 'from importlib.metadata import version; import talus; assert version("talus") == talus.__version__'

if "$python" -m pip --version >/dev/null 2>&1; then
  "$python" -m pip install --quiet --no-index --no-deps --target "$work/pip" "$source/python" 2>log || { cat log; fail pip; }
  TALUS_LIBRARY=$build try pip "$work/pip"
  [ ! -d "$source/python/build" ] || fail "pip has left something in the sources"
else
  echo "pip is not here: not tried"
fi
