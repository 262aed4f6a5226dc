"""Fits on many machines by Dask: over files, and over blocks of an image that no memory holds.

There is no scheduler here: Dask's own runs on one machine or a cluster. Fits are the same to the last bit wherever they
run. Needs dask (``pip install pysnakes[dask]``).
"""

from __future__ import annotations

import dataclasses
import itertools
import os
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from . import _core
from ._files import read_image
from ._fit import Prepared
from ._inputs import ArrayLike, Floats
from ._outline import Outline
from .store import _points, fit_file


def fit_bag(
    files: str | os.PathLike[str] | Iterable[str | os.PathLike[str]],
    start: Any,
    store: str | os.PathLike[str],
    *,
    partition_size: int = 1,
    load: Callable[[str], ArrayLike] = read_image,
    **options: Any,
) -> Any:
    """Fits of files, each of which is begun only if its results are not there yet.

    Parameters
    ----------
    files : str, path or iterable of such
        Image files, or a folder: all files in it by their names.
    start : array_like, list, dict or callable
        A start as in :func:`pysnakes.fit` for every image, a list of several, a dictionary with the name of the file
        without its ending as key, or a function of the path that gives one of these.
    store : str or path
        The folder of results, :class:`pysnakes.store.Results`; all workers must see it.
    partition_size : int
        Files a task.
    load : callable
        Reads an image of a path.
    **options
        As in :func:`pysnakes.fit`.

    Returns
    -------
    dask.bag.Bag
        A dictionary for each file: its name, how many outlines, and whether "now", "before" or "refused". Nothing is
        done before ``compute()``.

    Notes
    -----
    A worker that is killed takes at most the files it was at with it; Dask gives these to another, which passes over
    what is finished. Results of a file are written whole or not at all.
    """
    import dask.bag

    if isinstance(files, (str, os.PathLike)):
        folder = os.fspath(files)
        if not os.path.isdir(folder):
            raise ValueError(f"files must be a folder or a list of files, got {folder!r}")
        names = sorted(entry.path for entry in os.scandir(folder) if entry.is_file())
    else:
        names = [os.fspath(path) for path in files]
    if not names:
        raise ValueError("files must hold at least one file, got none")
    bag = dask.bag.from_sequence(names, partition_size=partition_size)
    return bag.map(fit_file, start=start, store=os.fspath(store), load=load, **options)


@dataclasses.dataclass(frozen=True)
class BlockOutline:
    """An outline of one block, its points counted in the whole image.

    Attributes
    ----------
    outline : Outline
        What was found; ``shape`` is that of the whole image.
    block : tuple of int
        Row and column of the block that its start lies in.
    label : int
        Its number in that block.
    seen : tuple of int
        The part of the image it was looked for in: first row and column, and the ones behind the last.
    """

    outline: Outline
    block: tuple[int, int]
    label: int
    seen: tuple[int, int, int, int]


_BLOCK = 1 << 32


@dataclasses.dataclass(frozen=True)
class _Place:
    """A block: its row and column, its number, the image's shape, the part that is seen, and where blocks meet in it."""

    block: tuple[int, int]
    number: int
    shape: tuple[int, int]
    seen: tuple[int, int, int, int]
    edges: tuple[tuple[int, ...], tuple[int, ...]]


def _numbered(block: np.ndarray[Any, Any], columns: int, block_id: Any = None) -> np.ndarray[Any, Any]:
    """Labels that no other block has."""
    number = block_id[0] * columns + block_id[1] + 1
    return np.where(block > 0, block.astype(np.int64) + number * _BLOCK, 0)


def _parts(view: np.ndarray[Any, Any], place: _Place, share: float) -> list[tuple[int, Floats]]:
    """The borders of the objects of a block, with what of them lies in others; only if most of one lies in this one.

    Labels of two blocks are of one object where they touch along most of the shorter of both at the border.
    """
    pixels = np.argwhere(view)
    marks = view[pixels[:, 0], pixels[:, 1]]
    order = np.argsort(marks, kind="stable")
    names, first = np.unique(marks[order], return_index=True)
    places = dict(zip(names.tolist(), np.split(pixels[order], first[1:])))
    parent: dict[int, int] = {label: label for label in places}

    def root(label: int) -> int:
        while parent[label] != label:
            parent[label] = parent[parent[label]]
            label = parent[label]
        return label

    lines = [(view[edge - 1], view[edge]) for edge in place.edges[0]]
    lines += [(view[:, edge - 1], view[:, edge]) for edge in place.edges[1]]
    for one, other in lines:
        both = (one != 0) & (other != 0)
        pairs, counts = np.unique(np.stack([one[both], other[both]]), axis=1, return_counts=True)
        for (a, b), count in zip(pairs.T.tolist(), counts.tolist()):
            if count > share * min(int((one == a).sum()), int((other == b).sum())):
                parent[max(root(a), root(b))] = min(root(a), root(b))
    groups: dict[int, list[int]] = {}
    for label in parent:
        groups.setdefault(root(label), []).append(label)
    found = []
    for labels_of in groups.values():
        own = [label for label in labels_of if label // _BLOCK == place.number]
        if not own:
            continue
        held: dict[int, int] = {}
        for label in labels_of:
            held[label // _BLOCK] = held.get(label // _BLOCK, 0) + len(places[label])
        # a block that holds more, as far as it is seen from here, sees all of its own, and takes it
        if held[place.number] < max(held.values()):
            continue
        inside = np.concatenate([places[label] for label in labels_of])
        low, high = inside.min(axis=0), inside.max(axis=0)
        mask = np.zeros(tuple((high - low + 1).tolist()), dtype=bool)
        mask[tuple((inside - low).T)] = True
        ring = max(_core.border(mask), key=len) + low[::-1].astype(np.float64)
        found.append((min(own) % _BLOCK, ring))
    return found


def _fit_block(
    pixels: ArrayLike,
    starts: list[tuple[int, Floats]] | np.ndarray[Any, Any],
    place: _Place,
    options: dict[str, Any],
) -> list[BlockOutline]:
    corner = np.array([place.seen[1], place.seen[0]], dtype=np.float64)
    by_labels = isinstance(starts, np.ndarray)
    given: list[tuple[int, Any]] = []
    if isinstance(starts, np.ndarray):
        given.extend(_parts(starts, place, 0.5))
    else:
        given.extend((label, points - corner) for label, points in starts)
    if not given:
        return []
    prepared, found = Prepared(pixels, **options), []
    for label, start in given:
        try:
            outline = prepared.fit(start)
        except ValueError:
            if by_labels:
                continue  # a sliver that encloses nothing
            raise
        moved = dataclasses.replace(outline, points=outline.points + corner, shape=place.shape)
        found.append(BlockOutline(moved, place.block, label, place.seen))
    return found


def fit_blocks(
    image: Any,
    starts: Any,
    *,
    depth: int = 64,
    **options: Any,
) -> Any:
    """Fits in the blocks of a dask array, each seen with so many pixels of its neighbors.

    Parameters
    ----------
    image : dask.array.Array of shape (rows, columns) or (rows, columns, channels)
        Its chunks are the blocks; channels must be in one.
    starts : list of array_like, or dask.array.Array of int
        Starts of points (x, y) in the whole image, each of which is fitted in the block that its middle lies in. Or
        an image of labels of the same chunks, as a network gives them block by block: 0 for nothing, and in each block
        numbers of its own for the parts of objects in it. Parts that touch across a border are one start.
    depth : int
        Pixels of overlap: as much as an object may reach beyond the block it is fitted in. Pixels.
    **options
        As in :func:`pysnakes.fit`.

    Returns
    -------
    dask.delayed.Delayed
        Of a list of :class:`BlockOutline`, block by block: pass it to :func:`stitch`.
    """
    import dask
    import dask.array

    if not isinstance(image, dask.array.Array) or image.ndim not in (2, 3):
        raise TypeError(f"image must be a dask array of 2 or 3 axes, got {type(image).__name__}")
    if image.ndim == 3 and len(image.chunks[2]) != 1:
        raise ValueError(f"image must have its channels in one chunk, got {len(image.chunks[2])}")
    if depth < 0:
        raise ValueError(f"depth must be at least 0, got {depth}")
    shape = (int(image.shape[0]), int(image.shape[1]))
    edges = [np.concatenate([[0], np.cumsum(chunks)]) for chunks in image.chunks[:2]]
    labels = starts if isinstance(starts, dask.array.Array) else None
    if labels is not None and labels.chunks != image.chunks[:2]:
        raise ValueError(f"labels must have the chunks of the image, {image.chunks[:2]}, got {labels.chunks}")
    owned = {} if labels is not None else _owners(starts, edges, shape)
    if labels is not None:
        labels = labels.map_blocks(_numbered, columns=len(edges[1]) - 1, dtype=np.int64)
    parts = []
    for row, column in itertools.product(range(len(edges[0]) - 1), range(len(edges[1]) - 1)):
        core = (edges[0][row], edges[1][column], edges[0][row + 1], edges[1][column + 1])
        top, left, bottom, right = (int(edge) for edge in core)
        seen = (max(top - depth, 0), max(left - depth, 0), min(bottom + depth, shape[0]), min(right + depth, shape[1]))
        view = (slice(seen[0], seen[2]), slice(seen[1], seen[3]))
        own: Any = owned.get((row, column), []) if labels is None else labels[view]
        if labels is None and not own:
            continue
        inner = [tuple(int(e) - low for e in own_edges if low < e < high)
                 for own_edges, low, high in zip(edges, seen[:2], seen[2:])]
        number = row * (len(edges[1]) - 1) + column + 1
        place = _Place((row, column), number, shape, seen, (inner[0], inner[1]))
        parts.append(dask.delayed(_fit_block, pure=False)(image[view], own, place, options))
    return dask.delayed(_joined, pure=False)(parts)


def _joined(parts: list[list[BlockOutline]]) -> list[BlockOutline]:
    return [one for part in parts for one in part]


def _owners(
    starts: Sequence[Any], edges: list[np.ndarray[Any, Any]], shape: tuple[int, int]
) -> dict[tuple[int, int], list[tuple[int, Floats]]]:
    """The starts of each block."""
    owned: dict[tuple[int, int], list[tuple[int, Floats]]] = {}
    for number, start in enumerate(starts):
        points = np.atleast_2d(np.asarray(_points(start), dtype=np.float64))
        x, y = points.mean(axis=0)
        if not (-0.5 <= x <= shape[1] - 0.5 and -0.5 <= y <= shape[0] - 0.5):
            raise ValueError(f"start {number} must have its middle in the image, got ({x:.6g}, {y:.6g})")
        row = int(np.clip(np.searchsorted(edges[0], y + 0.5, side="right") - 1, 0, len(edges[0]) - 2))
        column = int(np.clip(np.searchsorted(edges[1], x + 0.5, side="right") - 1, 0, len(edges[1]) - 2))
        owned.setdefault((row, column), []).append((number + 1, points))
    return owned


def stitch(found: Sequence[BlockOutline], *, share: float = 0.5) -> list[Outline]:
    """One outline for each object, of those that several blocks have found.

    Outlines of different blocks are one object where they lie on each other: where both blocks have looked, what both
    enclose is more than `share` of what the smaller does. Of outlines that their blocks have seen
    whole the surest is given; where there is none, the union of the parts, without errors of nodes.

    Parameters
    ----------
    found : sequence of BlockOutline
        What :func:`fit_blocks` gives.
    share : float
        Above 0, up to 1.

    Returns
    -------
    list of Outline
        In the order of their first parts.
    """
    if not 0.0 < share <= 1.0:
        raise ValueError(f"share must be above 0 and at most 1, got {share}")
    whole = [one for one in found if one.outline.is_outline]
    parent = list(range(len(whole)))

    def root(index: int) -> int:
        while parent[index] != index:
            parent[index] = parent[parent[index]]
            index = parent[index]
        return index

    for a, b in _near(whole):
        if root(a) != root(b) and _contact(whole[a], whole[b]) > share:
            parent[max(root(a), root(b))] = min(root(a), root(b))
    groups: dict[int, list[BlockOutline]] = {}
    for index, one in enumerate(whole):
        groups.setdefault(root(index), []).append(one)
    return [_one_of(group) for group in groups.values()]


def _near(found: list[BlockOutline]) -> Iterable[tuple[int, int]]:
    """Pairs of outlines of different blocks whose boxes meet, in order."""
    boxes = [(*one.outline.points.min(axis=0), *one.outline.points.max(axis=0)) for one in found]
    order = sorted(range(len(found)), key=lambda index: (boxes[index][0], index))
    for place, a in enumerate(order):
        for b in itertools.islice(order, place + 1, None):
            if boxes[b][0] > boxes[a][2]:
                break
            apart = boxes[b][1] > boxes[a][3] or boxes[a][1] > boxes[b][3]
            if not apart and found[a].block != found[b].block:
                yield (a, b) if a < b else (b, a)


def _contact(one: BlockOutline, other: BlockOutline) -> float:
    """What both enclose, of what the smaller does, where both blocks have looked."""
    a, b = one.outline.points, other.outline.points
    low = np.maximum(np.maximum(a.min(axis=0), b.min(axis=0)), np.maximum(one.seen[1::-1], other.seen[1::-1]))
    high = np.minimum(np.minimum(a.max(axis=0), b.max(axis=0)), np.minimum(one.seen[:1:-1], other.seen[:1:-1]))
    low, high = np.floor(low), np.ceil(high)
    if not (high > low).all():
        return 0.0
    size = (int(high[1] - low[1]) + 1, int(high[0] - low[0]) + 1)
    inside = [_core.filled([np.ascontiguousarray(points - low)], size) for points in (a, b)]
    # the smaller where both have looked, which is more than where their boxes meet
    top, left = np.maximum(one.seen[:2], other.seen[:2])
    bottom, right = np.minimum(one.seen[2:], other.seen[2:])
    corner, whole = np.array([left, top], dtype=np.float64), (int(bottom - top), int(right - left))
    areas = [int(_core.filled([np.ascontiguousarray(points - corner)], whole).sum()) for points in (a, b)]
    least = min(areas)
    return float((inside[0] & inside[1]).sum()) / least if least else 0.0


def _is_cut(one: BlockOutline) -> bool:
    """Whether it ends where its block's view does, inside the image."""
    rows, columns = one.outline.shape
    top, left, bottom, right = one.seen
    low, high = one.outline.points.min(axis=0), one.outline.points.max(axis=0)
    before = (left > 0 and low[0] < left + 2.0) or (top > 0 and low[1] < top + 2.0)
    return bool(before or (right < columns and high[0] > right - 3.0) or (bottom < rows and high[1] > bottom - 3.0))


def _one_of(group: list[BlockOutline]) -> Outline:
    """The surest of nearly the same outlines, or the union of parts."""

    def sure(outline: Outline) -> float:
        return float(np.mean(outline.strength)) if len(outline.strength) else 0.0

    outlines = [one.outline for one in group]
    whole = [one.outline for one in group if not _is_cut(one)]
    largest = max(outlines, key=lambda outline: outline.area)
    if whole and max(outline.area for outline in whole) > 0.8 * largest.area:
        return max((outline for outline in whole if outline.area > 0.8 * largest.area), key=sure)
    if len(outlines) == 1:
        return largest
    low = np.floor(np.min([outline.points.min(axis=0) for outline in outlines], axis=0)) - 1.0
    high = np.ceil(np.max([outline.points.max(axis=0) for outline in outlines], axis=0)) + 1.0
    size = (int(high[1] - low[1]) + 1, int(high[0] - low[0]) + 1)
    union = np.zeros(size, dtype=bool)
    for outline in outlines:
        union |= _core.filled([np.ascontiguousarray(outline.points - low)], size)
    ring = max(_core.border(union), key=len) + low
    nothing = np.full(len(ring), np.nan)
    return dataclasses.replace(
        largest, points=ring, strength=nothing, error=nothing, slope=nothing, offset=nothing,
        normal=np.full((len(ring), 2), np.nan), held=np.zeros(len(ring), dtype=bool),
        note=f"the union of {len(group)} parts that blocks have seen", explanation="",
    )


def labels(outlines: Sequence[Outline], shape: tuple[int, int], chunks: Any = "auto") -> Any:
    """Outlines as a dask array of labels from 1, painted block by block; of two in a pixel the later is seen.

    Parameters
    ----------
    outlines : sequence of Outline
        Points (x, y) in the whole image.
    shape : tuple of int
        Rows and columns.
    chunks
        As of dask.

    Returns
    -------
    dask.array.Array of int32
    """
    import dask
    import dask.array

    sizes = dask.array.core.normalize_chunks(chunks, shape, dtype=np.int32)
    edges = [np.concatenate([[0], np.cumsum(size)]) for size in sizes]
    boxes = [(outline.points.min(axis=0), outline.points.max(axis=0)) for outline in outlines]
    # which outlines each block has to do with
    own: dict[tuple[int, int], list[tuple[int, Floats]]] = {}
    for number, (outline, (low, high)) in enumerate(zip(outlines, boxes), start=1):
        spans = []
        for axis, own_edges in ((1, edges[0]), (0, edges[1])):
            begin = int(np.searchsorted(own_edges, np.floor(low[axis]), side="right")) - 1
            end = int(np.searchsorted(own_edges, np.ceil(high[axis]), side="right")) - 1
            spans.append(range(max(begin, 0), min(end, len(own_edges) - 2) + 1))
        for place in itertools.product(spans[0], spans[1]):
            own.setdefault(place, []).append((number, outline.points))
    rows = []
    for i, height in enumerate(sizes[0]):
        row = []
        for j, width in enumerate(sizes[1]):
            corner = (int(edges[1][j]), int(edges[0][i]))
            painted = dask.delayed(_painted, pure=False)((height, width), corner, own.get((i, j), []))
            row.append(dask.array.from_delayed(painted, shape=(height, width), dtype=np.int32))
        rows.append(row)
    return dask.array.block(rows)


def _painted(
    size: tuple[int, int], corner: tuple[int, int], rings: list[tuple[int, Floats]]
) -> np.ndarray[Any, np.dtype[np.int32]]:
    out = np.zeros(size, dtype=np.int32)
    for number, ring in rings:
        # no more is filled than its box
        low = np.maximum(np.floor(ring.min(axis=0)) - corner, 0).astype(int)
        high = np.minimum(np.ceil(ring.max(axis=0)) - corner + 1, size[::-1]).astype(int)
        if not (high > low).all():
            continue
        own = np.ascontiguousarray(ring - corner - low)
        inside = _core.filled([own], (int(high[1] - low[1]), int(high[0] - low[0])))
        out[low[1] : high[1], low[0] : high[0]][inside] = number
    return out
