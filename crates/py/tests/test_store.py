"""The results store: one table, whole or not at all, read by others, written by the command too."""

import json
import os
import struct
import subprocess

import numpy as np
import pyarrow.parquet
import pytest

import pysnakes
from conftest import disc
from pysnakes.store import Results, fit_file, schema


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
    # what is joined is finished
    assert results.is_finished("b") and not results.is_finished("d")
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


def test_every_file_has_the_schema_and_is_geoparquet(found, tmp_path):
    results = Results(tmp_path)
    part = results.write("a", [found])
    results.refuse("b", "no picture")
    single, joined = pyarrow.parquet.read_schema(part), pyarrow.parquet.read_schema(results.compact())
    for own in (single, joined):
        assert own.remove_metadata().equals(schema().remove_metadata())
        geo = json.loads(own.metadata[b"geo"])
        # by the specification: version, the primary column, and of it encoding and types
        assert geo["version"] == "1.1.0" and geo["primary_column"] == "geometry"
        assert geo["columns"]["geometry"]["encoding"] == "WKB"
        assert set(geo["columns"]["geometry"]["geometry_types"]) == {"Polygon", "LineString"}
        # coordinates that lie nowhere on Earth
        assert geo["columns"]["geometry"]["crs"] is None
        assert json.loads(schema().metadata[b"geo"]) == geo


def test_other_programs_read_the_table(found, tmp_path):
    results = Results(tmp_path)
    for name in "ab":
        results.write(name, [found, found])
    pandas, duckdb = pytest.importorskip("pandas"), pytest.importorskip("duckdb")
    frame = pandas.concat([pandas.read_parquet(path) for path in sorted(tmp_path.iterdir())])
    assert len(frame) == 4 and (frame["area"] == found.measures.area).all()
    assert (frame["x"].iloc[0] == found.points[:, 0]).all()
    query = f"select image, count(*), sum(area), any_value(x) from '{tmp_path}/*.parquet' group by image order by image"
    rows = duckdb.sql(query).fetchall()
    assert [row[:2] for row in rows] == [("a", 2), ("b", 2)]
    assert rows[0][2] == pytest.approx(2 * found.measures.area) and rows[0][3] == found.points[:, 0].tolist()
    results.compact()
    assert duckdb.sql(f"select count(*), max(len(y)) from '{tmp_path}/joined.parquet'").fetchall() == [(4, len(found))]


SNAKE = os.environ.get("SNAKE", "")
needs_snake = pytest.mark.skipif(not SNAKE, reason="SNAKE must say where the command snake is")


def images(folder):
    (folder / "images").mkdir()
    for index in range(5):
        levels = disc((80, 80), (40.0, 40.0), 12.0 + index).round().astype(np.uint8)
        (folder / "images" / f"{index}.pgm").write_bytes(b"P5 80 80 255\n" + levels.tobytes())
    (folder / "images" / "5.pgm").write_bytes(b"P5 80 80 255\n too short")
    return [f"images/{index}.pgm" for index in range(6)]


def by_command(folder, out, *more):
    points = ",".join(f"{x},{y}" for x, y in pysnakes.circle(41, 39, 18).tolist())
    args = [SNAKE, "fit", "images", "--from", f"polygon:{points}", "--out-dir", out, "--as", "parquet", *more]
    return subprocess.run(args, cwd=folder, capture_output=True, text=True).stderr


def by_python(out, names):
    return [fit_file(name, pysnakes.circle(41, 39, 18), out)["done"] for name in names]


@needs_snake
def test_the_command_writes_the_same_bytes(tmp_path, monkeypatch):
    names = images(tmp_path)
    monkeypatch.chdir(tmp_path)
    by_command(tmp_path, "command")
    assert by_python("python", names) == ["now"] * 5 + ["refused"]
    parts = sorted(path.name for path in (tmp_path / "python").iterdir())
    assert parts == sorted(path.name for path in (tmp_path / "command").iterdir()) and len(parts) == 6
    refused = Results("python")._store.part("images/5.pgm")
    for part in parts:
        if part != os.path.basename(refused):  # its reason is worded by each
            assert (tmp_path / "python" / part).read_bytes() == (tmp_path / "command" / part).read_bytes()
    assert Results("command").finished() == Results("python").finished() == set(names)


@needs_snake
@pytest.mark.parametrize("joined", [False, True])
def test_each_goes_on_with_what_the_other_has_finished(joined, tmp_path, monkeypatch):
    names = images(tmp_path)
    monkeypatch.chdir(tmp_path)
    assert by_python("one", names[:3]) == ["now"] * 3
    if joined:
        Results("one").compact()
    assert "3 there already" in by_command(tmp_path, "one", "--resume")
    by_command(tmp_path, "two")
    for index in (0, 2):
        os.remove(Results("two")._store.part(names[index]))
    if joined:
        Results("two").compact()
    assert by_python("two", names) == ["now", "before", "now", "before", "before", "before"]
    one, two = Results("one").table(), Results("two").table()
    same = [name for name in one.column_names if name != "reason"]
    assert one.select(same).equals(two.select(same)) and one.num_rows == 6
