#!/bin/sh
# What the program says of itself to man and to shells, and the case that it gives to begin with.
here=$(cd "$(dirname "$0")" && pwd)
. "$here/library.sh"
PATH=$(dirname "$talus"):$PATH

# One source: every option of a --help stands in the page and in each completion.
expect "the page" 0 "$talus" help --man
mv out.txt talus.1
for shell in bash zsh fish; do
  expect "completion $shell" 0 "$talus" completion $shell
  mv out.txt complete.$shell
done
commands=$("$talus" --help | sed -n '/^commands:/,/^$/s/^  \([a-z-]*\) .*/\1/p')
for command in $commands; do
  name="talus $command --help"
  "$talus" $command --help >help.txt
  says help.txt "usage: talus $command" "options:" "examples:" "  talus $command"
  says talus.1 ".SS talus $command"
  says complete.fish "__fish_use_subcommand -a $command "
  says complete.zsh "_talus_$command()" "'$command:"
  for option in $(sed -n '/^options:/,/^$/s/^  --\([a-z]*\) .*/\1/p' help.txt); do
    [ $option != help ] || continue
    says talus.1 '\-\-'$option'\fR'
    says complete.bash "'$command --$option')"
    says complete.zsh "--$option"
    says complete.fish "from $command' -l $option "
  done
  # examples name options that there are
  for option in $(sed -n "/^examples:/,\$s/#.*//; s/^  .*talus $command//p" help.txt | tr ' ' '\n' | sed -n 's/^--\([a-z]*\).*/\1/p'); do
    grep -q "^  --$option " help.txt || fail "$name: the examples name --$option"
  done
done
if command -v man >/dev/null && man --version >/dev/null 2>&1; then
  name="the page as man shows it"
  MANWIDTH=80 man --warnings -l talus.1 >page.txt 2>warnings.txt || fail "$name: man fails"
  [ ! -s warnings.txt ] || fail "$name: $(head -n 3 warnings.txt)"
  says page.txt "talus plot" "EXIT STATUS"
fi

expect "talus help plot" 0 "$talus" help plot
"$talus" plot --help | cmp -s out.txt - || fail "$name: it says something else"

# bash, as it works
completes() { # WORDS: RESULTS
  name="bash completes '$1'" wanted=$2
  eval "bash '$here/complete.bash' complete.bash $1" >got.txt 2>err.txt
  got=$(sort got.txt | tr '\n' ' ')
  [ "${got% }" = "$wanted" ] || fail "$name to '$got', not '$wanted'"
  [ ! -s err.txt ] || fail "$name: it complains"
}
mkdir -p cases/beam runs/beam 'a folder'
cantilever >cases/beam/case.yaml
cantilever >one.yaml
touch notes.txt runs/beam/history.csv
completes "talus ve" "verify version"
completes "talus run --re" "--resume"
completes "talus run --resume ru" "runs"
completes "talus plot runs/b" "runs/beam"
completes "talus run cases/" "cases/beam/case.yaml"
completes "talus run on" "one.yaml"
completes "talus run no" ""
completes "talus run a" "a folder"
completes "talus run one.yaml o" ""
completes "talus run --quiet on" "one.yaml"
completes "talus run --out x on" "one.yaml"
completes "talus run one.yaml --log no" "notes.txt"
completes "talus run one.yaml --log=no" "notes.txt"
completes "talus run one.yaml --set grid.si" "grid.size="
completes "talus run one.yaml --set method=" "fem gmm mpm"
completes "talus run one.yaml --set=method=m" "mpm"
completes "talus plot runs/beam --field mi" "mises"
completes "talus plot runs/beam --up ''" "x y z"
completes "talus list fi" "fields"
completes "talus completion ''" "bash fish zsh"
completes "talus init x --like cantil" "cantilever"
bash -n complete.bash || fail "bash does not read its completion"

# fish and zsh, where they are: what they offer at the end of a line. Their own order of words is not ours.
asked='talus ve: verify version
talus run --resu: --resume
talus run one.yaml --set grid.si: grid.size=
talus run one.yaml --set method=: method=fem method=gmm method=mpm
talus plot runs/beam --field mi: mises
talus plot runs/beam --up : x y z
talus plot runs/beam --format p: pdf png
talus list fi: fields
talus import : kratos
talus completion : bash fish zsh
talus init x --like cantil: cantilever'
offers() { # SHELL; its words on standard input
  cat >got.txt
  name="$1 completes"
  printf '%s\n' "$asked" | cmp -s - got.txt || fail "$name otherwise: $(printf '%s\n' "$asked" | diff - got.txt | tr '\n' ' ')"
}
if command -v fish >/dev/null; then
  name="fish"
  fish -n complete.fish || fail "$name does not read its completion"
  printf '%s\n' "$asked" | sed 's/: .*//' >lines.txt
  fish -c 'source complete.fish
    for line in (cat lines.txt); echo "$line: "(string join -- " " (complete -C "$line" | cut -f 1 | sort -u)); end' >fish.txt 2>&1
  offers fish <fish.txt
fi
if command -v zsh >/dev/null; then
  name="zsh"
  zsh -n complete.zsh || fail "$name does not read its completion"
  mkdir functions && cp complete.zsh functions/_talus
  printf '%s\n' "$asked" | sed 's/: .*//' | tr '\n' '\0' | xargs -0 zsh -f "$here/complete.zsh" "$PWD/functions" | offers zsh
fi
expect "no such shell" 2 "$talus" completion csh
says err.txt "'csh' is no shell that is known" "bash, zsh or fish"
expect "help of nothing" 2 "$talus" help rnu
says err.txt "'rnu' is no command"

# A case to begin with
expect "init" 0 "$talus" init begin/
says out.txt "begin/case.yaml: Sand slumps" "talus run begin/case.yaml"
expect "check of the first case" 0 "$talus" check begin/case.yaml
[ ! -s err.txt ] || fail "$name: it warns"
name="every line of the first case is explained"
grep -v -e '^ *#' -e '^$' begin/case.yaml | grep -v '#' | grep -v -e ':$' -e 'poisson:' -e '- name: sand' && fail "$name"
expect "run of the first case" 0 "$talus" run begin/case.yaml --set grid.size=0.125 --set analysis.end=0.5
says runs/begin/log.txt "front = " "balance = "
expect "init of two words" 0 "$talus" init "two words"
says out.txt "talus check 'two words/case.yaml'" "talus plot 'runs/two words'"
expect "init twice" 2 "$talus" init begin
says err.txt "'begin' is there already"
expect "init over a file" 2 "$talus" init notes.txt
says err.txt "'notes.txt' is there already"
expect "init nowhere" 2 "$talus" init no/where/at/all
says err.txt "the folder 'no/where/at/all' cannot be made: No such file"
expect "init of no name" 2 "$talus" init
says err.txt "there is no NAME on the command line"
expect "init list" 0 "$talus" init --list
says out.txt "cantilever               Cantilever under its own weight"
expect "init list and more" 2 "$talus" init x --list
says err.txt "--list stands alone"
expect "init like" 0 "$talus" init mine --like cantilever
cmp -s mine/case.yaml "$here/../../cases/cantilever/case.yaml" || fail "$name: another case"
[ -f mine/reference.yaml ] || fail "$name: no reference.yaml"
expect "init like what is not there" 2 "$talus" init other --like cantilevr
says err.txt "there is no case 'cantilevr'" "did you mean 'cantilever'?"
[ ! -e other ] || fail "$name: a folder is left"
expect "init like, of another folder" 0 env TALUS_CASES="$work/cases" "$talus" init again --like beam
cmp -s again/case.yaml cases/beam/case.yaml || fail "$name: another case"
expect "init without cases" 2 env TALUS_CASES=/nowhere "$talus" init --list
says err.txt "there are no cases in '/nowhere'"
expect "init on two ranks" 0 on_ranks 2 "$talus" init ranks
[ -f ranks/case.yaml ] || fail "$name: no case"

finish
