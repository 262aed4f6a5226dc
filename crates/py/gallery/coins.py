"""Many objects in one image.

Coins. A watershed gives rough masks, as a network would; each is refined, on all cores. Results come in the order of
the starts, each as soon as it is there, and are the same for any number of threads.
"""

import matplotlib.pyplot as plt
import numpy as np
from skimage import data
from skimage.filters import sobel
from skimage.measure import label
from skimage.segmentation import watershed

import pysnakes

image = data.coins()
sure = np.where(image < 30, 1, np.where(image > 150, 2, 0))
labels = label(watershed(sobel(image), sure) == 2)
masks = [labels == number for number in range(1, labels.max() + 1)]
starts = [mask for mask in masks if mask.sum() > 300]
found = list(pysnakes.fit_many(image, starts))
good = [outline for outline in found if outline.is_outline]

figure, (left, right) = plt.subplots(1, 2, figsize=(8, 3.4), width_ratios=[3, 2])
left.imshow(image, cmap="gray")
for outline in good:
    outline.plot(left, linewidth=1)
left.set_title(f"{len(good)} of {len(starts)} sure", fontsize=9)
left.axis("off")
right.hist([outline.measures.equivalent_diameter for outline in good], bins=range(36, 66, 2))
right.set_xlabel("diameter, pixels")
right.set_ylabel("coins")
figure.tight_layout()

# all 24 coins, and coins are round
round_ones = [outline.measures.circularity for outline in good]
assert len(good) == 24 and np.median(round_ones) > 0.98 and min(round_ones) > 0.85
