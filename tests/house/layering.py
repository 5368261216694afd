# SPDX-License-Identifier: MIT
"""layering.py ROOT [--list]: every #include of include/taut holds to the houses and rooms of docs/explanation/architecture.md.

A room includes the rooms below it and public headers, each of which belongs to a room. No cycle among headers, bodies at
their ends (.ipp and includes behind the last declaration) left out; Boost and OpenCL headers in core/compute alone, those
of MPI and PETSc in dist; 500 lines a file; floors of includes within a room, and what front ends and public
declarations use of impl, are bounded.
--list prints the measures: floors of each room, includes of front ends, names of impl in public headers."""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
include = root / "include/taut"

BASE = "core/core core/exact"
MESHES = BASE + " core/mesh"
ENERGIES = MESHES + " core/symbolic core/energy"
OBJECTIVES = ENERGIES + " core/compute core/sparse core/hierarchy core/measure core/constrain core/solve core/objective"
FILES = MESHES + " core/measure core/constrain files/file files/surface files/volume"
ROOMS = {
    "core/core": "",
    "core/exact": "core/core",
    "core/symbolic": "core/core",
    "core/solve": "core/core",
    "core/compute": "core/core core/symbolic",
    "core/sparse": "core/core core/compute",
    "core/mesh": BASE,
    "core/energy": MESHES + " core/symbolic",
    "core/hierarchy": MESHES + " core/energy",
    "core/measure": MESHES + " core/energy",
    "core/constrain": MESHES + " core/measure",
    "core/objective": ENERGIES + " core/compute core/sparse core/hierarchy core/measure core/constrain core/solve",
    "core/start": OBJECTIVES,
    "core/untangle": OBJECTIVES + " core/start",
    "core/map": OBJECTIVES + " core/start core/untangle",
    "files/file": BASE,
    "files/surface": MESHES + " core/constrain files/file files/volume",
    "files/volume": MESHES + " core/constrain files/file files/surface",
    "files/gltf": FILES,
    "charts/packing": BASE,
    "charts/repair": MESHES,
    "charts/bake": "core/core core/symbolic core/compute",
    "charts/atlas": OBJECTIVES + " core/start core/untangle core/map charts/packing",
    "charts/paste": OBJECTIVES + " core/start core/untangle core/map files/file files/surface",
    "dist/processes": MESHES,
    "dist/ranges": FILES + " dist/processes",
    "dist/shape": OBJECTIVES + " core/start core/untangle core/map files/file files/surface files/volume dist/processes dist/ranges",
}
# The room of each public header.
PUBLIC = {}
for room, names in {
    "core/core": "types errors options arrays version",
    "core/exact": "certify",
    "core/mesh": "elements mesh cell_data",
    "core/energy": "energies any_energy shell energy",
    "core/measure": "quality rigid_motion",
    "core/constrain": "constraints untangle_problem",
    "core/solve": "solve_params minimize",
    "core/symbolic": "symbolic traced_vectors recording",
    "core/compute": "device queue reductions device_vectors kernel",
    "core/objective": "evaluator solve",
    "core/start": "start_map",
    "core/untangle": "untangle",
    "core/map": "parameterize deform smooth session",
    "files/file": "files",
    "files/surface": "surface_file",
    "files/volume": "volume_file read write",
    "files/gltf": "gltf",
    "charts/packing": "pack",
    "charts/repair": "repair",
    "charts/bake": "bake",
    "charts/atlas": "charts atlas",
    "charts/paste": "paste",
    "dist/processes": "mesh_piece",
    "dist/shape": "dist",
}.items():
    PUBLIC.update({f"{name}.hpp": room for name in names.split()})
GATHER = {"taut.hpp", "eigen.hpp"}  # programs include them, rooms do not

# Measures: what a change that exceeds one has to explain.
FLOORS = 6
HIGH = {  # today's, to be lowered
    "charts/atlas": 15, "core/symbolic": 13, "files/volume": 11, "core/compute": 11, "core/solve": 10, "core/untangle": 10,
    "core/objective": 9, "core/start": 8, "core/map": 8, "core/sparse": 8, "files/gltf": 8, "core/hierarchy": 7,
    "charts/paste": 7, "files/surface": 7, "dist/ranges": 7, "dist/shape": 7,
}
FRONT_ENDS = 168
NAMES_OF_IMPL = 143


def room_of(header):
    return PUBLIC.get(header) if "/" not in header else "/".join(header.split("/")[1:3])


texts = {str(p.relative_to(include)): p.read_text() for p in sorted(include.rglob("*.[hi]pp"))}
if len(texts) < 20:
    sys.exit(f"only {len(texts)} headers below {include}")
failures, above = [], {}
for header, text in texts.items():
    room = room_of(header)
    if header not in GATHER and (room not in ROOMS):
        failures.append(f"{header}: in no room; give it one in tests/house/layering.py")
        continue
    if text.count("\n") > 500:
        failures.append(f"{header}: {text.count(chr(10))} lines, at most 500")
    begin = re.search(r"^namespace", text, re.M)
    above[header] = re.findall(r"#include <taut/([^>]+\.hpp)>", text[: begin.start()] if begin else text)
    for line in re.findall(r"^#include .*$", text, re.M):
        if re.search(r"<(boost|CL)/", line) and room != "core/compute":
            failures.append(f"{header}: {line}: Boost and OpenCL headers belong in core/compute")
        if re.search(r"<(mpi|petsc)", line) and not (room or "").startswith("dist/"):
            failures.append(f"{header}: {line}: headers of MPI and PETSc belong in dist")
        if '"' in line:
            failures.append(f"{header}: {line}: write <taut/...>")
        target = re.search(r"<taut/([^>]+)>", line)
        if not target or header in GATHER:
            continue
        if target.group(1).endswith(".inl"):
            continue  # text of the header that includes it
        if target.group(1) not in texts:
            failures.append(f"{header}: {line}: no such header")
        elif target.group(1) in GATHER:
            failures.append(f"{header}: {line}: is for programs")
        elif room_of(target.group(1)) not in [room, *ROOMS[room].split()]:
            failures.append(f"{header}: {line}: {room} must not depend on {room_of(target.group(1))}")

# Cycles, and floors within a room.
depth, state = {}, {}


def floor(header, path):
    if state.get(header) == "open":
        failures.append("a cycle: " + " -> ".join(path[path.index(header):] + [header]))
        return 0
    if header not in depth:
        state[header] = "open"
        own = room_of(header)
        below = [(floor(h, path + [header]), room_of(h) == own) for h in above.get(header, []) if h in above]
        depth[header] = 1 + max([d for d, same in below if same] or [0])
        state[header] = "done"
    return depth[header]


sys.setrecursionlimit(5000)
for header in list(above):
    floor(header, [])
floors = {}
for header, d in depth.items():
    if "/" in header:
        floors[room_of(header)] = max(floors.get(room_of(header), 0), d)
for room, d in floors.items():
    if d > HIGH.get(room, FLOORS):
        failures.append(f"{room}: {d} floors of includes, at most {HIGH.get(room, FLOORS)}")

# One file of a program has the bodies of all units.
units = {x for p in (root / "src").rglob("*.cpp") if p.parent.name != "dist" for x in re.findall(r"<(taut/impl/[^>]+\.ipp)>", p.read_text())}
gathered = set(re.findall(r"<(taut/impl/[^>]+\.ipp)>", (include / "impl/bodies.inl").read_text()))
failures += [f"src: {x} is not in impl/bodies.inl" for x in sorted(units - gathered)]
failures += [f"impl/bodies.inl: {x} is in no unit of src" for x in sorted(gathered - units)]
for p in include.glob("*.hpp"):
    if p.name in ("version.hpp", "dist.hpp", "mesh_piece.hpp"):
        continue
    guard = f"TAUT_{p.stem.upper()}_HPP"
    frame = (rf"// SPDX[^\n]*\n#include <taut/impl/enter.inl>\n(?:#if TAUT_OPEN == 1[^\n]*\n(?:#define TAUT_PART_\w+\n)+#endif\n)?"
             rf"#ifndef {guard}\n#define {guard}\n.*\n#endif\n#include <taut/impl/leave.inl>\n")
    if not re.fullmatch(frame, p.read_text(), re.S):
        failures.append(f"{p.name}: begins with impl/enter.inl, its parts and {guard}, ends with impl/leave.inl")
asked = {x for p in include.glob("*.hpp") for x in re.findall(r"#define TAUT_PART_(\w+)", p.read_text())}
held = set(re.findall(r"#ifdef TAUT_PART_(\w+)", (include / "impl/bodies.inl").read_text()))
failures += [f"impl/bodies.inl: no bodies of the part {x}" for x in sorted(asked - held)]

# Front ends include public headers.
front = [f"{p.relative_to(root)}: {line}" for folder in ("tools", "python", "examples") for p in sorted((root / folder).rglob("*.[ch]pp"))
         for line in re.findall(r"#include <taut/impl/[^>]+>", p.read_text())]
if len(front) > FRONT_ENDS:
    failures.append(f"front ends: {len(front)} includes of impl, at most {FRONT_ENDS}")

# Names of impl in the declarations of public headers.
seen = {(h, n) for h, text in texts.items() if "/" not in h for n in re.findall(r"\bimpl::(\w+)", re.sub(r"//[^\n]*", "", text))}
if len(seen) > NAMES_OF_IMPL:
    failures.append(f"public headers: {len(seen)} names of impl, at most {NAMES_OF_IMPL}")

if "--list" in sys.argv:
    print("\n".join(f"{d:3} floors {room}" for room, d in sorted(floors.items(), key=lambda r: -r[1])))
    print(f"{len(front)} includes of impl by front ends")
    print(f"{len(seen)} names of impl in public headers:", *sorted(f"{h}:{n}" for h, n in seen))
print("\n".join(failures) or f"{len(texts)} headers hold to the layers")
sys.exit(1 if failures else 0)
