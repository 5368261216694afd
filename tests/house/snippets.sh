#!/bin/sh
# SPDX-License-Identifier: MIT
# snippets.sh ROOT: every code block of README.md and docs/*/*.md behind a line
#     <!-- snippet: FILE TAG -->
# is the text between the two lines "// [TAG]" of FILE ("# [TAG]" of a Python program), less common indentation. FILE is compiled
# by the build, or run by its tests.

set -eu
cd "$1"
found=0
failed=0
for page in README.md docs/*/*.md; do
    while IFS= read -r line; do
        [ -n "$line" ] || continue
        file=$(printf '%s\n' "$line" | awk '{print $3}')
        tag=$(printf '%s\n' "$line" | awk '{print $4}')
        found=$((found + 1))
        expected=$(awk -v tag="[$tag]" '
            { t = $0; sub(/^ +/, "", t) }
            t == "// " tag || t == "# " tag { inside = !inside; next }
            inside { lines[++n] = $0; match($0, /^ */); if ($0 != "" && (!n1++ || RLENGTH < least)) least = RLENGTH }
            END { for (i = 1; i <= n; ++i) print substr(lines[i], least + 1) }' "$file")
        written=$(awk -v mark="$line" '
            $0 == mark { armed = 1; next }
            armed && /^```/ { if (inside) exit; inside = 1; next }
            inside { print }' "$page")
        if [ -z "$expected" ] || [ "$expected" != "$written" ]; then
            echo "$page: $line differs from $file"
            failed=1
        fi
    done <<EOT
$(grep '^<!-- snippet: ' "$page" || true)
EOT
done 2>/dev/null
[ "$found" -gt 1 ] || { echo "no snippets found"; exit 1; }
exit $failed
