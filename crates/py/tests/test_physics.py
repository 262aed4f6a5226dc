"""Scenes, simulations, tracks, fields, exact motion: against formulas and against each other."""

import pickle

import numpy as np
import pytest

import pysnakes
from conftest import disc


def test_every_scene_that_comes_with_the_package_has_a_title():
    assert "apple" in pysnakes.scene_names()
    for name in pysnakes.scene_names():
        assert pysnakes.Scene.load(name).title


def test_a_scene_runs_and_shows_its_steps():
    scene = pysnakes.Scene.load("soft-ball").with_values(run__steps=120)
    seen = []
    record = scene.run(lambda t, step, points: seen.append((t, step, points)), every=10)
    assert record.outcome == "finished" and "120 steps" in record.reason
    assert [step for _, step, _ in seen] == list(range(10, 121, 10))
    assert (seen[-1][2] == record.last.points).all()
    assert record.last.t == pytest.approx(seen[-1][0])
    # stepped by hand it is the same to the last bit
    simulation = scene.simulation()
    times = []
    assert simulation.run(120, lambda now: times.append(now.t), every=30) is None
    assert (simulation.points == record.last.points).all() and len(times) == 4
    assert simulation.steps == 120


def test_an_observer_ends_a_run_and_its_errors_are_raised():
    scene = pysnakes.Scene.load("soft-ball")
    record = scene.run(lambda t, step, points: step < 7)
    assert record.outcome == "stopped" and record.last.step == 7

    def fail(t, step, points):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        scene.run(fail)
    with pytest.raises(ValueError, match="every"):
        scene.run(every=0)


def test_simulations_are_copied_and_their_nodes_held():
    simulation = pysnakes.Scene.load("soft-ball").simulation()
    simulation.step(50)
    other = simulation.copy()
    other.hold([0])
    held = other.points[0].copy()
    simulation.step(100)
    other.step(100)
    assert (other.points[0] == held).all() and not (simulation.points[0] == held).all()
    assert "total" in simulation.energies
    with pytest.raises(ValueError):
        other.hold([10_000])


def test_scenes_are_texts_that_pickle():
    scene = pysnakes.Scene.load("rigid-ball").with_values(run__steps=50)
    again = pickle.loads(pickle.dumps(scene))
    assert again.source == scene.source
    assert (again.run().last.points == scene.run().last.points).all()
    with pytest.raises(ValueError, match="did you mean"):
        pysnakes.Scene.load("soft-bal")
    with pytest.raises(ValueError):
        pysnakes.Scene.parse("title = 3")
    with pytest.raises(ValueError):
        scene.with_values(run__stepz=3)


def test_a_mode_of_a_ring_swings_as_its_oscillator():
    n, radius, size = 64, 10.0, 0.3
    turn = 2 * np.pi * np.arange(n) / n
    circle = radius * np.column_stack([np.cos(turn), np.sin(turn)])
    # the third wave along x and y: an eigenvector of every circulant matrix
    wave = size * np.column_stack([np.cos(3 * turn), np.sin(3 * turn)])
    mass, damping, tether, tension = 1.3, 0.4, 0.2, 5.0
    h = 2 * radius * np.sin(np.pi / n)
    stiffness = tether + tension * (2 - 2 * np.cos(6 * np.pi / n)) / h**2
    times = np.array([0.0, 0.7, 3.0, 11.0])
    found = pysnakes.ring(circle + wave, times, rest=circle, tether=tether, tension=tension, mass=mass, damping=damping)
    fade, omega = damping / (2 * mass), np.sqrt(stiffness / mass - (damping / (2 * mass)) ** 2)
    share = np.exp(-fade * times) * (np.cos(omega * times) + fade / omega * np.sin(omega * times))
    exact = circle + share[:, None, None] * wave
    assert np.abs(found - exact).max() < 1e-10
    with pytest.raises(ValueError, match="times"):
        pysnakes.ring(circle, [-1.0])
    with pytest.raises(ValueError, match="as many points"):
        pysnakes.ring(circle, [1.0], rest=circle[:-1])


def test_damping_has_three_regimes():
    critical = pysnakes.critical_damping(2.0, 8.0)
    assert critical == 8.0
    assert [pysnakes.regime(2.0, d, 8.0) for d in (0.0, 7.9, 8.0, 8.1)] == [
        "undamped", "underdamped", "critical", "overdamped",
    ]
    with pytest.raises(ValueError):
        pysnakes.critical_damping(-1.0, 1.0)
    with pytest.raises(ValueError):
        pysnakes.regime(1.0, float("nan"), 1.0)


def test_a_certificate_says_when_a_curve_rings_and_how_long_a_step_may_be():
    circle = pysnakes.circle(0, 0, 10)
    found = pysnakes.certificate(circle, tether=0.5, tension=3.0, mass=1.0, damping=0.1)
    assert found.nodes == 64 and found.complete
    assert (found.damping_ratio < 1).any() and "ring" in repr(found)
    # leapfrog: two over the highest frequency
    limit = found.step_limits["leapfrog"]
    assert limit == pytest.approx(2 / found.elastic, rel=0.01)
    assert found.step_limits["exact"] is None
    assert "largest step" in str(pysnakes.Scene.load("apple").certificate())


def test_a_force_is_minus_the_slope_of_its_energy():
    image = disc((90, 90), (45, 45), 20)
    smooth = {"sigma": 3.0}
    for kind, parameters in [("edge", smooth), ("line", smooth), ("distance", {}), ("gvf", {}), ("vfc", {})]:
        force, energy = pysnakes.force_field(image, kind, energy=True, **parameters)
        assert force.shape == (90, 90, 2) and np.isfinite(force).all()
        if kind in ("edge", "line"):
            down, along = np.gradient(energy)
            inner = (slice(5, -5), slice(5, -5))
            slope = -np.stack([along, down], axis=-1)
            assert np.abs(force - slope)[inner].max() < 0.1 * np.abs(force).max()
    with pytest.raises(ValueError, match="kind"):
        pysnakes.force_field(image, "magic")
    with pytest.raises(TypeError, match="no keyword"):
        pysnakes.force_field(image, "edge", knee=3.0)
    with pytest.raises(ValueError, match="sigma"):
        pysnakes.force_field(image, "edge", sigma=-3.0)


def frames(count=12):
    for t in range(count):
        yield disc((80, 140), (30.0 + 4 * t, 40.0), 14.0)


def test_a_disc_is_followed():
    tracked = list(pysnakes.track(frames(), pysnakes.circle(30, 40, 14)))
    assert [one.frame for one in tracked] == list(range(12))
    for t, one in enumerate(tracked):
        outline = one[1]
        assert outline.state == "seen"
        assert np.hypot(*(outline.points.mean(axis=0) - (30 + 4 * t, 40))) < 0.5
    assert tracked[0].events[0].what == "begun"
    assert tracked[-1][1].velocity[0] == pytest.approx(4.0, abs=0.2)
    assert pickle.loads(pickle.dumps(tracked[3][1])).id == 1
    assert tracked[3][1].to_mask((80, 140)).sum() == pytest.approx(np.pi * 14**2, rel=0.05)
    with pytest.raises(KeyError):
        tracked[0][7]


def test_frames_come_one_by_one_and_are_of_one_size():
    asked = []

    def counted():
        for index, frame in enumerate(frames()):
            asked.append(index)
            yield frame

    following = pysnakes.track(counted(), pysnakes.circle(30, 40, 15))
    next(following), next(following)
    assert asked == [0, 1]
    with pytest.raises(ValueError, match="at least one frame"):
        pysnakes.track([], pysnakes.circle(30, 40, 15))
    with pytest.raises(ValueError, match="80"):
        list(pysnakes.track([next(frames()), np.zeros((10, 10))], pysnakes.circle(30, 40, 15)))


def test_several_objects_are_followed():
    def two():
        for t in range(6):
            yield np.maximum(disc((90, 160), (30.0 + 3 * t, 30.0), 12), disc((90, 160), (120.0 - 3 * t, 62.0), 12))

    tracked = list(pysnakes.track(two(), [pysnakes.circle(30, 30, 13), pysnakes.circle(120, 62, 13)]))
    assert [outline.id for outline in tracked[-1].outlines] == [1, 2]
    assert tracked[-1][2].points.mean(axis=0)[0] == pytest.approx(105, abs=0.6)


def test_outlines_are_layers_of_napari():
    from pysnakes.napari import get_reader, shapes_layer, starts_of

    found = pysnakes.fit(disc(), pysnakes.circle(50, 43, 25))
    data, keywords, kind = shapes_layer([found])
    assert kind == "shapes" and keywords["shape_type"] == ["polygon"]
    assert (data[0] == found.coords).all()

    class Layer:
        """What napari hands out: (row, column) in float32."""

    layer = Layer()
    layer.data = [data[0].astype(np.float32)]
    assert pysnakes.fit(disc(), starts_of(layer)[0]).is_outline
    assert get_reader("image.png") is None and get_reader(["a.geojson"]) is not None
