"""Pictures and outlines of files, and those that come with the package."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._inputs import Floats, points_of


def picture(name: str) -> npt.NDArray[Any]:
    """A picture that comes with the package: "apple" or "disturbing-edge".

    Returns
    -------
    ndarray of shape (rows, columns) or (rows, columns, 3)
    """
    return _core.picture(name)


def contour(name: str) -> Floats:
    """A contour that comes with the package, such as "apple-whole-without-the-stem": points (x, y)."""
    return _core.contour(name)


def read_image(path: str | os.PathLike[str]) -> npt.NDArray[Any]:
    """Read a picture file: PNG, JPEG, TIFF, WebP, PGM, PPM, PFM.

    Returns
    -------
    ndarray
        Grey of shape (rows, columns): uint8, or float64 levels from 0 to 255 where it is deeper; color of shape
        (rows, columns, 3) in uint8.

    Raises
    ------
    ValueError
        A file that cannot be read, by its name.
    """
    return _core.load_picture(os.fspath(path))


def load_outlines(path: str | os.PathLike[str]) -> list[Floats]:
    """Read outlines of a file: CSV, GeoJSON, COCO, ImageJ, SVG, labelme, CVAT, masks, labels.

    Returns
    -------
    list of ndarray of shape (n, 2)
        Points (x, y) of each ring.

    Raises
    ------
    ValueError
        A file that cannot be read, by its name.
    """
    return [points for points, _, _ in _core.load_outlines(os.fspath(path))]


_ENDINGS = {".csv": "csv", ".geojson": "geojson", ".json": "geojson", ".roi": "roi", ".zip": "imagej",
            ".svg": "svg", ".png": "labels", ".tif": "deep-labels", ".tiff": "deep-labels"}


def save_outlines(
    path: str | os.PathLike[str],
    outlines: Iterable[Any],
    *,
    format: str | None = None,
    shape: tuple[int, int] | None = None,
) -> None:
    """Write outlines into one file.

    Parameters
    ----------
    path : str or path
        Its ending says the format where `format` does not.
    outlines : iterable
        Outlines, or arrays of points (x, y).
    format : {"csv", "geojson", "coco", "imagej", "roi", "svg", "labelme", "mask", "labels", "deep-labels"}, optional
        The format.
    shape : tuple of int, optional
        Rows and columns of the image; that of the first outline if not given.

    Raises
    ------
    ValueError
        An ending that says no format; what the format cannot hold.
    """
    path = os.fspath(path)
    ending = os.path.splitext(path)[1].lower()
    chosen = format or _ENDINGS.get(ending)
    if chosen is None:
        raise ValueError(f"format must be given for a file that ends in {ending!r}")
    rows = []
    for index, outline in enumerate(outlines):
        points = points_of(getattr(outline, "points", outline), f"outline {index}")
        rows.append((points, bool(getattr(outline, "closed", True)), str(index + 1)))
        shape = shape or _shape(outline)
    size = (shape[1], shape[0]) if shape is not None else (0, 0)
    data = _core.written(rows, chosen, size)
    part = f"{path}.part"
    with open(part, "wb") as file:
        file.write(data)
    os.replace(part, path)


def _shape(outline: Any) -> tuple[int, int] | None:
    if isinstance(outline, np.ndarray):
        return None
    shape = getattr(outline, "shape", None)
    return shape if isinstance(shape, tuple) and len(shape) == 2 else None
