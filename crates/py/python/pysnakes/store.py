"""Results of many images as one table: a folder of Parquet files that pandas, DuckDB and QGIS read.

A row is an outline. What an image gave is one file, written whole or not at all, so a run that was killed goes on where
it was; :meth:`Results.compact` joins such files. The column ``geometry`` makes every file a GeoParquet file. The command
``snake fit --as parquet --out-dir FOLDER --resume`` writes the same files, and each passes over what the other has
finished. Reading and joining need pyarrow (``pip install pysnakes[store]``), writing does not.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from . import _core
from ._files import load_outlines, read_image
from ._fit import Prepared
from ._inputs import ArrayLike, Floats
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
        *((name, pa.list_(pa.field("element", pa.float64()))) for name in ("x", "y")),
        *((name, pa.list_(pa.field("element", pa.float32()))) for name in ("error", "strength")),
        ("geometry", pa.binary()),
    ]
    return pa.schema(fields, metadata={"geo": json.dumps(_GEO)})


def _given(outline: Outline) -> tuple[Floats, bool, bool, str, str, list[float], list[float]]:
    return (
        outline.points, outline.closed, outline.is_outline, outline.outcome, outline.reason, outline.error.tolist(),
        outline.strength.tolist(),
    )


_JOINED = "joined.parquet"
_OPEN: dict[tuple[str, int], tuple[tuple[int, int], _core.Store]] = {}


def _opened(folder: str) -> _core.Store:
    """The folder, opened anew by each process, and again when its joined file is another: that is read then."""
    try:
        now = os.stat(os.path.join(folder, _JOINED))
        state = (now.st_mtime_ns, now.st_size)
    except FileNotFoundError:
        state = (0, 0)
    key = (folder, os.getpid())
    known = _OPEN.get(key)
    if known is None or known[0] != state:
        known = _OPEN[key] = (state, _core.Store(folder))
    return known[1]


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

    @property
    def _store(self) -> _core.Store:
        return _opened(str(self.folder))

    def is_finished(self, image: str) -> bool:
        """Whether what this image gave is there, in a file of its own or in the joined one."""
        return self._store.is_finished(image)

    def finished(self) -> set[str]:
        """Names of all images whose results are there."""
        pa = _pyarrow()
        names: set[str] = set()
        for path in self._files():
            names.update(pa.parquet.read_table(path, columns=["image"])["image"].to_pylist())
        return names

    def write(self, image: str, outlines: Iterable[Outline]) -> Path:
        """Write what an image gave; its file is there whole or not at all."""
        return Path(self._store.write(image, [_given(outline) for outline in outlines]))

    def refuse(self, image: str, reason: str) -> Path:
        """Write that an image was refused, and why, so that it is not tried again."""
        return Path(self._store.refuse(image, reason))

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

    def _files(self) -> Iterator[Path]:
        # parts of images that the joined file has already are left out by name of the image below
        yield from self.folder.glob(_JOINED)
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
        """Join all files into ``joined.parquet``, which QGIS opens as it is; returns its path.

        May be done while nothing writes. Killed on the way, nothing is lost and nothing there twice.
        """
        pa = _pyarrow()
        parts = sorted(self.folder.glob("part-*.parquet"))
        table, path = self.table(), self.folder / _JOINED
        growing = path.with_name(f".{path.name}.{os.getpid()}")
        split = {f"{name}.list.element": "BYTE_STREAM_SPLIT" for name in ("x", "y", "error", "strength")}
        try:
            # what the Rust side reads too: no codec that it has not
            pa.parquet.write_table(
                table, growing, compression="snappy", use_dictionary=["image", "outcome", "reason"],
                column_encoding=split,
            )
            os.replace(growing, path)
        finally:
            growing.unlink(missing_ok=True)
        for part in parts:
            part.unlink()
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
        The file; as given, it is the name of the image in the table.
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
    image = _core.image_name(path)
    if results.is_finished(image):
        return {"image": image, "outlines": 0, "done": "before"}
    try:
        prepared = Prepared(load(path), **options)
        outlines = [prepared.fit(one) for one in _starts_of(start, path)]
    except (TypeError, ValueError, OSError) as error:
        results.refuse(image, str(error))
        return {"image": image, "outlines": 0, "done": "refused"}
    results.write(image, outlines)
    return {"image": image, "outlines": len(outlines), "done": "now"}
