"""A snake on its way to the top of the apple.

The scene is the report's: an open snake is drawn across the stem, the edge pulls, its mass carries it past, damping
calms it. The observer is called with the time, the number of steps and the nodes; here it keeps them.
"""

import matplotlib.pyplot as plt
import numpy as np

import pysnakes

scene = pysnakes.Scene.load("apple")
start = scene.simulation().points
kept: list[np.ndarray] = []


def observe(t: float, step: int, points: np.ndarray) -> None:
    kept.append(points)


record = scene.run(observe, every=100)

figure, axes = plt.subplots(figsize=(5, 4))
axes.imshow(pysnakes.picture("apple"), cmap="gray")
for share, points in zip(np.linspace(0, 1, len(kept)), kept):
    axes.plot(*points.T, color=plt.get_cmap("plasma")(0.9 - 0.8 * share), linewidth=1)
axes.plot(*start.T, "--", color="tab:cyan", linewidth=1)
axes.plot(*record.last.points.T, color="white", linewidth=2)
axes.set_title("dashed: drawn; yellow to violet: on its way; white: at rest", fontsize=9)
# where it has moved
moved = np.hypot(*(record.last.points - start).T) > 12
low, high = start[moved].min(axis=0) - 30, start[moved].max(axis=0) + 30
axes.set_xlim(low[0], high[0])
axes.set_ylim(high[1], low[1])
axes.axis("off")
figure.tight_layout()

assert len(kept) > 3
# it has come to rest: the last two that were kept are nearer than the first two
way = [np.abs(b - a).max() for a, b in zip(kept, kept[1:])]
assert way[-1] < 0.2 * way[0]
