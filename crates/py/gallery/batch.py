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

figure, (left, right) = plt.subplots(1, 2, figsize=(8, 3.2), width_ratios=[2, 3])
for row in table.slice(0, table.num_rows).to_pylist()[::6]:
    left.plot([*row["x"], row["x"][0]], [*row["y"], row["y"][0]], label=row["image"].split("/")[-1])
left.set_aspect("equal")
left.invert_yaxis()
left.legend(fontsize=7, loc="center")
left.set_title("four rows of the table", fontsize=9)
drawn, radii = 12 + np.arange(24) / 2, np.sqrt(np.array(table["area"]) / np.pi)
right.plot(drawn, radii - drawn, "o")
right.axhline(0, color="black", linewidth=0.5)
right.set_ylim(-0.1, 0.1)
right.set_xlabel("radius drawn, pixels")
right.set_ylabel("radius found less that, pixels")
figure.tight_layout()

assert {one["done"] for one in first} == {"now"} and {one["done"] for one in again} == {"before"}
assert table.num_rows == 24 and np.abs(radii - drawn).max() < 0.1
