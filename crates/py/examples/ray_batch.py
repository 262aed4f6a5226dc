"""A folder of files on Ray, into the same table as with Dask.

    pip install ray pysnakes[store]
    python ray_batch.py FOLDER RESULTS X Y RADIUS

Not run by the gate: Ray takes some 300 MB and seconds to begin.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")

import ray  # noqa: E402

import pysnakes  # noqa: E402
from pysnakes.store import fit_file  # noqa: E402


def main() -> None:
    folder, store = Path(sys.argv[1]), sys.argv[2]
    x, y, radius = map(float, sys.argv[3:6])
    ray.init(num_cpus=2, include_dashboard=False)
    start = ray.put(pysnakes.circle(x, y, radius))
    work = ray.remote(max_retries=3)(fit_file)  # a file is begun only if its results are not there
    left = [work.remote(str(path), start, store) for path in sorted(folder.iterdir())]
    counts: dict[object, int] = {}
    while left:
        done, left = ray.wait(left)
        for one in ray.get(done):
            counts[one["done"]] = counts.get(one["done"], 0) + 1
    print(counts)


if __name__ == "__main__":
    main()
