"""Scenes from arrays, from meshes of other packages, and from files."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Mapping, Sequence, TypeVar, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._cells import cells_of, connectivity_of
from ._core import Material, Parameter
from ._estimate import Estimate, find_parameter

Floats = NDArray[np.float64]
_T = TypeVar("_T")


@dataclass(frozen=True, eq=False)
class Box:
    """A part of space, bounds included: the corners have d coordinates [length].

    As a support it holds ``components`` (d flags, or "xz"; all by default) of its nodes at a
    ``displacement`` [length], zero by default.  The displacement "measured" is for a support that
    moved by amounts that the measurement at its nodes tells, and "rigid" for one that moved as a
    rigid body, such as a grip.
    """

    lower: ArrayLike
    upper: ArrayLike
    components: Sequence[bool] | str | None = None
    displacement: ArrayLike | str | None = None


@dataclass(frozen=True, eq=False)
class Resultant:
    """The force [force], shape (d,), that supports exert on held nodes, as a load cell measured it.

    NaN stands for a component that was not measured.  ``where`` is a Box or the numbers of nodes,
    and ``sd`` the standard deviation of the components [force], one or d numbers.
    """

    force: ArrayLike
    where: Union[Box, ArrayLike]
    sd: ArrayLike


@dataclass(frozen=True, eq=False)
class Traction:
    """A force per area [force / length^2], shape (d,), on facets.

    ``where`` is a Box, for the facets of the outer surface all of whose nodes are in it, or the
    nodes of facets, shape (f, nodes of a facet).
    """

    traction: ArrayLike
    where: Union[Box, ArrayLike]


@dataclass(frozen=True, eq=False)
class Pressure:
    """A pressure [force / length^2] on facets (see Traction); positive pushes inwards.

    ``follows`` tells whether it acts on the deformed surface, for laws of large strains.
    """

    pressure: float
    where: Union[Box, ArrayLike]
    follows: bool = False


@dataclass(frozen=True, eq=False)
class SurfaceForce:
    """A total force [force], shape (d,), that is spread evenly over facets (see Traction)."""

    force: ArrayLike
    where: Union[Box, ArrayLike]


@dataclass(frozen=True, eq=False)
class BodyForce:
    """A force per volume [force / length^3], shape (d,), or (m, d) for each element."""

    force_density: ArrayLike


Load = Union[Traction, Pressure, SurfaceForce, BodyForce]


@dataclass(frozen=True, eq=False)
class LoadCase:
    """One experiment on a specimen with n nodes in d dimensions.

    forces         on nodes, shape (n, d) [force]
    loads          other loads, which may act together with forces
    displacements  of the nodes, shape (n, d), or of the points, shape (p, d) [length]; NaN where a
                   component was not measured; None for a simulation
    points         positions, shape (p, d) [length], where displacements were measured; at the nodes
                   where it is None
    noise_sd       standard deviation of a measured component [length], if it is known
    tolerance      how far a point may lie outside the mesh [length]; by default a thousandth of the
                   diagonal of its bounding box
    resultants     forces of supports that were measured
    """

    forces: ArrayLike | None = None
    loads: Sequence[Load] = ()
    displacements: ArrayLike | None = None
    points: ArrayLike | None = None
    noise_sd: float | None = None
    tolerance: float | None = None
    resultants: Sequence[Resultant] = ()


class Scene:
    """A specimen, how it is held and loaded, and what was measured of it.

    nodes       positions, shape (n, d) with d = 3, or 2 for a planar specimen [length]; or a mesh of
                meshio or pyvista, and then no cells
    cells       node numbers from zero, shape (m, nodes of an element), in the order of VTK; or a
                dict of such arrays by their kinds
    supports    which nodes are held: node numbers, flags of shape (n,) or (n, d), a Box, or a
                list of boxes.  None for a specimen that nothing holds
    forces, loads, displacements, points, noise_sd, resultants
                the one load case (see LoadCase); or else
    cases       a list of LoadCase
    support_displacements
                at which nodes are held, shape (n, d) [length]; zero where it is None
    kind        of the elements, such as "tet4", where the number of nodes does not tell it
    section     "plane_stress" (the default of a planar specimen) or "plane_strain"
    thickness   of a planar specimen [length]
    regions     a region id for each cell, shape (m,)
    materials   a list of Material; None for one isotropic one
    origin      "computed" where these very elements computed the displacements, else "measured"
    rigid_motion_free
                whether displacements contain an unknown rigid motion

    Cells of several kinds are cut into tetrahedra or triangles, as those of a file are
    (docs/scenes.md); ``notices`` says so.  Arrays then have a row for each given node or cell.

    All numbers are in one consistent system of units (m, N, Pa or mm, N, MPa).  The scene has
    copies of its arrays, so that these may change afterwards.

    Raises ValueError, with one sentence that names the array and the mend, for wrong input.
    """

    def __init__(
        self,
        nodes: Any,
        cells: ArrayLike | Mapping[str, ArrayLike] | None = None,
        *,
        supports: ArrayLike | Box | Sequence[Box] | None = None,
        forces: ArrayLike | None = None,
        loads: Sequence[Load] = (),
        displacements: ArrayLike | None = None,
        points: ArrayLike | None = None,
        noise_sd: float | None = None,
        resultants: Sequence[Resultant] = (),
        cases: Sequence[LoadCase] | None = None,
        support_displacements: ArrayLike | None = None,
        kind: str | None = None,
        section: str | None = None,
        thickness: float = 1.0,
        regions: ArrayLike | None = None,
        materials: Sequence[Material] | None = None,
        origin: str = "measured",
        rigid_motion_free: bool = False,
    ) -> None:
        self._core = _core.Scene(*cells_of(nodes, cells, kind), section, thickness)
        _hold(self._core, supports, support_displacements)
        if regions is not None:
            self._core.set_regions(_regions(self._core, regions))
        if materials is not None:
            self._core.set_materials(_several("materials", materials, Material))
        self._core.set_origin(origin)
        self._core.set_rigid_motion_free(rigid_motion_free)
        one = LoadCase(forces, loads, displacements, points, noise_sd, resultants=resultants)
        given = [forces, displacements, points, noise_sd]
        is_given = bool(loads) or bool(resultants) or any(value is not None for value in given)
        if cases is not None and is_given:
            raise ValueError(
                "cases are given, and so are forces, loads, displacements, points, noise_sd or "
                "resultants; give these in the LoadCase that they belong to"
            )
        for k, case in enumerate([one] if cases is None else _several("cases", cases, LoadCase)):
            _add_case(self._core, case, "" if cases is None else f"load case {k + 1}: ")
        self._core.finish()

    @classmethod
    def _of(cls, core: _core.Scene) -> Scene:
        scene = cls.__new__(cls)
        scene._core = core
        return scene

    @property
    def kind(self) -> str:
        """The kind of the elements, such as "tet4"."""
        return self._core.kind

    @property
    def nodes(self) -> Floats:
        """Positions, shape (n, d) [length], and those of nodes that cuts have added."""
        return self._core.nodes

    @property
    def elements(self) -> NDArray[np.int32]:
        """Node numbers of the elements that are computed with; a view that cannot be written."""
        return self._core.elements

    @property
    def num_cases(self) -> int:
        """The number of load cases."""
        return self._core.num_cases

    @property
    def displacements(self) -> Floats:
        """Measured displacements of the given nodes in the first load case, shape (n, d) [length].

        NaN where a component was not measured; empty where nothing was measured at nodes.
        """
        return self.displacements_of(0)

    def displacements_of(self, load_case: int) -> Floats:
        """As ``displacements``, of the load case with this number from zero."""
        if not 0 <= load_case < self.num_cases:
            raise IndexError(f"there is no load case {load_case}")
        return self._core.displacement(load_case)

    @property
    def notices(self) -> list[str]:
        """What is read in another way than the mesh or the file has it."""
        return self._core.notices

    @property
    def parameters(self) -> list[Parameter]:
        """The parameters of the materials; the value is NaN where it is not known."""
        return self._core.parameters()

    def _prepared(
        self, order: int, noise_sd: float | None, origin: str | None, map: str | None
    ) -> _core.Scene:
        if order == 1 and noise_sd is None and origin is None and map is None:
            return self._core
        return self._core.with_choices(order, noise_sd, origin, map)

    def estimate(
        self,
        estimator: str = "auto",
        *,
        noise_sd: float | None = None,
        origin: str | None = None,
        order: int = 1,
        map: str | None = None,
        **options: Any,
    ) -> Estimate:
        """Estimates the parameters of the materials from the measured displacements.

        estimator  one of ``elastimate.estimators()``
        noise_sd   standard deviation of all measured components [length]
        origin     in place of that of the scene
        order      2 for quadratic elements on a mesh of linear ones
        map        "youngs_modulus", for the modulus of every element
        options    those of ``elastimate.Options``, by the names of the command line

        Numerical outcomes are a ``status`` of the estimate.  Raises ValueError for input that the
        estimator cannot serve, and KeyboardInterrupt after Ctrl-C, before the next factorisation.
        Other threads run meanwhile.
        """
        scene = self._prepared(order, noise_sd, origin, map)
        call = _call(
            "estimate", estimator, noise_sd=noise_sd, origin=origin, order=order, map=map, **options
        )
        return Estimate(_core.run(scene, estimator, _options(options)), call)

    def prepare(
        self,
        estimator: str = "auto",
        *,
        noise_sd: float | None = None,
        origin: str | None = None,
        order: int = 1,
        **options: Any,
    ) -> PreparedEstimator:
        """Prepares an estimator for a specimen that is measured again and again.

        The arguments are those of ``estimate``.  What does not depend on the displacements is done
        once.
        """
        scene = self._prepared(order, noise_sd, origin, None)
        call = _call(
            "prepare", estimator, noise_sd=noise_sd, origin=origin, order=order, **options
        )
        return PreparedEstimator(_core.Prepared(scene, estimator, _options(options)), call)

    def simulate(
        self,
        parameters: Mapping[str, float] | None = None,
        /,
        *,
        order: int = 1,
        noise_sd: float = 0,
        seed: int = 1,
        **named: float,
    ) -> Scene:
        """Returns the scene with the displacements that materials of these parameters have.

        parameters, named  values by the label, symbol or name of a parameter, such as E=5e3, nu=.3
        order              2 computes with quadratic elements on a mesh of linear ones
        noise_sd           standard deviation of Gaussian noise that is added [length]
        seed               of the noise

        Raises ValueError where a parameter is missing or unknown, and where the supports do not
        hold the specimen.
        """
        given = {**(parameters or {}), **named}
        known = self.parameters
        values = np.array([p.value for p in known])
        for key, value in given.items():
            try:
                values[find_parameter(known, key)] = value
            except KeyError as error:
                raise ValueError(error.args[0]) from None
        missing = [p.label for p, value in zip(known, values) if np.isnan(value)]
        if missing:
            raise ValueError(f"a simulation needs the value of {', '.join(missing)}; give all of them")
        if order not in (1, 2):
            raise ValueError(f"order={order}; it must be 1 for linear elements or 2 for quadratic ones")
        if not noise_sd >= 0:
            raise ValueError(f"noise_sd={noise_sd}; it must not be negative")
        return Scene._of(self._core.simulate(values, order, noise_sd, seed))

    def __repr__(self) -> str:
        return (
            f"<Scene of {len(self.nodes)} nodes, {len(self.elements)} elements of the kind "
            f"{self.kind}, {self.num_cases} load case{'' if self.num_cases == 1 else 's'}>"
        )


def _call(method: str, estimator: str, order: int, **given: Any) -> str:
    """Returns the call of a method of a scene, without what is left at its default."""
    if order != 1:
        given["order"] = order
    options = [f"{name}={value!r}" for name, value in given.items() if value is not None]
    return f"scene.{method}({', '.join([repr(estimator), *options])})"


def _options(options: dict[str, Any]) -> _core.Options:
    if isinstance(options.get("refine"), int):
        options = {**options, "refine": str(options["refine"])}
    for name, value in options.items():
        try:
            _core.Options(**{name: value})
        except TypeError:
            raise TypeError(
                f"{name}={value!r} is no option, or of another type; docs/python.md lists the options"
            ) from None
    return _core.Options(**options)


class PreparedEstimator:
    """An estimator that ``Scene.prepare`` has made ready for one specimen after another."""

    def __init__(self, core: _core.Prepared, call: str) -> None:
        self._core = core
        self._call = call

    def run(self, displacements: ArrayLike) -> Estimate:
        """Estimates from displacements of shape (n, d), or (k, n, d) for k load cases [length].

        Where the scene was measured at points, these are their displacements.  Threads may call
        this at once; they wait for each other.
        """
        values = np.asarray(displacements, dtype=float)
        frames = list(values) if values.ndim == 3 else [values]
        return Estimate(self._core.run(frames), f"{self._call}.run(displacements)")


def read(
    *paths: str | os.PathLike[str],
    section: str | None = None,
    thickness: float | None = None,
    regions: str = "given",
    material: str = "",
    measured: bool = True,
) -> Scene:
    """Reads a scene.json, or .vtu, .pvtu, .vtk or .msh files with the arrays of a scene (docs/scenes.md).

    paths      several files are further load cases of one specimen
    section, thickness
               of a planar mesh, in place of what the files say
    regions    "given", "one" (isotropic material) or "each" (region an isotropic material)
    material   the law of all materials; as given where it is empty
    measured   whether a scene without measured displacements is wrong input

    Raises ValueError, with one sentence that names the file and the mend.
    """
    return Scene._of(
        _core.read([Path(p) for p in paths], not measured, section, thickness, regions, material)
    )


def _of_elements(core: _core.Scene, values: NDArray[Any]) -> NDArray[Any] | None:
    """Returns a row for each element from one for each cell, or for each that is no facet or edge.

    None for another number of rows.
    """
    cells = core.cell_of_element
    if len(values) == core.num_cells:
        return values[cells]
    solid = np.unique(cells)
    return values[np.searchsorted(solid, cells)] if len(values) == len(solid) else None


def _regions(core: _core.Scene, regions: ArrayLike) -> NDArray[np.int32]:
    ids = np.asarray(regions)
    of_elements = _of_elements(core, ids) if ids.ndim == 1 and ids.dtype.kind in "iub" else None
    if of_elements is None or np.any(np.abs(of_elements) > np.iinfo(np.int32).max):
        raise ValueError(
            f"regions has the shape {ids.shape} and the type {ids.dtype}; give one integer "
            f"below 2^31 for each of the {core.num_cells} elements"
        )
    return of_elements.astype(np.int32)


def _several(name: str, values: Any, kind: type[_T]) -> list[_T]:
    """Returns a list of what is given, which may also be one of it."""
    several = list(values) if isinstance(values, (list, tuple)) else [values]
    for value in several:
        if not isinstance(value, kind):
            raise ValueError(
                f"{name} has a value of the type {type(value).__name__}; give a list of {kind.__name__}"
            )
    return several


def _numbers(name: str, values: ArrayLike) -> Floats:
    """Returns an array of numbers, NaN where it is masked."""
    try:
        if np.iscomplexobj(values):
            raise TypeError
        if isinstance(values, np.ma.MaskedArray):
            return np.where(values.mask, np.nan, values.data.astype(float))
        return np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise ValueError(f"{name} is no array of numbers; give numbers, all rows of one length") from None


def _number(name: str, value: Any) -> float | None:
    if value is not None and (isinstance(value, str) or np.size(value) != 1):
        raise ValueError(f"{name}={value!r}; give one number")
    return None if value is None else float(_numbers(name, value).reshape(()))


def _rows(name: str, values: ArrayLike, count: int, dimension: int, of: str) -> Floats:
    rows = _numbers(name, values)
    if rows.shape != (count, dimension):
        raise ValueError(
            f"{name} has the shape {rows.shape}; give ({count}, {dimension}): "
            f"one row for each {of}"
        )
    return rows


def _hold(core: _core.Scene, supports: Any, displacement: ArrayLike | None) -> None:
    n, d = core.num_points, core.dimension
    boxes = [supports] if isinstance(supports, Box) else supports
    if isinstance(boxes, (list, tuple)) and boxes and all(isinstance(b, Box) for b in boxes):
        if displacement is not None:
            raise ValueError("boxes have displacements of their own; leave support_displacements out")
        for box in boxes:
            _hold_box(core, box)
        return
    at = (
        np.zeros((n, d))
        if displacement is None
        else _rows("support_displacements", displacement, n, d, "node")
    )
    core.hold(_held(supports, n, d), at)


def _hold_box(core: _core.Scene, box: Box) -> None:
    lower, upper = _vector(box.lower), _vector(box.upper)
    components = None if box.components is None else _flags(box.components, core.dimension)
    if not isinstance(box.displacement, str):
        moved = None if box.displacement is None else _vector(box.displacement)
        core.hold_box(lower, upper, components, moved)
    elif box.displacement in ("measured", "rigid"):
        core.hold_moved_box(lower, upper, components, box.displacement == "rigid")
    else:
        raise ValueError(
            f'the displacement of a box is {box.displacement!r}; give "measured", "rigid" or a vector'
        )


def _flags(components: Sequence[bool] | str, dimension: int) -> NDArray[np.bool_]:
    axes = "xyz"[:dimension]
    if isinstance(components, str) and components and set(components) <= set(axes):
        return np.array([axis in components for axis in axes])
    flags = np.asarray(components)
    if flags.shape != (dimension,) or flags.dtype.kind not in "biu":
        raise ValueError(
            f'components={components!r}; give {dimension} flags or letters, such as "{axes[-1]}"'
        )
    return flags.astype(bool)


def _held(supports: ArrayLike | None, n: int, d: int) -> NDArray[np.bool_]:
    held = np.zeros((n, d), dtype=bool)
    if supports is None:
        return held
    given = np.asarray(supports)
    if given.dtype == bool and given.shape in ((n,), (n, d)):
        held[:] = given if given.ndim == 2 else given[:, np.newaxis]
    elif given.dtype.kind in "iu" and given.shape == (n,) and n > 2 and set(given) <= {0, 1}:
        raise ValueError(
            f"supports is 0 or 1 for each of the {n} nodes; give flags of the type bool, or the numbers "
            "of the nodes that are held"
        )
    elif given.dtype.kind in "iu" and given.ndim == 1:
        wrong = given[(given < 0) | (given >= n)]
        if len(wrong):
            raise ValueError(f"supports name node {wrong[0]}; give numbers from 0 to {n - 1}")
        held[given] = True
    else:
        raise ValueError(
            f"supports has the shape {given.shape} and the type {given.dtype}; give node numbers, "
            f"flags of shape ({n},) or ({n}, {d}), or boxes"
        )
    return held


def _vector(values: ArrayLike) -> Floats:
    return _numbers("a vector of a box, a load or a resultant", values).reshape(-1)


def _facets(core: _core.Scene, where: Any) -> NDArray[np.int32]:
    if not isinstance(where, Box):
        return connectivity_of("the facets of a load", where).astype(np.int32)
    facets = core.facets_in_box(_vector(where.lower), _vector(where.upper))
    if len(facets) == 0:
        raise ValueError(
            f"the box from {_vector(where.lower)} to {_vector(where.upper)} holds no whole facet of "
            f"the surface; the nodes lie between {core.nodes.min(axis=0)} and "
            f"{core.nodes.max(axis=0)}"
        )
    return facets


def _core_resultant(
    core: _core.Scene, resultant: Resultant, where: str
) -> tuple[NDArray[np.int32], Floats, Floats]:
    dimension = core.dimension
    force = _vector(resultant.force)
    sd = _vector(resultant.sd)
    if force.shape != (dimension,) or sd.shape not in ((1,), (dimension,)):
        raise ValueError(
            f"{where}a resultant has a force of {len(force)} components and an sd of {len(sd)}; "
            f"give {dimension} components, and one sd or {dimension}"
        )
    if isinstance(resultant.where, Box):
        lower, upper = _vector(resultant.where.lower), _vector(resultant.where.upper)
        inside = np.all((core.nodes >= lower) & (core.nodes <= upper), axis=1)
        nodes = np.flatnonzero(inside)
    else:
        nodes = np.asarray(resultant.where).reshape(-1)
    return nodes.astype(np.int32), force, np.broadcast_to(sd, (dimension,)).copy()


def _body_force(core: _core.Scene, density: Floats) -> Floats:
    of_elements = _of_elements(core, density)
    if of_elements is None:
        raise ValueError(
            f"a BodyForce has the shape {density.shape}; give {core.dimension} components, or a row "
            f"of them for each of the {core.num_cells} elements"
        )
    return of_elements


def _core_load(core: _core.Scene, load: object) -> _core._Load:
    if isinstance(load, Traction):
        return _core.Traction(_facets(core, load.where), np.atleast_2d(_vector(load.traction)))
    if isinstance(load, Pressure):
        pressure = _number("pressure", load.pressure)
        return _core.Pressure(_facets(core, load.where), 0 if pressure is None else pressure, load.follows)
    if isinstance(load, SurfaceForce):
        return _core.SurfaceForce(_facets(core, load.where), _vector(load.force))
    if isinstance(load, BodyForce):
        density = np.atleast_2d(_numbers("a BodyForce", load.force_density))
        return _core.BodyForce(density if len(density) == 1 else _body_force(core, density))
    raise ValueError(
        f"a load is of the type {type(load).__name__}; give a Traction, a Pressure, a SurfaceForce "
        "or a BodyForce"
    )


def _add_case(core: _core.Scene, case: LoadCase, where: str) -> None:
    n, d = core.num_points, core.dimension
    noise_sd = _number(f"{where}noise_sd", case.noise_sd)
    loads = [_core_load(core, load) for load in _several(f"{where}loads", case.loads, object)]
    resultants = [
        _core_resultant(core, one, where)
        for one in _several(f"{where}resultants", case.resultants, Resultant)
    ]
    if case.forces is not None:
        loads.append(_core.NodalForces(_rows(f"{where}forces", case.forces, n, d, "node")))
    if case.points is not None:
        points = _numbers(f"{where}points", case.points)
        if case.displacements is None:
            raise ValueError(f"{where}points are given without displacements; give both")
        of_points = _rows(f"{where}displacements", case.displacements, len(points), d, "point")
        tolerance = _number(f"{where}tolerance", case.tolerance)
        core.add_case(loads, None, None, points, of_points, tolerance, noise_sd, resultants)
        return
    displacement = observed = None
    if case.displacements is not None:
        displacement = _rows(f"{where}displacements", case.displacements, n, d, "node")
        missing = np.isnan(displacement)
        if missing.any():
            observed = ~missing
            displacement = np.where(missing, 0, displacement)
    core.add_case(loads, displacement, observed, None, None, None, noise_sd, resultants)
