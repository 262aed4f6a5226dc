"""The apple.

One rough circle, one call. The outline is drawn with a band of ten standard errors: where the edge is weak, the band is
wide. From the contour that was clicked by hand and comes with the picture nearly the same outline is found: of what both
enclose, 97 % is common.
"""

import matplotlib.pyplot as plt

import pysnakes

apple = pysnakes.picture("apple")
start = pysnakes.circle(256, 270, 220)
found = pysnakes.fit(apple, start)

figure, axes = plt.subplots(figsize=(5, 5))
axes.plot(*start.T, color="tab:blue", linewidth=1, linestyle="--")
found.plot(axes, image=apple, errors=10)
axes.set_title(f"{found.area:.0f} px², circularity {found.measures.circularity:.3f}")
axes.axis("off")

by_hand = pysnakes.fit(apple, pysnakes.contour("apple-whole-without-the-stem")).to_mask()
overlap = (found.to_mask() & by_hand).sum() / (found.to_mask() | by_hand).sum()
assert found.is_outline and overlap > 0.97
