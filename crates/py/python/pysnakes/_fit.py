"""The outline that a start is drawn around."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from . import _core
from ._inputs import ArrayLike, image_of, start_of
from ._outline import Outline

_OPTIONS = """
    method : {"search", "motion"}
        ``"search"`` (the default): the best curve near the start, by searches, then to a fraction of a pixel.
        ``"motion"``: an elastic curve moves from the start until it rests. What follows is of a motion only, but for
        `nodes` and `spacing`.
    nodes : int
        So many nodes. One a pixel of the outline if not given.
    spacing : float
        A node for each so many pixels of the start.
    tether, tension, rigidity : float
        How hard a node is held to its place in the start's shape, and how hard the curve resists stretching and
        bending out of it. M T⁻², M L² T⁻², M L⁴ T⁻²; 0, 20, 100.
    damping : float
        M T⁻¹; 2.
    sigma : float
        Width of the Gaussian that smooths the image. Pixels; √10.
    strength : float
        Pull of an edge as high as the image's contrast; 1.
    forces : list of str
        Forces by name instead of the edge force, each with a weight behind a colon: ``["gvf", "edge:0.5"]``; then the
        method is ``"motion"`` unless said otherwise.
    polarity : {"either", "dark-to-bright", "bright-to-dark"}
        Which edges attract, going outwards.
    balloon : float
        Pressure inside: above 0 it grows.
    step : float
        Steps of this length. T.
    steps : int
        Steps at most.
"""


def _with_options(function: Any) -> Any:
    if function.__doc__:
        function.__doc__ = function.__doc__.replace("    **options\n", _OPTIONS.lstrip("\n"))
    return function


@_with_options
class Prepared:
    """An image made ready for fits, for any number of starts.

    Parameters
    ----------
    image : array_like of shape (rows, columns) or (rows, columns, 3 or 4)
        Grey or color. Arrays of uint8, uint16, float32, float64 and bool are read where they are, with any strides;
        others are converted. They must not be written to while fits run.
    mask : array_like of bool, optional
        True where a pixel counts. That of a masked array is taken too.
    **options

    Raises
    ------
    TypeError
        An image that is no array of real numbers; an option that there is not.
    ValueError
        An image of another shape, without a pixel, with numbers that are not finite; an option out of its range.
    """

    def __init__(self, image: ArrayLike, *, mask: ArrayLike | None = None, **options: Any) -> None:
        self._image = image_of(image, mask)
        self._prepared = _core.Prepared(self._image, options)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self._image.shape

    def fit(self, start: ArrayLike, *, closed: bool = True) -> Outline:
        """Fit one start; see :func:`fit`."""
        points = start_of(start, self.shape)
        return Outline._of(self._prepared.fit(points, closed), self.shape)

    def __repr__(self) -> str:
        rows, columns = self.shape
        return f"<Prepared image of {rows} rows and {columns} columns>"


@_with_options
def fit(
    image: ArrayLike, start: ArrayLike, *, closed: bool = True, mask: ArrayLike | None = None, **options: Any
) -> Outline:
    """Find the outline of the object that a start is drawn around.

    Parameters
    ----------
    image : array_like of shape (rows, columns) or (rows, columns, 3 or 4)
        Grey or color. Arrays of uint8, uint16, float32, float64 and bool are read where they are, with any strides;
        others are converted. They must not be written to meanwhile.
    start : array_like
        Where to look, in one of these forms: points (x, y) of shape (n, 2) drawn roughly around the object; one point
        (x, y) inside it; a mask of bool of the image's shape; an :class:`Outline`.
    closed : bool
        Whether the outline is closed. Open ones are found between the ends of the start.
    mask : array_like of bool, optional
        True where a pixel counts. That of a masked array is taken too.
    **options

    Returns
    -------
    Outline
        Also where nothing was found: ask :attr:`Outline.is_outline` and :attr:`Outline.reason`.

    Raises
    ------
    TypeError
        An image or a start that is no array of real numbers; an option that there is not.
    ValueError
        An image of another shape, without a pixel, with numbers that are not finite; a start outside the image; an
        option out of its range.

    Notes
    -----
    The lock of Python is released, Ctrl-C is obeyed, and the result is the same to the last bit whatever runs beside
    it. How it works and how good it is: ``docs/finder.md`` of the project.

    Examples
    --------
    >>> import numpy as np, pysnakes
    >>> y, x = np.mgrid[:96, :96]
    >>> disc = np.clip(20.5 - np.hypot(x - 48, y - 44), 0, 1)
    >>> found = pysnakes.fit(disc, pysnakes.circle(50, 43, 25))
    >>> found.is_outline, abs(found.area / (np.pi * 400) - 1) < 0.01
    (True, True)
    """
    return Prepared(image, mask=mask, **options).fit(start, closed=closed)


@_with_options
def fit_many(
    image: ArrayLike,
    starts: Sequence[ArrayLike],
    *,
    closed: bool = True,
    mask: ArrayLike | None = None,
    threads: int | None = None,
    errors: str = "raise",
    **options: Any,
) -> Iterator[Outline]:
    """Fit many starts on several threads.

    Parameters
    ----------
    image : array_like or list of array_like
        One image for all starts, as in :func:`fit`, or a list with one for each.
    starts : sequence
        Starts as in :func:`fit`.
    closed : bool
        Whether outlines are closed.
    mask : array_like of bool, optional
        As in :func:`fit`, of one image.
    threads : int, optional
        As many as there are cores if not given. Results do not depend on it.
    errors : {"raise", "skip"}
        What to do where a start is refused: stop there, or go on and give None for it.
    **options

    Yields
    ------
    Outline
        In the order of the starts, each as soon as it and all before it are there.

    Raises
    ------
    TypeError, ValueError
        As :func:`fit`.
    """
    if threads is None:
        threads = os.cpu_count() or 1
    if threads < 1:
        raise ValueError(f"threads must be at least 1, got {threads}")
    if errors not in ("raise", "skip"):
        raise ValueError(f"errors must be 'raise' or 'skip', got {errors!r}")
    if isinstance(image, (list, tuple)) and image and np.ndim(image[0]) >= 2:
        if len(image) != len(starts):
            raise ValueError(f"a list of images must have one for each start, got {len(image)} and {len(starts)}")
        images = [image_of(one, name=f"image {index}") for index, one in enumerate(image)]
        which = list(range(len(images)))
    else:
        images, which = [image_of(image, mask)], [0] * len(starts)
    points = [start_of(start, images[at].shape, f"start {i}") for i, (start, at) in enumerate(zip(starts, which))]
    batch = _core.Batch(images, which, points, closed, options, threads)
    return _answers(batch, [images[at].shape for at in which], errors)


def _answers(batch: _core.Batch, shapes: list[tuple[int, int]], errors: str) -> Iterator[Outline]:
    for index, (found, refusal) in enumerate(batch):
        if found is not None:
            yield Outline._of(found, shapes[index])
        elif errors == "raise":
            raise ValueError(f"start {index}: {(refusal or '').removeprefix('start: ')}")
        else:
            yield None  # type: ignore[misc]
