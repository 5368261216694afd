# SPDX-License-Identifier: MIT
# A case of run.sh.

test_deform()
{
    volume 3 >bar.mesh
    expect 0 deform bar.mesh -o out.mesh --fix triangles:1 --move triangles:2:rotate:0,0,1,90 --stats stats.json
    says out '640|160' 'inverted *0 -> 0' 'converged' 'wrote *out.mesh, stats.json'
    keys stats.json schema outcome converged pins_held inverted branch_edges quality.mean_ratio.worst seconds.total stages.0.stage \
        stages.1.energy_after
    says values 'schema=taut.deform/1' 'outcome=valid' '^inverted=0' '^branch_edges=0'
    # All but coordinates is as it was, and vertices that are held keep their very text.
    grep -v '^[-0-9.e]* [-0-9.e]* [-0-9.e]* 0$' bar.mesh >before
    grep -v '^[-0-9.e]* [-0-9.e]* [-0-9.e]* 0$' out.mesh >after
    cmp before after || fail "more than coordinates has changed"
    [ "$(sed -n 7,22p bar.mesh)" = "$(sed -n 7,22p out.mesh)" ] || fail "fixed vertices have moved"

    # The moved group stands where it was told to, and the mesh goes back to its rest.
    expect 0 deform out.mesh -o back.mesh --rest bar.mesh --fix triangles:1 --quiet --stats stats.json
    keys stats.json energy inverted
    says values '^energy=(2\.00000|2$|1\.99999)' '^inverted=0'

    # Springs of a file, energies by name, a group by its number.
    for energy in isometric shape volume neo-hookean; do
        printf '150,0.5,0.5,3.4,10\n' >spring.csv
        expect 0 deform bar.mesh -o out.mesh --fix 1 --pins spring.csv --energy $energy --quiet
        silent out
    done
    # It ends where it is told to.
    expect 0 deform bar.mesh -o out.mesh --fix triangles:1 --move triangles:2:rotate:0,0,1,90 --tolerance 0.5 --stats stats.json
    keys stats.json gradient
    expect 2 deform bar.mesh -o out.mesh --tolerance 1
    error_says '--tolerance'
    echo 'vertex,x,y,z' >none.csv
    expect 0 deform bar.mesh -o out.mesh --fix triangles:1 --pins none.csv
    says err 'none.csv: no pins in it'
    printf '150,0.4,0.6,3.1\n' >end.csv
    expect 4 deform bar.mesh -o late.mesh --move triangles:1=end.csv
    error_says 'vertex 150 is not in group triangles:1'
    absent late.mesh

    # Wrong use.
    expect 4 deform bar.mesh -o late.mesh --fix nothing
    error_says 'nothing' 'triangles:1'
    expect 2 deform bar.mesh -o late.mesh --move triangles:1
    error_says 'GROUP:translate'
    expect 2 deform bar.mesh -o late.mesh --move triangles:1:rotate:0,0,0,90
    error_says 'axis'
    expect 2 deform bar.mesh -o late.mesh --move triangles:1:translate:1,2
    error_says 'give 3 numbers'
    expect 2 deform bar.mesh -o bar.mesh
    expect 3 deform nothing.mesh -o late.mesh
    expect 4 deform bar.mesh -o late.mesh --fix tetrahedra:7 --move triangles:2:translate:0,0,1
    error_says 'different ways'
    absent late.mesh
}
