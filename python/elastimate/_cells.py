"""The cells of a mesh: arrays, or an object of meshio or pyvista, known by what it has."""

from __future__ import annotations

from typing import Any, Mapping, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

# The number of each kind of cell in VTK, by the names of elastimate and of meshio.
_TYPES = {
    "vertex": 1, "line": 3, "line3": 21,
    "tri3": 5, "triangle": 5, "tri6": 22, "triangle6": 22, "curved_tri6": 22,
    "quad4": 9, "quad": 9, "quad8": 23, "quad9": 28,
    "tet4": 10, "tetra": 10, "tet10": 24, "tetra10": 24, "curved_tet10": 24,
    "hex8": 12, "hexahedron": 12, "hex20": 25, "hexahedron20": 25, "hex27": 29, "hexahedron27": 29,
    "wedge6": 13, "wedge": 13, "wedge15": 26,
    "pyramid5": 14, "pyramid": 14, "pyramid13": 27,
}  # fmt: skip

# The kind of cells that have so many nodes, in two and in three dimensions.
_KINDS_OF_COUNT = {
    2: {3: "tri3", 6: "tri6", 4: "quad4", 8: "quad8", 9: "quad9"},
    3: {4: "tet4", 10: "tet10", 8: "hex8", 20: "hex20", 27: "hex27", 6: "wedge6", 15: "wedge15",
        5: "pyramid5", 13: "pyramid13"},
}  # fmt: skip

_NODES_OF_TYPE = {
    _TYPES[kind]: count for kinds in _KINDS_OF_COUNT.values() for count, kind in kinds.items()
}


class Cells(NamedTuple):
    """Points, shape (n, 3), and cells as VTK has them: their types, and the points of all of them."""

    points: NDArray[np.float64]
    types: NDArray[np.uint8]
    connectivity: NDArray[np.int64]
    offsets: NDArray[np.int64]


def cells_of(nodes: Any, cells: Any, kind: str | None) -> Cells:
    """Returns the cells of arrays or, without cells, of a mesh of meshio or pyvista."""
    if hasattr(nodes, "points") and hasattr(nodes, "cells"):
        if cells is not None or kind is not None:
            raise ValueError("the mesh has cells of its own; leave cells and kind out")
        points = _points(nodes.points)
        if hasattr(nodes, "celltypes"):  # pyvista
            return Cells(points, *_flat(nodes.celltypes, nodes.cell_connectivity, nodes.offset))
        return _joined(points, [(block.type, block.data) for block in nodes.cells])
    if cells is None:
        raise ValueError(
            "the cells are missing; give node numbers, one row for each element, or a mesh of meshio "
            "or of pyvista (of a surface of pyvista, cast_to_unstructured_grid())"
        )
    points = _points(nodes)
    if isinstance(cells, Mapping):
        return _joined(points, list(cells.items()))
    connectivity = connectivity_of("the cells", cells)
    dimension = np.asarray(nodes).shape[1]
    return _joined(points, [(kind or _kind_of(dimension, connectivity.shape[1]), connectivity)])


def _points(nodes: Any) -> NDArray[np.float64]:
    try:
        positions = np.asarray(nodes, dtype=float)
    except (TypeError, ValueError):
        raise ValueError("nodes is no array of numbers; give one row of coordinates for each node") from None
    if positions.ndim != 2 or positions.shape[1] not in (2, 3):
        raise ValueError(
            f"nodes has the shape {positions.shape}; give one row of 2 or 3 coordinates for each node"
        )
    points = np.zeros((len(positions), 3))
    points[:, : positions.shape[1]] = positions
    return points


def connectivity_of(name: str, cells: ArrayLike) -> NDArray[np.int64]:
    """Returns node numbers, one row for each cell or facet."""
    try:
        connectivity = np.asarray(cells)
    except ValueError:  # NumPy makes no array of rows of different lengths.
        raise ValueError(
            f"{name} have different numbers of nodes; give a dict of cells with an array for each kind, "
            'such as {"hex8": ..., "wedge6": ...}'
        ) from None
    if connectivity.ndim != 2 or connectivity.dtype.kind not in "iu":
        raise ValueError(
            f"{name} have the shape {connectivity.shape} and the type {connectivity.dtype}; give "
            "integers, one row of node numbers for each of them"
        )
    return connectivity.astype(np.int64, copy=False)


def _joined(points: NDArray[np.float64], blocks: list[tuple[str, Any]]) -> Cells:
    types, connectivity, counts = np.zeros(0, int), np.zeros(0, int), np.zeros(0, int)
    for kind, of_kind in blocks:
        if kind not in _TYPES:
            raise ValueError(f'there is no element kind "{kind}"; the kinds are {", ".join(_TYPES)}')
        rows = connectivity_of("the cells", of_kind)
        due = _NODES_OF_TYPE.get(_TYPES[kind], rows.shape[1])
        if rows.shape[1] != due:
            raise ValueError(f"cells of the kind {kind} have {rows.shape[1]} nodes; give {due}")
        types = np.append(types, np.full(len(rows), _TYPES[kind]))
        connectivity = np.append(connectivity, rows)
        counts = np.append(counts, np.full(len(rows), rows.shape[1]))
    return Cells(points, *_flat(types, connectivity, np.append(0, np.cumsum(counts))))


def _flat(
    types: Any, connectivity: Any, offsets: Any
) -> tuple[NDArray[np.uint8], NDArray[np.int64], NDArray[np.int64]]:
    return (
        np.asarray(types, np.uint8), np.asarray(connectivity, np.int64), np.asarray(offsets, np.int64)
    )  # fmt: skip


def _kind_of(dimension: int, count: int) -> str:
    kinds = _KINDS_OF_COUNT[dimension]
    if count not in kinds:
        raise ValueError(
            f"there is no element kind with {count} nodes in {dimension} dimensions; give one of "
            f"{', '.join(f'{n} ({kind})' for n, kind in kinds.items())}"
        )
    return kinds[count]
