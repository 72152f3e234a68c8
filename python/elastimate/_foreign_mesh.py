"""Meshes of meshio and pyvista, known by what they have rather than by their type."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

# The names of meshio and the numbers of VTK.
_KINDS: dict[Any, str] = {
    "tetra": "tet4", 10: "tet4",
    "tetra10": "tet10", 24: "tet10",
    "hexahedron": "hex8", 12: "hex8",
    "hexahedron27": "hex27", 29: "hex27",
    "triangle": "tri3", 5: "tri3",
    "triangle6": "tri6", 22: "tri6",
    "quad": "quad4", 9: "quad4",
    "quad9": "quad9", 28: "quad9",
}  # fmt: skip

# Cells that are cut as a file is read, and whether they are planar.
_CUT: dict[Any, bool] = {
    "pyramid": False, 14: False,
    "wedge": False, 13: False,
    "hexahedron20": False, 25: False,
    "wedge15": False, 26: False,
    "pyramid13": False, 27: False,
    "quad8": True, 23: True,
}  # fmt: skip

NODES_OF_KIND = {
    "tet4": 4, "tet10": 10, "curved_tet10": 10, "hex8": 8, "hex27": 27,
    "tri3": 3, "tri6": 6, "curved_tri6": 6, "quad4": 4, "quad9": 9,
}  # fmt: skip


def is_planar(kind: str) -> bool:
    """Tells whether an element kind is one of the plane."""
    return "tri" in kind or "quad" in kind


def is_mesh(candidate: object) -> bool:
    """Tells whether an object has the points and cells of a mesh of meshio or pyvista."""
    return hasattr(candidate, "points") and hasattr(candidate, "cells_dict")


def take_mesh(mesh: Any) -> tuple[NDArray[np.float64], dict[str, NDArray[Any]]]:
    """Returns the points, shape (n, 3), and the cells of the highest dimension, by their kind."""
    cells = {_KINDS[name]: np.asarray(of_kind) for name, of_kind in mesh.cells_dict.items() if name in _KINDS}
    unknown = [str(name) for name in mesh.cells_dict if name not in _KINDS]
    solid = {kind: of_kind for kind, of_kind in cells.items() if not is_planar(kind)}
    chosen = solid or cells
    cut = [name for name in mesh.cells_dict if name in _CUT and not (_CUT[name] and solid)]
    if cut:
        raise ValueError(
            f"the mesh has cells that are to be cut ({', '.join(map(str, cut))}); save it as a .vtu "
            "file, whose cells elastimate.read cuts into simplices"
        )
    if not chosen:
        raise ValueError(
            "the mesh has no cells of a kind that elastimate knows"
            + (f" (it has {', '.join(unknown)})" if unknown else "")
            + "; give tetrahedra, hexahedra, triangles or quadrilaterals"
        )
    return np.asarray(mesh.points, dtype=float), chosen


def one_kind(
    nodes: NDArray[np.float64], cells: ArrayLike | dict[str, Any], kind: str | None
) -> tuple[str, NDArray[np.int32]]:
    """Returns the kind and the connectivity, shape (m, nodes of the kind), of cells.

    Without a kind, it follows from the number of nodes of a cell and the dimension of the nodes.
    """
    if isinstance(cells, dict):
        if len(cells) != 1:
            raise ValueError(
                f"the mesh has elements of {len(cells)} kinds ({', '.join(cells)}); "
                "give elements of one kind, or save the mesh as a .vtu file, whose elements "
                "elastimate.read cuts into simplices"
            )
        (kind, cells) = next(iter(cells.items()))
    try:
        connectivity = np.asarray(cells)
    except ValueError:  # NumPy makes no array of rows of different lengths.
        raise ValueError(
            "the cells have different numbers of nodes; give elements of one kind, or save the mesh "
            "as a .vtu file, whose elements elastimate.read cuts into simplices"
        ) from None
    if connectivity.ndim != 2 or connectivity.dtype.kind not in "iu":
        raise ValueError(
            "the cells are no array of node numbers with one row for each element; "
            "give integers of shape (number of elements, nodes of an element)"
        )
    if len(connectivity) and int(connectivity.max()) > np.iinfo(np.int32).max:
        raise ValueError(
            f"the cells name node {connectivity.max()}; give numbers from 0 to {len(nodes) - 1}"
        )
    return kind or _kind_of(nodes.shape[1], connectivity.shape[1]), connectivity.astype(
        np.int32, copy=False
    )


def _kind_of(dimension: int, count: int) -> str:
    candidates = [
        kind
        for kind, nodes in NODES_OF_KIND.items()
        if nodes == count and is_planar(kind) == (dimension == 2) and "curved" not in kind
    ]
    if not candidates:
        raise ValueError(
            f"there is no element kind with {count} nodes in {dimension} dimensions; give kind= "
            f"one of {', '.join(NODES_OF_KIND)}"
        )
    return candidates[0]
