"""Curves to start from."""

from __future__ import annotations

from . import _core
from ._inputs import Floats


def _above(**values: float) -> None:
    for name, number in values.items():
        if not number > 0.0 or number == float("inf"):
            raise ValueError(f"{name} must be finite and above 0, got {number}")


def circle(x: float, y: float, radius: float) -> Floats:
    """A circle of 64 points.

    Parameters
    ----------
    x, y : float
        Its center. Pixels.
    radius : float
        Its radius, above 0. Pixels.

    Returns
    -------
    ndarray of shape (64, 2)
        Points (x, y).
    """
    _above(radius=radius)
    return _core.curve("ellipse", (x, y), (radius, radius))


def ellipse(x: float, y: float, rx: float, ry: float) -> Floats:
    """An ellipse with its axes along x and y, of 64 points.

    Parameters
    ----------
    x, y : float
        Its center. Pixels.
    rx, ry : float
        Its half axes, above 0. Pixels.

    Returns
    -------
    ndarray of shape (64, 2)
        Points (x, y).
    """
    _above(rx=rx, ry=ry)
    return _core.curve("ellipse", (x, y), (rx, ry))


def rectangle(x: float, y: float, width: float, height: float) -> Floats:
    """A rectangle with points along its sides.

    Parameters
    ----------
    x, y : float
        Its upper left corner. Pixels.
    width, height : float
        Its size, above 0. Pixels.

    Returns
    -------
    ndarray of shape (32, 2)
        Points (x, y).
    """
    _above(width=width, height=height)
    return _core.curve("rectangle", (x, y), (x + width, y + height))
