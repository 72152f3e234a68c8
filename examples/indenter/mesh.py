"""Writes a block of gel, 40 x 40 x 20 mm, as an Abaqus file: python3 mesh.py CELLS FILE.

Its top has CELLS x CELLS hexahedra, and it is half as many high.  The sets are BOTTOM, which is glued
to a plate, and PUNCH, the nodes below a square indenter of 8 x 8 mm in the middle of the top.
"""

import sys

cells, path = int(sys.argv[1]), sys.argv[2]
edge = 40 / cells
heights = cells // 2


def number(i, j, k):
    return 1 + i + (cells + 1) * (j + (cells + 1) * k)


nodes = [(i, j, k) for k in range(heights + 1) for j in range(cells + 1) for i in range(cells + 1)]
elements = [(i, j, k) for k in range(heights) for j in range(cells) for i in range(cells)]
corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
bottom = [n for n in nodes if n[2] == 0]
punch = [n for n in nodes if n[2] == heights and all(abs(edge * x - 20) < 4.001 for x in n[:2])]


def write_set(file, name, members):
    file.write(f"*NSET, NSET={name}\n" + "".join(f"{number(*n)},\n" for n in members))


with open(path, "w") as file:
    file.write("*NODE\n")
    for n in nodes:
        file.write(f"{number(*n)}, {edge * n[0]:g}, {edge * n[1]:g}, {edge * n[2]:g}\n")
    file.write("*ELEMENT, TYPE=C3D8, ELSET=GEL\n")
    for e, (i, j, k) in enumerate(elements, 1):
        of_element = [number(i + x, j + y, k + z) for z in (0, 1) for x, y in corners]
        file.write(f"{e}, " + ", ".join(map(str, of_element)) + "\n")
    write_set(file, "BOTTOM", bottom)
    write_set(file, "PUNCH", punch)
