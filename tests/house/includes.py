# SPDX-License-Identifier: MIT
"""includes.py FOLDER: headers include what they use of the standard library, as far as names tell; bodies (.ipp) have
what their own header includes."""
import pathlib
import re
import sys

RULES = r"""
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
"""

rules = [line.split(" ", 1) for line in RULES.split("\n") if line]
rules = [(header, names, re.compile(f"std::({names})")) for header, names in rules]
missing = 0
for file in sorted(pathlib.Path(sys.argv[1]).rglob("*.[hi]pp")):
    text = file.read_text()
    for own in re.findall(rf"#include <taut/([\w/]+/{file.stem}\.hpp)>", text) if file.suffix == ".ipp" else []:
        text += (pathlib.Path(sys.argv[1]) / own).read_text()
    code = "\n".join(line for line in file.read_text().split("\n") if not line.lstrip(" ").startswith("//"))
    for header, names, used in rules:
        if used.search(code) and f"\n#include <{header}>" not in text:
            print(f"{file}: uses std::({names}) without #include <{header}>")
            missing += 1
sys.exit(1 if missing else 0)
