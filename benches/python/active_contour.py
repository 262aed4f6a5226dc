"""`active_contour` here and in scikit-image, in turns, by CPU time of the process.

    target/python/bin/python benches/python/active_contour.py [--rounds N]

Prints a table: the least CPU time of each over the rounds, their ratio, and how far the curves are apart. Needs what
`.ci/python` installs. BLAS runs on one thread.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Callable
from typing import Any

for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ.setdefault(name, "1")

import numpy as np  # noqa: E402
from skimage import data  # noqa: E402
from skimage.color import rgb2gray  # noqa: E402
from skimage.filters import gaussian  # noqa: E402
from skimage.segmentation import active_contour as reference  # noqa: E402

import pysnakes  # noqa: E402


def cases() -> list[tuple[str, Any, Any, dict[str, Any]]]:
    turn = np.linspace(0, 2 * np.pi, 400)
    face = np.array([100 + 100 * np.sin(turn), 220 + 100 * np.cos(turn)]).T
    line = np.column_stack([np.linspace(136, 50, 100), np.linspace(5, 424, 100)])
    astronaut = gaussian(rgb2gray(data.astronaut()), sigma=3, preserve_range=False)
    y, x = np.mgrid[:256, :256]
    disc = gaussian((np.hypot(x - 128, y - 128) < 60).astype(float), sigma=3)
    ring = np.array([128 + 75 * np.sin(turn[::2]), 128 + 75 * np.cos(turn[::2])]).T
    return [
        ("astronaut, 512×512, 400 points", astronaut, face, {"alpha": 0.015, "beta": 10, "gamma": 0.001}),
        ("text, 172×448, 100 points, fixed", gaussian(data.text(), sigma=1, preserve_range=False), line,
         {"boundary_condition": "fixed", "alpha": 0.1, "beta": 1.0, "w_line": -5, "w_edge": 0, "gamma": 0.1}),
        ("disc, 256×256, 200 points, 2500 steps", disc, ring,
         {"alpha": 0.015, "beta": 10, "gamma": 0.001, "convergence": 0.0}),
    ]


def seconds(work: Callable[[], Any], least: float = 0.05) -> tuple[float, Any]:
    """CPU seconds of one call, over as many as take long enough to be measured."""
    calls, began = 0, time.process_time()
    while True:
        result = work()
        calls += 1
        took = time.process_time() - began
        if took >= least:
            return took / calls, result


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--rounds", type=int, default=7)
    rounds = parser.parse_args().rounds
    print("| case | scikit-image, ms | pysnakes, ms | ratio | apart, pixels |\n| --- | ---: | ---: | ---: | ---: |")
    for name, image, snake, rules in cases():
        theirs, ours = [], []
        for _ in range(rounds):
            took, a = seconds(lambda: reference(image, snake, **rules))
            theirs.append(took)
            took, b = seconds(lambda: pysnakes.active_contour(image, snake, **rules))
            ours.append(took)
        apart = float(np.hypot(*(a - b).T).max())
        them, us = 1e3 * min(theirs), 1e3 * min(ours)
        print(f"| {name} | {them:.1f} | {us:.2f} | {them / us:.0f} | {apart:.1e} |", flush=True)


if __name__ == "__main__":
    main()
