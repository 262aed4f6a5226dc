"""Arrays go in where they are, or are converted, or are refused in one sentence."""

import numpy as np
import pytest

import pysnakes
from conftest import disc
from pysnakes import _core
from pysnakes._inputs import image_of

START = pysnakes.circle(50, 43, 25)
KINDS = ("uint8", "uint16", "float32", "float64", "bool")


def of_kind(kind):
    levels = disc()
    if kind == "bool":
        return levels > 120
    if kind == "uint16":
        return (levels * 257).astype(np.uint16)
    return levels.astype(kind)


LAYOUTS = {
    "C": lambda a: a,
    "Fortran": np.asfortranarray,
    "sliced": lambda a: np.repeat(np.repeat(a, 2, 0), 3, 1)[::2, ::3],
    "reversed": lambda a: np.ascontiguousarray(a[::-1, ::-1])[::-1, ::-1],
    "transposed": lambda a: np.ascontiguousarray(a.T).T,
    "a channel": lambda a: np.stack([a, a, a], axis=-1)[:, :, 1],
}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("layout", LAYOUTS)
def test_pixels_are_read_where_they_are(kind, layout):
    array = LAYOUTS[layout](of_kind(kind))
    array.flags.writeable = False
    made = image_of(array)
    assert made.address == array.__array_interface__["data"][0]
    assert made.shape == array.shape
    # and what is read there is what a plain copy holds
    assert pysnakes.fit(array, START) == pysnakes.fit(array.copy(), START)


def test_an_array_of_one_number_is_read_where_it_is():
    array = np.broadcast_to(np.uint8(7), (40, 50))
    assert array.strides == (0, 0)
    assert image_of(array).address == array.__array_interface__["data"][0]
    assert not pysnakes.fit(array, pysnakes.circle(25, 20, 8)).is_outline


def test_colors_are_read_where_they_are():
    array = np.stack([disc(low=90, high=90), disc(), disc(low=200, high=40)], axis=-1).astype(np.uint8)
    assert image_of(array).address == array.__array_interface__["data"][0]
    moved = np.moveaxis(np.ascontiguousarray(np.moveaxis(array, -1, 0)), 0, -1)
    assert image_of(moved).address == moved.__array_interface__["data"][0]
    assert pysnakes.fit(array, START) == pysnakes.fit(moved, START)
    assert pysnakes.fit(array, START).is_outline


@pytest.mark.parametrize("kind", ["int8", "int16", "uint32", "int64", "float16", ">u2", ">f4", ">f8", "longdouble"])
def test_other_numbers_are_converted(kind, bright):
    levels = np.round(bright / 2)
    found = pysnakes.fit(levels.astype(kind), START)
    assert found.is_outline
    assert abs(found.area - np.pi * 400) < 0.01 * np.pi * 400


def test_lists_and_whatever_has_an_array_are_converted(bright):
    class Tensor:
        """As torch's, which numpy asks for its array."""

        def __array__(self, dtype=None, copy=None):
            return bright

    assert pysnakes.fit(bright.tolist(), START.tolist()) == pysnakes.fit(bright, START)
    assert pysnakes.fit(Tensor(), START) == pysnakes.fit(bright, START)

    class Learning:
        """As torch's that need a gradient."""

        def __array__(self, dtype=None, copy=None):
            raise RuntimeError("Can't call numpy() on Tensor that requires grad. Use tensor.detach().numpy() instead.")

    with pytest.raises(TypeError, match="image must be .* got Learning: .*detach"):
        pysnakes.fit(Learning(), START)


def test_unaligned_arrays_are_copied(bright):
    record = np.zeros(bright.shape, dtype=[("a", "u1"), ("b", "f8")])
    record["b"] = bright
    view = record["b"]
    assert not view.flags.aligned
    assert pysnakes.fit(view, START) == pysnakes.fit(bright, START)


def test_masked_pixels_do_not_count(bright):
    spoiled = bright.copy()
    spoiled[5:9, 5:9] = np.nan
    masked = np.ma.masked_invalid(spoiled)
    by_mask = pysnakes.fit(spoiled, START, mask=np.isfinite(spoiled))
    assert by_mask == pysnakes.fit(masked, START)
    assert by_mask.is_outline


ODD = {
    "one axis": (np.zeros(5), ValueError, "shape"),
    "four axes": (np.zeros((2, 2, 2, 2)), ValueError, "shape"),
    "channels first": (np.zeros((3, 9, 20)), ValueError, "moveaxis"),
    "two channels": (np.zeros((9, 9, 2)), ValueError, "channels"),
    "empty": (np.zeros((0, 9)), ValueError, "at least one pixel"),
    "complex": (np.zeros((9, 9), complex), TypeError, "real numbers"),
    "objects": (np.array([["a"]], object), TypeError, "real numbers"),
    "text": ("picture.png", TypeError, "array of numbers"),
    "nothing": (None, TypeError, "array of numbers"),
    "a ragged list": ([[1, 2], [3]], TypeError, "array of numbers"),
    "dates": (np.zeros((9, 9), "M8[s]"), TypeError, "real numbers"),
    "fields": (np.zeros((9, 9), "f4,f4"), TypeError, "real numbers"),
}


@pytest.mark.parametrize("name", ODD)
def test_what_is_no_image_is_refused_in_one_sentence(name):
    image, kind, words = ODD[name]
    with pytest.raises(kind, match=words) as refused:
        pysnakes.fit(image, START)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("odd", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("kind", ["float32", "float64"])
def test_a_pixel_that_is_no_number_is_named(odd, kind, bright):
    image = bright.astype(kind)
    image[17, 31] = odd
    with pytest.raises(ValueError, match="row 17, column 31"):
        pysnakes.fit(image, START)
    with pytest.raises(ValueError, match="row 17, column 31"):
        pysnakes.active_contour(image, START[:, ::-1])


STARTS = {
    "outside": (pysnakes.circle(500, 500, 20), ValueError, "must lie in the image"),
    "not finite": ([(1, 2), (3, np.nan), (5, 5)], ValueError, "at point 1"),
    "two points": ([(1, 2), (3, 4)], ValueError, "at least 3"),
    "three columns": (np.zeros((9, 3)), ValueError, r"shape \(n, 2\)"),
    "empty": (np.zeros((0, 2)), ValueError, "at least 1"),
    "text": ("circle", TypeError, "array of numbers"),
    "a mask of another shape": (np.ones((5, 5), bool), ValueError, "shape of the image"),
    "an empty mask": (np.zeros((96, 96), bool), ValueError, "a pixel that is true"),
    "far outside": ([(1e300, 0), (48, 44), (50, 50)], ValueError, "beyond the picture"),
}


@pytest.mark.parametrize("name", STARTS)
def test_what_is_no_start_is_refused_in_one_sentence(name, bright):
    start, kind, words = STARTS[name]
    with pytest.raises(kind, match=words) as refused:
        pysnakes.fit(bright, start)
    assert "\n" not in str(refused.value)


def test_a_start_in_the_other_order_is_told_so():
    wide = disc(shape=(60, 400), center=(300.0, 30.0))
    start = pysnakes.circle(300, 30, 25)
    assert pysnakes.fit(wide, start).is_outline
    with pytest.raises(ValueError, match="row, column"):
        pysnakes.fit(wide, start[:, ::-1])


def test_options_are_checked_by_name(bright):
    for options, kind, words in [
        ({"sigmaa": 3}, TypeError, "no option"),
        ({"sigma": "wide"}, TypeError, "sigma must be a number"),
        ({"sigma": -1.0}, ValueError, "sigma"),
        ({"method": "magic"}, ValueError, "method"),
        ({"forces": ["gvff"]}, ValueError, "did you mean"),
        ({"polarity": "up"}, ValueError, "polarity"),
    ]:
        with pytest.raises(kind, match=words):
            pysnakes.fit(bright, START, **options)


def test_the_compiled_part_refuses_what_the_package_would_have_converted():
    with pytest.raises(TypeError, match="uint8"):
        _core.Image(np.zeros((4, 4), np.int64), 1.0)


def test_the_range_of_levels_does_not_matter(bright):
    mask = pysnakes.fit(bright, START).to_mask()
    whole = np.round(bright).astype(np.uint8)
    words = whole.astype(np.uint16)
    for other in (bright / 255, bright / 2550, bright * 1000, words * 257, words * 16):
        found = pysnakes.fit(other, START)
        assert found.is_outline and (found.to_mask() != mask).sum() <= 4
