"""How sure a node is.

A disc in noise of four strengths, fifty times each. The standard error that a fit states for its nodes is compared with
how far they really are from the circle, which is a formula. The points lie a little below the line: what is stated is
cautious by a third.
"""

import matplotlib.pyplot as plt
import numpy as np

import pysnakes

y, x = np.mgrid[:96, :96]
clean = 60 + 100 * np.clip(25.5 - np.hypot(x - 47.3, y - 48.6), 0, 1)
noise = np.random.default_rng(4)
start = pysnakes.circle(49, 47, 29)

stated, true = [], []
for sigma in (2.0, 5.0, 10.0, 20.0):
    found = [pysnakes.fit(clean + noise.normal(0, sigma, clean.shape), start) for _ in range(50)]
    errors = np.concatenate([outline.error for outline in found])
    off = np.concatenate([np.hypot(*(outline.points - (47.3, 48.6)).T) - 25.0 for outline in found])
    measured = np.isfinite(errors)
    stated.append(np.sqrt(np.mean(errors[measured] ** 2)))
    true.append(np.sqrt(np.mean(off[measured] ** 2)))

figure, axes = plt.subplots(figsize=(4.5, 4))
axes.loglog(stated, true, "o")
axes.loglog([0.006, 0.1], [0.006, 0.1], "k:", linewidth=1)
axes.set_xlim(0.006, 0.1)
axes.set_ylim(0.006, 0.1)
for sigma, a, b in zip((2, 5, 10, 20), stated, true):
    axes.annotate(f" noise {sigma}", (a, b), fontsize=8)
axes.set_xlabel("standard error stated, pixels")
axes.set_ylabel("deviation from the circle, pixels")
figure.tight_layout()

ratio = np.array(true) / np.array(stated)
assert ((ratio > 1 / 3) & (ratio < 3)).all()
