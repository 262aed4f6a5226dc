"""Pictures that tests share; their outlines are formulas."""

import numpy as np
import pytest


def disc(shape=(96, 96), center=(48.0, 44.0), radius=20.0, low=40.0, high=200.0):
    """A bright disc whose border is smooth over a pixel."""
    y, x = np.mgrid[: shape[0], : shape[1]]
    return low + (high - low) * np.clip(radius + 0.5 - np.hypot(x - center[0], y - center[1]), 0.0, 1.0)


@pytest.fixture
def bright():
    return disc()
