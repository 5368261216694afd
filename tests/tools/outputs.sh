# SPDX-License-Identifier: MIT
# A case of run.sh.

test_outputs()
{
    grid 4 >in.obj
    cp in.obj copy.obj
    expect 2 unwrap in.obj -o missing/out.obj
    error_says 'no folder missing'
    expect 2 unwrap in.obj -o out.ply
    error_says 'must end in .obj'
    expect 2 unwrap in.obj -o .
    error_says 'is a folder'
    expect 2 unwrap in.obj -o out.obj --picture out.jpg
    error_says '--picture' '.png or .svg'
    expect 2 unwrap in.obj -o out.obj --stats missing/stats.json
    error_says '--stats' 'no folder'
    expect 2 unwrap in.obj -o out.obj --picture same.png --render ./same.png
    error_says 'is also the file of --picture'
    # Nothing is solved before the outputs are known to be writable: the input need not even be there.
    expect 2 unwrap nothing.obj -o missing/out.obj
    absent out.obj

    # What was there stays when a run fails, and temporary files do not.
    echo precious >out.obj
    octahedron >closed.obj
    ls -A >before
    expect 4 unwrap closed.obj -o out.obj
    [ "$(cat out.obj)" = precious ] || fail "a failed run touched its output"
    # All outputs of a run, or none: an error when the work is done changes no file.
    if [ -w /dev/full ]; then
        expect 2 unwrap in.obj -o /dev/full --quiet
        error_says 'No space left'
        expect 2 unwrap in.obj -o out.obj --stats /dev/full --picture out.png --quiet
        error_says '/dev/full'
        "$taut" unwrap in.obj -o out.obj >/dev/full 2>err
        [ $? = 2 ] || fail "no error where the report cannot be printed"
        [ "$(cat out.obj)" = precious ] || fail "an output was replaced without the others"
    fi
    ls -A | diff before - >out || fail "files are left"
    rm out.obj

    # In place, as asked.
    cp in.obj place.obj
    expect 0 unwrap place.obj -o place.obj --quiet
    silent out
    silent err
    same_vertices in.obj place.obj
    valid_map place.obj
    # The input is no place for anything else, nor are pins for any output.
    printf '0,0,0\n' >pins.obj
    cp pins.obj pins.copy
    ln -s in.obj link.json
    ln in.obj hard.json
    ln -s pins.obj pins.json
    ln pins.obj hard_pins.json
    for name in link hard; do
        expect 2 unwrap in.obj -o out.obj --stats $name.json
        error_says 'overwrite the input'
    done
    expect 2 unwrap - -o out.obj --stats hard.json <in.obj
    error_says 'overwrite the input'
    for name in pins hard_pins; do
        expect 2 unwrap in.obj -o out.obj --pins pins.obj --stats $name.json
        error_says 'overwrite the pins'
    done
    expect 2 unwrap in.obj -o pins.obj --pins pins.obj
    error_says 'overwrite the pins'
    cp in.obj out.obj.invalid
    expect 2 unwrap out.obj.invalid --format obj -o out.obj
    error_says 'overwrite the input'
    cmp -s pins.obj pins.copy || fail "the pins were changed"
    ln hard.json out.obj
    expect 2 unwrap copy.obj -o out.obj --stats hard.json
    error_says 'is also the file of'
    expect 2 unwrap in.obj -o - --stats -
    error_says 'is also the file of'
    cmp -s in.obj copy.obj || fail "the input was changed"
}
