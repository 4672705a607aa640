#!/bin/sh
# build.sh TALUS BUILD: the site in BUILD/docs/html. Whatever Sphinx, KaTeX, Doxygen or the test of links warns of is an error.
set -eu
here=$(dirname "$0") talus=$1 build=$2
source=$build/docs/source html=$build/docs/html
python=/usr/bin/python3
[ -x $python ] || python=python3

TALUS_VERSION=$("$talus" version | sed -n '1s/^talus //p')
export TALUS_VERSION
$python "$here/assemble.py" "$talus" "$source"
$python -m sphinx -a -q -W --keep-going -j 3 -b html -c "$here" -D html_extra_path="$source/_extra" \
  -d "$build/docs/doctrees" "$source" "$html"
doxygen "$build/Doxyfile"
$python "$here/links.py" "$html"
echo "the site: $(cd "$html" && pwd)/index.html"
