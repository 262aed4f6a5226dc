"""active_contour: where scikit-image is right, within a pixel of it; where it is wrong, better."""

import numpy as np
import pytest
from skimage import data
from skimage.color import rgb2gray
from skimage.filters import gaussian
from skimage.segmentation import active_contour as reference

import pysnakes


def distance(a, b):
    return np.hypot(*(np.asarray(a) - np.asarray(b)).T).max()


def same(image, snake, within=0.05, **keywords):
    ours = pysnakes.active_contour(image, snake, **keywords)
    theirs = reference(image, snake, **keywords)
    assert ours.dtype == theirs.dtype and ours.shape == theirs.shape
    assert distance(ours, theirs) < within, distance(ours, theirs)
    return ours


def around(row, column, radius, count):
    turn = np.linspace(0, 2 * np.pi, count)
    return np.column_stack([row + radius * np.sin(turn), column + radius * np.cos(turn)])


def test_the_face_of_the_astronaut():
    image = gaussian(rgb2gray(data.astronaut()), sigma=3, preserve_range=False)
    same(image, around(100, 220, 100, 400), alpha=0.015, beta=10, gamma=0.001)


@pytest.mark.parametrize("condition", ["fixed", "fixed-fixed", "free", "free-free", "fixed-free", "free-fixed"])
def test_a_line_of_text(condition):
    image = gaussian(data.text(), sigma=1, preserve_range=False)
    snake = np.column_stack([np.linspace(136, 50, 100), np.linspace(5, 424, 100)])
    same(
        image, snake, boundary_condition=condition, alpha=0.1, beta=1.0, w_line=-5, w_edge=0, gamma=0.1,
        max_num_iter=300,
    )


def box(size=(100, 100)):
    image = np.zeros(size)
    image[40:60, 40:60] = 1.0
    return image


@pytest.mark.parametrize("kind", ["float64", "float32", "uint8", "uint16", "int16", "bool"])
def test_every_kind_of_number(kind):
    scale = 1 if kind in ("float64", "float32", "bool") else np.iinfo(kind).max
    smooth = gaussian(box(), sigma=3)
    image = (smooth > 0.5) if kind == "bool" else (smooth * scale).astype(kind)
    # of float32, scikit-image rounds every step to float32; along the jumps of a bool image a rounding grows
    steps = 20 if kind == "bool" else 2500
    same(image, around(50, 50, 35, 80), alpha=0.02, beta=0.5, gamma=0.01, w_edge=3, max_num_iter=steps, within=0.1)


def test_channels_are_added_up():
    grey = gaussian(box(), sigma=3)
    image = np.stack([grey, grey[::-1] * 0.5, grey.T * 0.3], axis=-1)
    same(image, around(50, 50, 30, 80), alpha=0.02, beta=0.5)
    same(image, around(50, 50, 30, 80), alpha=0.02, beta=0.5, w_line=0.1)


def test_at_the_border_of_the_image():
    rough = np.random.default_rng(3).random((60, 70))
    image = gaussian(rough, sigma=2)
    # the start reaches beyond the image on all sides
    same(image, around(30, 35, 45, 60), alpha=0.001, beta=0.4, gamma=0.05, max_num_iter=50, convergence=0)


def test_every_step_is_the_same_for_a_while():
    rough = gaussian(np.random.default_rng(7).random((120, 130)), sigma=3)
    for steps in (1, 2, 5, 20):
        same(rough, around(60, 65, 40, 100), max_num_iter=steps, convergence=0, within=1e-7, w_line=0.5)


def disc(radius=60.0, size=256, sigma=3.0):
    y, x = np.mgrid[:size, :size]
    return gaussian((np.hypot(x - size / 2, y - size / 2) < radius).astype(float), sigma=sigma)


@pytest.mark.parametrize("gamma", [0.05, 0.1, 0.5])
def test_a_snake_that_creeps_is_not_at_rest(gamma):
    image, start = disc(), around(128, 128, 75, 200)
    theirs = reference(image, start, gamma=gamma)
    ours = pysnakes.active_contour(image, start, gamma=gamma, max_num_iter=20_000)
    radius = lambda points: np.hypot(*(points - 128).T).mean()
    assert radius(theirs) > 74.5  # stopped at its start, fifteen pixels from the edge
    assert abs(radius(ours) - 60.0) < 1.0


@pytest.mark.parametrize("weights", [{}, {"alpha": 0.015, "beta": 10, "gamma": 0.001}])
def test_a_snake_of_few_points_does_not_collapse(weights):
    count = 25 if not weights else 50
    image, start = disc(), around(128, 128, 75, count + 1)[:-1]
    rules = {"max_num_iter": 8000, "convergence": 0.0 if not weights else 0.1} | weights
    theirs = reference(image, start, **rules)
    ours = pysnakes.active_contour(image, start, **rules)
    radius = lambda points: np.hypot(*(points - points.mean(axis=0)).T).mean()
    assert radius(theirs) < 5.0
    assert abs(radius(ours) - 60.0) < 2.0
    assert ours.shape == start.shape


def test_a_snake_that_nothing_holds_collapses_with_a_warning():
    with pytest.warns(RuntimeWarning, match="collapsed"):
        pysnakes.active_contour(np.zeros((200, 200)), around(100, 100, 60, 100), alpha=1.0, max_num_iter=20_000)


def test_what_makes_no_sense_is_refused():
    image, snake = box(), around(50, 50, 30, 50)
    for change, words in [
        ({"boundary_condition": "open"}, "boundary_condition"),
        ({"max_num_iter": 0}, "max_num_iter"),
        ({"gamma": 0.0}, "gamma"),
        ({"alpha": np.nan}, "alpha"),
        ({"alpha": -5.0}, "alpha"),
        ({"max_px_move": -1.0}, "max_px_move"),
        ({"convergence": -1.0}, "convergence"),
        ({"snake": snake[:4]}, "at least 5"),
        ({"snake": snake[:, :1]}, "shape"),
        ({"snake": np.full((9, 2), np.nan)}, "finite"),
        ({"image": image[:2]}, "3×3"),
        ({"image": image[0]}, "shape"),
        ({"image": np.ma.masked_less(image, 0.5)}, "masked"),
    ]:
        with pytest.raises(ValueError, match=words) as refused:
            pysnakes.active_contour(**({"image": image, "snake": snake} | change))
        assert "\n" not in str(refused.value)


def test_inputs_are_not_written_to():
    image, snake = box(), around(50, 50, 30, 50)
    before = image.copy(), snake.copy()
    pysnakes.active_contour(image, snake)
    assert (image == before[0]).all() and (snake == before[1]).all()
