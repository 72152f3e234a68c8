"""Estimates: they are those of the command line, may be stopped, and let other threads run."""

import base64
import json
import os
import re
import signal
import threading
import time

import numpy as np
import pytest
from conftest import SOURCE, block

import elastimate as em

ORGAN = SOURCE / "examples/scenes/organ.vtu"
BLOCK = SOURCE / "examples/block/scene.json"
REGIONS = SOURCE / "examples/three_regions/scene.json"


def without_times(report):
    """Returns a report without what another run of the same estimate changes."""
    if isinstance(report, dict):
        return {
            key: without_times(value)
            for key, value in report.items()
            if "seconds" not in key and key not in ("time", "times", "timings", "stages")
        }
    if isinstance(report, list):
        return [without_times(value) for value in report]
    return report


def assert_alike(got, expected, place="report"):
    if isinstance(expected, dict):
        assert got.keys() == expected.keys(), place
        for key in expected:
            assert_alike(got[key], expected[key], f"{place}.{key}")
    elif isinstance(expected, list):
        assert len(got) == len(expected), place
        for i, value in enumerate(expected):
            assert_alike(got[i], value, f"{place}[{i}]")
    elif isinstance(expected, float):
        assert got == pytest.approx(expected, rel=1e-12, nan_ok=True), place
    else:
        assert got == expected, place


@pytest.mark.parametrize("estimator", [name for name, _ in em.estimators()])
def test_every_estimator_gives_what_the_command_line_gives(estimator, command_line):
    expected = command_line("estimate", ORGAN, f"--estimator={estimator}", "--json=-")
    assert_alike(
        without_times(em.read(ORGAN).estimate(estimator).to_dict()), without_times(expected)
    )


@pytest.mark.parametrize(
    "scene, flags, options",
    [
        (ORGAN, ["--nu=0.3"], {"nu": 0.3}),
        (ORGAN, ["--nu_max=0.28", "--youngs_min=1"], {"nu_max": 0.28, "youngs_min": 1}),
        (ORGAN, ["--loss=huber", "--noise_sd=1e-4"], {"loss": "huber", "noise_sd": 1e-4}),
        (REGIONS, ["--order=2", "--origin=measured"], {"order": 2, "origin": "measured"}),
        (BLOCK, ["--refine=0", "--kinematics=small"], {"refine": "0", "kinematics": "small"}),
        (REGIONS, [], {}),
    ],
)
def test_options_are_those_of_the_command_line(scene, flags, options, command_line):
    expected = command_line("estimate", scene, "--estimator=iterative-fe", "--json=-", *flags)
    got = em.read(scene).estimate("iterative-fe", **options).to_dict()
    assert_alike(without_times(got), without_times(expected))


def test_arrays_give_what_a_file_of_them_gives(command_line, tmp_path):
    read = em.read(ORGAN)
    file = tmp_path / "simulated.vtu"
    command_line("simulate", ORGAN, "--youngs=5e4", "--nu=0.3", f"--out={file}", "--noise_sd=1e-5", "--seed=3")
    simulated = read.simulate(E=5e4, nu=0.3, noise_sd=1e-5, seed=3)
    expected = em.read(file)
    largest = np.abs(expected.displacements).max()
    np.testing.assert_allclose(
        simulated.displacements, expected.displacements, rtol=0, atol=1e-12 * largest
    )


def test_the_table_is_that_of_the_command_line(command_line):
    def lines(text):
        return [line for line in re.sub(r"[0-9.e-]+ s\b", "S", text).splitlines() if line]

    expected = command_line("estimate", BLOCK, "--estimator=auto")
    assert lines(str(em.read(BLOCK).estimate())) == lines(expected)


def test_parameters_and_their_errors(arrays):
    noisy = em.Scene(**arrays).simulate(E=1e4, nu=0.3, noise_sd=1e-5)
    estimate = noisy.estimate("iterative-fe")
    modulus = estimate["E"]
    assert estimate["youngs_modulus"].value == modulus.value
    assert abs(modulus.value - 1e4) < 5 * modulus.standard_error
    np.testing.assert_allclose(estimate.covariance[0, 0], modulus.standard_error**2, rtol=1e-12)
    lower, upper = modulus.interval
    assert lower < modulus.value < upper
    with pytest.raises(KeyError, match='"E", "nu"'):
        estimate["mu"]


def test_an_estimate_outlives_its_scene(arrays):
    covariance = em.Scene(**arrays).simulate(E=1e4, nu=0.3, noise_sd=1e-5).estimate("iterative-fe").covariance
    assert np.isfinite(covariance).all()
    assert not covariance.flags.writeable


def test_refused_estimates_say_why(arrays):
    scene = em.Scene(**arrays, displacements=-em.Scene(**arrays).simulate(E=1e4, nu=0.3).displacements)
    estimate = scene.estimate("closed-form")
    assert not estimate.is_usable
    assert estimate.status in ("not_identifiable", "unphysical")
    (error,) = [f for f in estimate.findings if f.severity == "error"]
    assert estimate.message == f"{error.text}; {error.advice}"
    assert estimate["E"].standard_error is None


def test_notebooks_and_figures(arrays):
    pytest.importorskip("matplotlib")
    estimate = em.Scene(**arrays).simulate(E=1e4, nu=0.3, noise_sd=1e-5).estimate("iterative-fe")
    assert f"{estimate['E'].value:.6g}" in estimate._repr_html_()
    figure = estimate.plot()
    assert len(figure.axes) == 2
    assert figure.axes[0].get_title(loc="left").startswith("E = ")
    assert any(bar.get_width() > 0 for bar in figure.axes[0].patches)
    json.dumps(estimate.to_dict())


def page_data(path):
    text = path.read_text()
    start = '<script type="application/json" id="data">'
    return json.loads(text[text.index(start) + len(start) :].split("</script>")[0])


def residuals(data):
    points = data["specimen"]["cases"][0]["points"]
    return np.frombuffer(base64.b64decode(points["residual"]), dtype="<f4")


def test_reports_are_pages_of_the_measurement(arrays, tmp_path):
    scene = em.Scene(**arrays).simulate(E=1e4, nu=0.3, noise_sd=1e-5)
    page = tmp_path / "page.html"
    with pytest.raises(ValueError, match="must end in .html"):
        scene.estimate("closed-form").report(tmp_path / "page.txt")
    with pytest.raises(ValueError, match="title=5; give a text, such as title='5'"):
        scene.estimate("closed-form").report(page, title=5)
    try:
        scene.estimate("iterative-fe", noise_sd=1e-5).report(page, "a cube")
    except ValueError as error:
        if "npm" not in str(error):
            raise
        pytest.skip(str(error))
    data = page_data(page)
    assert data["title"] == "a cube"
    assert data["command"] == f"scene.estimate('iterative-fe', noise_sd=1e-05).report({str(page)!r})"
    # A prepared estimator is of another measurement, from which the residuals are.
    prepared = em.Scene(**arrays).simulate(E=2e4, nu=0.3).prepare("iterative-fe", noise_sd=1e-5)
    prepared.run(scene.displacements).report(page)
    np.testing.assert_allclose(residuals(page_data(page)), residuals(data), rtol=1e-3, atol=1e-9)


def test_prepared_estimators_give_what_estimate_gives(arrays):
    frames = [
        em.Scene(**arrays).simulate(E=e, nu=0.3, noise_sd=1e-5, seed=i).displacements
        for i, e in enumerate([1e4, 2e4])
    ]
    prepared = em.Scene(**arrays).prepare("iterative-fe", noise_sd=1e-5)
    for u in frames:
        alone = em.Scene(**arrays, displacements=u).estimate("iterative-fe", noise_sd=1e-5)
        assert prepared.run(u)["E"].value == pytest.approx(alone["E"].value, rel=1e-6)
    with pytest.raises(ValueError):
        prepared.run(frames[0][:5])


def test_wrong_options_are_refused(arrays):
    scene = em.Scene(**arrays).simulate(E=1e4, nu=0.3)
    for options, sentence in [
        ({"loss": "square"}, "loss=\"square\"; it must be one of cauchy, huber, none"),
        ({"nu": 0.7}, "0.7"),
        ({"order": 3}, "order=3"),
        ({"origin": "x"}, "origin"),
    ]:
        with pytest.raises(ValueError, match=sentence):
            scene.estimate("iterative-fe", **options)
    with pytest.raises(ValueError, match="closed-form"):
        scene.estimate("guess")
    with pytest.raises(TypeError):
        scene.estimate("auto", unknown_option=1)
    with pytest.raises(ValueError, match="displacement"):
        em.Scene(**arrays).estimate("closed-form")


def large_scene(n):
    nodes, tets = block(n)
    pull = em.Traction([1000, 0, 3000], em.Box([0, 0, 0.1], [0.1, 0.1, 0.1]))
    held = em.Box([0, 0, 0], [0.1, 0.1, 0])
    return em.Scene(nodes, tets, supports=held, loads=[pull]).simulate(E=1e4, nu=0.3, noise_sd=1e-5)


@pytest.mark.parametrize("estimator", ["iterative-fe", "reduced-fe"])
def test_control_c_ends_a_fit(estimator):
    scene = large_scene(6)
    stopped = []

    def interrupt(count):
        stopped.append(count)
        os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        scene.estimate(estimator, on_factorization=interrupt)
    assert len(stopped) >= 1
    # What was stopped leaves nothing behind.
    assert scene.estimate(estimator).status == "ok"


def test_what_a_caller_raises_ends_a_fit():
    def refuse(count):
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        large_scene(3).estimate("iterative-fe", on_factorization=refuse)


def test_other_threads_run_during_a_fit():
    scene = large_scene(8)
    done = threading.Event()
    ticks = 0

    def estimate():
        scene.estimate("iterative-fe")
        done.set()

    thread = threading.Thread(target=estimate)
    start = time.perf_counter()
    thread.start()
    while not done.wait(0.001):
        ticks += 1
    thread.join()
    seconds = time.perf_counter() - start
    # A fit that kept the lock of the interpreter would leave one tick or two.
    assert ticks > 50 * seconds


def test_two_threads_estimate_the_same(arrays):
    scene = em.Scene(**arrays).simulate(E=1e4, nu=0.3, noise_sd=1e-5)
    expected = scene.estimate("iterative-fe")["E"].value
    found = []
    threads = [
        threading.Thread(target=lambda: found.append(scene.estimate("iterative-fe")["E"].value))
        for _ in range(4)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == pytest.approx([expected] * 4, rel=1e-9)
