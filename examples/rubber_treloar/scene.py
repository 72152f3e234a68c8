#!/usr/bin/env python3
"""Writes the scene of a unit cube of Treloar's rubber, in MPa.

    scene.py LAW STRETCH [TEST]      writes cube.vtk and LAW.json

Each row of treloar.csv up to that stretch, of both tests or of the one that is
named, becomes a load case: the faces of the cube are moved as measured, and the
force is a resultant with an error of 5 %.
"""
import csv
import json
import pathlib
import sys

MPA = 0.0980665  # 1 kg/cm^2, the unit of Treloar
BULK_MODULUS = 2000  # MPa, a usual value; these tests hardly depend on it

law, stretch = sys.argv[1], float(sys.argv[2])
tests = sys.argv[3:] or ["uniaxial", "equibiaxial"]
with open(pathlib.Path(__file__).with_name("treloar.csv")) as file:
    rows = [row for row in csv.DictReader(file)
            if row["test"] in tests and float(row["stretch"]) <= stretch]


def face(axis, position):
    """Returns the nodes of the cube on one of its faces."""
    lower, upper = [-1, -1, -1], [2, 2, 2]
    lower[axis], upper[axis] = position - 0.01, position + 0.01
    return {"box": [lower, upper]}


def support(axis, position, **motion):
    return {"nodes": face(axis, position), "components": "xyz"[axis], **motion}


cases = []
arrays = [("observed_uniaxial", [1, 0, 0]), ("observed_equibiaxial", [1, 1, 0])]
for i, row in enumerate(rows):
    pulled = [0] if row["test"] == "uniaxial" else [0, 1]
    motion = float(row["stretch"]) - 1
    stress = float(row["stress"]) * MPA
    name = f"u{i}"
    arrays.append((name, [motion if axis in pulled else 0 for axis in range(3)]))
    supports = [support(axis, 0) for axis in range(3)]
    loads = []
    for axis in pulled:
        supports.append(support(axis, 1, displacement="measured"))
        value = [None, None, None]
        value[axis] = round(stress, 6)
        loads.append({"type": "resultant", "value": value, "relative_sd": 0.05,
                      "surface": face(axis, 1)})
    cases.append({"displacement": {"array": name},
                  "observed": {"array": "observed_" + row["test"]},
                  "supports": supports, "loads": loads, "noise_sd": 1e-5})

scene = {"mesh": "cube.vtk", "origin": "computed",
         "materials": [{"law": law, "known": {"bulk_modulus": BULK_MODULUS}}],
         "cases": cases}
with open(law + ".json", "w") as file:
    json.dump(scene, file, indent=1)

nodes = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
with open("cube.vtk", "w") as file:
    file.write("# vtk DataFile Version 3.0\na cube of rubber\nASCII\n"
               "DATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n")
    file.writelines("%d %d %d\n" % node for node in nodes)
    file.write("CELLS 1 9\n8 0 1 3 2 4 5 7 6\nCELL_TYPES 1\n12\nPOINT_DATA 8\n")
    for name, motion in arrays:
        file.write(f"VECTORS {name} double\n")
        for node in nodes:
            file.write(" ".join("%.10g" % (u * x) for u, x in zip(motion, node)))
            file.write("\n")
