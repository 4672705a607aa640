# complete.zsh FOLDER LINE...: what zsh completes the end of each line to, with the function _talus of FOLDER: "LINE: OFFER OFFER". It is
# zsh itself that is asked, its editor at a terminal: its completion calls `compadd` for what it offers, which is written down.
zmodload zsh/zpty || exit 77
typeset -gx offers_in=$1 offers_out=$PWD/offers.$$ offers_lines="${(F)@[2,-1]}" ZDOTDIR=$(mktemp -d)
cat >$ZDOTDIR/.zshrc <<'END'
fpath=($offers_in $fpath)
autoload -Uz compinit && compinit -u -D
compadd() {
  [[ "${@[(r)-[OAD]*]}" == "" ]] || { builtin compadd "$@"; return; }
  local -a fit
  builtin compadd -O fit "$@"
  offered+=("${fit[@]}")
  builtin compadd "$@"
}
zle -C offer complete-word _main_complete
zle-line-init() {
  local line
  for line in "${(f)offers_lines}"; do
    typeset -ga offered=()
    BUFFER=$line CURSOR=$#line
    zle offer
    print -r -- "$line:" ${(ou)offered} >>$offers_out
  done
  BUFFER=exit
  zle accept-line
}
zle -N zle-line-init
END
: >$offers_out
zpty -b editor zsh -i
for ((tries = 0; tries < 300; ++tries)); do
  zpty -r -t editor ignored 2>/dev/null
  zpty -t editor || break
  sleep 0.1
done
zpty -d editor
cat $offers_out
rm -rf $offers_out $ZDOTDIR
