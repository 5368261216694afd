# SPDX-License-Identifier: MIT
"""sizes.py ROOT [--list]: rooms of the library have one subject and at most 30 files with their sub-folders (a header and
its bodies count once), headers at most 8 internal includes, functions at most 60 lines. What is larger stands here with its reason and may not grow."""
import pathlib
import re
import sys

FILES, INCLUDES, BODIES, LINES = 30, 8, 12, 60

# Rooms above 30 files: the most they may have until they are cut by subject.
ROOMS = {
    "charts/atlas": (63, "cutting, seams and symmetry are to be rooms"),
    "core/map": (38, "sessions, overlap and entry points"),
    "core/untangle": (55, "stages, proofs and the device"),
    "charts/paste": (40, "regions, radial basis functions and paste"),
    "core/compute": (60, "devices: the only room that sees OpenCL"),
    "core/solve": (35, "methods and line searches"),
    "files/volume": (31, "a grammar of each format"),
}

# Headers above 8 includes of the library. Public headers gather what belongs together and have no bound.
GATHER = {
    "impl/core/map/session/initial_guess.hpp": 14,
    "impl/core/objective/map_objective.hpp": 10,
    "impl/charts/atlas/cutting/flat_surface.hpp": 9,
    "impl/charts/atlas/pressed_charts.hpp": 9,
    "impl/core/objective/running_map.hpp": 9,
    "impl/dist/shape/shape_body.hpp": 9,
    "impl/dist/ranges/open_volume.ipp": 10,
    "impl/core/untangle/state.hpp": 9,
    "impl/core/untangle/coarse_stage.hpp": 9,
    "impl/core/map/parameterize_params.hpp": 9,
    "impl/core/map/deform_params.hpp": 9,
    "impl/charts/atlas/chart_batch.hpp": 9,
}

# Functions above 60 lines, each with its reason; none above 110.
LONGEST = 110
LONG = {
    "impl/charts/bake/bake.ipp bake_by_rows": "one launch with its arguments by name",
    "impl/dist/ranges/su2_lines.hpp su2_lines": "one section of the file after another",
    "impl/dist/ranges/tetgen_lines.hpp tetgen_lines": "one file of the format after another",
    "impl/charts/paste/pasted.hpp stitch": "steps of one numbering",
    "impl/core/untangle/proofs/vanishing_sum.hpp fit_nonnegative": "Lawson and Hanson's algorithm as printed",
    "impl/files/gltf/new_gltf.hpp new_gltf_source": "the text of one file, from top to bottom",
    "impl/files/volume/cell_faces.hpp faces": "one case per kind of cell",
    "impl/files/surface/polygons.hpp split": "one case per number of corners",
    "impl/files/volume/subdivided.ipp plain_subdivided": "one section of the file after another",
    "impl/charts/packing/certificate.hpp certify_outlined": "a sweep with its state as locals",
    "impl/charts/packing/outlines.hpp append_outline": "a walk with its state as locals",
    "impl/charts/packing/raster.hpp rasterize": "inner loop, where calls cost",
    "impl/charts/repair/fans.hpp part_repeated": "a walk with its state as locals",
    "impl/charts/repair/winding.hpp wind": "a walk with its state as locals",
    "impl/core/solve/line/brent.hpp brent": "Brent's algorithm as printed",
    "impl/core/solve/pcg.hpp solve": "one iteration with its state as locals",
    "impl/core/start/make_barycentric_system.hpp make_barycentric_system": "one pass that counts and one that fills",
    "impl/core/symbolic/reverse.ipp propagate": "one case per operation",
    "impl/core/symbolic/statement_writer.ipp expression": "one case per operation",
}


def functions(text):
    """Names and lengths, in lines from the first of the signature, of functions with a body of their own lines."""
    lines = text.split("\n")
    for i, line in enumerate(lines):
        if not re.fullmatch(r" *\{", line) or i == 0:
            continue
        indent = len(line) - 1
        begin = i - 1
        while begin > 0 and (len(lines[begin]) - len(lines[begin].lstrip()) > indent or lines[begin].startswith(" " * indent + ":")):
            begin -= 1
        head = " ".join(part.strip() for part in lines[begin:i])
        if re.match(r"(if|for|while|else|do|switch|try|catch|namespace|struct|class|enum|union|\[|return|const auto|auto|static const)\b", head):
            continue
        name = re.search(r"([~\w]+|operator\(\)|operator\S+)\s*\(", head)
        if not name or "[" in head[:name.start()] or "=" in head[:name.start()]:
            continue
        end = next((k for k in range(i, len(lines)) if lines[k].startswith(" " * indent + "}")), i)
        yield name.group(1), end - begin + 1


def main():
    root = pathlib.Path(sys.argv[1]) / "include/taut"
    failures, rooms, long = [], {}, {}
    for file in sorted(root.rglob("*.[hi]pp")):
        name = str(file.relative_to(root))
        if "compute/kernels/" in name:
            continue
        text = file.read_text()
        if name.startswith("impl/"):
            room = "/".join(name.split("/")[1:3])
            rooms.setdefault(room, set()).add(name[:-4])
            count = len(re.findall(r"^#include <taut/.*[.]hpp>", text, re.M))
            most = GATHER.get(name, BODIES if file.suffix == ".ipp" else INCLUDES)
            if count > most:
                failures.append(f"{name}: {count} includes of the library, at most {most}")
        for function, length in functions(text):
            if length > LINES:
                long[f"{name} {function}"] = length
    for room, files in rooms.items():
        count = len(files)
        most = ROOMS.get(room, (FILES, ""))[0]
        if count > most:
            failures.append(f"impl/{room}: {count} files with its sub-folders, at most {most}")
    for key, length in long.items():
        most = LONGEST if key in LONG else LINES
        if length > most:
            failures.append(f"{key}: {length} lines, at most {most}; cut it, or list it with a reason")
    failures += [f"{key}: not above {LINES} lines any more; take it off the list" for key in LONG if key not in long]
    if "--list" in sys.argv:
        print("\n".join(f"{len(files):4} {room}" for room, files in sorted(rooms.items(), key=lambda r: -len(r[1]))))
        print("\n".join(f"{length:4} {key}" for key, length in sorted(long.items(), key=lambda f: -f[1])))
    print("\n".join(failures))
    sys.exit(1 if failures else 0)


main()
