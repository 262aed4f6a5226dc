"""Scenes: situations as text, run or stepped."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Callable
from typing import Any

import numpy as np

from . import _core
from ._inputs import Floats
from ._physics import Certificate


@dataclasses.dataclass(frozen=True, eq=False)
class Curve:
    """A curve at a moment: its number, whether it is closed, its nodes (x, y) and their velocities if kept."""

    id: int
    closed: bool
    points: Floats
    velocities: Floats | None


@dataclasses.dataclass(frozen=True, eq=False)
class Frame:
    """A moment of a run: steps made, time, every curve, and the energies by name if kept."""

    step: int
    t: float
    curves: list[Curve]
    energies: dict[str, float] | None

    @property
    def points(self) -> Floats:
        """Nodes of the first curve."""
        return self.curves[0].points if self.curves else np.empty((0, 2))


@dataclasses.dataclass(frozen=True, eq=False)
class Record:
    """A run as it was.

    Attributes
    ----------
    scene, title, scheme : str
        What was run, and by which scheme.
    dt : float
        The step. T.
    frames : list of Frame
        The moments kept: the start, those asked for, the end.
    events : list of str
        What happened to curves on the way.
    outcome, reason : str
        How it ended, as a word and in words.
    """

    scene: str
    title: str
    scheme: str
    dt: float
    frames: list[Frame]
    events: list[str]
    outcome: str
    reason: str

    @property
    def last(self) -> Frame:
        """The last moment kept."""
        return self.frames[-1]

    def __repr__(self) -> str:
        return f"<Record of {self.scene!r}: {self.reason}, {len(self.frames)} frames kept>"


def _record(told: dict[str, Any]) -> Record:
    terms = told.pop("terms")
    frames = []
    for step, t, curves, energies in told.pop("frames"):
        named = None if energies is None else dict(zip(terms, energies))
        frames.append(Frame(step, t, [Curve(*curve) for curve in curves], named))
    return Record(frames=frames, **told)


class Scene:
    """A situation that a text describes: a picture, a curve, a material, a world, a plan.

    Made by :meth:`load` or :meth:`parse`; the format is in ``docs/formats.md`` of the project.
    """

    def __init__(self, text: str, folder: str | os.PathLike[str] = ".", name: str = "scene") -> None:
        self._folder = os.fspath(folder)
        self._scene = _core.Scene("text", text, self._folder, name)

    @classmethod
    def load(cls, name: str | os.PathLike[str]) -> Scene:
        """A scene that comes with the package, by its name, or one of a file.

        Parameters
        ----------
        name : str or path
            One of :func:`scene_names`, or a file that ends in ``.toml``.

        Raises
        ------
        ValueError
            A name that none has, with the nearest one; a file that cannot be read or makes no sense, by the key.
        """
        name = os.fspath(name)
        is_file = name.endswith(".toml") or os.sep in name
        scene = cls.__new__(cls)
        scene._folder = os.path.dirname(os.path.abspath(name)) if is_file else "."
        scene._scene = _core.Scene("file" if is_file else "named", name, scene._folder, name)
        return scene

    @classmethod
    def parse(cls, text: str, folder: str | os.PathLike[str] = ".") -> Scene:
        """A scene of a text whose files are looked for in a folder."""
        return cls(text, folder)

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (self.source, self._folder, self.name))

    def __repr__(self) -> str:
        name, title = self._scene.titles
        return f"<Scene {name!r}: {title}>"

    @property
    def name(self) -> str:
        """The name it is called by."""
        return self._scene.titles[0]

    @property
    def title(self) -> str:
        """One line about it."""
        return self._scene.titles[1]

    @property
    def source(self) -> str:
        """The text."""
        return self._scene.source

    def with_values(self, **values: Any) -> Scene:
        """The same scene with other values of some keys.

        Parameters
        ----------
        **values
            Keys with two underscores for the dot, ``run__time=60``; values as Python has them.

        Raises
        ------
        ValueError
            A key that there is not, with the nearest one; a value that will not do.
        """
        texts = [(key.replace("__", ".").replace("_", "-"), _toml(value)) for key, value in values.items()]
        changed = type(self).__new__(type(self))
        changed._scene = self._scene.with_values(texts)
        changed._folder = self._folder
        return changed

    def run(self, observer: Callable[[float, int, Floats], object] | None = None, every: int = 1) -> Record:
        """Run it from its start to its end.

        Parameters
        ----------
        observer : callable, optional
            Called as ``observer(t, steps, points)`` with the nodes of the first curve; the run ends when it returns
            False. What it raises ends the run and is raised.
        every : int
            After every so many steps.

        Returns
        -------
        Record
        """
        if every < 1:
            raise ValueError(f"every must be at least 1, got {every}")
        return _record(self._scene.run(observer, every))

    def simulation(self) -> Simulation:
        """Everything that moves, at its start, to be stepped."""
        return Simulation(self._scene.simulation())

    def certificate(self) -> Certificate:
        """What its parameters say of its motion."""
        return Certificate._of(self._scene.certificate())


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_toml(one) for one in value) + "]"
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    return repr(value)


class Simulation:
    """Curves that move, between two steps. Made by :meth:`Scene.simulation`."""

    def __init__(self, simulation: _core.Simulation) -> None:
        self._simulation = simulation

    @property
    def t(self) -> float:
        """Time."""
        return self._simulation.t

    @property
    def steps(self) -> int:
        """Steps made."""
        return self._simulation.steps

    @property
    def curves(self) -> list[Curve]:
        """Every curve as it is, with velocities."""
        return [Curve(*curve) for curve in self._simulation.curves()]

    @property
    def points(self) -> Floats:
        """Nodes of the first curve, (x, y)."""
        curves = self._simulation.curves()
        return curves[0][2] if curves else np.empty((0, 2))

    @property
    def energies(self) -> dict[str, float]:
        """The energies by name, and their total."""
        return self._simulation.energies()

    def step(self, steps: int = 1) -> str | None:
        """Make so many steps.

        Returns
        -------
        str or None
            How it has ended, in words, if it has.
        """
        if steps < 1:
            raise ValueError(f"steps must be at least 1, got {steps}")
        ended = self._simulation.step(steps)
        return None if ended is None else ended[1]

    def run(self, steps: int, callback: Callable[[Simulation], object] | None = None, every: int = 1) -> str | None:
        """Make so many steps, with a call of ``callback(self)`` after every few; it ends the run by returning False.

        Returns
        -------
        str or None
            How it has ended, in words, if it has before all steps were made.
        """
        if every < 1:
            raise ValueError(f"every must be at least 1, got {every}")
        made = 0
        while made < steps:
            now = min(every if callback is not None else steps, steps - made)
            ended = self.step(now)
            made += now
            if callback is not None and callback(self) is False:
                return "stopped by the callback"
            if ended is not None:
                return ended
        return None

    def hold(self, nodes: list[int], curve: int = 0) -> None:
        """Hold these nodes where they are."""
        self._simulation.hold(curve, nodes, True)

    def release(self, nodes: list[int], curve: int = 0) -> None:
        """Let these nodes go."""
        self._simulation.hold(curve, nodes, False)

    def copy(self) -> Simulation:
        """The same simulation, to go on by itself."""
        return Simulation(self._simulation.copy())

    def __repr__(self) -> str:
        return f"<Simulation at t = {self.t:.6g} after {self.steps} steps, {len(self._simulation.curves())} curves>"


def scene_names() -> list[str]:
    """Names of the scenes that come with the package."""
    return _core.scene_names()
