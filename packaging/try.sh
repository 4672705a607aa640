#!/bin/sh
# What somebody does with the installed packages, in an empty home; prints what it saw, ends with 1 where something is not as it should be.
set -eu
cd "$(mktemp -d)"
fail() { echo "FAILED: $*"; exit 1; }
step() { echo "== $*"; }

step talus --version
talus --version
step man talus
MANWIDTH=80 man talus | sed -n 1,8p
MANWIDTH=80 man talus | grep -q 'EXIT STATUS' || fail "the page has no exit status"
step completion
bash -c '. /usr/share/bash-completion/completions/talus; COMP_WORDS=(talus plo); COMP_CWORD=1; compopt() { :; }; _talus; echo "${COMPREPLY[0]}"' |
  grep -x plot || fail "bash completes nothing"
step talus init
talus init --list | sed -n 1,3p
talus init slump
talus check slump/case.yaml >/dev/null 2>warnings.txt || fail "check"
[ ! -s warnings.txt ] || fail "the first case warns"
step talus run
talus run slump/case.yaml | grep -e '^front' -e '^balance' -e '^steps'
step mpiexec -n 2 talus run
talus init beam --like cantilever >/dev/null
mpiexec --oversubscribe -n 2 talus run beam/case.yaml | grep '^tip'
step talus plot
talus plot runs/slump
for picture in runs/slump/pictures/*.png; do [ -s "$picture" ] || fail "no picture"; done
step "a mesh of Gmsh: talus check"
talus init cook --like cook >/dev/null && talus check cook/case.yaml | grep cells | sed -n 1p
step "the library: pkg-config and CMake"
cp /usr/share/doc/talus/example/ten_lines.c .
cc ten_lines.c -o ten_lines $(pkg-config --cflags --libs talus)
./ten_lines beam/case.yaml | grep tip
printf '%s\n' 'cmake_minimum_required(VERSION 3.25)' 'project(mine LANGUAGES C)' 'find_package(talus 0.2 REQUIRED)' \
  'add_executable(shared ten_lines.c)' 'target_link_libraries(shared PRIVATE talus::talus)' \
  'add_executable(static ten_lines.c)' 'target_link_libraries(static PRIVATE talus::static)' >CMakeLists.txt
cmake -S . -B build >cmake.log 2>&1 && cmake --build build >>cmake.log 2>&1 || { tail cmake.log; fail "CMake"; }
build/shared beam/case.yaml | grep tip
build/static beam/case.yaml | grep tip
if [ -d /usr/lib/python3/dist-packages/talus ]; then
  step "python3: import talus"
  python3 -c 'import talus; run = talus.open("runs/slump"); print(talus.__version__, run)'
fi
step documentation
[ -f /usr/share/doc/talus/html/index.html ] || [ -f /usr/share/doc/talus-doc/html/index.html ] || fail "no site"
ls /usr/share/doc/talus* -d
# Nothing of a younger machine: vectors of 256 bits and wider are those of AVX.
if command -v objdump >/dev/null; then
  for file in /usr/bin/talus /usr/lib/*/libtalus.so.?.?; do
    wide=$(objdump -d --no-show-raw-insn "$file" | grep -c -e '%ymm' -e '%zmm') || :
    [ "$wide" -eq 0 ] || fail "$file has $wide instructions with AVX"
  done
  step "no instruction beyond plain x86-64"
fi
echo "all is well"
