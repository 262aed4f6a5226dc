"""scikit-image's ``active_contour``, faster."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._inputs import ArrayLike, array_of, readable

_CONDITIONS = ("periodic", "free", "fixed", "free-fixed", "fixed-free", "fixed-fixed", "free-free")


def active_contour(
    image: ArrayLike,
    snake: ArrayLike,
    alpha: float = 0.01,
    beta: float = 0.1,
    w_line: float = 0,
    w_edge: float = 1,
    gamma: float = 0.01,
    max_px_move: float = 1.0,
    max_num_iter: int = 2500,
    convergence: float = 0.1,
    *,
    boundary_condition: str = "periodic",
) -> npt.NDArray[Any]:
    """Active contour model, with the signature and the coordinates of ``skimage.segmentation.active_contour``.

    Parameters
    ----------
    image : array_like of shape (M, N) or (M, N, C)
        Grey or with channels. Integers are brought to 0 … 1 (−1 … 1 if signed) by the range of their type, floats are
        taken as they are.
    snake : array_like of shape (P, 2)
        Where it starts: (row, column) of each point.
    alpha : float
        Tension: higher values make it contract faster.
    beta : float
        Rigidity: higher values make it smoother.
    w_line : float
        Attraction to brightness; negative values attract towards dark regions.
    w_edge : float
        Attraction to edges; negative values repel.
    gamma : float
        One over the step in time, above 0.
    max_px_move : float
        The longest way of a point in a step. Pixels.
    max_num_iter : int
        Steps at most.
    convergence : float
        It is at rest when it is nearer than this to where it was in the last ten steps, and does not drift. Pixels.
    boundary_condition : {"periodic", "free", "fixed", "free-fixed", "fixed-free", "fixed-fixed", "free-free"}
        Whether it is closed, and what its ends do if not: the first word is of the first point.

    Returns
    -------
    ndarray of shape (P, 2)
        Points (row, column): float32 for an image of float32 or float16, else float64.

    Raises
    ------
    TypeError
        An image or a snake that is no array of real numbers.
    ValueError
        Numbers that are not finite, too few points, a parameter out of its range.

    Warns
    -----
    RuntimeWarning
        Where the snake has collapsed onto a point.

    Notes
    -----
    The method is that of [1]_, and where scikit-image comes to rest this does so within a pixel. What differs, and
    why, is in ``docs/python.md`` of the project.

    References
    ----------
    .. [1] Kass, M.; Witkin, A.; Terzopoulos, D. "Snakes: Active contour models". International Journal of Computer
       Vision 1 (4): 321 (1988). :DOI:`10.1007/BF00133570`
    """
    if boundary_condition not in _CONDITIONS:
        raise ValueError(f"boundary_condition must be one of {', '.join(_CONDITIONS)}, got {boundary_condition!r}")
    if max_num_iter <= 0:
        raise ValueError(f"max_num_iter must be above 0, got {max_num_iter}")
    if isinstance(image, np.ma.MaskedArray) and np.ma.getmaskarray(image).any():
        raise ValueError("image must have no masked pixels; fill them, or use pysnakes.fit, which leaves them out")
    pixels = array_of(image, "image")
    if pixels.ndim not in (2, 3):
        raise ValueError(f"image must have the shape (rows, columns) or (rows, columns, channels), got {pixels.shape}")
    start = array_of(snake, "snake")
    if start.ndim != 2 or start.shape[1] != 2:
        raise ValueError(f"snake must have the shape (n, 2), a row (row, column) for each point, got {start.shape}")
    unit = 1.0 / float(np.iinfo(pixels.dtype).max) if pixels.dtype.kind in "ui" else 1.0
    narrow = pixels.dtype.kind == "f" and pixels.dtype.itemsize <= 4
    numbers = [alpha, beta, w_line, w_edge, gamma, max_px_move, convergence]
    xy = np.ascontiguousarray(start[:, ::-1], dtype=np.float64)
    points, _, _, _, collapsed = _core.active_contour(
        readable(pixels), xy, [float(number) for number in numbers], int(max_num_iter), boundary_condition, unit
    )
    if collapsed:
        warnings.warn(
            "the snake has collapsed onto a point: no edge holds it against alpha and beta",
            RuntimeWarning,
            stacklevel=2,
        )
    return points[:, ::-1].astype(np.float32 if narrow else np.float64, order="C")
