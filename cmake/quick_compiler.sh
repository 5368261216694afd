#!/bin/sh
# SPDX-License-Identifier: MIT
# quick_compiler.sh CLANG GCC OPTION...: clang++ in the place of GCC, with GCC's options (quick_compiler.cmake).
clang=$1
shift 2
case " $* " in
*" c++-header "*) # of an older precompiled header it would make the new one
    for option; do case $option in *.gch) rm -f "$option" ;; esac; done
    ;;
esac
# No warnings that GCC lacks: of conversions of signs, and of names that two files of a unit have in common. A compiler
# cache may have made a precompiled header before the file that it names.
# shellcheck disable=SC2086
exec $clang "$@" -Wno-unknown-warning-option -Wno-sign-conversion -Wno-shadow \
    -fpch-instantiate-templates -Xclang -fno-pch-timestamp
