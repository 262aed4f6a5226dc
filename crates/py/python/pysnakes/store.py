"""Results of many images as one table: a folder of Parquet files that pandas, DuckDB and QGIS read.

A row is an outline. What an image gave is one file, written whole or not at all, so a run that was killed goes on where
it was; :meth:`Results.compact` joins such files. The column ``geometry`` makes every file a GeoParquet file. Needs
pyarrow (``pip install pysnakes[store]``).
"""

from __future__ import annotations

import hashlib
import json
import os
import struct
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ._files import load_outlines, read_image
from ._fit import Prepared
from ._inputs import ArrayLike
from ._outline import Outline

_MEASURES = ("area", "perimeter", "major_axis", "minor_axis", "angle", "circularity", "solidity")

_GEO = {
    "version": "1.1.0",
    "primary_column": "geometry",
    "columns": {"geometry": {"encoding": "WKB", "geometry_types": ["Polygon", "LineString"], "crs": None}},
}


def _pyarrow() -> Any:
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError as error:
        raise ImportError("the results store needs pyarrow: pip install 'pysnakes[store]'") from error
    return pyarrow


def schema() -> Any:
    """The columns of the table, as a pyarrow schema.

    ========================== ==================================================================================
    ``image``                  name of the image
    ``object``                 number of the outline in it, from 0; null where the image was refused
    ``is_outline``             whether nothing speaks against it
    ``outcome``, ``reason``    how it ended; of a refused image "refused", and why
    ``closed``, ``nodes``      whether it is closed; how many nodes it has
    ``area`` … ``solidity``    what it measures, :class:`pysnakes.Measures`; null where it encloses nothing
    ``centroid_x``, ``_y``     center of its area
    ``x``, ``y``               its nodes
    ``error``, ``strength``    of each node; null where no edge could be measured
    ``geometry``               the same nodes as well-known binary
    ========================== ==================================================================================
    """
    pa = _pyarrow()
    numbers = [(name, pa.float64()) for name in (*_MEASURES, "centroid_x", "centroid_y")]
    fields = [
        ("image", pa.string()),
        ("object", pa.int32()),
        ("is_outline", pa.bool_()),
        ("outcome", pa.string()),
        ("reason", pa.string()),
        ("closed", pa.bool_()),
        ("nodes", pa.int32()),
        *numbers,
        ("x", pa.list_(pa.float64())),
        ("y", pa.list_(pa.float64())),
        ("error", pa.list_(pa.float32())),
        ("strength", pa.list_(pa.float32())),
        ("geometry", pa.binary()),
    ]
    return pa.schema(fields, metadata={"geo": json.dumps(_GEO)})


def _wkb(points: np.ndarray[Any, Any], closed: bool) -> bytes:
    """A polygon or a line as well-known binary."""
    if closed:
        points = np.concatenate([points, points[:1]])
        head = struct.pack("<BIII", 1, 3, 1, len(points))
    else:
        head = struct.pack("<BII", 1, 2, len(points))
    return head + np.ascontiguousarray(points, dtype="<f8").tobytes()


def _row(image: str, number: int, outline: Outline) -> dict[str, Any]:
    row: dict[str, Any] = dict.fromkeys((*_MEASURES, "centroid_x", "centroid_y"))
    if outline.closed and outline.area > 0.0:
        measures = outline.measures
        row |= {name: getattr(measures, name) for name in _MEASURES}
        row["centroid_x"], row["centroid_y"] = measures.centroid
    return row | {
        "image": image,
        "object": number,
        "is_outline": outline.is_outline,
        "outcome": outline.outcome,
        "reason": outline.reason,
        "closed": outline.closed,
        "nodes": len(outline),
        "x": outline.points[:, 0].tolist(),
        "y": outline.points[:, 1].tolist(),
        "error": [None if np.isnan(error) else error for error in outline.error.tolist()],
        "strength": [None if np.isnan(one) else one for one in outline.strength.tolist()],
        "geometry": _wkb(outline.points, outline.closed),
    }


class Results:
    """A folder of results.

    Parameters
    ----------
    folder : str or path
        Made if it is not there.
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)
        if self.folder.exists() and not self.folder.is_dir():
            raise ValueError(f"{self.folder} is a file; a folder is needed for results")
        self.folder.mkdir(parents=True, exist_ok=True)

    def __repr__(self) -> str:
        return f"<Results in {str(self.folder)!r}>"

    def _part(self, image: str) -> Path:
        digest = hashlib.sha256(image.encode()).hexdigest()[:20]
        return self.folder / f"part-{digest}.parquet"

    def is_finished(self, image: str) -> bool:
        """Whether what this image gave is there, in a file of its own."""
        return self._part(image).exists()

    def finished(self) -> set[str]:
        """Names of all images whose results are there."""
        pa = _pyarrow()
        names: set[str] = set()
        for path in self._files():
            names.update(pa.parquet.read_table(path, columns=["image"])["image"].to_pylist())
        return names

    def write(self, image: str, outlines: Iterable[Outline]) -> Path:
        """Write what an image gave; its file is there whole or not at all."""
        return self._write(image, [_row(image, number, outline) for number, outline in enumerate(outlines)])

    def refuse(self, image: str, reason: str) -> Path:
        """Write that an image was refused, and why, so that it is not tried again."""
        row = {"image": image, "is_outline": False, "outcome": "refused", "reason": reason}
        return self._write(image, [row])

    def collect(self, files: Iterable[str | os.PathLike[str]]) -> int:
        """Take in files of outlines that another program wrote, ``snake fit --out-dir`` among them.

        Parameters
        ----------
        files : iterable of str or path
            Files as :func:`pysnakes.load_outlines` reads them; the name without its ending is that of the image.

        Returns
        -------
        int
            Files taken in; those whose image is there already are passed over.
        """
        taken = 0
        for path in files:
            image = Path(path).stem
            if self.is_finished(image):
                continue
            self.write(image, [Outline._bare(points) for points in load_outlines(path)])
            taken += 1
        return taken

    def _write(self, image: str, rows: list[dict[str, Any]]) -> Path:
        if not rows:
            rows = [{"image": image, "is_outline": False, "outcome": "empty", "reason": "no start in this image"}]
        pa = _pyarrow()
        path = self._part(image)
        self._put(pa.Table.from_pylist(rows, schema=schema()), path)
        return path

    @staticmethod
    def _put(table: Any, path: Path) -> None:
        pa = _pyarrow()
        growing = path.with_name(f".{path.name}.{os.getpid()}")
        try:
            pa.parquet.write_table(table, growing, compression="zstd")
            os.replace(growing, path)
        finally:
            growing.unlink(missing_ok=True)

    def _files(self) -> Iterator[Path]:
        # parts of images that a joined file has already are left out by name of the image below
        yield from sorted(self.folder.glob("joined-*.parquet"))
        yield from sorted(self.folder.glob("part-*.parquet"))

    def table(self) -> Any:
        """All rows as a pyarrow table, by the names of the images."""
        pa = _pyarrow()
        tables, seen = [], set[str]()
        for path in self._files():
            table = pa.parquet.read_table(path)
            names = table["image"].to_pylist()
            if seen and any(name in seen for name in names):
                table = table.filter(pa.array([name not in seen for name in names]))
            seen.update(names)
            tables.append(table)
        if not tables:
            return schema().empty_table()
        return pa.concat_tables(tables).sort_by([("image", "ascending"), ("object", "ascending")])

    def compact(self) -> Path:
        """Join all files into one, which QGIS opens as it is; returns its path.

        May be done while nothing writes. Killed on the way, nothing is lost and nothing there twice.
        """
        table, old = self.table(), list(self._files())
        digest = hashlib.sha256("\n".join(sorted(set(table["image"].to_pylist()))).encode()).hexdigest()[:20]
        path = self.folder / f"joined-{digest}.parquet"
        self._put(table, path)
        for other in old:
            if other != path:
                other.unlink()
        return path


def _points(one: Any) -> Any:
    return getattr(one, "points", one)


def _starts_of(start: Any, path: str) -> list[Any]:
    """The starts in the image of a file."""
    if callable(start):
        start = start(path)
    if isinstance(start, dict):
        stem = os.path.splitext(os.path.basename(path))[0]
        if stem not in start:
            raise ValueError(f"start has no entry {stem!r}")
        start = start[stem]
    several = isinstance(start, (list, tuple)) and (not start or np.ndim(_points(start[0])) == 2)
    return list(start) if several else [start]


def fit_file(
    path: str | os.PathLike[str],
    start: Any,
    store: str | os.PathLike[str],
    *,
    load: Callable[[str], ArrayLike] = read_image,
    **options: Any,
) -> dict[str, Any]:
    """Fit the image of a file, unless its results are there: what a scheduler gives to a worker.

    Parameters
    ----------
    path : str or path
        The file; its name as given is that of the image in the table.
    start : array_like, list, dict or callable
        A start as in :func:`pysnakes.fit`, a list of several, a dictionary with the name of the file without its ending
        as key, or a function of the path that gives one of these.
    store : str or path
        The folder of results.
    load : callable
        Reads the image.
    **options
        As in :func:`pysnakes.fit`.

    Returns
    -------
    dict
        ``image``, ``outlines`` (how many), ``done``: "now", "before", or "refused", the reason of which is in the table.
    """
    path, results = os.fspath(path), Results(store)
    if results.is_finished(path):
        return {"image": path, "outlines": 0, "done": "before"}
    try:
        prepared = Prepared(load(path), **options)
        outlines = [prepared.fit(one) for one in _starts_of(start, path)]
    except (TypeError, ValueError, OSError) as error:
        results.refuse(path, str(error))
        return {"image": path, "outlines": 0, "done": "refused"}
    results.write(path, outlines)
    return {"image": path, "outlines": len(outlines), "done": "now"}
