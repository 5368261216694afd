# SPDX-License-Identifier: MIT
"""Text that declares single precision: cells that are flat once its digits are floats are no valid mesh to anyone."""
import json

from exact import exact, volume6
from formats import Vtk, Vtu, single
from program import main


def judged_as_declared(taut):
    """A cell that is positive in the digits of the text and flat as floats; in doubles the same file is fine."""
    far = 2.0 ** 24
    points = [(far, 0.0, 0.0), (far + 0.5, 1.0, 0.0), (far, 1.0, 1.0), (far + 0.25, 3.0, 0.5)]
    cells = [(0, 1, 2, 3)]
    if volume6(*map(exact, points)) < 0:
        cells = [(0, 2, 1, 3)]
    assert volume6(*(exact([single(x) for x in p]) for p in points)) == 0
    for wide, narrow in (Vtk("double", False), Vtk("float", False)), (Vtu("Float64", False), Vtu("Float32", False)):
        for kind, bad in (wide, 0), (narrow, 1):
            name = "far" + kind.extension
            taut.write(name, kind.files(points, cells, 3)[kind.extension])
            told = json.loads(taut("check", name, "--json", code=4 if bad else 0).stdout)
            assert told["inverted"] == bad, (kind, told)
            assert json.loads(taut("eval", name, "--json").stdout)["inverted"] == bad, kind
            if bad:
                assert "single precision" in taut("check", name, code=4).stdout


if __name__ == "__main__":
    main(judged_as_declared)
