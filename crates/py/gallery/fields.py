"""Force fields of an image.

What pulls a curve, by kind: edges reach three times the width of the smoothing, the nearest edge and gradient vector
flow reach as far as the image. Color is the direction of the force, brightness its size.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import hsv_to_rgb

import pysnakes

y, x = np.mgrid[:120, :120]
image = np.clip(30.5 - np.hypot(x - 60, (y - 60) * 1.3), 0, 1) * (1 - np.clip(8.5 - np.hypot(x - 78, y - 60), 0, 1))

figure, all_axes = plt.subplots(2, 3, figsize=(7.5, 5.2))
all_axes[0, 0].imshow(image, cmap="gray")
all_axes[0, 0].set_title("image, and colors of directions", fontsize=9)
down, right = np.mgrid[-1:1:81j, -1:1:81j]
hue = np.arctan2(down, right) / (2 * np.pi) + 0.5
wheel = np.concatenate([hsv_to_rgb(np.stack([hue, hue**0, hue**0], axis=-1)), (np.hypot(right, down) < 1)[..., None]], axis=-1)
legend = all_axes[0, 0].inset_axes((0.76, 0.02, 0.22, 0.22))
legend.imshow(wheel)
legend.axis("off")
far = {}
for kind, axes in zip(["edge", "scales", "distance", "gvf", "vfc"], all_axes.flat[1:]):
    force = pysnakes.force_field(image, kind)
    size = np.hypot(force[..., 0], force[..., 1])
    hue = np.arctan2(force[..., 1], force[..., 0]) / (2 * np.pi) + 0.5
    shown = np.stack([hue, np.ones_like(hue), np.clip(size / np.quantile(size, 0.95), 0, 1) ** 0.5], axis=-1)
    axes.imshow(hsv_to_rgb(shown))
    axes.set_title(kind, fontsize=9)
    far[kind] = size[4, 60] / size.max()
for axes in all_axes.flat:
    axes.axis("off")
figure.tight_layout()

assert far["edge"] < 1e-3 and min(far["distance"], far["gvf"], far["vfc"]) > 1e-2
