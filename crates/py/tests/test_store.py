"""The results store: one table, whole or not at all, read by others."""

import struct

import numpy as np
import pyarrow.parquet
import pytest

import pysnakes
from conftest import disc
from pysnakes.store import Results


@pytest.fixture
def found():
    return pysnakes.fit(disc(), pysnakes.circle(50, 43, 25))


def test_a_table_has_all_of_an_outline(found, tmp_path):
    results = Results(tmp_path / "results")
    assert results.table().num_rows == 0
    results.write("b.png", [found, found])
    results.write("a.png", [found])
    results.write("none.png", [])
    results.refuse("c.png", "holds no picture")
    assert results.finished() == {"a.png", "b.png", "c.png", "none.png"}
    rows = results.table().to_pylist()
    assert [(row["image"], row["object"]) for row in rows] == [
        ("a.png", 0), ("b.png", 0), ("b.png", 1), ("c.png", None), ("none.png", None),
    ]
    row = rows[0]
    assert row["area"] == found.measures.area
    assert row["x"] == found.points[:, 0].tolist()
    assert np.allclose(row["strength"], found.strength)
    order, kind, rings, count = struct.unpack_from("<BIII", row["geometry"])
    assert (order, kind, rings, count) == (1, 3, 1, len(found) + 1)
    ring = np.frombuffer(row["geometry"], "<f8", offset=13).reshape(-1, 2)
    assert (ring[:-1] == found.points).all() and (ring[-1] == ring[0]).all()


def test_joined_files_hold_the_same_rows_and_say_where_the_geometry_is(found, tmp_path):
    results = Results(tmp_path)
    for name in "abc":
        results.write(name, [found])
    before = results.table()
    path = results.compact()
    assert [path] == list(tmp_path.iterdir())
    assert results.table().equals(before)
    assert b'"primary_column": "geometry"' in pyarrow.parquet.read_schema(path).metadata[b"geo"]
    # a part that a killed join has left is not there twice
    results.write("a", [found])
    assert results.table().equals(before)
    results.write("d", [found])
    assert results.table().num_rows == 4
    results.compact()
    assert results.table().num_rows == 4 and len(list(tmp_path.iterdir())) == 1
    assert results.finished() == set("abcd")


def test_the_same_results_are_the_same_bytes(found, tmp_path):
    a, b = Results(tmp_path / "a").write("x", [found]), Results(tmp_path / "b").write("x", [found])
    assert a.read_bytes() == b.read_bytes()
    assert not list(tmp_path.glob("*/.*"))


def test_a_file_is_no_folder(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(ValueError, match="folder"):
        Results(tmp_path / "file")


def test_outlines_of_other_programs_are_taken_in(found, tmp_path):
    (tmp_path / "found").mkdir()
    for name in ("one", "two"):
        pysnakes.save_outlines(tmp_path / "found" / f"{name}.geojson", [found])
    results = Results(tmp_path / "results")
    files = sorted((tmp_path / "found").iterdir())
    assert results.collect(files) == 2 and results.collect(files) == 0
    rows = results.table().to_pylist()
    assert [row["image"] for row in rows] == ["one", "two"]
    assert rows[0]["area"] == pytest.approx(found.area, rel=1e-6) and rows[0]["error"][0] is None
