#!/bin/sh
# SPDX-License-Identifier: MIT
# includes.sh FOLDER: headers include what they use of the standard library, as far as names tell.
set -eu
cd "$1"
status=0
while read -r header names; do
    for file in $(grep -rlE --include='*.[hi]pp' "std::($names)" .); do
        grep -v '^ *//' "$file" | grep -qE "std::($names)" || continue
        grep -q "^#include <$header>" "$file" && continue
        echo "$file: uses std::($names) without #include <$header>"
        status=1
    done
done <<'RULES'
algorithm (max|min|sort|clamp|fill|fill_n|copy|copy_n|any_of|all_of|none_of|max_element|min_element|lower_bound|equal_range|replace|nth_element|equal|count)\(
array array\b
atomic atomic\b
chrono chrono\b
cmath (sqrt|isfinite|isnan|abs|exp|log|pow|sin|cos|atan2|ldexp|hypot|floor|ceil|lround)\b
cstddef size_t\b
cstdint u?int(8|16|32|64)_t\b
filesystem filesystem\b
functional function<
limits numeric_limits\b
map map<
memory (unique_ptr|shared_ptr|weak_ptr|make_unique|make_shared)\b
numeric (iota|accumulate)\b
optional (optional|nullopt)\b
ostream ostream\b
span span\b
sstream (ostringstream|istringstream|stringstream)\b
string (string|to_string)\b
string_view string_view\b
type_traits (is_same_v|is_floating_point_v|is_integral_v|is_arithmetic_v|conditional_t|remove_reference_t)\b
utility (move|exchange|pair|swap|forward)\b
vector vector<
RULES
exit $status
