"""Past one machine: same bytes as one process, nothing lost and nothing twice when a worker is killed."""

import os
import signal
import time

import dask.array
import numpy as np
import pytest
from distributed import Client, LocalCluster

import pysnakes
from conftest import disc
from pysnakes.dask import fit_bag, fit_blocks, labels, stitch
from pysnakes.store import Results

START = pysnakes.circle(41, 39, 18)


@pytest.fixture(scope="module")
def client():
    cluster = LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, host="127.0.0.1", dashboard_address="127.0.0.1:0",
        worker_dashboard_address="127.0.0.1:0",
    )
    with cluster, Client(cluster) as client:
        yield client


def folder_of(path, count):
    folder = path / "images"
    folder.mkdir()
    for index in range(count):
        levels = disc((80, 80), (40.0, 40.0), 10.0 + index % 17 / 2).astype(np.uint8)
        (folder / f"disc-{index:03}.pgm").write_bytes(b"P5 80 80 255\n" + levels.tobytes())
    return folder


def test_a_cluster_gives_the_bytes_of_one_process(client, tmp_path):
    folder = folder_of(tmp_path, 20)
    (folder / "broken.pgm").write_bytes(b"P5 80 80 255\n too short")
    by_hand = Results(tmp_path / "hand")
    for path in sorted(folder.iterdir()):
        if path.name != "broken.pgm":
            by_hand.write(str(path), [pysnakes.fit(pysnakes.read_image(path), START)])
    bag = fit_bag(folder, START, tmp_path / "cluster")
    done = client.compute(bag).result()
    assert sorted(one["done"] for one in done) == ["now"] * 20 + ["refused"]
    there = Results(tmp_path / "cluster")
    for path in sorted(by_hand.folder.iterdir()):
        assert (there.folder / path.name).read_bytes() == path.read_bytes()
    table = there.table()
    assert table.num_rows == 21
    refused = [row for row in table.to_pylist() if row["outcome"] == "refused"]
    assert len(refused) == 1 and "broken.pgm" in refused[0]["reason"]


def slowly(path):
    """Reads a file, and notes that it did."""
    with open(os.environ["PYSNAKES_LOG"], "a") as log:
        log.write(f"{path}\n")
    time.sleep(0.05)
    return pysnakes.read_image(path)


def test_a_killed_worker_loses_nothing_and_repeats_no_finished_file(tmp_path, monkeypatch):
    folder, log = folder_of(tmp_path, 60), tmp_path / "log"
    monkeypatch.setenv("PYSNAKES_LOG", str(log))
    store = tmp_path / "results"
    cluster = LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, host="127.0.0.1", dashboard_address="127.0.0.1:0",
        worker_dashboard_address="127.0.0.1:0",
    )
    with cluster, Client(cluster) as client:
        future = client.compute(fit_bag(folder, START, store, load=slowly))
        results, waited = Results(store), time.monotonic()
        while len(list(store.glob("part-*"))) < 15:
            assert time.monotonic() - waited < 60
            time.sleep(0.01)
        finished = results.finished()
        begun_before = log.read_text().splitlines()
        pid = next(iter(client.run(os.getpid).values()))
        os.kill(pid, signal.SIGKILL)
        done = future.result(timeout=120)
    assert len(done) == 60
    table = results.table()
    assert table.num_rows == 60 and all(table["is_outline"].to_pylist())
    begun = log.read_text().splitlines()
    # what was finished when the worker was killed was begun once
    assert all(begun.count(path) == 1 for path in finished)
    assert len(finished) >= 15 and len(begun_before) < 60
    # only what the killed worker was at may have been begun twice
    assert sum(begun.count(path) > 1 for path in set(begun)) <= 1
    again = fit_bag(folder, START, store, load=slowly).compute(scheduler="sync")
    assert {one["done"] for one in again} == {"before"}
    assert log.read_text().splitlines() == begun


def cells():
    y, x = np.mgrid[:240, :330]
    centers = [(45 + 80 * i + 5 * j, 45 + 75 * j) for i in range(4) for j in range(3)]
    inside = np.maximum.reduce([np.clip(25.5 - np.hypot(x - cx, y - cy), 0, 1) for cx, cy in centers])
    noise = np.random.default_rng(5).normal(0, 3, inside.shape)
    return (50 + 150 * inside + noise).astype(np.float32), inside > 0.5, centers


def test_blocks_with_starts_are_the_same_on_a_cluster_as_alone(client):
    image, _, centers = cells()
    pixels = dask.array.from_array(image, chunks=(90, 110))
    starts = [pysnakes.circle(x + 1, y - 1, 28) for x, y in centers]
    work = fit_blocks(pixels, starts, depth=60)
    alone, far = work.compute(scheduler="sync"), client.compute(work).result()
    assert [one.outline for one in far] == [one.outline for one in alone]
    assert sorted(one.label for one in alone) == list(range(1, 13))
    for one in alone:
        center = np.array(centers[one.label - 1])
        assert np.abs(np.hypot(*(one.outline.points - center).T) - 25).max() < 0.7


def test_labels_of_blocks_are_stitched_by_contact(client):
    from skimage.measure import label

    image, inside, centers = cells()
    chunks = (90, 110)
    pixels = dask.array.from_array(image, chunks=chunks)
    parts = dask.array.from_array(inside, chunks=chunks)
    own = parts.map_blocks(lambda part: label(part).astype(np.int32), dtype=np.int32)
    found = client.compute(fit_blocks(pixels, own, depth=60)).result()
    objects = stitch(found)
    parts = sum(len(np.unique(np.asarray(own.blocks[i, j]))) - 1 for i in range(3) for j in range(3))
    assert parts > len(centers) == len(objects)
    painted = np.asarray(labels(objects, image.shape, chunks))
    assert set(np.unique(painted)) == set(range(len(centers) + 1))
    # each object has one label, in all blocks
    for x, y in centers:
        part = painted[int(y) - 15 : int(y) + 15, int(x) - 15 : int(x) + 15]
        assert len(np.unique(part)) == 1 and part[0, 0] > 0
    assert (painted > 0).sum() == pytest.approx(inside.sum(), rel=0.03)


def test_an_object_larger_than_the_overlap_is_the_union_of_its_parts():
    image = disc((100, 400), (200.0, 50.0), 0.0)
    y, x = np.mgrid[:100, :400]
    bar = (np.abs(y - 50) < 20) & (np.abs(x - 200) < 170)
    image = np.where(bar, 200.0, 40.0)
    chunks = (100, 100)
    pixels = dask.array.from_array(image, chunks=chunks)
    own = dask.array.from_array(bar.astype(np.int32), chunks=chunks)
    objects = stitch(fit_blocks(pixels, own, depth=30).compute(scheduler="sync"))
    assert len(objects) == 1
    mask = objects[0].to_mask()
    assert (mask & bar).sum() / (mask | bar).sum() > 0.93
    assert "union" in objects[0].note


def test_what_is_no_image_in_blocks_is_refused():
    pixels = dask.array.zeros((50, 50), chunks=25)
    for call, kind, words in [
        (lambda: fit_blocks(np.zeros((5, 5)), []), TypeError, "dask array"),
        (lambda: fit_blocks(pixels, [[(100.0, 100.0)] * 3]), ValueError, "middle"),
        (lambda: fit_blocks(pixels, [], depth=-1), ValueError, "depth"),
        (lambda: fit_blocks(pixels, dask.array.zeros((50, 50), chunks=50, dtype=int)), ValueError, "chunks"),
        (lambda: fit_bag([], START, "x"), ValueError, "at least one"),
        (lambda: fit_bag("no-such-folder", START, "x"), ValueError, "folder"),
        (lambda: stitch([], share=0.0), ValueError, "share"),
    ]:
        with pytest.raises(kind, match=words):
            call()
