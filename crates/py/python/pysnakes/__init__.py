"""Outlines of objects in images, by elastic curves that have mass.

Points are ``(x, y)`` in pixels everywhere: x to the right, y down, the center of the first pixel at (0, 0). So
``points[:, 0]`` are columns and ``points[:, 1]`` rows. The one exception is :func:`active_contour`, which keeps
scikit-image's order, (row, column); :attr:`Outline.coords` has that order too.

>>> import pysnakes
>>> apple = pysnakes.picture("apple")
>>> found = pysnakes.fit(apple, pysnakes.circle(256, 270, 220))
>>> found.is_outline
True
"""

from __future__ import annotations

from ._classic import active_contour
from ._core import PanicError, __version__
from ._files import contour, load_outlines, picture, read_image, save_outlines
from ._fit import Prepared, fit, fit_many
from ._outline import Measures, Outline
from ._physics import Certificate, certificate, critical_damping, force_field, regime, ring
from ._scene import Curve, Frame, Record, Scene, Simulation, scene_names
from ._shapes import circle, ellipse, rectangle
from ._track import Event, Tracked, Tracker, TrackedOutline, track

__all__ = [
    "Certificate",
    "Curve",
    "Event",
    "Frame",
    "Measures",
    "Outline",
    "PanicError",
    "Prepared",
    "Record",
    "Scene",
    "Simulation",
    "Tracked",
    "TrackedOutline",
    "Tracker",
    "__version__",
    "active_contour",
    "certificate",
    "circle",
    "contour",
    "critical_damping",
    "ellipse",
    "fit",
    "fit_many",
    "force_field",
    "load_outlines",
    "picture",
    "read_image",
    "rectangle",
    "regime",
    "ring",
    "save_outlines",
    "scene_names",
    "track",
]
