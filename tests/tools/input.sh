# SPDX-License-Identifier: MIT
# A case of run.sh.

test_input()
{
    expect 3 unwrap nothing.obj -o out.obj
    error_says 'nothing.obj'
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 zero\nf 1 2 3\n' >word.obj
    expect 3 eval nothing.obj
    error_says 'nothing.obj'
    grid 4 >in.stp
    expect 3 unwrap in.stp -o out.obj
    error_says '.obj, .off, .ply and .stl'
    # Kinds of names, wherever one is read: no file, a folder, a file of another kind.
    mkdir folder
    grid 4 >in.obj
    printf 'MeshVersionFormatted 2\nDimension 2\n' >plane.mesh
    for command in 'unwrap folder' 'atlas folder' 'smooth folder' 'deform folder' 'untangle folder' \
                   'unwrap in.obj --pins folder'; do
        # shellcheck disable=SC2086
        expect 3 $command -o out.obj
        error_says 'folder: is a folder; name a file'
    done
    expect 3 batch --manifest folder
    error_says 'folder: is a folder'
    for command in 'unwrap none.stp' 'smooth none.stp'; do
        # shellcheck disable=SC2086
        expect 3 $command -o out.obj
        error_says 'none.stp: No such file'
    done
    expect 3 unwrap plane.mesh -o out.obj
    error_says 'plane.mesh: a volume, or a mesh of the plane; surfaces are read from .obj'
    expect 3 smooth word.obj -o out.obj
    error_says 'word.obj: a surface in space; volumes are read from .mesh'
    printf 'glTF' >model.glb
    expect 3 unwrap model.glb -o out.obj
    error_says 'model.glb: a model of glTF; surfaces are read from .* for .taut atlas.'
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\n' >points.obj
    expect 4 atlas points.obj -o out.obj
    error_says 'points.obj: the mesh has no triangles'
    expect 3 unwrap word.obj -o out.obj
    error_says 'line 3'
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 nan\nf 1 2 3\n' >nan.obj
    expect 3 unwrap nan.obj -o out.obj
    error_says 'line 3'
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n' >range.obj
    expect 3 unwrap range.obj -o out.obj
    error_says 'line 4|4'
    printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n' >short.off
    expect 3 unwrap short.off -o out.obj
    error_says 'short.off'
    # What a terminal would obey does not reach it.
    printf 'v \033[31mX\302\2332J 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >escape.obj
    expect 3 unwrap escape.obj -o out.obj
    error_says "found '\\?\\[31mX\\?2J'"
    expect 3 check escape.obj
    says out "found '\\?\\[31mX\\?2J'"
    absent out.obj
}
