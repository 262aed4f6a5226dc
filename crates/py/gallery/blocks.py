"""An image in blocks.

A dask array stands for an image that no memory holds. Each block is seen with some pixels of its neighbors. Labels that
a network gave block by block, numbered anew in each, are the starts. Parts that touch across a border are one start,
and outlines that lie on each other are one object.
"""

import dask.array
import matplotlib.pyplot as plt
import numpy as np
from skimage.measure import label

import pysnakes.dask

y, x = np.mgrid[:300, :400]
noise = np.random.default_rng(2)
centers = [(60 + 70 * i + 10 * (j % 2), 55 + 63 * j) for i in range(5) for j in range(4)]
inside = np.maximum.reduce([np.clip(22.5 - np.hypot(x - cx, y - cy), 0, 1) for cx, cy in centers])
image = 60 + 110 * inside + noise.normal(0, 5, inside.shape)

pixels = dask.array.from_array(image.astype(np.float32), chunks=(100, 100))


def numbered(block: np.ndarray) -> np.ndarray:
    """The connected parts of a block, numbered from 1."""
    return np.asarray(label(block), dtype=np.int32)


seen_by_network = dask.array.from_array(inside > 0.5, chunks=(100, 100))
labels = seen_by_network.map_blocks(numbered, dtype=np.int32)
found = pysnakes.dask.fit_blocks(pixels, labels, depth=40).compute(scheduler="threads")
objects = pysnakes.dask.stitch(found)
painted = np.asarray(pysnakes.dask.labels(objects, pixels.shape, chunks=pixels.chunks))

figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.8))
left.imshow(image, cmap="gray")
for one in found:
    one.outline.plot(left, linewidth=1.5, color=plt.get_cmap("tab20")((one.block[0] * 4 + one.block[1]) % 20))
left.set_title(f"{len(found)} outlines, a color for each of the 12 blocks", fontsize=9)
right.imshow(np.ma.masked_equal(painted * 7 % 20 + (painted > 0), 0), cmap="tab20")
right.set_facecolor("black")
right.set_title(f"labels of {len(objects)} objects, the same on both sides of a border", fontsize=9)
for axes in (left, right):
    for edge in (100, 200, 300):
        axes.axvline(edge, color="white", linewidth=0.4)
        axes.axhline(edge, color="white", linewidth=0.4)
    axes.set_xlim(0, 399)
    axes.set_ylim(299, 0)
    axes.set_xticks([])
    axes.set_yticks([])
figure.tight_layout()

assert len(objects) == len(centers) and (painted > 0).sum() < 1.02 * (inside > 0.5).sum()
