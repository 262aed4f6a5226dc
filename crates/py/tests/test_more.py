"""With other programs: napari, a notebook, torch, Ray, each where it is installed (`.ci/python more`)."""

import ast
import base64
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import pysnakes
from conftest import disc

START = pysnakes.circle(50, 43, 25)
FOLDER = Path(__file__).resolve().parents[1]


@pytest.fixture
def viewer():
    pytest.importorskip("napari")
    import npe2
    from napari.components import ViewerModel

    npe2.PluginManager.instance().discover()  # as the window does when it opens
    return ViewerModel()


def test_napari_opens_files_of_outlines(viewer, tmp_path):
    from pysnakes.napari import starts_of

    found = pysnakes.fit(disc(), START)
    for name in ("a.geojson", "b.csv", "c.zip", "d.svg"):
        pysnakes.save_outlines(tmp_path / name, [found, found], shape=(96, 96))
        # by the manifest of the package, as dropping a file into the window does
        (layer,) = viewer.open(tmp_path / name, plugin="pysnakes")
        assert type(layer).__name__ == "Shapes" and layer.name == name
        assert len(layer.data) == 2 and set(layer.shape_type) == {"polygon"}
        (start, _) = starts_of(layer)
        assert start.dtype == np.float64 and np.abs(start - found.points).max() < 0.51, name


def test_napari_shows_outlines_and_hands_out_starts(viewer):
    from pysnakes.napari import add_outlines, starts_of

    image = viewer.add_image(disc())
    found = pysnakes.fit(image.data, START)
    layer = add_outlines(viewer, [found], edge_width=2)
    assert layer in viewer.layers and layer.features["is_outline"].tolist() == [True]
    # the corners of a box drawn by hand
    drawn = viewer.add_shapes([[[20.0, 25.0], [68.0, 72.0]]], shape_type="rectangle")
    again = pysnakes.fit(image.data, starts_of(drawn)[0])
    assert again.is_outline and abs(again.area / found.area - 1) < 0.01


def test_tensors_of_torch():
    torch = pytest.importorskip("torch")
    tensor, plain = torch.from_numpy(disc()), pysnakes.fit(disc(), START)
    assert pysnakes.fit(tensor, torch.from_numpy(START)) == plain
    assert pysnakes.fit(tensor.T.contiguous().T, START) == plain
    with pytest.raises(TypeError, match="detach"):
        pysnakes.fit(tensor.clone().requires_grad_(), START)


def five_lines():
    text = (FOLDER / "README.md").read_text()
    return re.search(r"```python\n(.*?)```", text, re.S).group(1)


def test_five_lines_draw_the_apple_in_a_notebook():
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    book = nbformat.v4.new_notebook()
    book.cells.append(nbformat.v4.new_code_cell("%matplotlib inline\n" + five_lines()))
    nbclient.NotebookClient(book, timeout=120, kernel_name="python3").execute()
    outputs = book.cells[0].outputs
    pictures = [output["data"]["image/png"] for output in outputs if "image/png" in output.get("data", {})]
    assert len(pictures) == 1 and base64.b64decode(pictures[0]).startswith(b"\x89PNG")
    told = [output["data"]["text/plain"] for output in outputs if output["output_type"] == "execute_result"]
    assert len(told) == 1 and "True" in told[0] and "area=157" in told[0]


def test_the_example_of_ray_gives_the_bytes_of_one_process_though_a_worker_is_killed(tmp_path):
    pytest.importorskip("ray")
    import signal
    import time

    import psutil
    from pysnakes.store import fit_file

    folder, results = tmp_path / "images", tmp_path / "ray"
    folder.mkdir()
    for index in range(60):
        levels = disc((480, 480), (240.0, 240.0), 150.0 + index).astype(np.uint8)
        (folder / f"{index:02}.pgm").write_bytes(b"P5 480 480 255\n" + levels.tobytes())
    environment = os.environ | {"RAY_USAGE_STATS_ENABLED": "0", "HOME": str(tmp_path)}
    command = [sys.executable, FOLDER / "examples" / "ray_batch.py", folder, results, "240", "240", "180"]
    child = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    began = time.monotonic()
    while len(list(results.glob("part-*"))) < 10:
        assert time.monotonic() - began < 120 and child.poll() is None
        time.sleep(0.01)
    workers = [one for one in psutil.Process(child.pid).children(recursive=True) if "fit_file" in " ".join(one.cmdline())]
    workers[0].send_signal(signal.SIGKILL)
    out, err = child.communicate(timeout=300)
    assert child.returncode == 0, err
    counts = ast.literal_eval(out.strip().splitlines()[-1])
    assert sum(counts.values()) == 60 and set(counts) <= {"now", "before"}
    for path in sorted(folder.iterdir()):
        fit_file(path, pysnakes.circle(240, 240, 180), tmp_path / "here")
    parts = sorted((tmp_path / "here").iterdir())
    assert len(parts) == 60
    assert all((results / part.name).read_bytes() == part.read_bytes() for part in parts)
