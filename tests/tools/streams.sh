# SPDX-License-Identifier: MIT
# A case of run.sh.

# What is no file is written through and stays what it is, for pictures, too.
test_streams()
{
    grid 4 >in.obj
    expect 0 unwrap in.obj -o out.obj --quiet
    mkfifo pipe
    for options in 'in.obj -o copy.obj --picture' 'in.obj -o copy.obj --render'; do
        timeout 60 cat pipe >from_pipe &
        # shellcheck disable=SC2086
        expect 0 unwrap $options pipe --quiet
        wait
        [ -p pipe ] || fail "the pipe was replaced"
        [ "$(od -An -tx1 -N8 from_pipe | tr -d ' \n')" = 89504e470d0a1a0a ] || fail "no PNG came through: $options"
    done
    if mknod null c 1 3 2>/dev/null && : 2>/dev/null >null; then
        expect 0 unwrap in.obj -o null --picture ./null --render null --quiet
        [ -c null ] || fail "the device was replaced"
        absent null.invalid
    else
        echo "without a device of our own: only root makes one"
    fi
    # Whatever ends a run before all is written leaves nothing: here it waits for a reader of the pipe.
    ls -A >before
    "$taut" unwrap in.obj -o new.obj --render pipe --quiet --progress json 2>err &
    program=$!
    until grep -q '"phase":"write"' err; do
        kill -0 $program || fail "ended before it was killed"
        sleep 0.1
    done
    sleep 0.5
    kill -KILL $program
    wait $program 2>/dev/null
    case $(stat -f -c %T . 2>/dev/null) in
    ext2/ext3 | xfs | btrfs | tmpfs) ls -A | diff before - >out || fail "a killed run has left files" ;;
    *) echo "this file system may have no files without a name" ;;
    esac
    ln -s picture.png link.png
    chmod 640 out.obj
    expect 0 unwrap in.obj -o out.obj --picture link.png --quiet
    [ -L link.png ] || fail "the link was replaced"
    [ -f picture.png ] || fail "the link was not followed"
    [ "$(ls -l out.obj | cut -c 1-10)" = -rw-r----- ] || fail "the permissions are not kept"

    # Standard input and output, as - and by name, into a pipe and into a file.
    expect 0 unwrap - -o - <in.obj
    cmp -s out out.obj || fail "another map by standard streams"
    says err '^mesh +/dev/stdin: 25 vertices' '^wrote +/dev/stdout$'
    expect 0 unwrap /dev/stdin -o /dev/stdout --quiet --stats stats.json <in.obj
    cmp -s out out.obj || fail "another map by standard streams"
    keys stats.json input output
    says values '^input=/dev/stdin$' '^output=/dev/stdout$'
    cat in.obj | "$taut" unwrap - -o - --quiet | cmp -s - out.obj || fail "another map through pipes"
    { echo before; "$taut" unwrap in.obj -o - --quiet; echo after; } >all
    { echo before; cat out.obj; echo after; } | cmp -s - all || fail "standard output was not written where it stood"
    expect 0 unwrap in.obj -o copy.obj --stats -
    cp out stats.json
    keys stats.json schema
    says err '^mesh '
    for kind in off ply; do
        grid 4 $kind >in.$kind
        expect 0 unwrap - -o copy.obj --quiet <in.$kind
        cmp -s copy.obj out.obj || fail "another map of $kind by standard input"
        cp in.$kind in.dat
        expect 3 check in.dat
        expect 0 check in.dat --format $kind
        expect 0 unwrap in.dat --format $kind -o copy.obj --quiet
    done
    expect 3 check - --format ply <in.off
    expect 0 eval - <out.obj
    says out '^flipped +0 of 32'
    printf '0,0,0\n' >pins.csv
    expect 2 check - --pins - <in.obj
    expect 0 check - --pins pins.csv <in.obj
    expect 0 check in.obj --pins - <pins.csv
    says out '1 pinned vertex'
    strip 8 collapsed >in.prob
    expect 0 check - --format prob <in.prob
    says out 'problem of triangles'
    expect 0 untangle in.prob -o map.txt --quiet
    expect 0 untangle - -o - <in.prob
    cmp -s out map.txt || fail "another map by standard streams"
    says err '^outcome +injective'

    # An input without an end. The limit is a quarter of what the process may have.
    (ulimit -v 1000000 && "$taut" eval /dev/zero >out 2>err)
    [ $? = 3 ] || fail "endless input"
    error_says '/dev/zero: has more than [0-9]+ MiB'

    # What cannot be printed is no success.
    if [ -w /dev/full ]; then
        for words in 'eval out.obj' 'eval out.obj --json' 'check in.obj' 'check in.obj --json' devices --help --version; do
            # shellcheck disable=SC2086
            "$taut" $words >/dev/full 2>err
            [ $? = 2 ] || fail "taut $words succeeds on a full standard output"
            error_says '/dev/stdout: cannot write: No space left'
        done
    fi
    "$taut" check in.obj >&- 2>err && fail "succeeds without a standard output"
    "$taut" unwrap nothing.obj -o new.obj >&- 2>err
    [ $? = 2 ] || fail "a closed standard output is not found before the run"
    error_says '/dev/stdout: .*--quiet'
    # But who has stopped reading the report does not lose the map.
    { sleep 0.5; "$taut" unwrap in.obj -o new.obj 2>err; echo $? >code; } | true
    [ "$(cat code)" = 0 ] || fail "no map where nobody reads the report"
    valid_map new.obj
    rm new.obj

    # What a run without a valid map has left is gone when there is one.
    echo stale >out.obj.invalid
    echo stale >map.txt.invalid
    expect 0 unwrap in.obj -o out.obj --quiet
    expect 0 untangle in.prob -o map.txt --quiet
    absent out.obj.invalid
    absent map.txt.invalid
}
