"""Outlines in napari: a reader of their files, and layers. napari itself is imported by nothing here."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ._files import load_outlines
from ._outline import Outline

_READ = (".csv", ".geojson", ".roi", ".zip", ".svg")

LayerData = tuple[list[Any], dict[str, Any], str]


def shapes_layer(outlines: Sequence[Any], *, name: str = "outlines", **keywords: Any) -> LayerData:
    """Outlines as the data of a shapes layer.

    Parameters
    ----------
    outlines : sequence of Outline or array_like
        Outlines, or points (x, y).
    name : str
        The name of the layer.
    **keywords
        Of napari's layer.

    Returns
    -------
    tuple
        Data, keywords and "shapes", as ``viewer.add_layer(napari.layers.Layer.create(*data))`` takes them.
    """
    data = [np.asarray(getattr(one, "points", one), dtype=np.float64)[:, ::-1] for one in outlines]
    kinds = ["polygon" if getattr(one, "closed", True) else "path" for one in outlines]
    chosen: dict[str, Any] = {
        "name": name, "shape_type": kinds, "edge_color": "orange", "face_color": "transparent", "edge_width": 1,
    }
    whole = [one for one in outlines if isinstance(one, Outline)]
    if len(whole) == len(data) and whole:
        chosen["features"] = {
            "is_outline": [one.is_outline for one in whole],
            "area": [one.area for one in whole],
        }
    return data, chosen | keywords, "shapes"


def add_outlines(viewer: Any, outlines: Sequence[Any], **keywords: Any) -> Any:
    """Add outlines to a viewer as a shapes layer, and return the layer."""
    data, chosen, _ = shapes_layer(outlines, **keywords)
    return viewer.add_shapes(data, **chosen)


def starts_of(layer: Any) -> list[np.ndarray[Any, np.dtype[np.float64]]]:
    """The shapes of a layer as starts, points (x, y) in float64; napari has (row, column) in float32."""
    return [np.asarray(shape, dtype=np.float64)[:, ::-1] for shape in layer.data]


def get_reader(path: str | Sequence[str]) -> Callable[[Any], list[LayerData]] | None:
    """napari's question: what reads this? None for what no outlines are in."""
    first = path if isinstance(path, str) else path[0]
    return _read if os.path.splitext(first)[1].lower() in _READ else None


def _read(path: str | Sequence[str]) -> list[LayerData]:
    paths = [path] if isinstance(path, str) else list(path)
    return [shapes_layer(load_outlines(one), name=os.path.basename(one)) for one in paths]
