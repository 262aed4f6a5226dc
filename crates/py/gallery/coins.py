"""Many objects in one image.

Twenty-four coins, a rough circle about each, on all cores. Results come in the order of the starts, each as soon as it
is there, and are the same for any number of threads.
"""

import matplotlib.pyplot as plt
import numpy as np
from skimage import data

import pysnakes

image = data.coins()
rows = [(50, [48, 105, 158, 211, 266, 330]), (127, [52, 111, 170, 224, 279, 340])]
rows += [(193, [48, 113, 171, 222, 275, 334]), (264, [50, 103, 160, 214, 272, 341])]
starts = [pysnakes.circle(x, y, 26) for y, columns in rows for x in columns]
found = list(pysnakes.fit_many(image, starts))
good = [outline for outline in found if outline.is_outline]

figure, (left, right) = plt.subplots(1, 2, figsize=(8, 3.4), width_ratios=[3, 2])
left.imshow(image, cmap="gray")
for outline in good:
    outline.plot(left, linewidth=1)
left.set_title(f"{len(good)} of {len(starts)} sure", fontsize=9)
left.axis("off")
right.hist([outline.measures.equivalent_diameter for outline in good], bins=12)
right.set_xlabel("diameter, pixels")
figure.tight_layout()

assert len(good) >= 20
