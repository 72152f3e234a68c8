#!/usr/bin/env python3
"""Computes the displacements of the bodies of this folder anew, with CalculiX (ccx).

    compute.py BODY...      for instance compute.py block pillar

BODY.vtk gives the mesh of vertices, and BODY.json the supports and the loads.  The elements are divided,
get nodes in the middle of their edges, and are loaded by nodal forces of a uniform traction.  The
displacements of the vertices replace those in BODY.vtk.  Needs numpy.
"""
import json
import os
import subprocess
import sys
import tempfile

import numpy as np

# c10, c01 and the bulk modulus [MPa], and how many times elements are divided.
BODIES = {
    "bar": (0.1, 0, 14 / 15, 2),
    "block": (0.1, 0, 13 / 30, 2),
    "cone": (0.15, 0, 2.9, 2),
    "cross": (3.51, 0.93, 4000, 1),
    "ell": (0.1, 0, 0.6, 1),
    "pillar": (0.1, 0, 14 / 15, 2),
}
# By number of vertices: VTK cell type, element of CalculiX, edges, faces.
KINDS = {
    4: (10, "C3D10", [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)],
        [(0, 1, 2), (0, 1, 3), (1, 2, 3), (0, 2, 3)]),
    8: (12, "C3D20", [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)],
        [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]),
}
CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]


class Nodes:
    """Nodes, to which nodes in the middle of others are added once."""

    def __init__(self, nodes):
        self.at = list(nodes)
        self.middles = {}

    def middle(self, *of):
        if len(of) == 1:
            return of[0]
        key = tuple(sorted(of))
        if key not in self.middles:
            self.middles[key] = len(self.at)
            self.at.append(np.mean([self.at[node] for node in of], axis=0))
        return self.middles[key]


def divided_tetrahedron(element, nodes):
    a, b, c, d = element
    ab, bc, ac, ad, bd, cd = (nodes.middle(*pair) for pair in ((a, b), (b, c), (a, c), (a, d), (b, d), (c, d)))
    children = [(a, ab, ac, ad), (ab, b, bc, bd), (ac, bc, c, cd), (ad, bd, cd, d)]
    # The octahedron in the middle is divided around its shortest diagonal.
    diagonals = [((ab, cd), (ac, ad, bd, bc)), ((ac, bd), (ab, bc, cd, ad)), ((ad, bc), (ab, ac, cd, bd))]
    ends, ring = min(diagonals, key=lambda choice: round(np.linalg.norm(
        nodes.at[choice[0][0]] - nodes.at[choice[0][1]]), 9))
    for i in range(4):
        child = (*ends, ring[i], ring[(i + 1) % 4])
        x = [nodes.at[node] for node in child]
        positive = np.linalg.det([x[1] - x[0], x[2] - x[0], x[3] - x[0]]) > 0
        children.append(child if positive else (child[1], child[0], *child[2:]))
    return children


def divided_hexahedron(element, nodes):
    grid = {}
    for place in np.ndindex(3, 3, 3):
        ranges = [(0, 1) if i == 1 else (i // 2,) for i in place]
        grid[place] = nodes.middle(*(element[CORNERS.index((i, j, k))]
                                     for i in ranges[0] for j in ranges[1] for k in ranges[2]))
    return [tuple(grid[i + a, j + b, k + c] for a, b, c in CORNERS) for i, j, k in np.ndindex(2, 2, 2)]


def read_mesh(path):
    words = open(path).read().split()
    at = words.index("POINTS")
    count = int(words[at + 1])
    nodes = np.array(words[at + 3:at + 3 + 3 * count], float).reshape(-1, 3)
    at = words.index("CELLS")
    count = int(words[at + 1])
    size = int(words[at + 2]) // count
    return nodes, np.array(words[at + 3:at + 3 + size * count], int).reshape(-1, size)[:, 1:]


def write_mesh(path, nodes, elements, displacement):
    count, size = elements.shape
    with open(path, "w") as file:
        file.write("# vtk DataFile Version 3.0\nDisplacements by CalculiX\nASCII\nDATASET UNSTRUCTURED_GRID\n"
                   f"POINTS {len(nodes)} double\n")
        file.writelines("%.9g %.9g %.9g\n" % tuple(node) for node in nodes)
        file.write(f"CELLS {count} {count * (size + 1)}\n")
        file.writelines(f"{size} " + " ".join(map(str, element)) + "\n" for element in elements)
        file.write(f"CELL_TYPES {count}\n" + " ".join([str(KINDS[size][0])] * count) + "\n")
        file.write(f"POINT_DATA {len(nodes)}\nVECTORS displacement double\n")
        file.writelines("%.7g %.7g %.7g\n" % tuple(u) for u in displacement)


def in_box(box, x):
    return bool(np.all(x >= np.array(box[0])) and np.all(x <= np.array(box[1])))


def weights_of_surface(box, elements, nodes, count):
    """The shares of nodes in a force that is spread uniformly over the surface in a box."""
    faces = {}
    for element in elements:
        for face in KINDS[len(element)][3]:
            corners = tuple(element[i] for i in face)
            faces.setdefault(tuple(sorted(corners)), []).append(corners)
    weights = np.zeros(count)
    area = 0
    for (face, *inner) in faces.values():
        if inner or not all(in_box(box, nodes.at[node]) for node in face):
            continue
        x = [nodes.at[node] for node in face]
        if len(face) == 3:
            part = np.linalg.norm(np.cross(x[1] - x[0], x[2] - x[0])) / 2
        else:
            part = np.linalg.norm(np.cross(x[2] - x[0], x[3] - x[1])) / 2
            weights[list(face)] -= part / 12
        for i in range(len(face)):
            weights[nodes.middle(face[i], face[(i + 1) % len(face)])] += part / 3
        area += part
    return weights / area


def weights_of_volume(elements, nodes, count):
    """The nodal forces of a unit body force on quadratic tetrahedra."""
    weights = np.zeros(count)
    for element in elements:
        x = [nodes.at[node] for node in element[:4]]
        part = abs(np.linalg.det([x[1] - x[0], x[2] - x[0], x[3] - x[0]])) / 6
        weights[element[:4]] -= part / 20
        weights[element[4:]] += part / 5
    return weights


def displacements(scene, elements, nodes, moduli):
    """Runs CalculiX with quadratic elements."""
    _, kind, edges, _ = KINDS[len(elements[0])]
    quadratic = np.array([[*element, *(nodes.middle(element[a], element[b]) for a, b in edges)]
                          for element in elements])
    count = len(nodes.at)
    forces = np.zeros((count, 3))
    for load in scene["cases"][0]["loads"]:
        weights = (weights_of_surface(load["surface"]["box"], elements, nodes, count)
                   if load["type"] == "force" else weights_of_volume(quadratic, nodes, count))
        forces += np.outer(weights, load["value"])
    c10, c01, bulk_modulus = moduli
    with tempfile.TemporaryDirectory() as folder:
        with open(f"{folder}/body.inp", "w") as file:
            file.write("*NODE,NSET=ALL\n")
            file.writelines(f"{i + 1},{x[0]:.9g},{x[1]:.9g},{x[2]:.9g}\n" for i, x in enumerate(nodes.at))
            file.write(f"*ELEMENT,TYPE={kind},ELSET=BODY\n")
            for i, element in enumerate(quadratic):
                row = [str(number) for number in (i + 1, *(element + 1))]
                file.write(",".join(row[:11]) + (",\n" + ",".join(row[11:]) if len(row) > 11 else "") + "\n")
            law = f"NEO HOOKE\n{c10},{2 / bulk_modulus}" if c01 == 0 else f"MOONEY-RIVLIN\n{c10},{c01},{2 / bulk_modulus}"
            file.write(f"*MATERIAL,NAME=RUBBER\n*HYPERELASTIC,{law}\n"
                       "*SOLID SECTION,ELSET=BODY,MATERIAL=RUBBER\n*BOUNDARY\n")
            for support in scene["supports"]:
                for i, x in enumerate(nodes.at):
                    if in_box(support["nodes"]["box"], x):
                        for component in support.get("components", "xyz"):
                            number = "xyz".index(component) + 1
                            file.write(f"{i + 1},{number},{number}\n")
            file.write("*STEP,NLGEOM,INC=500\n*STATIC\n0.1,1.,1e-6,0.25\n*CLOAD\n")
            file.writelines(f"{node + 1},{i + 1},{forces[node, i]:.10g}\n" for node, i in zip(*forces.nonzero()))
            file.write("*NODE PRINT,NSET=ALL,FREQUENCY=1000\nU\n*END STEP\n")
        subprocess.run(["ccx", "body"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        lines = open(f"{folder}/body.dat").read().split("\n")
    last = max(i for i, line in enumerate(lines) if "displacements" in line)
    if "1.0000000E+00" not in lines[last] and "0.1000000E+01" not in lines[last]:
        sys.exit("ccx did not reach the whole load")
    found = np.zeros((count, 3))
    for line in lines[last + 2:last + 2 + count]:
        number, *u = line.split()
        found[int(number) - 1] = [float(value) for value in u]
    return found


for body in sys.argv[1:]:
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), body)
    vertices, mesh = read_mesh(path + ".vtk")
    *law, divisions = BODIES[body]
    grown = Nodes(vertices)
    parts = [tuple(element) for element in mesh]
    for _ in range(divisions):
        divide = divided_tetrahedron if mesh.shape[1] == 4 else divided_hexahedron
        parts = [child for element in parts for child in divide(element, grown)]
    result = displacements(json.load(open(path + ".json")), parts, grown, law)
    # Rounding leaves no digits of symmetric bodies that are zero.
    write_mesh(path + ".vtk", vertices, mesh, result[:len(vertices)].round(9) + 0.0)
