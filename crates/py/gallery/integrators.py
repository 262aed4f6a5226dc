"""Schemes against the exact motion.

The same ring by four schemes with steps of several lengths, compared with its exact motion. A scheme of order
one gains a digit for ten times the work, one of order two two digits, and so on.
"""

import matplotlib.pyplot as plt
import numpy as np

import pysnakes

scene = pysnakes.Scene.load("ringing-oval")
steps = np.array([0.05, 0.025, 0.0125, 0.00625])
end = 4.0


def last(scheme: str, dt: float) -> np.ndarray:
    values = {"run__scheme": scheme, "run__dt": float(dt)}
    simulation = scene.with_values(**values).simulation()
    simulation.run(round(end / dt))
    return simulation.points


exact = last("exact", 0.01)
figure, axes = plt.subplots(figsize=(5, 3.8))
orders = {}
for scheme in ("report", "leapfrog", "newmark", "rk4"):
    errors = [np.abs(last(scheme, dt) - exact).max() for dt in steps]
    orders[scheme] = float(np.polyfit(np.log(steps[:3]), np.log(errors[:3]), 1)[0])
    axes.loglog(steps, errors, "o-", label=f"{scheme}: order {orders[scheme]:.1f}")
axes.set_xticks(steps, [f"{dt:g}" for dt in steps])
axes.minorticks_off()
axes.set_xlabel("step")
axes.set_ylabel("largest error of a node")
axes.legend(fontsize=8)
figure.tight_layout()

assert abs(orders["report"] - 1) < 0.3 and abs(orders["leapfrog"] - 2) < 0.3 and abs(orders["rk4"] - 4) < 0.5
