"""Outlines: right, told in full, the same on any number of threads, stopped by Ctrl-C."""

import copy
import gc
import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import pysnakes
from conftest import disc
from pysnakes import _core

START = pysnakes.circle(50, 43, 25)


def test_a_disc_is_found_to_a_fraction_of_a_pixel(bright):
    found = pysnakes.fit(bright, START)
    radii = np.hypot(*(found.points - (48.0, 44.0)).T)
    assert found.is_outline and found.closed and found.outcome == "settled"
    assert abs(radii.mean() - 20.0) < 0.05
    assert np.abs(radii - 20.0).max() < 0.2
    assert len(found) == len(found.strength) == len(found.error) == len(found.held)
    assert np.nanmedian(found.error) < 0.1
    assert found.slope.mean() < 0.0  # darker outside
    # normals point outwards
    assert ((found.points - (48.0, 44.0)) * found.normal).sum(axis=1).min() > 0.0


@pytest.mark.parametrize("start", [(48.0, 44.0), [(47, 45)], "mask", "outline", "motion"])
def test_every_kind_of_start_leads_there(bright, start):
    options = {}
    if isinstance(start, str):
        options = {"method": "motion", "sigma": 1.5} if start == "motion" else {}
        start = {
            "mask": disc(radius=18) > 120,
            "outline": pysnakes.fit(bright, START),
            "motion": START,
        }[start]
    found = pysnakes.fit(bright, start, **options)
    assert abs(found.area / (np.pi * 400) - 1) < 0.02
    assert found.is_outline


def test_nothing_to_find_is_an_answer_with_a_reason():
    found = pysnakes.fit(np.full((80, 80), 7.0), pysnakes.circle(40, 40, 20))
    assert not found.is_outline
    assert found.reason
    assert "no outline" in repr(found)


def test_the_apple_is_found_by_the_five_lines_of_the_readme():
    apple = pysnakes.picture("apple")
    found = pysnakes.fit(apple, pysnakes.circle(256, 270, 220))
    # from the contour that was clicked by hand and comes with the picture it is nearly the same
    other = pysnakes.fit(apple, pysnakes.contour("apple-whole-without-the-stem")).to_mask()
    mask = found.to_mask()
    assert found.is_outline
    assert (mask & other).sum() / (mask | other).sum() > 0.97
    assert "pixels" in found.explanation


def test_an_outline_measures_and_is_a_mask_a_feature_and_a_roi(bright):
    found = pysnakes.fit(bright, START)
    measures = found.measures
    assert abs(measures.area - found.area) < 1e-9
    assert np.hypot(measures.centroid[0] - 48, measures.centroid[1] - 44) < 0.02
    assert measures.circularity > 0.98
    assert abs(found.to_mask().sum() - found.area) < 20
    assert found.to_mask((10, 10)).shape == (10, 10)
    feature = found.to_geojson(label="disc")
    assert feature["geometry"]["type"] == "Polygon"
    corner = np.array(feature["geometry"]["coordinates"][0][:-1])
    assert np.abs(corner.mean(axis=0) - (48.5, 44.5)).max() < 0.1  # from the corner of the first pixel
    assert feature["properties"]["label"] == "disc"
    roi = found.to_roi("disc")
    assert roi[:4] == b"Iout"
    with pytest.raises(ValueError):
        found.points[0] = 0.0  # a result is not written over by accident
    assert (found.coords == found.points[:, ::-1]).all()


def test_outlines_pickle_copy_and_compare(bright):
    found = pysnakes.fit(bright, START)
    assert pickle.loads(pickle.dumps(found)) == found
    assert copy.deepcopy(found) == found
    other = pysnakes.fit(bright, pysnakes.circle(48, 44, 30), nodes=50)
    assert found != other
    assert "an outline" in repr(found) and "px²" in repr(found)


def test_outlines_are_files_of_other_programs(bright, tmp_path):
    found = pysnakes.fit(bright, START)
    for name in ["a.csv", "a.geojson", "a.roi", "a.svg"]:
        path = tmp_path / name
        pysnakes.save_outlines(path, [found])
        back = pysnakes.load_outlines(path)
        assert len(back) == 1
        assert np.abs(back[0].mean(axis=0) - found.points.mean(axis=0)).max() < 0.05, name
        assert not list(tmp_path.glob("*.part"))
    pysnakes.save_outlines(tmp_path / "labels.png", [found], shape=bright.shape)
    assert (pysnakes.read_image(tmp_path / "labels.png") > 0).sum() == found.to_mask().sum()
    with pytest.raises(ValueError, match="format"):
        pysnakes.save_outlines(tmp_path / "a.what", [found])
    with pytest.raises(ValueError, match="nowhere"):
        pysnakes.read_image("nowhere.png")


def many():
    image = np.maximum.reduce([disc((200, 260), (30 + 50 * i, 30 + 45 * j), 15) for i in range(5) for j in range(4)])
    starts = [pysnakes.circle(31 + 50 * i, 29 + 45 * j, 18) for i in range(5) for j in range(4)]
    return image, starts


def test_many_fits_are_the_same_for_any_number_of_threads():
    image, starts = many()
    alone = [pysnakes.fit(image, start) for start in starts]
    for threads in (1, 2, 5):
        assert list(pysnakes.fit_many(image, starts, threads=threads)) == alone
    images = [image.copy() for _ in starts]
    assert list(pysnakes.fit_many(images, starts, threads=3)) == alone
    # in threads of Python too: the lock is released
    found = [None] * len(starts)

    def work(first):
        for index in range(first, len(starts), 3):
            found[index] = pysnakes.fit(image, starts[index])

    threads = [threading.Thread(target=work, args=(first,)) for first in range(3)]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert found == alone


def test_results_of_many_fits_come_as_they_are_there():
    image, starts = many()
    batch = pysnakes.fit_many(image, starts * 20, threads=1)
    began = threading.active_count()
    first = next(batch)
    assert first.is_outline
    batch.close()  # and the others are not made
    assert threading.active_count() == began


def test_a_refused_start_of_many_is_named_or_passed_over():
    image, starts = many()
    with pytest.raises(ValueError, match="start 1"):
        pysnakes.fit_many(image, [starts[0], np.zeros((2, 2))])
    far = np.array([(1e300, 0.0), (48, 44), (50, 50)])
    with pytest.raises(ValueError, match="start 1: reaches"):
        list(pysnakes.fit_many(image, [starts[0], far]))
    skipped = list(pysnakes.fit_many(image, [starts[0], far, starts[1]], errors="skip"))
    assert [one is None for one in skipped] == [False, True, False]
    with pytest.raises(ValueError, match="threads"):
        pysnakes.fit_many(image, starts, threads=0)


def test_another_thread_goes_on_during_a_fit():
    image, starts = many()
    counted, stop = 0, threading.Event()

    def count():
        nonlocal counted
        while not stop.is_set():
            counted += 1

    counter = threading.Thread(target=count)
    prepared = pysnakes.Prepared(image, method="motion")
    before = counted
    counter.start()
    for start in starts:
        at = counted
        prepared.fit(start)
        before = max(before, counted - at)
    stop.set()
    counter.join()
    assert before > 100


def test_a_panic_is_an_exception_that_says_where():
    with pytest.raises(pysnakes.PanicError, match=r"waiting\.rs:\d+:\d+: on purpose"):
        _core._fail_on_purpose()
    assert issubclass(pysnakes.PanicError, RuntimeError)
    # and the next call goes well
    assert pysnakes.fit(disc(), START).is_outline


STOPPED = """
import numpy as np, pysnakes, signal, sys
from pysnakes import _core
image = 128 + 60 * np.sin(np.arange(700)[:, None] * 0.11) * np.sin(np.arange(700) * 0.13)
starts = [pysnakes.circle(350, 350, 100 + i % 50) for i in range(100000)]
work = {
    "one": lambda: _core._sleep(60.0),
    "search": lambda: [pysnakes.fit(image, (350.0, 350.0)) for _ in range(10**6)],
    "many": lambda: list(pysnakes.fit_many(image, starts, threads=2)),
    "scene": lambda: pysnakes.Scene.load("soft-ball").with_values(
        run__steps=200_000_000, record__every=100_000_000).run(),
    "classic": lambda: pysnakes.active_contour(
        image, pysnakes.circle(350, 350, 300)[:, ::-1], convergence=0, max_num_iter=10**9),
}[sys.argv[1]]
# what was begun in the background by a shell is deaf to it
signal.signal(signal.SIGINT, signal.default_int_handler)
print("ready", flush=True)
try:
    work()
except KeyboardInterrupt:
    print("stopped", flush=True)
"""


@pytest.mark.parametrize("work", ["one", "search", "many", "scene", "classic"])
def test_ctrl_c_stops_work(work):
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    child = subprocess.Popen([sys.executable, "-c", STOPPED, work], **pipes)
    assert child.stdout.readline() == "ready\n"
    time.sleep(0.3)
    child.send_signal(signal.SIGINT)
    out, err = child.communicate(timeout=60)
    assert out == "stopped\n", err


def test_thousands_of_fits_keep_no_memory():
    image = disc((48, 48), (24.0, 24.0), 10.0)
    start = pysnakes.circle(24, 24, 12)

    def resident():
        gc.collect()
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    def work(times):
        for _ in range(times):
            pysnakes.fit(image, start, nodes=40)

    work(500)
    before = resident()
    work(2500)
    # an image kept each time would be 46 MB
    assert resident() - before < 4_000_000


def test_a_forked_process_fits_too(bright):
    pysnakes.fit(bright, START)
    child = os.fork()
    if child == 0:
        os._exit(0 if pysnakes.fit(bright, START).is_outline else 1)
    assert os.waitpid(child, 0)[1] == 0


def test_an_outline_is_drawn(bright, tmp_path):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    found = pysnakes.fit(bright, START)
    figure, axes = plt.subplots()
    assert found.plot(axes, image=bright, errors=3.0) is axes
    assert found._repr_svg_().startswith("<svg") and "polygon" in found._repr_svg_()
    assert len(axes.lines) == 1 and len(axes.images) == 1
    line = axes.lines[0].get_xydata()
    assert (line[0] == line[-1]).all() and len(line) == len(found) + 1
    plt.close(figure)


def test_an_open_start_finds_an_edge_between_its_ends():
    x = np.arange(90)
    image = np.tile(60 + 120 / (1 + np.exp(-(x - 40.3) / 0.8)), (90, 1))
    found = pysnakes.fit(image, [(38.0, 10.0), (43.0, 45.0), (39.0, 80.0)], closed=False)
    assert not found.closed and "open" in repr(found)
    assert np.abs(found.points[:, 0] - 40.3).max() < 0.3
    assert found.to_geojson()["geometry"]["type"] == "LineString"


def test_forces_by_name_pull_a_curve_from_afar():
    image = disc((120, 120), (60.0, 60.0), 20.0)
    far = pysnakes.circle(60, 60, 50)
    found = pysnakes.fit(image, far, forces=["gvf"], tension=5.0, rigidity=20.0)
    assert np.abs(np.hypot(*(found.points - 60).T) - 20).max() < 1.5
