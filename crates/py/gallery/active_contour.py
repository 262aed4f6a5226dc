"""The face of the astronaut, by scikit-image's signature.

The gallery example of scikit-image with another import. Both curves lie on each other to a few hundredths of a pixel;
how long each takes is measured by ``benches/python/active_contour.py``.
"""

import matplotlib.pyplot as plt
import numpy as np
from skimage import data
from skimage.color import rgb2gray
from skimage.filters import gaussian
from skimage.segmentation import active_contour as reference

import pysnakes

image = gaussian(rgb2gray(data.astronaut()), sigma=3, preserve_range=False)
turn = np.linspace(0, 2 * np.pi, 400)
start = np.array([100 + 100 * np.sin(turn), 220 + 100 * np.cos(turn)]).T

ours = pysnakes.active_contour(image, start, alpha=0.015, beta=10, gamma=0.001)
theirs = reference(image, start, alpha=0.015, beta=10, gamma=0.001)

figure, axes = plt.subplots(figsize=(5, 5))
axes.imshow(image, cmap="gray")
axes.plot(start[:, 1], start[:, 0], "--", color="tab:blue", linewidth=1)
axes.plot(theirs[:, 1], theirs[:, 0], color="white", linewidth=4)
axes.plot(ours[:, 1], ours[:, 0], color="tab:orange", linewidth=1.5)
axes.set_title("white: scikit-image, orange: pysnakes", fontsize=9)
axes.axis("off")

assert np.abs(ours - theirs).max() < 0.1
