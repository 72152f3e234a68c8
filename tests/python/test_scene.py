"""Scenes: what they take, what they refuse, and how long their arrays live."""

import gc
from types import SimpleNamespace

import numpy as np
import pytest

import elastimate as em


def test_arrays_are_those_of_the_scene(arrays):
    scene = em.Scene(**arrays)
    assert scene.kind == "tet4"
    np.testing.assert_array_equal(scene.nodes, arrays["nodes"])
    np.testing.assert_array_equal(scene.elements, arrays["cells"])
    assert not scene.nodes.flags.writeable
    # A view of the memory of the scene, which it keeps alive.
    assert np.shares_memory(scene.nodes, scene.nodes)


def test_arrays_may_change_and_go_after_a_scene_is_made(arrays):
    expected = arrays["nodes"].copy()
    scene = em.Scene(**arrays)
    arrays["nodes"][:] = 7
    arrays["forces"][:] = np.nan
    arrays.clear()
    gc.collect()
    nodes = scene.simulate(E=1e4, nu=0.3).nodes
    gc.collect()
    np.testing.assert_array_equal(nodes, expected)


def test_simulation_is_found_again(arrays):
    scene = em.Scene(**arrays).simulate(E=5e3, nu=0.3)
    estimate = scene.estimate("closed-form")
    assert estimate.status == "ok"
    assert estimate["E"].value == pytest.approx(5e3, rel=1e-9)
    assert estimate["nu"].value == pytest.approx(0.3, rel=1e-9)


def test_displacement_of_a_bar_is_what_theory_says():
    # A cube under uniaxial stress s = F / A: u = s (z, -nu x, -nu y) / E.
    nodes = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    hexahedron = [[0, 4, 6, 2, 1, 5, 7, 3]]
    held = nodes == 0
    held[:, :2] &= (nodes[:, :2] == 0) & True
    scene = em.Scene(
        nodes, hexahedron, supports=held, loads=[em.Traction([0, 0, 8], em.Box([0, 0, 1], [1, 1, 1]))]
    ).simulate(E=100, nu=0.25)
    expected = 0.08 * nodes * [-0.25, -0.25, 1]
    np.testing.assert_allclose(scene.displacements, expected, atol=1e-14)


@pytest.mark.parametrize(
    "load",
    [
        em.Traction([0, 0, 10000], em.Box([0, 0, 0.1], [0.1, 0.1, 0.1])),
        em.Pressure(-10000, em.Box([0, 0, 0.1], [0.1, 0.1, 0.1])),
        em.SurfaceForce([0, 0, 100], em.Box([0, 0, 0.1], [0.1, 0.1, 0.1])),
    ],
)
def test_loads_of_a_face_are_alike(arrays, load):
    arrays.pop("forces")
    u = em.Scene(**arrays, loads=[load]).simulate(E=1e4, nu=0.3).displacements
    top = em.Box([0, 0, 0.1], [0.1, 0.1, 0.1])
    expected = em.Scene(**arrays, loads=[em.Traction([0, 0, 10000], top)]).simulate(E=1e4, nu=0.3)
    np.testing.assert_allclose(u, expected.displacements, rtol=1e-9, atol=1e-12)


def test_weight_of_a_body_is_balanced(arrays):
    arrays.pop("forces")
    u = em.Scene(**arrays, loads=[em.BodyForce([0, 0, -9810])]).simulate(E=1e4, nu=0.3).displacements
    assert u[:, 2].min() < -1e-4


def test_supports_are_given_in_several_ways(arrays):
    held = arrays.pop("supports")
    flags = np.repeat(held[:, np.newaxis], 3, axis=1)
    u = [
        em.Scene(**arrays, supports=s).simulate(E=1e4, nu=0.3).displacements
        for s in (held, flags, np.flatnonzero(held), em.Box([0, 0, 0], [0.1, 0.1, 0]))
    ]
    for other in u[1:]:
        np.testing.assert_array_equal(other, u[0])


def test_what_was_not_measured_is_not_used(arrays):
    u = em.Scene(**arrays).simulate(E=1e4, nu=0.3).displacements.copy()
    u[5:8] = np.nan
    measured = em.Scene(**arrays, displacements=u, origin="computed")
    assert measured.estimate("iterative-fe")["E"].value == pytest.approx(1e4, rel=1e-6)
    np.testing.assert_array_equal(measured.displacements, u)
    assert np.isfinite(measured.simulate(E=1e4, nu=0.3).displacements).all()


def test_masked_values_were_not_measured(arrays):
    u = em.Scene(**arrays).simulate(E=1e4, nu=0.3).displacements
    masked = np.ma.masked_where(np.arange(81).reshape(27, 3) % 7 == 0, u)
    scene = em.Scene(**arrays, displacements=np.ma.array(masked.filled(1e3), mask=masked.mask))
    np.testing.assert_array_equal(scene.displacements, masked.filled(np.nan))


def test_one_load_and_letters_stand_for_lists(arrays):
    arrays.pop("forces")
    arrays["supports"] = em.Box([0, 0, 0], [0.1, 0.1, 0], "xyz")
    push = em.Pressure(5, em.Box([0, 0, 0.1], [0.1, 0.1, 0.1]))
    u = em.Scene(**arrays, loads=push, materials=em.Material()).simulate(E=1e4, nu=0.3).displacements
    arrays["supports"] = em.Box([0, 0, 0], [0.1, 0.1, 0])
    case = em.LoadCase(loads=[push])
    expected = em.Scene(**arrays, cases=case).simulate(E=1e4, nu=0.3).displacements
    np.testing.assert_array_equal(u, expected)


def test_points_need_not_be_nodes(arrays):
    u = em.Scene(**arrays).simulate(E=1e4, nu=0.3).displacements
    tets = arrays["cells"]
    scene = em.Scene(
        **arrays,
        points=arrays["nodes"][tets].mean(axis=1),
        displacements=u[tets].mean(axis=1),
        origin="computed",
    )
    assert scene.estimate("iterative-fe")["E"].value == pytest.approx(1e4, rel=1e-6)


def test_points_outside_the_mesh_are_refused(arrays):
    outside = {"points": [[0.05, 0.05, 0.102]], "displacements": [[0, 0, 1e-3]]}
    with pytest.raises(ValueError, match="point 0 lies 0.002 outside the mesh"):
        em.Scene(**arrays, **outside)
    forces = arrays.pop("forces")
    case = em.LoadCase(forces=forces, tolerance=0.003, **outside)
    assert em.Scene(**arrays, cases=[case]).num_cases == 1


def test_load_cases_stand_beside_each_other(arrays):
    forces = arrays.pop("forces")
    cases = [em.LoadCase(forces=forces), em.LoadCase(forces=2 * forces)]
    scene = em.Scene(**arrays, cases=cases).simulate(E=1e4, nu=0.3)
    assert scene.num_cases == 2
    np.testing.assert_allclose(scene.displacements_of(1), 2 * scene.displacements_of(0), rtol=1e-9)
    with pytest.raises(IndexError, match="no load case 2"):
        scene.displacements_of(2)


def test_planar_scenes_have_a_section():
    nodes = [[0, 0], [1, 0], [1, 1], [0, 1]]
    held = [[True, True], [False, True], [False, False], [True, False]]
    u = {}
    for section in ("plane_stress", "plane_strain"):
        pull = em.Traction([3, 0], em.Box([1, 0], [1, 1]))
        scene = em.Scene(nodes, [[0, 1, 2, 3]], supports=held, loads=[pull], section=section)
        u[section] = scene.simulate(E=100, nu=0.25).displacements
    # e_x = s / E, in plane strain (1 - nu^2) s / E.
    np.testing.assert_allclose(u["plane_stress"][1], [0.03, 0], atol=1e-14)
    np.testing.assert_allclose(u["plane_strain"][1], [0.03 * (1 - 0.25**2), 0], atol=1e-14)


def test_two_materials_have_parameters_each(arrays):
    regions = np.arange(len(arrays["cells"])) % 2
    scene = em.Scene(
        **arrays, regions=regions, materials=[em.Material(regions=[0]), em.Material(regions=[1])]
    )
    assert [p.label for p in scene.parameters] == [
        "E of region 0", "nu of region 0", "E of region 1", "nu of region 1",
    ]  # fmt: skip
    given = dict(zip([p.label for p in scene.parameters], [1e4, 0.3, 3e4, 0.2]))
    estimate = scene.simulate(given).estimate("closed-form")
    assert estimate["E of region 1"].value == pytest.approx(3e4, rel=1e-6)
    with pytest.raises(KeyError, match='"E of region 0"'):
        estimate["E"]


def test_meshes_of_meshio(arrays):
    meshio = pytest.importorskip("meshio")
    mesh = meshio.Mesh(
        arrays["nodes"], {"tetra": arrays["cells"], "triangle": arrays["cells"][:, :3]}
    )
    scene = em.Scene(mesh, supports=arrays["supports"], forces=arrays["forces"])
    np.testing.assert_array_equal(scene.elements, arrays["cells"])


def as_meshio(nodes, cells):
    """Returns what a mesh of meshio has, whose version 5.0 makes none of wedges of 15 nodes."""
    blocks = [SimpleNamespace(type=name, data=of_kind) for name, of_kind in cells.items()]
    return SimpleNamespace(points=nodes, cells=blocks)


def as_pyvista(nodes, types, cells):
    """Returns what an unstructured grid of pyvista has of cells of these types of VTK."""
    return SimpleNamespace(
        points=nodes,
        cells=None,
        celltypes=np.array(types, np.uint8),
        cell_connectivity=np.concatenate(cells),
        offset=np.concatenate([[0], np.cumsum([len(cell) for cell in cells])]),
    )


def test_meshes_of_pyvista(arrays):
    mesh = as_pyvista(arrays["nodes"], [10] * len(arrays["cells"]), arrays["cells"])
    scene = em.Scene(mesh, supports=arrays["supports"], forces=arrays["forces"])
    np.testing.assert_array_equal(scene.elements, arrays["cells"])


# The ends of the edges of cells, in the order of VTK.
EDGES = {
    "hexahedron": [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4),
                   (0, 4), (1, 5), (2, 6), (3, 7)],
    "wedge": [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
    "tetra": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
}  # fmt: skip


def bar(order, seed=None):
    """Returns a bar of six tetrahedra, two wedges and a hexahedron along x, by their names in meshio.

    Its size is 3 x 1 x 1.  Order 2 puts a node into the middle of each edge.  A seed puts the
    middle nodes anywhere, and adds some nodes that no cell uses.
    """
    nodes = np.array([[x, y, z] for x in range(4) for y in (0, 1) for z in (0, 1)], dtype=float)
    corner = lambda x, y, z: (x * 2 + y) * 2 + z
    unit, along = np.eye(3, dtype=int), [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)]
    tets = [[corner(*p) for p in (0 * unit[0], unit[a], unit[a] + unit[b], (1, 1, 1))] for a, b in along]
    bases = [[(1, 0), (2, 0), (2, 1)], [(1, 0), (2, 1), (1, 1)]]
    wedges = [[corner(x, y, z) for z in (0, 1) for x, y in base] for base in bases]
    square = [(2, 0), (3, 0), (3, 1), (2, 1)]
    cells = {
        "tetra": np.array(tets),
        "wedge": np.array(wedges),
        "hexahedron": np.array([[corner(x, y, z) for z in (0, 1) for x, y in square]]),
    }
    if order == 2:
        middles = {}
        for name, of_kind in cells.items():
            ends = [[tuple(sorted(cell[list(edge)])) for edge in EDGES[name]] for cell in of_kind]
            new = [[middles.setdefault(e, len(nodes) + len(middles)) for e in row] for row in ends]
            cells[name] = np.hstack([of_kind, new])
        nodes = np.concatenate([nodes, [nodes[list(edge)].mean(axis=0) for edge in middles]])
        cells = {f"{name}{of_kind.shape[1]}": of_kind for name, of_kind in cells.items()}
    if seed is not None:
        number = np.random.default_rng(seed).permutation(len(nodes) + 3)[: len(nodes)]
        number[:16] = np.sort(number[:16])  # Wedges are cut as the tetrahedra beside them.
        shuffled = np.full((len(nodes) + 3, 3), 7.0)
        shuffled[number] = nodes
        nodes, cells = shuffled, {name: number[of_kind] for name, of_kind in cells.items()}
    return nodes, cells


def pulled(nodes):
    """Returns the flags of supports that let a bar along x narrow, and its displacement for E = 100,
    nu = 0.25 and a traction of 8: u = s (x, -nu y, -nu z) / E."""
    return nodes == 0, 0.08 * nodes * [1, -0.25, -0.25]


END = em.Box([3, 0, 0], [3, 1, 1])


@pytest.mark.parametrize("order, seed", [(1, None), (1, 5), (2, None), (2, 5)])
def test_cells_of_several_kinds_are_cut(order, seed):
    nodes, cells = bar(order, seed)
    held, expected = pulled(nodes)
    used = np.isin(np.arange(len(nodes)), np.concatenate([c.ravel() for c in cells.values()]))
    loads = [em.Traction([8, 0, 0], END)]
    scene = em.Scene(as_meshio(nodes, cells), supports=held, loads=loads)
    assert scene.kind == ("tet4" if order == 1 else "tet10")
    assert "are read as 18 tetrahedra" in scene.notices[0]
    u = scene.simulate(E=100, nu=0.25).displacements
    assert u.shape == nodes.shape
    np.testing.assert_allclose(u[used], expected[used], atol=1e-13)
    assert np.isnan(u[~used]).all()
    np.testing.assert_array_equal(scene.nodes[: len(nodes)], nodes)
    volumes = np.linalg.det(scene.nodes[scene.elements[:, 1:4]] - scene.nodes[scene.elements[:, :1]])
    assert np.abs(volumes).sum() / 6 == pytest.approx(3)
    # The added nodes were not measured, so that the values there do not count.
    measured = em.Scene(nodes, cells, supports=held, loads=loads, displacements=u)
    np.testing.assert_array_equal(measured.displacements, u)
    estimate = measured.estimate("iterative-fe")
    assert estimate["E"].value == pytest.approx(100, rel=1e-6)
    run = em.Scene(nodes, cells, supports=held, loads=loads).prepare("iterative-fe").run(2 * u)
    assert run["E"].value == pytest.approx(50, rel=1e-6)


def test_cells_of_a_mesh_are_those_of_its_file(tmp_path):
    meshio = pytest.importorskip("meshio")
    nodes, cells = bar(1)
    held, _ = pulled(nodes)
    force = np.where(nodes[:, :1] == 3, [[8.0, 0, 0]], 0)
    mesh = meshio.Mesh(nodes, cells, point_data={"fixed": held * 1.0, "force": force})
    mesh.write(tmp_path / "bar.vtu")
    read = em.read(tmp_path / "bar.vtu", measured=False)
    scene = em.Scene(mesh, supports=held, forces=force)
    # meshio turns wedges round in files, which changes the order of the parts of a wedge.
    parts = [sorted(map(sorted, cut.elements.tolist())) for cut in (scene, read)]
    assert parts[0] == parts[1]
    np.testing.assert_array_equal(scene.nodes, read.nodes)
    np.testing.assert_allclose(
        scene.simulate(E=1, nu=0).displacements,
        read.simulate(E=1, nu=0).displacements[: len(nodes)],
        rtol=1e-9,
        atol=1e-12,
    )


def test_regions_and_weights_are_those_of_cells():
    nodes, cells = bar(1)
    cells = {"triangle": [[0, 1, 2]], **cells}
    held = nodes[:, 0] == 0
    solid = np.array([1] * 6 + [2] * 2 + [3])
    materials = [em.Material(regions=[r]) for r in (1, 2, 3)]
    values = {f"{s} of region {r}": v for r in (1, 2, 3) for s, v in (("E", 10.0**r), ("nu", 0.2))}
    density = np.outer(solid == 3, [1.0, 0, 0])
    u = [
        em.Scene(nodes, cells, supports=held, regions=r, materials=materials, loads=[em.BodyForce(b)])
        .simulate(values)
        .displacements
        for r, b in [(solid, density), (np.append(9, solid), np.insert(density, 0, 7, axis=0))]
    ]
    np.testing.assert_array_equal(u[0], u[1])
    # A force of 1 stretches the soft part about ten times as much as the next one.
    end = lambda x: u[0][nodes[:, 0] == x, 0].mean()
    assert 7 < end(1) / (end(2) - end(1)) < 14
    with pytest.raises(ValueError, match="one integer below 2.31 for each of the 10"):
        em.Scene(nodes, cells, regions=[1, 2], supports=held)
    with pytest.raises(ValueError, match="a row of them for each of the 10 elements"):
        em.Scene(nodes, cells, loads=[em.BodyForce(np.ones((4, 3)))], supports=held)


@pytest.mark.parametrize("order", [1, 2])
def test_facets_of_four_nodes_are_cut_as_cells_are(order):
    nodes, cells = bar(order, seed=2)
    held, expected = pulled(nodes)
    at = lambda place: int(np.flatnonzero((nodes == place).all(axis=1))[0])
    facet = [at(corner) for corner in ([3, 0, 0], [3, 1, 0], [3, 1, 1], [3, 0, 1])]
    used = nodes[:, 0] < 7
    given = [facet]
    if order == 2:
        given.append(facet + [at(middle) for middle in ([3, 0.5, 0], [3, 1, 0.5], [3, 0.5, 1], [3, 0, 0.5])])
    for one in given:
        scene = em.Scene(nodes, cells, supports=held, loads=[em.Traction([8, 0, 0], [one])])
        u = scene.simulate(E=100, nu=0.25).displacements
        np.testing.assert_allclose(u[used], expected[used], atol=1e-13)
    unused = int(np.flatnonzero(~used)[0])
    for node in (unused, -1, 999):
        with pytest.raises(ValueError, match=f"names node {node}, which no element uses"):
            em.Scene(nodes, cells, loads=[em.Traction([8, 0, 0], [[node, *facet[1:]]])])
        with pytest.raises(ValueError, match=f"names node {node}, which no element uses"):
            em.Scene(nodes, cells, resultants=[em.Resultant([1, 0, 0], [node], 1)])
    inside = [at(corner) for corner in ([1, 0, 0], [1, 1, 0], [1, 1, 1], [2, 0, 1])]
    with pytest.raises(ValueError, match="is not a face" if order == 1 else "is no face"):
        em.Scene(nodes, cells, loads=[em.Traction([8, 0, 0], [inside])])


def test_middle_nodes_may_stand_among_vertices():
    meshio = pytest.importorskip("meshio")
    nodes, cells = bar(2, seed=3)
    held, expected = pulled(nodes)
    tets = cells["tetra10"]
    mesh = meshio.Mesh(nodes, {"tetra10": tets})
    pull = em.Traction([8, 0, 0], em.Box([1, 0, 0], [1, 1, 1]))
    scene = em.Scene(mesh, supports=held, loads=[pull])
    np.testing.assert_array_equal(scene.elements, tets)
    np.testing.assert_array_equal(scene.nodes, nodes)
    assert "29 points that no tetrahedron uses are left out" in scene.notices[0]
    u = scene.simulate(E=100, nu=0.25).displacements
    np.testing.assert_allclose(u[np.unique(tets)], expected[np.unique(tets)], atol=1e-13)


def test_elements_that_were_cut_did_not_compute_displacements():
    nodes, cells = bar(1)
    held, u = pulled(nodes)
    with pytest.raises(ValueError, match="cells of the mesh were cut into tetrahedra"):
        em.Scene(nodes, cells, supports=held, displacements=u, origin="computed")


@pytest.mark.parametrize(
    "change, sentence",
    [
        ({"forces": np.zeros((2, 3))}, r"forces has the shape \(2, 3\); give \(27, 3\)"),
        ({"supports": [99]}, "supports name node 99; give numbers from 0 to 26"),
        ({"supports": np.zeros(3, dtype=bool)}, "supports has the shape"),
        ({"cells": [[0, 1, 2, 99]]}, "99"),
        ({"cells": [[0, 1, 2]]}, "no element kind with 3 nodes in 3 dimensions"),
        ({"kind": "tet5"}, 'there is no element kind "tet5"'),
        ({"cells": [[0, 1, 2, 2**40]]}, f"cell 0 names point {2**40}, but there are 27 points"),
        ({"cells": np.zeros((0, 4), int)}, "the mesh has no elements"),
        ({"cells": np.zeros((3, 4))}, "type float64; give integers"),
        ({"nodes": [["a", "b", "c"]]}, "nodes is no array of numbers"),
        ({"cells": {"polygon": [[0, 1, 2, 3]]}}, 'there is no element kind "polygon"'),
        ({"displacements": np.zeros((3, 3))}, "displacements has the shape"),
        ({"regions": [1]}, "one integer below 2.31 for each of the 48 elements"),
        ({"origin": "guessed"}, "must be \"measured\" or \"computed\""),
        ({"nodes": np.zeros(3)}, "nodes has the shape"),
        ({"materials": [em.Material("cheese")]}, "cheese"),
        ({"supports": [1] * 9 + [0] * 18}, "supports is 0 or 1 for each of the 27 nodes"),
        ({"supports": em.Box([0, 0, 0], [1, 1, 0], "uz")}, "give 3 flags or letters"),
        ({"supports": em.Box([0, 0, 0], [1, 1, 0], [1, 1])}, "give 3 flags or letters"),
        ({"supports": em.Box("low", [1, 1, 0])}, "is no array of numbers"),
        ({"displacements": np.zeros((27, 3)).tolist()[:-1] + [[0]]}, "displacements is no array of"),
        ({"loads": [em.Pressure(1, [[0.0, 1, 2]])]}, "type float64; give integers"),
        ({"displacements": np.zeros((27, 3)) + 1j}, "displacements is no array of numbers"),
        ({"noise_sd": "0.1"}, "noise_sd='0.1'; give one number"),
        ({"forces": None, "loads": [em.Pressure([0, 1], [[0, 1, 2]])]}, "pressure=.* one number"),
        ({"regions": [2**40] * 48}, "one integer below 2.31 for each of the 48 elements"),
        ({"cells": {"hex8": [[0, 1, 2, 3]]}}, "cells of the kind hex8 have 4 nodes; give 8"),
        ({"loads": "push"}, "a load is of the type str"),
        ({"materials": ["isotropic"]}, "give a list of Material"),
        ({"forces": None, "cases": [np.zeros((27, 3))]}, "give a list of LoadCase"),
        ({"noise_sd": -1.0, "displacements": np.ones((27, 3))}, "noise"),
        ({"cases": []}, "cases are given"),
    ],
)
def test_wrong_input_is_refused_in_one_sentence(arrays, change, sentence):
    with pytest.raises(ValueError, match=sentence):
        em.Scene(**{**arrays, **change})


def test_wrong_parameters_are_refused(arrays):
    scene = em.Scene(**arrays)
    with pytest.raises(ValueError, match="needs the value of nu"):
        scene.simulate(E=1)
    with pytest.raises(ValueError, match='no one parameter "mu"'):
        scene.simulate(E=1, nu=0.3, mu=2)
    free = {**arrays, "supports": None}
    with pytest.raises(ValueError):
        em.Scene(**free).simulate(E=1, nu=0.3)


@pytest.mark.parametrize("option", [{"refine": 1.5}, {"young": 3}, {"nu": "0.3"}])
def test_wrong_options_are_refused_in_one_sentence(arrays, option):
    (name,) = option
    with pytest.raises(TypeError, match=f"^{name}=.* is no option, or of another type"):
        em.Scene(**arrays).estimate("auto", **option)


def test_load_cases_are_counted_from_zero(arrays):
    with pytest.raises(IndexError, match="no load case -1"):
        em.Scene(**arrays).displacements_of(-1)


def test_files_that_are_not_there_are_named():
    with pytest.raises(ValueError, match="missing.json"):
        em.read("missing.json")


def test_a_grip_that_moved_and_a_load_cell_tell_the_modulus(arrays):
    arrays.pop("forces")
    arrays.pop("supports")
    top = arrays["nodes"][:, 2].max()
    size = arrays["nodes"].max(axis=0)
    bottom = em.Box([0, 0, 0], [size[0], size[1], 0])
    grip = ([0, 0, top], [size[0], size[1], top])
    held = em.Scene(
        **arrays, supports=[bottom, em.Box(*grip, displacement=[0, 0, 1e-4])]
    ).simulate(E=5e3, nu=0.3)
    # The force at E = 5e3 is found again from that of a scene where it is the load.
    cell = em.Resultant([np.nan, np.nan, 2.0], em.Box(*grip), sd=0.01)
    moved = em.Scene(
        **arrays,
        supports=[bottom, em.Box(*grip, displacement="rigid")],
        displacements=held.displacements,
        noise_sd=1e-8,
        resultants=[cell],
        origin="computed",
    )
    doubled = em.Scene(
        **arrays,
        supports=[bottom, em.Box(*grip, displacement="measured")],
        displacements=held.displacements,
        noise_sd=1e-8,
        resultants=[em.Resultant([np.nan, np.nan, 4.0], em.Box(*grip), sd=0.01)],
        origin="computed",
    )
    one, two = (scene.estimate("iterative-fe") for scene in (moved, doubled))
    assert one["nu"].value == pytest.approx(0.3, abs=1e-3)
    assert two["E"].value == pytest.approx(2 * one["E"].value, rel=1e-3)
    with pytest.raises(ValueError, match='"measured", "rigid" or a vector'):
        em.Scene(**arrays, supports=[em.Box(*grip, displacement="loose")])
    with pytest.raises(ValueError, match="give 3 components, and one sd or 3"):
        em.Scene(**arrays, supports=[bottom], resultants=[em.Resultant([1.0], [0], 1.0)])


def test_rows_of_different_lengths_are_refused_in_a_sentence(arrays):
    arrays["cells"] = [[0, 1, 2, 3], [0, 1, 2, 3, 4, 5, 6, 7]]
    with pytest.raises(ValueError, match="the cells have different numbers of nodes; give a dict"):
        em.Scene(**arrays)
