"""The apple.

One rough circle, one call. Below, the standard error of each node along the outline: it is large where the edge is weak.
From the contour that was clicked by hand and comes with the picture nearly the same outline is found: of what both
enclose, 97 % is common.
"""

import matplotlib.pyplot as plt

import pysnakes

apple = pysnakes.picture("apple")
start = pysnakes.circle(256, 270, 220)
found = pysnakes.fit(apple, start)

figure, (axes, below) = plt.subplots(2, 1, figsize=(5, 6.4), height_ratios=[4, 1])
axes.plot(*start.T, color="tab:blue", linewidth=1, linestyle="--")
found.plot(axes, image=apple)
axes.set_title(f"{found.area:.0f} px², circularity {found.measures.circularity:.3f}")
axes.axis("off")
below.plot(found.error, linewidth=0.8)
below.set_xlabel("node")
below.set_ylabel("error, pixels")
figure.tight_layout()

by_hand = pysnakes.fit(apple, pysnakes.contour("apple-whole-without-the-stem")).to_mask()
overlap = (found.to_mask() & by_hand).sum() / (found.to_mask() | by_hand).sum()
assert found.is_outline and overlap > 0.97
