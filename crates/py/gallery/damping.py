"""Damping: ringing, critical, creeping.

An oval ring swings about its circle. Each mode is a damped oscillator and is solved exactly, so a hundred moments
cost a hundred steps, whatever their distance. With the critical damping of its slowest mode it is at rest first.
"""

import matplotlib.pyplot as plt
import numpy as np

import pysnakes

circle = pysnakes.circle(0, 0, 10)
oval = pysnakes.ellipse(0, 0, 12, 8)
slowest = pysnakes.certificate(circle, tether=0.2, tension=2.0)
stiffness = float(slowest.frequency[slowest.frequency > 0].min()) ** 2
critical = pysnakes.critical_damping(1.0, stiffness)
times = np.linspace(0, 25, 120)

figure, axes = plt.subplots(figsize=(6, 3.5))
left = {}
for factor in (0.2, 1.0, 5.0):
    damping = factor * critical
    motion = pysnakes.ring(oval, times, rest=circle, tether=0.2, tension=2.0, damping=damping)
    width = motion[:, 0, 0] - 10.0
    word = pysnakes.regime(1.0, damping, stiffness)
    axes.plot(times, width, label=f"{factor:g} of critical: {word}")
    left[word] = np.abs(width[60:]).max()
axes.set_xlabel("time")
axes.set_ylabel("half width less that of the circle")
axes.legend(fontsize=8)
figure.tight_layout()

assert left["critical"] < 0.1 * min(left["underdamped"], left["overdamped"])
