#!/bin/sh
# build.sh FOLDER: Debian packages from the files that git tracks, as they are now, into FOLDER; then lintian over them.
# Their maintainer is who builds them: TALUS_MAINTAINER="Name <address>", or what Debian's tools (DEBFULLNAME, DEBEMAIL) or git know of him.
# DEB_BUILD_PROFILES=nodoc leaves the site out. Fails if a package does not build or lintian finds an error.
set -eu
source=$(cd "$(dirname "$0")/.." && pwd)
mkdir -p "$1"
folder=$(cd "$1" && pwd)
version=$(sed -n 's/^project(talus VERSION \([0-9.]*\).*/\1/p' "$source/CMakeLists.txt")
tree=$folder/talus-$version

maintainer=${TALUS_MAINTAINER:-}
[ -n "$maintainer" ] || [ -z "${DEBFULLNAME:-}" ] || [ -z "${DEBEMAIL:-}" ] || maintainer="$DEBFULLNAME <$DEBEMAIL>"
if [ -z "$maintainer" ] && git -C "$source" config user.email >/dev/null; then
  maintainer="$(git -C "$source" config user.name || :) <$(git -C "$source" config user.email)>"
fi
if [ -z "$maintainer" ]; then
  maintainer="Not named <nobody@talus.invalid>"
  echo "packaging/build.sh: who maintains these packages? MAINTAINER=\"Name <address>\" says it; until then: $maintainer" >&2
fi
case $maintainer in
  *[!\ ]*" <"*@*">") echo "maintainer: $maintainer" ;;
  *) echo "packaging/build.sh: '$maintainer' is no maintainer, as in \"Name <address@host>\"" >&2; exit 2 ;;
esac

rm -rf "$tree" "$folder"/*.deb "$folder"/*.changes "$folder"/*.dsc "$folder"/*.tar.*
mkdir "$tree"
(cd "$source" && git ls-files -z | xargs -0 cp -P --parents -t "$tree")
tar -C "$folder" --sort=name --owner=0 --group=0 --numeric-owner -cJf "$folder/talus_$version.orig.tar.xz" "talus-$version"
cp -R "$tree/packaging/debian" "$tree/debian"
rm -f "$tree"/debian/*.md
MAINTAINER=$maintainer perl -pi -e 's/\@MAINTAINER\@/$ENV{MAINTAINER}/' "$tree/debian/control" "$tree/debian/changelog"

# A cache of compilations, if there is one, lies where debhelper's own HOME would hide it.
[ -z "${TALUS_CCACHE:-}" ] || export CCACHE_DIR="${CCACHE_DIR:-$HOME/.cache/ccache}" PATH="/usr/lib/ccache:$PATH"
(cd "$tree" && dpkg-buildpackage --unsigned-source --unsigned-changes >"$folder/build.log" 2>&1) ||
  { tail -n 40 "$folder/build.log"; echo "packaging/build.sh: no packages; $folder/build.log says why" >&2; exit 1; }

echo "lintian:"
status=0
lintian --fail-on error --tag-display-limit 0 --allow-root "$folder"/*.changes >"$folder/lintian.txt" 2>&1 || status=1
sed 's/^/  /' "$folder/lintian.txt"
rm -rf "$tree"
(cd "$folder" && ls -l -- *.deb | awk '{printf "  %9.1f kB  %s\n", $5 / 1000, $9}')
exit $status
