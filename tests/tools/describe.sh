# SPDX-License-Identifier: MIT
# A case of run.sh: pages of man and completions, judged by man and by the shells, where these are installed.

# bash_offers LINE: what bash completes the line with, a word a line, to the file out.
bash_offers()
{
    bash -c '
        . ./taut.bash
        COMP_LINE=$1 COMP_POINT=${#1}
        words=${1//=/ = }
        read -ra COMP_WORDS <<<"$words"
        case $words in *" ") COMP_WORDS+=("") ;; esac
        COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
        _taut
        printf "%s\n" "${COMPREPLY[@]}"' - "$1" >out 2>err || fail "bash cannot complete $1"
    silent err
}

fish_offers()
{
    # shellcheck disable=SC2016
    HOME=$PWD XDG_CONFIG_HOME=$PWD fish --no-config -c 'source taut.fish; complete -C $argv[1]' "$1" >out 2>err ||
        fail "fish cannot complete $1"
}

zsh_offers()
{
    timeout 60 zsh -f "$here/offers.zsh" "$1" "$2" >out 2>err || fail "zsh does not offer $2 for $1"
}

test_describe()
{
    expect 0 man pages
    for page in taut taut-unwrap taut-atlas taut-bake taut-untangle taut-deform taut-smooth taut-paste taut-check taut-eval \
                taut-view taut-batch taut-devices; do
        says "pages/$page.1" '^\.TH ' '^\.SH NAME' '^\.SH OPTIONS' '^\.SH EXIT STATUS'
    done
    [ "$(find pages -type f | wc -l)" = 13 ] || fail "other pages than those of commands"
    says pages/taut.1 'taut\\-unwrap' 'TAUT_DEVICE'
    if command -v man >/dev/null; then
        for page in pages/*.1; do
            LC_ALL=C.UTF-8 MANROFFSEQ='' MANWIDTH=100 man --warnings -l "$page" >out 2>err || fail "man refuses $page"
            silent err
        done
        LC_ALL=C.UTF-8 MANWIDTH=100 man -l pages/taut-unwrap.1 >out 2>err
        says out '^NAME' 'taut-unwrap - Flatten' '--boundary free\|circle\|square' '^EXIT STATUS' 'time limit'
    fi
    touch a_file
    expect 2 man a_file
    error_says 'a_file'
    expect 2 completion
    error_says 'SHELL is required'
    expect 2 completion csh
    error_says 'csh'

    expect 0 completion bash
    cp out taut.bash
    expect 0 completion zsh
    cp out _taut
    expect 0 completion fish
    cp out taut.fish
    if command -v bash >/dev/null; then
        bash -n taut.bash || fail "bash refuses taut.bash"
        bash_offers 'taut un'
        [ "$(tr '\n' ' ' <out)" = 'unwrap untangle ' ] || fail "bash offers other commands"
        bash_offers 'taut unwrap --b'
        [ "$(cat out)" = --boundary ] || fail "bash does not offer --boundary alone"
        bash_offers 'taut unwrap --boundary '
        [ "$(tr '\n' ' ' <out)" = 'free circle square ' ] || fail "bash offers other boundaries"
        bash_offers 'taut unwrap --boundary=ci'
        [ "$(cat out)" = circle ] || fail "bash does not offer --boundary=circle"
        bash_offers 'taut unwrap a_f'
        [ "$(cat out)" = a_file ] || fail "bash does not offer files"
        bash_offers 'taut unwrap in.obj --pins a_'
        [ "$(cat out)" = a_file ] || fail "bash does not offer files of options"
    fi
    if command -v fish >/dev/null; then
        fish --no-config -n taut.fish || fail "fish refuses taut.fish"
        fish_offers 'taut unwrap --b'
        says out '^--boundary'
        fish_offers 'taut unwrap --boundary '
        says out '^free' '^circle' '^square'
        fish_offers 'taut un'
        says out '^unwrap' '^untangle'
    fi
    if command -v zsh >/dev/null; then
        zsh -n _taut || fail "zsh refuses _taut"
        zsh_offers 'taut unwrap --weig' weights
        zsh_offers 'taut unwrap --boundary=ci' circle
        zsh_offers 'taut unw' unwrap
    fi
}
