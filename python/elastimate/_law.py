"""Laws of elasticity: a list of them, and laws that are written in Python."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Sequence

import numpy as np
from numpy.typing import NDArray

from . import _core

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class LawParameter:
    """A parameter of a law.

    name        such as "youngs_modulus"
    symbol      such as "E"
    is_modulus  whether it is a stiffness [pressure], positive, whose logarithm is fitted; else
                it is a ratio [1]
    lower, upper  the closed range that fits search
    typical     a common value, where fits start
    """

    name: str
    symbol: str
    is_modulus: bool = True
    lower: float = 1e-300
    upper: float = 1e300
    typical: float = 1.0


@dataclass(frozen=True)
class LawDescription:
    """What there is to know of a law: its name, one line, and the names of its parameters."""

    name: str
    description: str
    parameters: tuple[str, ...]


class Law:
    """A law of elasticity of small strains, written in Python, for trying it out.

    A law gives the stress at a point, linear in its moduli theta,

        P(H; theta) = sum over k of theta_k P_k(H),   H_ij = du_i / dx_j,

    where P_k = dW_k / dH for energy densities W_k.  A subclass sets ``name``, ``description`` and
    ``parameters``, and overrides ``stresses``.  If its moduli are not its parameters, it also sets
    ``num_moduli`` and overrides ``moduli``, ``moduli_jacobian`` and ``parameters_of``.

    ``sections`` are those it takes, of "3d", "plane_strain" and "plane_stress".  d is 3 in "3d",
    else 2.  Each function is called for each element, so an estimate takes about a hundred times
    longer than with a law of the library.
    """

    name: str = ""
    description: str = ""
    parameters: Sequence[LawParameter] = ()
    sections: Sequence[str] = ("3d",)
    num_moduli: int | None = None

    def stresses(self, gradient: Floats, section: str) -> Floats:
        """Returns P_k(H) [1], shape (num_moduli, d, d), for H of shape (d, d)."""
        raise NotImplementedError

    def energies(self, gradient: Floats, section: str) -> Floats:
        """Returns W_k(H) [1], shape (num_moduli,); by default H : P_k(H) / 2."""
        energies: Floats = np.einsum("ij,kij->k", gradient, self.stresses(gradient, section)) / 2
        return energies

    def tangent(self, moduli: Floats, gradient: Floats, section: str) -> Floats:
        """Returns dP_ij / dH_kl [pressure], shape (d, d, d, d).

        By default it is found from the stresses, which are linear in H.
        """
        d = len(gradient)
        tangent = np.empty((d, d, d, d))
        for k, l in np.ndindex(d, d):
            unit = np.zeros((d, d))
            unit[k, l] = 1
            tangent[:, :, k, l] = np.tensordot(moduli, self.stresses(unit, section), 1)
        return tangent

    def moduli(self, parameters: Floats, section: str) -> Floats:
        """Returns theta(p), shape (num_moduli,); by default the parameters."""
        return parameters

    def moduli_jacobian(self, parameters: Floats, section: str) -> Floats:
        """Returns d theta / d p, shape (num_moduli, num_parameters); by default the identity."""
        return np.eye(len(parameters))

    def parameters_of(self, moduli: Floats, section: str) -> Floats:
        """Returns the p of theta(p), shape (num_parameters,); by default theta."""
        return moduli

    # The libraries write a matrix H as one column after another.

    def _stress_columns(self, gradient: Floats, section: str) -> Floats:
        stresses = np.asarray(self.stresses(gradient, section), dtype=float)
        return stresses.transpose(2, 1, 0).reshape(-1, len(stresses))

    def _tangent_columns(self, moduli: Floats, gradient: Floats, section: str) -> Floats:
        d = len(gradient)
        tangent = np.asarray(self.tangent(moduli, gradient, section), dtype=float)
        return tangent.transpose(1, 0, 3, 2).reshape(d * d, d * d)

    def _core_law(self) -> _core.PythonLaw:
        parameters = [
            (p.name, p.symbol, p.is_modulus, p.lower, p.upper, p.typical) for p in self.parameters
        ]
        count = len(parameters) if self.num_moduli is None else self.num_moduli
        return _core.PythonLaw(
            self, self.name, self.description, parameters, count, list(self.sections)
        )


def check_law(law: Law) -> list[str]:
    """Returns a sentence for each thing that is wrong with a law; none for a right law.

    Derivatives are compared with finite differences; symmetry, definiteness and ranges are
    checked.
    """
    return _core.check_law(law._core_law())


def register_law(law: Law) -> None:
    """Makes a law known by its name to materials, until the program ends.

    Raises ValueError, which says what is wrong, where ``check_law`` finds something, or where
    there is a law of this name.
    """
    _core.register_law(law._core_law())


def laws() -> list[LawDescription]:
    """Returns all laws: those of the library, then those of ``register_law``."""
    return [LawDescription(name, text, tuple(names)) for name, text, names in _core.laws()]


@dataclass(frozen=True)
class LawCurve:
    """What a material does in five tests of a block, as ``law_curve`` returns it.

    law        its name
    stretches  [1], shape (n,)
    stress     for each test the force per undeformed area [pressure], shape (n,); NaN where no
               stable state was found.  The tests are "uniaxial", "equibiaxial" and "pure_shear",
               whose free sides bear no traction; "simple_shear", F = I + (stretch - 1) e1 e2^T;
               and "volumetric".
    """

    law: str
    stretches: Floats
    stress: dict[str, Floats]

    def plot(self) -> Figure:
        """Returns a figure of matplotlib, a line for each test."""
        from ._plot import plot_curve

        return plot_curve(self)


def law_curve(
    law: str, *, stretches: Sequence[float] | Floats | None = None, **parameters: float
) -> LawCurve:
    """Returns the stress of a material in five tests.  Give every parameter of its law by name.

        em.law_curve("neo_hookean", youngs_modulus=1e4, poisson_ratio=0.45).plot()

    By default there are 101 stretches from 0.5 to 3.  Raises ValueError for a wrong law,
    parameter or stretch.  The cost is some hundred evaluations of the law for each test.
    """
    where = np.linspace(0.5, 3, 101) if stretches is None else np.ravel(stretches).astype(float)
    found = _core.law_curves(law, parameters, where.tolist())
    return LawCurve(law, where, {test: np.array(stress) for test, stress in found.items()})


__all__ = [
    "Law",
    "LawCurve",
    "LawDescription",
    "LawParameter",
    "check_law",
    "law_curve",
    "laws",
    "register_law",
]
