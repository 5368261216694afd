#!/bin/sh
# SPDX-License-Identifier: MIT
# rounding.sh FOLDER...: numbers are rounded to single precision by in_single (taut/impl/core/core/single.hpp) alone: a conversion to
# float and back is one that GCC 12 drops from loops.
set -eu
conversion='(double|static_cast<double>)\((float|static_cast<float>)\('
found=$(grep -rnE --include='*.[hic]pp' "$conversion" "$@" | grep -vE '^[^:]*:[0-9]+: *//' || true)
[ -z "$found" ] || { printf '%s\nround by in_single of taut/impl/core/core/single.hpp\n' "$found"; exit 1; }
