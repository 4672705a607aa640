#!/bin/sh
# test_install.sh CMAKE SOURCE BUILD PYTHON: the package under a prefix finds the library there, in whichever Python looks; a wheel
# of the sources is the same.
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

# What pip makes of the sources, by its own interface to the backend; pip itself takes seconds.
mkdir wheel wheels
(cd "$source/python" && "$python" -B -c "import backend, sys; print(backend.build_wheel(sys.argv[1]))" "$work/wheels") >name
"$python" -m zipfile -e "wheels/$(cat name)" wheel
diff -r -x RECORD wheel "local/${packages#./}" || fail "the wheel is not what cmake installs"
