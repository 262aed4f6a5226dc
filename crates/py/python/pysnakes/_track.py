"""Outlines followed through frames."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import numpy as np

from . import _core
from ._inputs import ArrayLike, Floats, image_of, start_of


@dataclasses.dataclass(frozen=True, eq=False)
class TrackedOutline:
    """One object in a frame.

    Attributes
    ----------
    id : int
        Its number, from 1, the same in all frames.
    parent : int or None
        The object it came from by division.
    points : ndarray of shape (n, 2)
        Nodes (x, y). Pixels.
    error : ndarray of shape (n,)
        Standard error of each node along its normal. Pixels.
    state : {"seen", "partly", "coasting", "left"}
        How it is known.
    confidence : float
        What was seen against what was learnt: about 1 at best, 0 for nothing.
    velocity : tuple of float
        Motion of its middle, (x, y). Pixels a frame.
    rotation : float
        Radians a frame.
    """

    id: int
    parent: int | None
    points: Floats
    error: Floats
    state: str
    confidence: float
    velocity: tuple[float, float]
    rotation: float

    def to_mask(self, shape: tuple[int, int]) -> np.ndarray[Any, np.dtype[np.bool_]]:
        """The pixels of an image of that shape whose centers are inside."""
        return _core.filled([self.points], shape)

    def __repr__(self) -> str:
        return f"<TrackedOutline {self.id}, {self.state}, {len(self.points)} nodes, confidence {self.confidence:.2f}>"


@dataclasses.dataclass(frozen=True)
class Event:
    """Something that happened to an object: ``what`` is a word such as "begun", "hidden", "found", "left", "lost",
    "divided", "born", "merged"; ``others`` are the objects it became or cannot be told from."""

    id: int
    what: str
    others: tuple[int, ...]
    confidence: float


@dataclasses.dataclass(frozen=True, eq=False)
class Tracked:
    """All objects in a frame."""

    frame: int
    outlines: list[TrackedOutline]
    events: list[Event]

    def __getitem__(self, id: int) -> TrackedOutline:
        """The object of this number."""
        for outline in self.outlines:
            if outline.id == id:
                return outline
        raise KeyError(f"no object {id} in frame {self.frame}; there are {[o.id for o in self.outlines]}")

    def __repr__(self) -> str:
        happened = "".join(f", {event.what} {event.id}" for event in self.events)
        return f"<Tracked frame {self.frame}: {len(self.outlines)} outlines{happened}>"


def _told(told: dict[str, Any]) -> Tracked:
    outlines = [TrackedOutline(**one) for one in told["outlines"]]
    events = [Event(id, what, tuple(others), sure) for id, what, others, sure in told["events"]]
    return Tracked(told["frame"], outlines, events)


class Tracker:
    """Objects that are followed, one frame after the other.

    Parameters
    ----------
    frame : array_like
        The first frame; an image as in :func:`pysnakes.fit`.
    start : array_like or list of array_like
        The outline of an object in it, as in :func:`pysnakes.fit`, or a list of such.
    start_as : {"chosen", "exact", "rough"}
        Whether starts are outlines as they are, drawn roughly, or which is to be found out.
    patience : int
        An object that was not seen for so many frames is given up.
    births : bool
        Whether objects may divide and new ones appear, as cells do.
    threads : int
        Results do not depend on it.
    **options
        Of the fit of a rough start, as in :func:`pysnakes.fit`.

    Raises
    ------
    TypeError, ValueError
        As :func:`pysnakes.fit`; a start that encloses nothing in the frame.
    """

    def __init__(
        self,
        frame: ArrayLike,
        start: ArrayLike,
        *,
        start_as: str = "chosen",
        patience: int = 30,
        births: bool = False,
        threads: int = 1,
        **options: Any,
    ) -> None:
        first = image_of(frame, name="frame 0")
        several = isinstance(start, (list, tuple)) and len(start) > 0 and np.ndim(_shape_of(start[0])) == 2
        starts: Sequence[ArrayLike] = start if several else [start]
        points = [start_of(one, first.shape) for one in starts]
        rules = (int(patience), int(threads), bool(births))
        self._tracker = _core.Tracker(first, points, start_as, rules, options)
        self._frames = 1

    @property
    def first(self) -> Tracked:
        """The first frame as it was taken."""
        return _told(self._tracker.first())

    def next(self, frame: ArrayLike) -> Tracked:
        """Follow all objects into the next frame, of the size of the first."""
        image = image_of(frame, name=f"frame {self._frames}")
        told = _told(self._tracker.next(image))
        self._frames += 1
        return told


def _shape_of(one: ArrayLike) -> ArrayLike:
    return getattr(one, "points", one)


def track(frames: Iterable[ArrayLike], start: ArrayLike, **options: Any) -> Iterator[Tracked]:
    """Follow outlines through frames.

    Parameters
    ----------
    frames : iterable of array_like
        Images as in :func:`pysnakes.fit`, all of one size; one is in memory at a time.
    start : array_like or list of array_like
        The outline of an object in the first, or of several.
    **options
        As :class:`Tracker`.

    Yields
    ------
    Tracked
        Of every frame, the first included, as soon as it is there.

    Raises
    ------
    TypeError, ValueError
        As :class:`Tracker`; no frame; a frame of another size.
    """
    rest = iter(frames)
    try:
        first = next(rest)
    except StopIteration:
        raise ValueError("frames must hold at least one frame, got none") from None
    tracker = Tracker(first, start, **options)
    return _followed(tracker, rest)


def _followed(tracker: Tracker, frames: Iterator[ArrayLike]) -> Iterator[Tracked]:
    yield tracker.first
    for frame in frames:
        yield tracker.next(frame)
