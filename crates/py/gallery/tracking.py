"""An outline followed through frames.

A bright blob drifts, turns and pulses, and passes behind a bar. Where part of it is hidden the rest goes on as the
shape that is remembered. Frames are taken one by one from any iterable.
"""

from collections.abc import Iterator

import matplotlib.pyplot as plt
import numpy as np

import pysnakes

y, x = np.mgrid[:120, :220]
noise = np.random.default_rng(1)


def radius(t: int, angle: np.ndarray) -> np.ndarray:
    return np.asarray(17 + 2.5 * np.cos(3 * (angle - 0.05 * t)) + np.sin(0.3 * t))


def frames() -> Iterator[np.ndarray]:
    for t in range(45):
        dx, dy = x - (35 + 3.3 * t), y - (60 + 12 * np.sin(0.1 * t))
        inside = np.clip(radius(t, np.arctan2(dy, dx)) + 0.5 - np.hypot(dx, dy), 0, 1)
        frame = 60 + 110 * inside
        frame[:, 108:120] = 100  # the bar
        yield frame + noise.normal(0, 4, frame.shape)


start = pysnakes.circle(35, 60, 18)
tracked = list(pysnakes.track(frames(), start))

figure, axes = plt.subplots(figsize=(7, 3.8))
axes.imshow(list(frames())[-1], cmap="gray")
colors = {"seen": "tab:orange", "partly": "gold", "coasting": "tab:red", "left": "tab:purple"}
for one in tracked[::4]:
    outline = one[1]
    ring = np.concatenate([outline.points, outline.points[:1]])
    axes.plot(*ring.T, color=colors[outline.state], linewidth=1)
way = np.array([one[1].points.mean(axis=0) for one in tracked])
axes.plot(*way.T, ":", color="white")
axes.set_title("orange: seen, yellow: seen in part", fontsize=9)
axes.axis("off")

true = np.array([(35 + 3.3 * t, 60 + 12 * np.sin(0.1 * t)) for t in range(45)])
assert np.hypot(*(way - true).T)[-10:].max() < 1.5
