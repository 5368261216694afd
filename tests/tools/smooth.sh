# SPDX-License-Identifier: MIT
# A case of run.sh.

test_smooth()
{
    volume 3 | awk '/^Triangles/ { inside = 0 } inside && $1 > 0 && $1 < 1 && $2 > 0 && $2 < 1 && $3 > 0 && $3 < 3 {
        $1 += 0.12; $2 -= 0.1 } /^Vertices/ { inside = 1 } { print }' >bar.mesh
    expect 0 smooth bar.mesh -o out.mesh --stats stats.json
    keys stats.json schema outcome inverted quality_start.mean_ratio.worst quality.mean_ratio.worst
    says values 'schema=taut.smooth/1' '^inverted=0'
    awk -F= '/^quality_start/ { before = $2 } /^quality\./ { after = $2 } END { exit !(after > before) }' values ||
        fail "the worst element is no better"
    for boundary in fixed free; do
        expect 0 smooth bar.mesh -o out.mesh --boundary $boundary --exponent 3 --fix triangles:1 --quiet
        expect 0 check out.mesh
        says out '^inverted +0 of'
    done
    expect 2 smooth bar.mesh -o out.mesh --exponent 9
    expect 2 smooth bar.mesh -o out.mesh --boundary round
}
