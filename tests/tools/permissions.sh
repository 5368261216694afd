# SPDX-License-Identifier: MIT
# A case of run.sh.

# Outputs that cannot be written, found before anything is read, which here means: before the input is missed.
test_permissions()
{
    [ "$(id -u)" != 0 ] || { echo "root may write anywhere"; exit 77; }
    mkdir sealed
    echo precious >sealed/out.obj
    echo precious >read_only.obj
    chmod a-w sealed read_only.obj
    trap 'chmod u+w sealed' EXIT
    for name in sealed/new.obj sealed/out.obj read_only.obj; do
        expect 2 unwrap nothing.obj -o $name
        error_says "$name: cannot write: Permission denied"
    done
    expect 2 unwrap nothing.obj -o out.obj --stats sealed/new.json
    error_says '--stats: sealed/new.json: cannot write: Permission denied'
    expect 2 untangle nothing.prob -o map.txt --picture sealed/new.svg
    error_says '--picture: sealed/new.svg: cannot write: Permission denied'
    [ "$(cat sealed/out.obj read_only.obj | sort -u)" = precious ] || fail "a read-only file was changed"
}
