#!/usr/bin/env python3
"""Writes Cook's membrane as a grid of quadrilaterals, in mm.

    mesh.py N FILE.vtk      N quadrilaterals along each edge
"""
import sys

n = int(sys.argv[1])
nodes = []
for j in range(n + 1):
    for i in range(n + 1):
        low, high = 44 * i / n, 44 + 16 * i / n
        nodes.append((48 * i / n, low + (high - low) * j / n))
with open(sys.argv[2], "w") as file:
    file.write("# vtk DataFile Version 3.0\nCook's membrane\nASCII\n"
               f"DATASET UNSTRUCTURED_GRID\nPOINTS {len(nodes)} double\n")
    file.writelines("%.15g %.15g 0\n" % node for node in nodes)
    file.write(f"CELLS {n * n} {5 * n * n}\n")
    for j in range(n):
        for i in range(n):
            first = j * (n + 1) + i
            file.write(f"4 {first} {first + 1} {first + n + 2} {first + n + 1}\n")
    file.write(f"CELL_TYPES {n * n}\n" + "9\n" * (n * n))
