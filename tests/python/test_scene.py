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
    estimate = em.Scene(**arrays, displacements=u, origin="computed").estimate("iterative-fe")
    assert estimate["E"].value == pytest.approx(1e4, rel=1e-6)


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


def test_meshes_of_pyvista_have_kinds_by_number(arrays):
    mesh = SimpleNamespace(points=arrays["nodes"], cells_dict={10: arrays["cells"]})
    scene = em.Scene(mesh, supports=arrays["supports"], forces=arrays["forces"])
    np.testing.assert_array_equal(scene.elements, arrays["cells"])


@pytest.mark.parametrize(
    "change, sentence",
    [
        ({"forces": np.zeros((2, 3))}, r"forces has the shape \(2, 3\); give \(27, 3\)"),
        ({"supports": [99]}, "supports name node 99; give numbers from 0 to 26"),
        ({"supports": np.zeros(3, dtype=bool)}, "supports has the shape"),
        ({"cells": [[0, 1, 2, 99]]}, "99"),
        ({"cells": [[0, 1, 2]]}, "no element kind with 3 nodes in 3 dimensions"),
        ({"kind": "tet5"}, "there is no element kind"),
        ({"displacements": np.zeros((3, 3))}, "displacements has the shape"),
        ({"regions": [1]}, "one integer for each of the 48 elements"),
        ({"origin": "guessed"}, "must be \"measured\" or \"computed\""),
        ({"nodes": np.zeros(3)}, "nodes has the shape"),
        ({"materials": [em.Material("cheese")]}, "cheese"),
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


def test_cells_of_several_kinds_are_refused_in_a_sentence(arrays):
    arrays["cells"] = [[0, 1, 2, 3], [0, 1, 2, 3, 4, 5, 6, 7]]
    with pytest.raises(ValueError, match="the cells have different numbers of nodes"):
        em.Scene(**arrays)


def test_cells_that_are_to_be_cut_are_not_left_out(arrays):
    mesh = SimpleNamespace(
        points=arrays.pop("nodes"),
        cells_dict={"tetra": arrays.pop("cells"), "wedge": np.array([[0, 1, 2, 3, 4, 5]])},
    )
    with pytest.raises(ValueError, match=r"cells that are to be cut \(wedge\); save it as a .vtu"):
        em.Scene(mesh, **arrays)
