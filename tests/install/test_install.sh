#!/bin/sh
# test_install.sh CMAKE SOURCE BUILD CC: installs to one prefix, moves it to another (packages are relocatable), and
# builds the ten-line program there with pkg-config and with find_package, shared and static. Each must run the case.
set -eu
cmake=$1 source=$2 build=$3 cc=$4
work=$(mktemp -d "$build/install-test.XXXXXX")
trap 'rm -rf "$work"' EXIT
fail() { echo "FAILED: $*" >&2; exit 1; }

"$cmake" --install "$build" --prefix "$work/first" >"$work/install.log" || { cat "$work/install.log"; fail install; }
mv "$work/first" "$work/talus prefix"
prefix="$work/talus prefix"
example=$source/docs/example/ten_lines.c
case_file=$source/tests/install/block.yaml

# Nothing of the build may be named in what is installed for others.
for file in $(cd "$prefix" && find . -name '*.pc' -o -name '*.cmake' -o -name '*.h'); do
  ! grep -n -e "$source" -e "$work" "$prefix/$file" || fail "$file names a path of the build"
done

# check NAME PROGRAM: runs the case in a directory of its own.
check() {
  mkdir "$work/run-$1"
  (cd "$work/run-$1" && LD_LIBRARY_PATH=$libdir "$2" "$case_file") >"$work/$1.out" 2>&1 ||
    { cat "$work/$1.out"; fail "$1: the program ended with an error"; }
  [ -s "$work/$1.out" ] || fail "$1: the program printed nothing"
  echo "$1: $(tail -n 1 "$work/$1.out")"
}

"$prefix/bin/talus" --version >/dev/null || fail "bin/talus --version"
for file in man/man1/talus.1 bash-completion/completions/talus zsh/site-functions/_talus fish/vendor_completions.d/talus.fish; do
  [ -s "$prefix/share/$file" ] || fail "share/$file is not there"
done
# What an installation gives to begin with is its own, not that of the source tree.
(cd "$work" && "$prefix/bin/talus" init mine --like cantilever >init.log) || fail "bin/talus init --like"
cmp "$work/mine/case.yaml" "$prefix/share/talus/cases/cantilever/case.yaml" || fail "talus init copies another case"
pc=$(cd "$prefix" && find . -name talus.pc)
export PKG_CONFIG_PATH="$prefix/${pc%/talus.pc}"
libdir=$(dirname "$PKG_CONFIG_PATH")

# pkg-config escapes the blank in the prefix, which only a second reading by the shell takes away.
eval "\"$cc\" \"$example\" -o \"$work/by_pkg_config\" $(pkg-config --cflags --libs talus)"
check by_pkg_config "$work/by_pkg_config"

"$cmake" -S "$source/tests/install/consumer" -B "$work/consumer" -G Ninja -DEXAMPLE="$example" -DCMAKE_C_COMPILER="$cc" \
  -DCMAKE_PREFIX_PATH="$prefix" >"$work/configure.log" 2>&1 || { cat "$work/configure.log"; fail find_package; }
"$cmake" --build "$work/consumer" >"$work/build.log" 2>&1 || { cat "$work/build.log"; fail "build with find_package"; }
check by_find_package "$work/consumer/ten_lines"
libdir=/nowhere
check static "$work/consumer/ten_lines_static"

# The outside sees only the public names.
foreign=$(nm -D --defined-only "$prefix"/lib*/libtalus.so "$prefix"/lib*/*/libtalus.so 2>/dev/null |
  awk 'NF == 3 && $3 !~ /^(Talus|talus_)/ {print $3}')
[ -z "$foreign" ] || fail "the shared library exports $foreign"

# Results do not depend on the way of linking.
cmp "$work/by_pkg_config.out" "$work/by_find_package.out" && cmp "$work/by_pkg_config.out" "$work/static.out" ||
  fail "the three programs print different results"
