#!/bin/sh
# release-check.sh [--agree | VERSION]: what must be so before the tag vVERSION is set. --agree: only whether all files
# tell one version (a test, at any time).
set -u
cd "$(dirname "$0")/.." || exit 2
wrong=0
complain() { echo "$*"; wrong=1; }

version=$(sed -n 's/^project(talus VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
[ -n "$version" ] || { echo "CMakeLists.txt tells no version"; exit 2; }
minor=${version%.*}
# tells FILE VERSION WANTED
tells() { [ "$2" = "$3" ] || complain "$1 tells version '$2', CMakeLists.txt $version"; }
tells CHANGELOG.md "$(sed -n 's/^## \([0-9.]*\).*/\1/p' CHANGELOG.md | head -n 1)" "$version"
tells CITATION.cff "$(sed -n 's/^version: *//p' CITATION.cff)" "$version"
tells packaging/debian/changelog "$(sed -n '1s/^talus (\([0-9.]*\)-.*/\1/p' packaging/debian/changelog)" "$version"
tells packaging/debian/control "$(sed -n 's/^Package: libtalus\([0-9.]*\)$/\1/p' packaging/debian/control)" "$minor"
[ -f packaging/debian/libtalus$minor.install ] || complain "packaging/debian/libtalus$minor.install is not there"
for file in docs/example/README.md packaging/try.sh; do
  tells $file "$(sed -n 's/.*find_package(talus \([0-9.]*\).*/\1/p' $file | head -n 1)" "$minor"
done
if grep -q "^version" python/pyproject.toml 2>/dev/null; then # otherwise it is read from CMakeLists.txt
  tells python/pyproject.toml "$(sed -n 's/^version *= *"\(.*\)"/\1/p' python/pyproject.toml)" "$version"
fi
[ "${1:-}" != --agree ] || { [ $wrong -eq 0 ] && echo "all files tell $version"; exit $wrong; }

[ -z "${1:-}" ] || [ "$1" = "$version" ] || complain "the release is to be $1, the files tell $version"
head=$(grep -m 1 '^## ' CHANGELOG.md)
echo "$head" | grep -q '^## [0-9.]* ([0-9]* [A-Z][a-z]* [0-9]*)$' || complain "CHANGELOG.md: '$head' has no date, as in '## $version (3 December 2026)'"
grep -q "^date-released: " CITATION.cff || complain "CITATION.cff has no date-released"
[ -z "$(git status --porcelain)" ] || complain "the tree has changes that are not committed"
! git rev-parse -q --verify "refs/tags/v$version" >/dev/null || complain "the tag v$version is there already"
! grep -n -e '-dirty' docs/verification.md || complain "docs/verification.md has numbers of a tree with changes"
[ $wrong -eq 0 ] || exit 1
echo "$version may be tagged. Left to do by hand: CONTRIBUTING.md, A release"
