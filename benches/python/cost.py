"""What a fit of a file costs, piece by piece: read, start, fit, write, send.

    target/python/bin/python benches/python/cost.py

CPU time of the process, the least of several rounds; what it is for is in docs/python-scale.md.
"""

from __future__ import annotations

import pickle
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib.image
import numpy as np
from distributed import Client, LocalCluster

import pysnakes
from pysnakes.dask import BlockOutline, _fit_block, _Place
from pysnakes.store import Results


def least(work: Callable[[], Any], rounds: int = 15) -> tuple[float, Any]:
    took, result = [], None
    for _ in range(rounds):
        began = time.process_time()
        result = work()
        took.append(time.process_time() - began)
    return 1e3 * min(took), result


def picture(size: int, radius: float) -> np.ndarray[Any, Any]:
    y, x = np.mgrid[:size, :size]
    noise = np.random.default_rng(3).normal(0, 6, (size, size))
    inside = np.clip(radius + 0.5 - np.hypot(x - size / 2, y - size / 2), 0, 1)
    return np.clip(60 + 110 * inside + noise, 0, 255).astype(np.uint8)


def main() -> None:
    folder = Path(tempfile.mkdtemp())
    image = picture(512, 60.0)
    matplotlib.image.imsave(folder / "a.png", image, cmap="gray")
    (folder / "a.pgm").write_bytes(b"P5 512 512 255\n" + image.tobytes())
    start = pysnakes.circle(258, 254, 70)
    rows = []
    rows.append(("read, PNG of 512×512", least(lambda: pysnakes.read_image(folder / "a.png"))[0]))
    rows.append(("read, PGM of 512×512", least(lambda: pysnakes.read_image(folder / "a.pgm"))[0]))
    for radius in (15.0, 60.0, 200.0):
        image = picture(512, radius)
        around = pysnakes.circle(257, 255, radius * 1.15)
        took, found = least(lambda: pysnakes.fit(image, around))
        assert found.is_outline
        rows.append((f"fit, radius {radius:.0f}, {len(found)} nodes", took))
    image = picture(512, 60.0)
    found = pysnakes.fit(image, start)
    results, names = Results(folder / "results"), iter(range(10**6))
    rows.append(("write a file of results", least(lambda: results.write(str(next(names)), [found]))[0]))
    path = sum(part.stat().st_size for part in results.folder.iterdir()) / len(list(results.folder.iterdir()))
    rows.append(("pickle and unpickle an outline", least(lambda: pickle.loads(pickle.dumps(found)))[0]))
    rows.append(("pickle and unpickle an image of 512×512", least(lambda: pickle.loads(pickle.dumps(image)))[0]))
    block = np.tile(picture(256, 40.0), (4, 4))
    starts = [(k + 1, pysnakes.circle(128 + 256 * (k % 4), 128 + 256 * (k // 4), 46)) for k in range(16)]
    place = _Place((0, 0), 1, (1024, 1024), (0, 0, 1024, 1024), ((), ()))
    took, parts = least(lambda: _fit_block(block, starts, place, {}), 5)
    assert all(isinstance(part, BlockOutline) and part.outline.is_outline for part in parts)
    rows.append(("a block of 1024×1024 with 16 objects", took))
    with LocalCluster(
        n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address="127.0.0.1:0",
        worker_dashboard_address="127.0.0.1:0",
    ) as cluster, Client(cluster) as client:
        client.gather(client.map(abs, range(100), pure=False))
        began = time.perf_counter()
        client.gather(client.map(abs, range(2000), pure=False))
        rows.append(("a task of Dask, elapsed, of two workers together", 0.5 * (time.perf_counter() - began)))
        payload = [np.zeros(1 << 20, np.uint8) for _ in range(50)]
        began = time.perf_counter()
        client.gather(client.map(len, client.scatter(payload), pure=False))
        rows.append(("1 MiB to a worker, elapsed", 20.0 * (time.perf_counter() - began)))
    print("| piece | CPU, ms |\n| --- | ---: |")
    for name, took in rows:
        print(f"| {name} | {took:.2f} |")
    print(f"\nbytes: results {path:.0f}, pickled outline {len(pickle.dumps(found))}, image {image.nbytes}")


if __name__ == "__main__":
    main()
