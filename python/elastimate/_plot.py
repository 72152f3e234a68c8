"""Figures of estimates and of laws."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ._estimate import Estimate
    from ._law import LawCurve


def plot(estimate: Estimate) -> Figure:
    """Draws a row for each parameter that has a standard error: the parts of its error."""
    from matplotlib.figure import Figure

    budget = estimate.to_dict()["error_budget"]
    shown = [i for i, p in enumerate(estimate.parameters) if p.standard_error is not None]
    figure = Figure(figsize=(7, 1.5 + 1.2 * max(len(shown), 1)), layout="constrained")
    axes = figure.subplots(max(len(shown), 1), 1, squeeze=False)[:, 0]
    figure.suptitle(f"{estimate.estimator}: {estimate.status}")
    for ax, i in zip(axes, shown):
        parameter = estimate.parameters[i]
        parts = {cause: part for cause, of in budget.items() if (part := _part(of, parameter.name, i))}
        ax.barh(list(parts), list(parts.values()), color="0.4")
        ax.invert_yaxis()
        ax.set_title(
            f"{parameter.label} = {parameter.value:.5g} +- {parameter.standard_error:.2g}",
            loc="left",
        )
        ax.set_xlabel("relative standard deviation" if parameter.is_modulus else "standard deviation")
    if not shown:
        axes[0].axis("off")
        axes[0].text(0, 0.5, estimate.message or "no standard errors", wrap=True)
    return figure


def plot_curve(curve: LawCurve) -> Figure:
    """Draws the stress of each test against the stretch.

    The volumetric test of rubber is so much stiffer than the others that it has an axis of its own.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7, 6), layout="constrained")
    of_shape, of_volume = figure.subplots(2, 1, sharex=True)
    figure.suptitle(curve.law)
    for style, test in zip(("-", "--", "-.", ":"), ("uniaxial", "equibiaxial", "pure_shear", "simple_shear")):
        of_shape.plot(curve.stretches, curve.stress[test], style, label=test.replace("_", " "))
    of_volume.plot(curve.stretches, curve.stress["volumetric"], label="volumetric")
    of_volume.set_xlabel("stretch")
    for ax in (of_shape, of_volume):
        ax.set_ylabel("force per undeformed area")
        ax.axhline(0, color="0.7", linewidth=0.8, zorder=0)
        ax.legend()
    return figure


def _part(errors: Any, name: str, place: int) -> float | None:
    """Returns what the report says of a parameter: by name of one material, in order of several."""
    if not errors:
        return None
    part: float | None = errors[name] if isinstance(errors, dict) else errors[place]
    return part
