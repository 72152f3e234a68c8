"""Young's modulus and Poisson's ratio, with error bars, from a mesh, loads and displacements.

    import elastimate as em
    scene = em.Scene(nodes, tets, supports=held, forces=f, displacements=u)
    estimate = scene.estimate("auto", noise_sd=1e-5)
    print(estimate)
    estimate["E"].value, estimate["E"].standard_error

Shapes: n nodes in d dimensions, m elements.  All numbers are in one consistent system of units.
Wrong input raises ValueError with one sentence that says what is wrong and what mends it.
"""

from ._core import Finding, Material, Options, Parameter, __version__, estimators
from ._estimate import Estimate
from ._law import (
    Law,
    LawCurve,
    LawDescription,
    LawParameter,
    check_law,
    law_curve,
    laws,
    register_law,
)
from ._scene import (
    BodyForce,
    Box,
    LoadCase,
    PreparedEstimator,
    Pressure,
    Resultant,
    Scene,
    SurfaceForce,
    Traction,
    read,
)

__all__ = [
    "BodyForce",
    "Box",
    "Estimate",
    "Finding",
    "Law",
    "LawCurve",
    "LawDescription",
    "LawParameter",
    "LoadCase",
    "Material",
    "Options",
    "Parameter",
    "PreparedEstimator",
    "Pressure",
    "Resultant",
    "Scene",
    "SurfaceForce",
    "Traction",
    "__version__",
    "check_law",
    "estimators",
    "law_curve",
    "laws",
    "read",
    "register_law",
]
