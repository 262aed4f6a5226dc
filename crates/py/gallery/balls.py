"""Balls that hit a wall.

Three oval balls of the same mass, from soft to hard, in the report's world of two walls and gravity. A simulation is stepped
with a callback between.
"""

import matplotlib.pyplot as plt
import numpy as np

import pysnakes

figure, all_axes = plt.subplots(1, 3, figsize=(9, 3.2), sharex=True, sharey=True)
squeezed = []
for name, axes in zip(["soft-ball", "rigid-ball", "hard-ball"], all_axes):
    simulation = pysnakes.Scene.load(name).simulation()
    shapes: list[np.ndarray] = []
    simulation.run(7000, lambda now: shapes.append(now.points), every=350)
    for share, points in zip(np.linspace(0, 1, len(shapes)), shapes):
        ring = np.concatenate([points, points[:1]])
        axes.plot(*ring.T, color=plt.get_cmap("viridis")(share), linewidth=0.8)
    areas = [abs(np.cross(p - p.mean(0), np.roll(p, -1, 0) - p.mean(0)).sum()) / 2 for p in map(np.asarray, shapes)]
    squeezed.append(min(areas) / max(areas))
    axes.set_title(f"{name}: down to {100 * squeezed[-1]:.0f} % of its area", fontsize=9)
    axes.set_aspect("equal")
    axes.axhline(0, color="black")
    axes.axvline(0, color="black")
figure.tight_layout()

assert squeezed == sorted(squeezed)  # the harder, the less it is squeezed
