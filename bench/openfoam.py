#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""openfoam.py [--size 0.12] [--motions shift,turn,far] [--processes 2] [--steps 10] [--bin build/release/bin] [--folder F]

A channel with a flat body inside, meshed by gmsh; the body is moved, and the walls are held. Mesh motion of OpenFOAM
(displacementLaplacian with inverse-distance diffusivity, displacementSBRStress), in --steps time steps, beside `taut-mpi
deform` in one call: inverted cells, worst non-orthogonality and skewness by OpenFOAM's own checkMesh, seconds, processor
seconds and memory: a table for docs/explanation/distribution.md. Needs gmsh and OpenFOAM, which Debian has."""
import argparse
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time

CHANNEL, BODY = ((0, 0, 0), (4, 2, 2)), ((1.5, 0.9, 0.5), (2.5, 1.1, 1.5))
# Angle about the z axis through the middle of the body, in degrees, and displacement.
MOTIONS = {"shift": (0, (0.3, 0.4, 0)), "turn": (60, (0, 0, 0)), "far": (90, (0.8, 0.2, 0))}

GEOMETRY = """SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 4, 2, 2};
Box(2) = {1.5, 0.9, 0.5, 1, 0.2, 1};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
body() = Surface In BoundingBox {1.49, 0.89, 0.49, 2.51, 1.11, 1.51};
all() = Surface{:};
all() -= body();
Physical Surface("walls") = all();
Physical Surface("body") = body();
Physical Volume("fluid") = {3};
Mesh.MeshSizeMax = %g;
Mesh.MeshSizeMin = %g;
Mesh.MeshSizeFromPoints = 0;
Field[1] = Distance; Field[1].FacesList = {body()};
Field[2] = Threshold; Field[2].IField = 1; Field[2].LcMin = %g; Field[2].LcMax = %g; Field[2].DistMin = 0.05; Field[2].DistMax = 0.8;
Background Field = 2;
Mesh.MshFileVersion = 2.2;
"""


def head(kind, name):
    return f"FoamFile {{ version 2.0; format ascii; class {kind}; object {name}; }}\n"


def write(path, text):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w") as f:
        f.write(text)


# Where Debian has OpenFOAM's own files; elsewhere its bashrc says it.
if os.path.isdir("/usr/share/openfoam/etc"):
    os.environ.setdefault("WM_PROJECT_DIR", "/usr/share/openfoam")


def run(command, folder, log):
    """Seconds, processor seconds and peak memory in MB of a program and its children; None where it failed."""
    with open(os.path.join(folder, log), "w") as out:
        begin = time.monotonic()
        child = subprocess.Popen(command, cwd=folder, stdout=out, stderr=subprocess.STDOUT)
        _, status, used = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        print(f"{' '.join(command)}: {child.returncode}, see {folder}/{log}", file=sys.stderr)
        return None
    return time.monotonic() - begin, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def mesh(size, folder):
    write(os.path.join(folder, "channel.geo"), GEOMETRY % (size, size / 3, size / 3, size))
    if run(["gmsh", "-3", "-format", "msh22", "-o", "channel.msh", "channel.geo"], folder, "gmsh.log") is None:
        sys.exit("gmsh failed")


def start_case(folder, msh, steps):
    shutil.rmtree(folder, ignore_errors=True)
    write(os.path.join(folder, "system/controlDict"),
          head("dictionary", "controlDict") + "application moveDynamicMesh; startFrom startTime; startTime 0; stopAt endTime; "
          f"endTime 1; deltaT {1 / steps:.17g}; writeControl timeStep; writeInterval {steps}; purgeWrite 0; "
          "writeFormat binary; writePrecision 17; timeFormat general; timePrecision 9; runTimeModifiable false;\n"
          "libs (fvMotionSolvers);\n")
    write(os.path.join(folder, "system/fvSchemes"),
          head("dictionary", "fvSchemes") + "ddtSchemes { default Euler; } gradSchemes { default Gauss linear; } divSchemes { default "
          "Gauss linear; } laplacianSchemes { default Gauss linear corrected; } interpolationSchemes { default linear; } "
          "snGradSchemes { default corrected; }\n")
    write(os.path.join(folder, "system/fvSolution"),
          head("dictionary", "fvSolution") + 'solvers { "cellDisplacement.*" { solver GAMG; smoother GaussSeidel; '
          "tolerance 1e-8; relTol 0; } }\n")
    if run(["gmshToFoam", msh], folder, "gmshToFoam.log") is None:
        sys.exit("gmshToFoam failed")


def motion_field(motion):
    angle, shift = MOTIONS[motion]
    middle = [(a + b) / 2 for a, b in zip(*BODY)]
    functions = []
    if angle:
        functions.append("{ solidBodyMotionFunction rotatingMotion; origin (%g %g %g); axis (0 0 1); omega %.17g; }" %
                         (*middle, angle * 3.141592653589793 / 180))
    if any(shift):
        functions.append("{ solidBodyMotionFunction linearMotion; velocity (%g %g %g); }" % shift)
    # Of several motions the last is applied first.
    if len(functions) == 1:
        body = functions[0][1:-1]
    else:
        body = "solidBodyMotionFunction multiMotion; " + " ".join(
            f"m{k} {f}" for k, f in enumerate(reversed(functions)))
    return (head("pointVectorField", "pointDisplacement") + "dimensions [0 1 0 0 0 0 0]; internalField uniform (0 0 0);\n"
            "boundaryField { walls { type fixedValue; value uniform (0 0 0); } defaultFaces { type fixedValue; value uniform "
            f"(0 0 0); }} body {{ type solidBodyMotionDisplacement; {body} value uniform (0 0 0); }} }}\n")


def check(folder, options):
    """Inverted cells, worst non-orthogonality in degrees, worst skewness."""
    run(["checkMesh", *options], folder, "checkMesh.log")
    with open(os.path.join(folder, "checkMesh.log")) as f:
        text = f.read()
    inverted = re.search(r"Number of negative volume cells: *(\d+)", text)
    wrong = re.search(r"Error in face pyramids: *(\d+)", text)
    angle = re.search(r"non-orthogonality Max: *([-+.\deE]+)", text)
    skew = re.search(r"[Mm]ax skewness = *([-+.\deE]+)", text)
    count = [int(found.group(1)) if found else 0 for found in (inverted, wrong)]
    worst = [float(found.group(1)) if found else float("nan") for found in (angle, skew)]
    return count[0], worst[0], worst[1], count[1]


def openfoam(solver, motion, folder, msh, steps):
    start_case(folder, msh, steps)
    diffusivity = "diffusivity quadratic inverseDistance (body);"
    write(os.path.join(folder, "constant/dynamicMeshDict"),
          head("dictionary", "dynamicMeshDict") + "dynamicFvMesh dynamicMotionSolverFvMesh; motionSolverLibs (fvMotionSolvers); "
          f"motionSolver {solver}; {solver}Coeffs {{ {diffusivity} }} {diffusivity}\n")
    write(os.path.join(folder, "0/pointDisplacement"), motion_field(motion))
    cost = run(["moveDynamicMesh"], folder, "moveDynamicMesh.log")
    return cost, check(folder, ["-latestTime"]) if cost else None


def taut(motion, folder, msh, processes, programs):
    angle, shift = MOTIONS[motion]
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    places(msh, motion, os.path.join(folder, "body.csv"))
    task = ["mpirun", "-n", str(processes), os.path.join(programs, "taut-mpi"), "deform", msh, "-o", "moved.msh", "--fix", "walls",
            "--move", "body=body.csv", "--stats", "stats.json"]
    run(task, folder, "cold.log")  # kernels are compiled
    cost = run(task, folder, "taut-mpi.log")
    if cost is None:
        return None, None
    case = os.path.join(folder, "case")
    start_case(case, os.path.join(folder, "moved.msh"), 1)
    return cost, check(case, [])


def places(msh, motion, path):
    """Where the vertices of the body go, as --move reads it."""
    import math
    angle, shift = MOTIONS[motion]
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    mx, my = ((a + b) / 2 for a, b in zip(BODY[0][:2], BODY[1][:2]))
    with open(msh) as f:
        lines = f.read().split("\n")
    names = {}
    at = lines.index("$PhysicalNames")
    for line in lines[at + 2:at + 2 + int(lines[at + 1])]:
        _, tag, name = line.split(None, 2)
        names[name.strip('"')] = tag
    at = lines.index("$Nodes")
    nodes = [line.split() for line in lines[at + 2:at + 2 + int(lines[at + 1])]]
    place = {n[0]: k for k, n in enumerate(nodes)}
    at = lines.index("$Elements")
    body = set()
    for line in lines[at + 2:at + 2 + int(lines[at + 1])]:
        w = line.split()
        if w[1] == "2" and w[3] == names["body"]:
            body.update(place[v] for v in w[-3:])
    with open(path, "w") as f:
        for v in sorted(body):
            x, y, z = map(float, nodes[v][1:4])
            f.write("%d,%.17g,%.17g,%.17g\n" % (v, mx + c * (x - mx) - s * (y - my) + shift[0],
                                                my + s * (x - mx) + c * (y - my) + shift[1], z + shift[2]))


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--size", type=float, default=0.12)
    p.add_argument("--motions", default="shift,turn,far")
    p.add_argument("--processes", type=int, default=2)
    p.add_argument("--steps", type=int, default=10)
    p.add_argument("--bin", default="build/release/bin")
    p.add_argument("--folder", default=None)
    a = p.parse_args()
    folder = os.path.abspath(a.folder or tempfile.mkdtemp())
    programs = os.path.abspath(a.bin)
    os.makedirs(folder, exist_ok=True)
    mesh(a.size, folder)
    msh = os.path.join(folder, "channel.msh")
    with open(msh) as f:
        text = f.read()
    tetrahedra = len(re.findall(r"^\d+ 4 ", text[text.index("$Elements"):], re.M))
    print(f"{tetrahedra} tetrahedra, {a.steps} time steps of OpenFOAM, {a.processes} processes of taut-mpi\n")
    print("| motion | method | inverted cells | wrong faces | non-orthogonality | skewness | seconds | processor | MB |")
    print("|---|---|---|---|---|---|---|---|---|")
    for motion in a.motions.split(","):
        for method in ("displacementLaplacian", "displacementSBRStress", "taut-mpi"):
            place = os.path.join(folder, motion + "-" + method)
            if method == "taut-mpi":
                cost, found = taut(motion, place, msh, a.processes, programs)
            else:
                cost, found = openfoam(method, motion, place, msh, a.steps)
            if cost is None:
                print(f"| {motion} | {method} | failed | | | | | | |", flush=True)
                continue
            inverted, angle, skew, wrong = found
            print(f"| {motion} | {method} | {inverted} | {wrong} | {angle:.1f} | {skew:.2f} | {cost[0]:.1f} | {cost[1]:.1f} | "
                  f"{cost[2]:.0f} |", flush=True)


if __name__ == "__main__":
    main()
