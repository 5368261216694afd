# SPDX-License-Identifier: MIT
# A case of run.sh.

test_usage()
{
    grid 4 >in.obj
    expect 0 --help
    says out 'unwrap' 'untangle' 'check' 'eval' 'devices' 'exit codes: 0 valid map; 2 usage'
    expect 0 unwrap --help
    says out '--energy isometric\|shape\|area' '--time-limit' '130 interrupted'
    expect 0 --version
    says out '^taut [0-9]+\.[0-9]+\.[0-9]+(-rc\.[0-9]+)?$'

    expect 2
    error_says 'subcommand' '--help'
    expect 2 flatten in.obj
    error_says 'no subcommand flatten' '--help'
    expect 2 unwarp in.obj
    error_says 'no subcommand unwarp' 'did you mean unwrap'
    expect 2 unwrap in.obj
    error_says '--output is required' 'taut unwrap --help'
    expect 2 unwrap -o out.obj
    error_says 'IN is required'
    expect 2 unwrap in.obj -o out.obj --colour red
    error_says 'no option --colour;'
    expect 2 unwrap in.obj --out out.obj
    error_says 'no option --out \(did you mean --output\?\)'
    expect 2 unwrap in.obj -o out.obj --seams edges.txt
    error_says 'no option --seams, which is one of atlas;'
    expect 2 unwrap in.obj in.obj -o out.obj
    error_says 'no place for in.obj'
    for option in -o '-o out.obj --pins' '-o out.obj --stats'; do # as of a variable that is not set
        expect 2 unwrap in.obj $option ''
        error_says 'the name is empty; name a file'
    done
    expect 2 unwrap in.obj -o out.obj --energy warm
    error_says '--energy' 'warm' 'isometric'
    expect 2 unwrap in.obj -o out.obj --iterations many
    error_says '--iterations' 'many is no whole number'
    expect 2 unwrap in.obj -o out.obj --device ''
    error_says '--device' 'without a name'
    expect 0 smooth --help
    says out '--zone N  ' '--exponent 1..8  '
    expect 0 view --help
    says out '130 ended by Ctrl-C'
    expect 2 unwrap in.obj -o out.obj --time-limit 20,5
    error_says '--time-limit' '20,5 is no number'
    for wrong in '--iterations -1' '--tolerance -1' '--tolerance 2' '--tolerance nan' '--time-limit 0' \
                 '--time-limit -3' '--time-limit nan' '--boundary circle --start uv' '--precision half' \
                 '--solver simplex' '--start tube' \
                 '--start conformal --boundary square' '--start coarse --solver lbfgs' '--up +z' '--front -y' \
                 '--placement here' '--placement as-solved --pins p.csv'; do
        # shellcheck disable=SC2086
        expect 2 unwrap in.obj -o out.obj $wrong
        error_says "${wrong%% *}"
        [ "$(wc -l <err)" = 1 ] || fail "more than one line for $wrong"
    done
    absent out.obj

    # Former names are taken, and told.
    expect 2 eval in.obj --cut=x
    says err '^taut: note: --cut is now --clip$'
    error_says '--clip'
    expect 2 smooth in.mesh -o out.mesh --worst 9
    says err '--worst is now --exponent'
    expect 2 paste --texels 7
    says err '--texels is now --resolution'
    expect 0 atlas in.obj -o out.obj --upright
    says err '--upright is now --no-rotation'
    expect 0 atlas in.obj -o out.obj --upright --quiet
    silent err
    if out=$("$taut" atlas --help | grep -e --upright); then fail "the help lists a former name"; fi
}
