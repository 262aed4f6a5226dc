"""Ours beside its peers, in turn, by the processor time of one thread; writes docs/benchmarks.md.

    python3 benches/peers/beside.py [--rounds 15] [--quick]

The first run makes a virtual environment in target/peers-venv and installs what requirements.txt names. Everything
runs on one thread, one case after the other, round by round, so that whatever else the machine does meets all of
them. Only figures of one run are comparable, and of those the ratios.
"""

import argparse
import datetime
import os
import pathlib
import platform
import statistics
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
VENV = ROOT / "target" / "peers-venv"
ONE_THREAD = {name: "1" for name in
              ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"]}


def in_the_environment():
    """Starts this file again in its own environment, which is made where it is missing."""
    python = VENV / "bin" / "python"
    if pathlib.Path(sys.prefix).resolve() == VENV.resolve():
        return
    if not python.exists():
        subprocess.run([sys.executable, "-m", "venv", VENV], check=True)
        needed = ROOT / "benches" / "peers" / "requirements.txt"
        subprocess.run([python, "-m", "pip", "install", "-q", "-r", needed], check=True)
    os.execve(python, [str(python), *sys.argv], os.environ | ONE_THREAD)


in_the_environment()

import cv2
import numba
import numpy as np
import skimage
from skimage.segmentation import active_contour

cv2.setNumThreads(1)


class Ours:
    """A process that runs the cases of beside.rs, in registers of at most so many bits."""

    def __init__(self, bits):
        program = ROOT / "target" / "release" / "examples" / "beside"
        self.process = subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                                        env=os.environ | {"SNAKES_REGISTERS": str(bits)})

    def ask(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        if not answer:
            raise SystemExit(f"beside has ended at {line!r}")
        return int(answer)


def picture(side, kind):
    y, x = np.mgrid[0:side, 0:side]
    inside = np.hypot(x - side / 2, y - side / 2) < 0.4 * side
    return (np.where(inside, 180, 40) + (x * 7919 + y * 104729) % 23).astype(kind)


# --- the report's force field: 20 passes and a difference along an axis, [1 2 1] across, magnitude, the same again

def report_taps():
    even = np.ones(1)
    for _ in range(20):
        even = np.convolve(even, [0.25, 0.5, 0.25])
    return np.convolve(even, [1, 0, -1])


TAPS = report_taps()
ACROSS = np.array([1.0, 2.0, 1.0]) / 4
SLOPE = np.array([-1.0, 0.0, 1.0])
GAIN = 0.15 * 10


def opencv_filters(image):
    odd = TAPS[::-1].copy()
    return (cv2.sepFilter2D(image, cv2.CV_32F, odd, ACROSS, borderType=cv2.BORDER_REFLECT),
            cv2.sepFilter2D(image, cv2.CV_32F, ACROSS, odd, borderType=cv2.BORDER_REFLECT))


def opencv(image):
    dx, dy = opencv_filters(image)
    np.abs(dx, out=dx)
    np.abs(dy, out=dy)
    across = GAIN * ACROSS
    return (cv2.sepFilter2D(dx, cv2.CV_32F, SLOPE, across, borderType=cv2.BORDER_CONSTANT),
            cv2.sepFilter2D(dy, cv2.CV_32F, across, SLOPE, borderType=cv2.BORDER_CONSTANT))


REACH = 17


@numba.njit(fastmath=True)
def _rows(image, weights, gain, padded, out):
    """The same row by row: what later rows need of earlier ones is kept for three rows.

    The filters are of a length known when this is compiled, so that their loops are unrolled and the loops along the row
    are in wide registers.
    """
    height, width = image.shape
    for r in range(height):
        row, to = image[r], padded[r + REACH]
        for c in range(width):
            to[REACH + c] = row[c]
        for c in range(REACH):
            to[c] = row[min(REACH - 1 - c, width - 1)]
            to[REACH + width + c] = row[max(width - 1 - c, 0)]
    for r in range(REACH):
        padded[r] = padded[2 * REACH - 1 - r]
        padded[height + REACH + r] = padded[height + REACH - 1 - r]
    d = np.zeros((3, width), np.float32)
    a = np.zeros((3, width), np.float32)
    g = np.zeros(width + 2, np.float32)
    h = np.zeros(width + 2, np.float32)
    s = np.zeros(width + 2, np.float32)
    e = np.zeros((3, width), np.float32)
    w = weights
    for r in range(height + 2):
        to = d[r % 3]
        if r < height:
            line = padded[r + REACH]
            for c in range(width):
                total = np.float32(0)
                for k in range(REACH):
                    total += w[k] * (line[REACH + c + k + 1] - line[REACH + c - k - 1])
                to[c] = total
            for c in range(width):
                total = np.float32(0)
                for k in range(REACH):
                    total += w[k] * (padded[r + REACH + k + 1, REACH + c] - padded[r + REACH - k - 1, REACH + c])
                g[c + 1] = total
            for c in range(width):
                h[c + 1] = abs(g[c] + 2 * g[c + 1] + g[c + 2])
            here = e[r % 3]
            for c in range(width):
                here[c] = h[c] + 2 * h[c + 1] + h[c + 2]
        else:
            to[:] = 0.0
            e[r % 3][:] = 0.0
        if 1 <= r <= height:
            up, here, down, to = d[(r - 2) % 3], d[(r - 1) % 3], d[r % 3], a[(r - 1) % 3]
            for c in range(width):
                to[c] = abs(up[c] + 2 * here[c] + down[c])
            lower, upper, to = e[r % 3], e[(r - 2) % 3], out[r - 1]
            for c in range(width):
                to[c, 1] = gain * (lower[c] - upper[c])
        elif r == height + 1:
            a[height % 3][:] = 0.0
        if r >= 2:
            up, here, down = a[(r - 3) % 3], a[(r - 2) % 3], a[(r - 1) % 3]
            for c in range(width):
                s[c + 1] = up[c] + 2 * here[c] + down[c]
            to = out[r - 2]
            for c in range(width):
                to[c, 0] = gain * (s[c + 2] - s[c])


WEIGHTS = np.ascontiguousarray(-TAPS[21 + 1:][:REACH], np.float32)


def numba_rows(image, out, padded):
    _rows(image, WEIGHTS, np.float32(GAIN / 16), padded, out)
    return out


def room(side):
    """Memory for a field and for the picture with its margins."""
    return np.empty((side, side, 2), np.float32), np.empty((side + 2 * REACH, side + 2 * REACH), np.float32)


# --- one step of a snake

@numba.njit(fastmath=True)
def _steps(x, y, u, v, field, steps, tension, rigidity, keep, kick, settle, dt):
    """Leapfrog of a closed snake in a field of pairs, read bilinearly; what each step does is in one loop."""
    n = len(x)
    height, width = field.shape[0], field.shape[1]
    fx, fy = np.zeros(n), np.zeros(n)
    for step in range(steps):
        for i in range(n):
            u[i] = keep * u[i] + kick * fx[i]
            v[i] = keep * v[i] + kick * fy[i]
            x[i] += dt * u[i]
            y[i] += dt * v[i]
        for i in range(n):
            a = i - 2 if i >= 2 else i - 2 + n
            b = i - 1 if i >= 1 else n - 1
            c = i + 1 if i + 1 < n else 0
            d = i + 2 if i + 2 < n else i + 2 - n
            px = min(max(x[i], 0.0), width - 1.000001)
            py = min(max(y[i], 0.0), height - 1.000001)
            column, row = int(px), int(py)
            s, t = px - column, py - row
            gx = ((1 - t) * ((1 - s) * field[row, column, 0] + s * field[row, column + 1, 0])
                  + t * ((1 - s) * field[row + 1, column, 0] + s * field[row + 1, column + 1, 0]))
            gy = ((1 - t) * ((1 - s) * field[row, column, 1] + s * field[row, column + 1, 1])
                  + t * ((1 - s) * field[row + 1, column, 1] + s * field[row + 1, column + 1, 1]))
            fx[i] = gx + tension * (x[b] - 2 * x[i] + x[c]) - rigidity * (
                x[a] - 4 * x[b] + 6 * x[i] - 4 * x[c] + x[d])
            fy[i] = gy + tension * (y[b] - 2 * y[i] + y[c]) - rigidity * (
                y[a] - 4 * y[b] + 6 * y[i] - 4 * y[c] + y[d])
        for i in range(n):
            u[i] = settle * (u[i] + kick * fx[i])
            v[i] = settle * (v[i] + kick * fy[i])


STEPS = 2000


class NumbaSnake:
    def __init__(self, nodes, field):
        angle = 2 * np.pi * np.arange(nodes) / nodes
        self.at = [256 + 205 * np.cos(angle), 256 + 205 * np.sin(angle), np.zeros(nodes), np.zeros(nodes)]
        self.field = field

    def __call__(self):
        _steps(*self.at, self.field, STEPS, 2.0, 2.0, 0.975, 0.025, 1 / 1.025, 0.05)


def skimage_iterations(image, nodes, iterations):
    angle = 2 * np.pi * np.arange(nodes) / nodes
    circle = np.stack([256 + 205 * np.sin(angle), 256 + 205 * np.cos(angle)], 1)
    return active_contour(image, circle, max_num_iter=iterations, convergence=0)


# --- taking turns

def timed(work):
    begin = time.thread_time_ns()
    work()
    return time.thread_time_ns() - begin


def take_turns(cases, rounds):
    """Nanoseconds of each case: the median of the rounds."""
    for case in cases.values():
        case()
    seen = {name: [] for name in cases}
    for _ in range(rounds):
        for name, case in cases.items():
            seen[name].append(case())
    return {name: statistics.median(times) for name, times in seen.items()}


def machine():
    name = platform.processor() or platform.machine()
    flags = ""
    try:
        for line in open("/proc/cpuinfo", encoding="utf-8"):
            if line.startswith("model name"):
                name = line.split(":", 1)[1].strip()
            if line.startswith("flags"):
                flags = line
    except OSError:
        pass
    sets = [said for flag, said in [("avx2", "AVX2"), ("fma", "FMA"), ("avx512f", "AVX-512")] if f" {flag}" in flags]
    return f"{name}, {os.cpu_count()} virtual cores, {', '.join(sets) or 'no wide registers known'}"


def fields(ours, rounds, sides):
    rows = []
    for side in sides:
        for kind in ["f32", "u8", "u16"]:
            numpy_kind = {"f32": np.float32, "u8": np.uint8, "u16": np.uint16}[kind]
            image = picture(side, numpy_kind)
            out, padded = room(side)
            cases = {}
            for bits, process in ours.items():
                for rules in ["report", "corrected"]:
                    line = f"field {rules} {kind} {side}"
                    cases[f"{rules} {bits}"] = lambda process=process, line=line: process.ask(line)
            cases["opencv"] = lambda: timed(lambda: opencv(image))
            cases["filters"] = lambda: timed(lambda: opencv_filters(image))
            cases["numba"] = lambda: timed(lambda: numba_rows(image, out, padded))
            found = take_turns(cases, rounds if side < 8000 else min(rounds, 5))
            per = {name: ns / side ** 2 for name, ns in found.items()}
            rows.append((f"{side}² {kind}", per))
            print(rows[-1])
    return rows


def snakes(ours, rounds, nodes):
    image = picture(512, np.uint8)
    field = numba_rows(image, *room(512))
    cases = {}
    for bits, process in ours.items():
        for what in ["step", "run"]:
            for scheme in ["leapfrog", "imex", "sbdf2"]:
                line = f"{what} {scheme} {nodes}"
                cases[f"{what} {scheme} {bits}"] = lambda process=process, line=line: process.ask(line)
    snake = NumbaSnake(nodes, field)
    cases["numba"] = lambda: timed(snake)
    found = {name: ns / STEPS / nodes for name, ns in take_turns(cases, rounds).items()}
    scaled = image / 255
    few, many = [min(timed(lambda: skimage_iterations(scaled, nodes, n)) for _ in range(2)) for n in [2, 12]]
    found["skimage"] = (many - few) / 10 / nodes
    print(found)
    return found


def reach(ours, rounds):
    sigmas = [1, 3.2, 10, 17, 20, 40, 80, 160]
    cases = {}
    for bits, process in ours.items():
        for sigma in sigmas:
            line = f"field {sigma} u8 512"
            cases[f"{sigma} {bits}"] = lambda process=process, line=line: process.ask(line)
    found = take_turns(cases, rounds)
    return sigmas, {name: ns / 512 ** 2 for name, ns in found.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--quick", action="store_true", help="no pictures of 8192² pixels")
    parser.add_argument("--built", action="store_true", help="the program as it was built last")
    options = parser.parse_args()
    if not options.built:
        subprocess.run(["cargo", "build", "--release", "-p", "benches", "--example", "beside"], check=True, cwd=ROOT)
    ours = {}
    for bits in [256, 512]:
        process = Ours(bits)
        ours.setdefault(process.ask("registers"), process)
    text = [
        "# Benchmarks", "",
        "Written by `python3 benches/peers/beside.py`, which has us and our peers work in turn, on one thread each, and takes the "
        f"median processor time of {options.rounds} rounds. Other programs may have been running; ratios within a row are what counts.", "",
        f"Machine: {machine()}. {datetime.date.today()}. OpenCV {cv2.__version__}, numba {numba.__version__}, "
        f"scikit-image {skimage.__version__}. Registers of "
        f"{' and '.join(str(bits) for bits in ours)} bits (`SNAKES_REGISTERS`).", "",
        "## Force field, ns a pixel", "",
        "The report's rules, both components, by all: 20 passes and a difference along an axis are one filter of 43 numbers. OpenCV: two "
        "`sepFilter2D` of 43 × 3, magnitudes, two of 3 × 3; in brackets the two long ones alone. numba: row by row, 34 numbers (what is "
        "left out is below 2e-7). Ours in brackets: the corrected rules.", "",
    ]
    rows = fields(ours, options.rounds, [512, 2048] + ([] if options.quick else [8192]))
    widths = list(ours)
    head = [f"ours, {bits} bits" for bits in widths]
    text.append("| picture | " + " | ".join(head) + " | OpenCV | numba | " + " | ".join(
        f"of OpenCV, {bits} | of numba, {bits}" for bits in widths) + " |")
    text.append("| --- " * (3 + 3 * len(widths)) + "|")
    for name, per in rows:
        mine = [f"{per[f'report {b}']:.2f} ({per[f'corrected {b}']:.2f})" for b in widths]
        ratios = [f"{per[f'report {b}'] / per['opencv']:.2f} | {per[f'report {b}'] / per['numba']:.2f}" for b in widths]
        text.append(f"| {name} | " + " | ".join(mine) + f" | {per['opencv']:.1f} ({per['filters']:.1f}) | "
                    f"{per['numba']:.1f} | " + " | ".join(ratios) + " |")
    found = snakes(ours, options.rounds, 1000)
    text += ["", "## One step of a snake, ns a node", "",
             f"1000 nodes in a picture of 512², bilinear, {STEPS} steps at a time. numba: leapfrog in three loops, as fast as a page of "
             "Python gets; it checks nothing. scikit-image: one iteration of `active_contour`.", "",
             "| | " + " | ".join(f"stepper, {b} bits | of numba | whole run | of stepper" for b in widths) + " |",
             "| --- " * (1 + 4 * len(widths)) + "|"]
    for scheme in ["leapfrog", "imex", "sbdf2"]:
        cells = []
        for b in widths:
            step, run = found[f"step {scheme} {b}"], found[f"run {scheme} {b}"]
            cells.append(f"{step:.2f} | {step / found['numba']:.2f} | {run:.2f} | {run / step:.2f}")
        text.append(f"| {scheme} | " + " | ".join(cells) + " |")
    text += ["", f"numba {found['numba']:.1f}, scikit-image {found['skimage']:.0f}.", "",
             "## Reach, ns a pixel", "", "Corrected rules, Gaussian smoothing, 512² of 8 bits.", ""]
    sigmas, wide = reach(ours, options.rounds)
    text.append("| σ, px | " + " | ".join(str(s) for s in sigmas) + " |")
    text.append("| --- " * (1 + len(sigmas)) + "|")
    for b in widths:
        text.append(f"| {b} bits | " + " | ".join(f"{wide[f'{s} {b}']:.1f}" for s in sigmas) + " |")
    (ROOT / "docs" / "benchmarks.md").write_text("\n".join(text) + "\n", encoding="utf-8")


main()
