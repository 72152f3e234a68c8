"""Laws that are written in Python."""

import threading

import numpy as np
import pytest

import elastimate as em


class Isotropic(em.Law):
    """Isotropic elasticity, P = 2 mu e + lambda tr(e) I, by other means than the library's."""

    name = "python_isotropic"
    description = "isotropic elasticity, for a test"
    parameters = [em.LawParameter("lame_mu", "mu"), em.LawParameter("lame_lambda", "lambda")]

    def stresses(self, gradient, section):
        strain = (gradient + gradient.T) / 2
        return np.stack([2 * strain, np.trace(strain) * np.eye(len(strain))])


class Skewed(Isotropic):
    name = "skewed"

    def stresses(self, gradient, section):
        stresses = Isotropic.stresses(self, gradient, section)
        stresses[1, 0, 1] += gradient[0, 1] ** 2
        return stresses


def test_a_law_gives_what_that_of_the_library_gives(arrays):
    E, nu = 1e4, 0.3
    mu, lame = E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu))
    assert em.check_law(Isotropic()) == []
    em.register_law(Isotropic())
    assert "python_isotropic" in [law.name for law in em.laws()]
    scene = em.Scene(**arrays, materials=[em.Material("python_isotropic")])
    built_in = em.Scene(**arrays).simulate(E=E, nu=nu, noise_sd=1e-5)
    simulated = scene.simulate({"mu": mu, "lambda": lame}, noise_sd=1e-5)
    np.testing.assert_allclose(simulated.displacements, built_in.displacements, rtol=1e-9, atol=1e-12)

    estimate = simulated.estimate("iterative-fe")
    expected = built_in.estimate("iterative-fe")
    m, l = estimate["mu"].value, estimate["lambda"].value
    assert m * (3 * l + 2 * m) / (l + m) == pytest.approx(expected["E"].value, rel=1e-6)
    assert l / (2 * (l + m)) == pytest.approx(expected["nu"].value, rel=1e-6)


def test_laws_are_listed_and_registered_while_another_thread_calls_one(arrays):
    class Other(Isotropic):
        name = "other"

    class Third(Isotropic):
        name = "third"

    em.register_law(Other())
    scene = em.Scene(**arrays, materials=[em.Material("other")]).simulate({"mu": 1, "lambda": 2})
    found = []
    threads = [
        threading.Thread(target=lambda: found.append(scene.estimate("closed-form")["mu"].value))
        for _ in range(3)
    ]
    for thread in threads:
        thread.start()
    em.register_law(Third())
    while any(thread.is_alive() for thread in threads):
        assert "third" in [law.name for law in em.laws()]
    assert found == pytest.approx([1, 1, 1], rel=1e-9)


def test_wrong_laws_are_refused():
    assert em.check_law(Skewed()) != []
    with pytest.raises(ValueError, match="skewed"):
        em.register_law(Skewed())
    with pytest.raises(ValueError, match="has no name"):
        em.register_law(em.Law())


# A closed form: a column of Hooke's law is as stiff as E, whatever the law is called that turns with it.
def test_the_curve_of_a_law():
    curve = em.law_curve("corotated", stretches=[0.5, 1, 2], youngs_modulus=10, poisson_ratio=0.25)
    assert np.allclose(curve.stress["uniaxial"], [-5, 0, 10])
    assert sorted(curve.stress) == ["equibiaxial", "pure_shear", "simple_shear", "uniaxial", "volumetric"]
    figure = em.law_curve("st_venant_kirchhoff", youngs_modulus=1, poisson_ratio=0.45).plot()
    assert [len(ax.lines) for ax in figure.axes] == [5, 2]


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: em.law_curve("rubber"), "one of three dimensions"),
        (lambda: em.law_curve("corotated", youngs_modulus=1), "corotated needs poisson_ratio as well"),
        (lambda: em.law_curve("corotated", c10=1), "has no parameter c10"),
        (
            lambda: em.law_curve("corotated", stretches=[0], youngs_modulus=1, poisson_ratio=0.25),
            "a stretch is 0; it must be positive",
        ),
    ],
)
def test_the_curve_of_no_material_is_refused(call, sentence):
    with pytest.raises(ValueError, match=sentence):
        call()
