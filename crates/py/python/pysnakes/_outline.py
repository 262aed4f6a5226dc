"""An outline that was found, and what there is to know of it."""

from __future__ import annotations

import dataclasses
import json
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._inputs import ArrayLike, Floats

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclasses.dataclass(frozen=True)
class Measures:
    """What an outline measures, exact for its polygon, by the definitions of scikit-image's ``regionprops``.

    Attributes
    ----------
    area, perimeter : float
        Square pixels, pixels.
    centroid : tuple of float
        Center of the area, (x, y).
    major_axis, minor_axis : float
        Axes of the ellipse with the same second moments. Pixels.
    angle : float
        Direction of the longer axis, from +x towards +y. Radians.
    circularity : float
        4π area / perimeter²; 1 of a circle.
    solidity : float
        Area over that of the convex hull.
    equivalent_diameter : float
        Diameter of a circle of the same area. Pixels.
    low, high : tuple of float
        Least and greatest x and y.
    """

    area: float
    perimeter: float
    centroid: tuple[float, float]
    major_axis: float
    minor_axis: float
    angle: float
    circularity: float
    solidity: float
    equivalent_diameter: float
    low: tuple[float, float]
    high: tuple[float, float]


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Outline:
    """An outline, node by node, and how well the image supports it.

    Attributes
    ----------
    points : ndarray of shape (n, 2)
        Nodes (x, y). Pixels.
    closed : bool
        Whether the last node is joined to the first.
    strength : ndarray of shape (n,)
        Slope of the image across the outline at each node; 1 is the steepest of an edge as high as the contrast.
    error : ndarray of shape (n,)
        Standard error of each node along its normal, from the image's noise; NaN where no edge could be measured.
        Pixels.
    slope : ndarray of shape (n,)
        That slope in grey levels a pixel; above 0 where it is brighter outside.
    offset : ndarray of shape (n,)
        How far along the normal the forces of the image balance; NaN where nowhere near. Pixels.
    normal : ndarray of shape (n, 2)
        Unit normals; of a closed outline they point outwards.
    held : ndarray of bool of shape (n,)
        Whether the image pulls the node back when it is moved along the normal.
    outcome : str
        How it ended: ``"settled"``, or why not.
    reason : str
        The same in words; what speaks against it where it is no outline.
    is_outline : bool
        Whether it came to rest and nothing speaks against it.
    note : str or None
        What to know of an outline that is one.
    held_share : float or None
        Share of nodes that are held.
    crossings : int or None
        How often it crosses itself.
    steps : int
        Steps made, or rounds of the last stage.
    explanation : str
        What was measured and chosen on the way.
    shape : tuple of int
        Rows and columns of the image.
    """

    points: Floats
    closed: bool
    strength: Floats
    error: Floats
    slope: Floats
    offset: Floats
    normal: Floats
    held: npt.NDArray[np.bool_]
    outcome: str
    reason: str
    is_outline: bool
    note: str | None
    held_share: float | None
    crossings: int | None
    steps: int
    explanation: str
    shape: tuple[int, int]

    @classmethod
    def _of(cls, found: dict[str, Any], shape: tuple[int, int]) -> Outline:
        for value in found.values():
            if isinstance(value, np.ndarray):
                value.flags.writeable = False
        return cls(shape=shape, **found)

    @classmethod
    def _bare(cls, points: Floats) -> Outline:
        """An outline of which nothing is known but its nodes."""
        none = np.full(len(points), np.nan)
        normal, held = np.full((len(points), 2), np.nan), np.zeros(len(points), dtype=bool)
        return cls(
            points=points, closed=True, strength=none, error=none, slope=none, offset=none, normal=normal, held=held,
            outcome="read", reason="read from a file", is_outline=True, note=None, held_share=None, crossings=None,
            steps=0, explanation="", shape=(0, 0),
        )

    @property
    def coords(self) -> Floats:
        """Nodes as (row, column), the order of scikit-image and napari."""
        return self.points[:, ::-1]

    @property
    def measures(self) -> Measures:
        """Area, axes and so on.

        Raises
        ------
        ValueError
            Where it encloses no area.
        """
        return Measures(**_core.measures(self.points))

    @property
    def area(self) -> float:
        """Area in square pixels; 0 where it encloses none."""
        x, y = self.points.T
        return 0.5 * abs(float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))))

    def __len__(self) -> int:
        return len(self.points)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Outline):
            return NotImplemented
        return all(
            np.array_equal(a, b, equal_nan=a.dtype.kind == "f") if isinstance(a, np.ndarray) else a == b
            for a, b in (
                (getattr(self, field.name), getattr(other, field.name)) for field in dataclasses.fields(self)
            )
        )

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        kind = "closed" if self.closed else "open"
        said = [f"{kind}, {len(self)} nodes"]
        if self.closed:
            said.append(f"area {self.area:.1f} px²")
        measured = self.error[np.isfinite(self.error)]
        if len(measured):
            said.append(f"error {np.median(measured):.3f} px")
        said.append("an outline" if self.is_outline else f"no outline: {self.reason}")
        return f"<Outline {', '.join(said)}>"

    def _repr_svg_(self) -> str:
        """What a notebook shows."""
        low, high = self.points.min(axis=0) - 2.0, self.points.max(axis=0) + 2.0
        width, height = (high - low).tolist()
        scale = 240.0 / max(width, height)
        way = " ".join(f"{x:.2f},{y:.2f}" for x, y in self.points)
        kind = "polygon" if self.closed else "polyline"
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width * scale:.0f}" height="{height * scale:.0f}" '
            f'viewBox="{low[0]:.2f} {low[1]:.2f} {width:.2f} {height:.2f}"><{kind} points="{way}" fill="none" '
            f'stroke="darkorange" stroke-width="{1.5 / scale:.3f}"/></svg>'
        )

    def to_mask(self, shape: tuple[int, int] | None = None) -> npt.NDArray[np.bool_]:
        """The pixels whose centers are inside.

        Parameters
        ----------
        shape : tuple of int, optional
            Rows and columns; those of the image if not given.

        Returns
        -------
        ndarray of bool
        """
        rows, columns = shape or self.shape
        return _core.filled([self.points], (rows, columns))

    def to_geojson(self, **properties: Any) -> dict[str, Any]:
        """A GeoJSON feature: a polygon, or a line if open, as QuPath and others read it.

        GeoJSON counts from the outer corner of the first pixel, half a pixel before its center.

        Parameters
        ----------
        **properties
            Values noted beside it; the measures are there by themselves.

        Returns
        -------
        dict
        """
        text = _core.written([(self.points, self.closed, None)], "geojson", (self.shape[1], self.shape[0]))
        collection: dict[str, Any] = json.loads(text)
        feature: dict[str, Any] = collection["features"][0]
        own: dict[str, Any] = {"outcome": self.outcome, "is_outline": self.is_outline}
        if self.closed and self.area > 0.0:
            measures = self.measures
            own |= {"area": measures.area, "perimeter": measures.perimeter}
        feature["properties"] = (feature.get("properties") or {}) | own | properties
        return feature

    def to_roi(self, name: str = "outline") -> bytes:
        """The bytes of an ImageJ ROI file.

        Parameters
        ----------
        name : str
            The name of the ROI.

        Returns
        -------
        bytes
        """
        return _core.written([(self.points, self.closed, name)], "roi", (self.shape[1], self.shape[0]))

    def plot(
        self, ax: Axes | None = None, *, image: ArrayLike | None = None, errors: float = 0.0, **line: Any
    ) -> Axes:
        """Draw it with matplotlib.

        Parameters
        ----------
        ax : matplotlib axes, optional
            Where; the current axes if not given.
        image : array_like, optional
            Drawn below it.
        errors : float
            Draw a band of so many standard errors to either side.
        **line
            Passed to ``ax.plot``.

        Returns
        -------
        matplotlib axes
        """
        import matplotlib.pyplot as plt

        if ax is None:
            ax = plt.gca()
        if image is not None:
            ax.imshow(np.asarray(image), cmap="gray")
        ends = self.points[:1] if self.closed else self.points[:0]
        x, y = np.concatenate([self.points, ends]).T
        look: dict[str, Any] = {"color": "tab:orange", "linewidth": 1.5}
        drawn = ax.plot(x, y, **(look | line))
        if errors > 0.0:
            width = np.nan_to_num(self.error, nan=0.0)[:, np.newaxis] * errors * self.normal
            outer, inner = self.points + width, self.points - width
            band = np.concatenate([outer, outer[:1], inner[:1], inner[::-1]])
            ax.fill(band[:, 0], band[:, 1], color=drawn[0].get_color(), alpha=0.3, linewidth=0)
        if image is None and not ax.images and not ax.yaxis_inverted():
            ax.invert_yaxis()
            ax.set_aspect("equal")
        return ax
