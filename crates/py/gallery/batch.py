"""A folder of files, on Dask, into one table.

Every file's results are written whole or not at all, so a second run, after whatever ended the first, does only what is
left. The table is Parquet: pandas, DuckDB and QGIS read it. The same lines run on a cluster whose workers see the
folder.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import pysnakes
from pysnakes.dask import fit_bag
from pysnakes.store import Results

y, x = np.mgrid[:80, :80]
folder = Path(tempfile.mkdtemp())
(folder / "images").mkdir()
for index in range(24):
    disc = 60 + 120 * np.clip(12 + index / 2 + 0.5 - np.hypot(x - 40, y - 40), 0, 1)
    header = b"P5 80 80 255\n"
    (folder / "images" / f"disc-{index:02}.pgm").write_bytes(header + disc.astype(np.uint8).tobytes())

bag = fit_bag(folder / "images", pysnakes.circle(41, 39, 20), folder / "results")
first = bag.compute(scheduler="threads")
again = bag.compute(scheduler="threads")
table = Results(folder / "results").table()

figure, axes = plt.subplots(figsize=(5, 3.5))
radii = np.sqrt(np.array(table["area"]) / np.pi)
axes.plot(12 + np.arange(24) / 2, radii, "o")
axes.plot([12, 24], [12, 24], "k:", linewidth=1)
axes.set_xlabel("radius drawn, pixels")
axes.set_ylabel("radius found, pixels")
figure.tight_layout()

assert {one["done"] for one in first} == {"now"} and {one["done"] for one in again} == {"before"}
assert table.num_rows == 24 and np.abs(radii - (12 + np.arange(24) / 2)).max() < 0.1
