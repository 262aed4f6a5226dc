"""Forces of images, exact motion, damping, and what parameters say before a step is made."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from . import _core
from ._inputs import ArrayLike, Floats, image_of, points_of


def force_field(
    image: ArrayLike,
    kind: str = "edge",
    *,
    energy: bool = False,
    mask: ArrayLike | None = None,
    **parameters: Any,
) -> Any:
    """The force that an image exerts at every pixel.

    Parameters
    ----------
    image : array_like
        As in :func:`pysnakes.fit`.
    kind : {"edge", "color-edge", "scales", "line", "termination", "distance", "gvf", "vfc"}
        Edges; edges in color; edges at several scales; bright or dark lines; ends of lines and corners; the nearest
        edge; gradient vector flow; vector field convolution.
    energy : bool
        Whether to give the energy too.
    mask : array_like of bool, optional
        True where a pixel counts.
    **parameters
        Of the kind: `sigma` and `strength` of all but "scales" (`sigmas`); `shade` of "line"; `floor` of
        "termination"; `threshold` and `reach` of "distance" and "vfc"; `threshold`, `smoothness` or `spread`, and
        `knee` of "gvf"; `exponent` or `width`, and `knee` of "vfc".

    Returns
    -------
    force : ndarray of shape (rows, columns, 2)
        (x, y) at each pixel. M L T⁻².
    energy : ndarray of shape (rows, columns) or None
        Only if asked for: what the force is minus the gradient of; None if there is no such energy.

    Raises
    ------
    TypeError
        A parameter that the kind does not have.
    ValueError
        A kind that there is not; a parameter out of its range.
    """
    force, potential = _core.force_field(image_of(image, mask), kind, parameters)
    return (force, potential) if energy else force


def ring(
    start: ArrayLike,
    times: ArrayLike,
    *,
    rest: ArrayLike | None = None,
    velocity: ArrayLike | None = None,
    tether: float = 0.0,
    tension: float = 1.0,
    rigidity: float = 0.0,
    mass: float = 1.0,
    damping: float = 0.0,
) -> Floats:
    """Exact motion of a closed elastic curve on which nothing acts from outside.

    Every mode is a damped oscillator, solved exactly: there is no error of a step, however long it is.

    Parameters
    ----------
    start : array_like of shape (n, 2)
        Nodes at time 0. L.
    times : array_like of shape (k,)
        At least 0. T.
    rest : array_like of shape (n, 2), optional
        The shape without deformation; a circle of the same number of nodes and length if not given.
    velocity : array_like of shape (n, 2), optional
        At time 0; none if not given. L T⁻¹.
    tether, tension, rigidity : float
        Resistance to displacement, stretching and bending out of the rest shape. M T⁻², M L² T⁻², M L⁴ T⁻².
    mass, damping : float
        Densities along the curve. M, M T⁻¹.

    Returns
    -------
    ndarray of shape (k, n, 2)
        Nodes at each time.
    """
    nodes = points_of(start, "start")
    moments = np.atleast_1d(np.asarray(times, dtype=np.float64))
    if not (np.isfinite(moments).all() and (moments >= 0.0).all()):
        raise ValueError("times must be finite and at least 0")
    if rest is None:
        length = float(np.hypot(*(np.roll(nodes, -1, axis=0) - nodes).T).sum())
        turn = 2.0 * np.pi * np.arange(len(nodes)) / len(nodes)
        radius = length / (2.0 * np.pi)
        rest = nodes.mean(axis=0) + radius * np.column_stack([np.cos(turn), np.sin(turn)])
    shape = points_of(rest, "rest")
    moving = np.zeros_like(nodes) if velocity is None else points_of(velocity, "velocity")
    for name, other in (("rest", shape), ("velocity", moving)):
        if len(other) != len(nodes):
            raise ValueError(f"{name} must have as many points as start, {len(nodes)}, got {len(other)}")
    return _core.ring(shape, nodes, moving, moments.tolist(), [tether, tension, rigidity, mass, damping])


def critical_damping(mass: float, stiffness: float) -> float:
    """Damping at which an oscillator comes to rest first, 2 √(mass stiffness) (report §3.4.2).

    Parameters
    ----------
    mass : float
        At least 0. M.
    stiffness : float
        λ of a mode, at least 0. M T⁻².

    Returns
    -------
    float
        M T⁻¹.
    """
    if not (mass >= 0.0 and stiffness >= 0.0):
        raise ValueError(f"mass and stiffness must be at least 0, got {mass} and {stiffness}")
    return 2.0 * math.sqrt(mass * stiffness)


def regime(mass: float, damping: float, stiffness: float) -> str:
    """How an oscillator comes to rest: "underdamped", "critical", "overdamped" or "undamped".

    Parameters
    ----------
    mass, damping, stiffness : float
        At least 0. M, M T⁻¹, M T⁻².
    """
    if not damping >= 0.0:
        raise ValueError(f"damping must be at least 0, got {damping}")
    critical = critical_damping(mass, stiffness)
    if damping == 0.0:
        return "undamped"
    if math.isclose(damping, critical, rel_tol=1e-12):
        return "critical"
    return "underdamped" if damping < critical else "overdamped"


@dataclasses.dataclass(frozen=True, eq=False)
class Certificate:
    """What a snake's parameters say of its motion, before a step is made.

    Attributes
    ----------
    nodes : int
        Nodes.
    elastic, image, contact : float
        Highest frequencies of the elastic force, about an edge, at a wall. T⁻¹.
    step_limits : dict
        The largest step of each scheme; None where no step is too large. T.
    frequency, damping_ratio, decay : ndarray
        Of each mode: ω without damping, ζ (below 1 it rings), and the rate at which it fades in the end. T⁻¹, 1, T⁻¹.
    time_to_rest : float or None
        Until the slowest mode has fallen to a hundredth; None without damping. T.
    complete : bool
        Whether these are all modes.
    text : str
        The same for people.
    """

    nodes: int
    elastic: float
    image: float
    contact: float
    step_limits: dict[str, float | None]
    frequency: Floats
    damping_ratio: Floats
    decay: Floats
    time_to_rest: float | None
    complete: bool
    text: str

    @classmethod
    def _of(cls, told: dict[str, Any]) -> Certificate:
        return cls(**told)

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        ringing = int((self.damping_ratio < 1.0).sum())
        creeping = len(self.damping_ratio) - ringing
        rest = "never at rest" if self.time_to_rest is None else f"at rest after {self.time_to_rest:.4g} T"
        return f"<Certificate of {self.nodes} nodes: {ringing} modes ring, {creeping} creep, {rest}>"


def certificate(
    rest: ArrayLike,
    *,
    closed: bool = True,
    tether: float = 0.0,
    tension: float = 1.0,
    rigidity: float = 0.0,
    mass: float = 1.0,
    damping: float = 0.0,
) -> Certificate:
    """What the parameters of a lone curve say of its motion.

    Parameters
    ----------
    rest : array_like of shape (n, 2)
        Its rest shape. L.
    closed : bool
        Whether it is closed; else its ends are free.
    tether, tension, rigidity, mass, damping : float
        As in :func:`ring`.

    Returns
    -------
    Certificate
    """
    numbers: Sequence[float] = [tether, tension, rigidity, mass, damping]
    return Certificate._of(_core.certificate(points_of(rest, "rest"), closed, numbers))
