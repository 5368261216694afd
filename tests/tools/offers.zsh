# SPDX-License-Identifier: MIT
# offers.zsh LINE WORD: types a line and a tab into a zsh of its own, which takes completions from this folder; fails if
# no completion shows WORD.
zmodload zsh/zpty
export TERM=vt100
zpty shell zsh -f -i
zpty -w shell "PS1=; fpath=($PWD \$fpath); autoload -U compinit; compinit -u -d $PWD/dump; bindkey -e
bindkey '^I' complete-word; print rea''dy"
all=
wait_for()
{
    for k in {1..100}; do
        zpty -r -t shell seen && all+=$seen
        [[ $all = *$1* ]] && return 0
        sleep 0.2
    done
    return 1
}
wait_for $'\n'ready && zpty -w -n shell "$1"$'\t' && wait_for "$2"
found=$?
print -r -- "$all"
zpty -d shell
exit $found
