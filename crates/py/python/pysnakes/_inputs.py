"""What users pass, as the compiled part takes it: arrays where they are, or a refusal in one sentence."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from . import _core

ArrayLike: TypeAlias = Any
"""An array, or anything that numpy makes one of: lists, tensors with ``__array__``."""

Floats: TypeAlias = npt.NDArray[np.float64]

_DIRECT = ("uint8", "uint16", "float32", "float64")


def array_of(value: ArrayLike, name: str) -> npt.NDArray[Any]:
    """An array of numbers."""
    if value is None or isinstance(value, (str, bytes, dict)):
        raise TypeError(f"{name} must be an array of numbers, got {type(value).__name__}")
    try:
        array = np.asarray(value)
    except (ValueError, TypeError, RuntimeError) as error:
        # of tensors that are no arrays, as those that need a gradient, theirs says what would do
        why = (str(error).splitlines() or [""])[0]
        raise TypeError(f"{name} must be an array of numbers, got {type(value).__name__}: {why}") from None
    if array.dtype.kind not in "buif":
        raise TypeError(f"{name} must be an array of real numbers, got dtype {array.dtype}")
    return array


def readable(array: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """The same array if the compiled part can read it where it is; else a copy of the nearest kind.

    uint8, uint16, float32 and float64 are read as they lie in memory, with any strides; bool as bytes.
    """
    if array.dtype.kind == "b":
        array = array.view(np.uint8)
    if array.dtype.name not in _DIRECT:
        array = array.astype(np.float32 if array.dtype == np.float16 else np.float64)
    elif not array.dtype.isnative:
        array = array.astype(array.dtype.newbyteorder("="))
    size = array.dtype.itemsize
    if not array.flags.aligned or any(stride % size for stride in array.strides):
        array = array.copy()
    return array


def _masked(image: ArrayLike, mask: ArrayLike | None) -> tuple[ArrayLike, npt.NDArray[np.bool_] | None]:
    """An image without its mask, and which of its pixels count."""
    valid = None
    if mask is not None:
        valid = array_of(mask, "mask")
        if valid.dtype.kind != "b":
            raise TypeError(f"mask must be an array of bool, true where a pixel counts, got dtype {valid.dtype}")
    if isinstance(image, np.ma.MaskedArray):
        hidden: npt.NDArray[np.bool_] = np.ma.getmaskarray(image)
        if hidden.ndim == 3:
            hidden = np.logical_or.reduce(hidden, axis=2)
        if hidden.any():
            valid = ~hidden if valid is None else np.logical_and(valid, ~hidden)
        image = image.data
    return image, valid


def image_of(image: ArrayLike, mask: ArrayLike | None = None, name: str = "image") -> _core.Image:
    """An image whose pixels are read where they are."""
    if isinstance(image, _core.Image):
        return image
    image, valid = _masked(image, mask)
    array = array_of(image, name)
    if array.ndim == 3 and array.shape[2] == 1:
        array = array[:, :, 0]
    if not (array.ndim == 2 or (array.ndim == 3 and array.shape[2] in (3, 4))):
        first = array.ndim == 3 and array.shape[0] in (1, 3, 4)
        hint = f"; channels come last, so pass numpy.moveaxis({name}, 0, -1) if they are first" if first else ""
        raise ValueError(
            f"{name} must have the shape (rows, columns) or (rows, columns, 3 or 4 channels), got {array.shape}{hint}"
        )
    if array.size == 0:
        raise ValueError(f"{name} must have at least one pixel, got the shape {array.shape}")
    if valid is not None and valid.shape != array.shape[:2]:
        raise ValueError(f"mask must have the shape of the image, {array.shape[:2]}, got {valid.shape}")
    unit = _unit(array, valid)
    return _core.Image(readable(array), unit, None if valid is None else np.ascontiguousarray(valid))


def _unit(array: npt.NDArray[Any], valid: npt.NDArray[np.bool_] | None) -> float:
    """The grey level, 0 to 255, of a pixel of 1."""
    if array.dtype.kind == "b":
        return 255.0
    if array.dtype == np.uint8:
        return 1.0
    if array.dtype == np.uint16:
        return 1.0 / 257.0
    if array.dtype.kind in "ui":
        top = float(max(abs(int(array.min())), abs(int(array.max())), 1))
    elif valid is None:
        top = float(np.max(np.abs(array)))
    else:
        counted = np.abs(array[valid])
        top = float(counted.max()) if counted.size else 1.0
    if not np.isfinite(top):
        return 1.0  # refused with its place
    # floats up to 1 are shares, those up to 255 levels, and others are brought to 255
    if array.dtype.kind == "f" and top <= 1.0:
        return 255.0
    return 1.0 if top <= 255.0 else 255.0 / top


def points_of(value: ArrayLike, name: str, least: int = 3) -> Floats:
    """Points as an array of float64 with two columns."""
    if isinstance(value, np.ma.MaskedArray) and np.ma.getmaskarray(value).any():
        raise ValueError(f"{name} must have no masked points; pass {name}.compressed() or drop them first")
    array = array_of(value, name)
    if array.dtype.kind == "b":
        raise TypeError(f"{name} must be points (x, y), got an array of bool of the shape {array.shape}")
    if array.ndim != 2 or array.shape[1] != 2:
        raise ValueError(f"{name} must have the shape (n, 2), a row (x, y) for each point, got {array.shape}")
    if len(array) < least:
        raise ValueError(f"{name} must have at least {least} points, got {len(array)}")
    points = np.array(array, dtype=np.float64, order="C")
    bad = ~np.isfinite(points).all(axis=1)
    if bad.any():
        index = int(np.argmax(bad))
        raise ValueError(f"{name} must be finite, got {tuple(points[index].tolist())} at point {index}")
    return points


def start_of(start: ArrayLike, shape: tuple[int, int], name: str = "start") -> Floats:
    """The points to start from: those given, the border of a mask, or one point for a click."""
    points = getattr(start, "points", None)
    if points is not None:
        return points_of(points, name)
    array = array_of(start, name)
    if array.shape == (2,) and array.dtype.kind != "b":
        return _inside(points_of(array[np.newaxis], name, 1), shape, name)
    if array.dtype.kind == "b":
        return _border_of(array, shape, name)
    points = points_of(start, name, 1)
    if len(points) == 2:
        raise ValueError(f"{name} must have at least 3 points, or 1 for a click inside the object, got 2")
    return _inside(points, shape, name)


def _border_of(mask: npt.NDArray[np.bool_], shape: tuple[int, int], name: str) -> Floats:
    """The border of the largest part of a mask."""
    if mask.shape != shape:
        raise ValueError(f"{name} as a mask must have the shape of the image, {shape}, got {mask.shape}")
    rings = _core.border(np.ascontiguousarray(mask))
    if not rings:
        raise ValueError(f"{name} as a mask must have a pixel that is true")
    return max(rings, key=lambda ring: _core.measures(ring)["area"])


def _inside(points: Floats, shape: tuple[int, int], name: str) -> Floats:
    """Refuse a start whose box does not meet the image, with a word on the order of its columns."""
    rows, columns = shape

    def within(x: Floats, y: Floats) -> bool:
        return bool(x.max() >= -0.5 and x.min() <= columns - 0.5 and y.max() >= -0.5 and y.min() <= rows - 0.5)

    if within(points[:, 0], points[:, 1]):
        return points
    hint = ""
    if within(points[:, 1], points[:, 0]):
        hint = f"; points are (x, y), so pass {name}[:, ::-1] if these are (row, column)"
    x, y = points.mean(axis=0).tolist()
    raise ValueError(
        f"{name} must lie in the image of {columns}×{rows} pixels (x, y), got points about ({x:.6g}, {y:.6g}){hint}"
    )
