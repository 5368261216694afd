# SPDX-License-Identifier: MIT
# A case of run.sh.

# A disk with little room.
test_full_disk()
{
    mkdir small
    mount -t tmpfs -o size=64k tmpfs small 2>/dev/null || { echo "no small disk can be mounted"; exit 77; }
    trap 'umount small' EXIT
    grid 4 >in.obj
    echo precious >small/out.obj
    expect 2 unwrap in.obj -o small/out.obj --picture small/out.png --stats small/out.json
    error_says 'out.png: cannot write: No space left'
    [ "$(ls -A small) $(cat small/out.obj)" = 'out.obj precious' ] || fail "a failed run changed files: $(ls -A small)"
    # No room at all is found before anything is read.
    head -c 100000 /dev/zero >small/filler 2>/dev/null
    expect 2 unwrap nothing.obj -o small/new.obj
    error_says 'new.obj: cannot write: No space left'
}
