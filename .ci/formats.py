#!/usr/bin/env python3
"""Outlines and tracks as other programs read and write them, compared with what ours does.

Called by .ci/run: formats.py CONVERT, where CONVERT is the built example `convert`; the example `tracks` is beside it,
the program `snake` in the folder above. What it needs from outside is installed into a folder of its own beside the
build.
"""

import os
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

NEEDED = [
    "numpy==2.4.6", "roifile==2026.2.10", "shapely==2.2.0", "pycocotools==2.0.11",
    "tifffile==2026.3.3", "pillow==13.0.0", "svgelements==1.9.6",
]
ROOT = Path(__file__).resolve().parent.parent
WIDTH, HEIGHT = 96, 80


def in_own_python():
    """Run this script again by a Python that has what it needs."""
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    home = target / "formats-python"
    python = home / "bin" / "python"
    stamp = home / "installed"
    if not stamp.exists() or stamp.read_text() != "\n".join(NEEDED):
        subprocess.run([sys.executable, "-m", "venv", "--clear", str(home)], check=True)
        subprocess.run([str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *NEEDED],
                       check=True)
        stamp.write_text("\n".join(NEEDED))
    os.execv(python, [str(python), str(Path(__file__).resolve()), *sys.argv[1:], "--installed"])


if "--installed" not in sys.argv:
    in_own_python()

import json  # noqa: E402

import numpy as np  # noqa: E402
import roifile  # noqa: E402
import shapely  # noqa: E402
import tifffile  # noqa: E402
from PIL import Image  # noqa: E402
from pycocotools import mask as coco_mask  # noqa: E402
from pycocotools.coco import COCO  # noqa: E402
from svgelements import SVG, Matrix, Path as SvgPath  # noqa: E402

CONVERT = os.path.abspath(sys.argv[1])
TRACKS = os.path.join(os.path.dirname(CONVERT), "tracks")
SNAKE = os.path.join(os.path.dirname(os.path.dirname(CONVERT)), "snake")
checks = 0


def check(said, what, *numbers):
    """Count a comparison, and stop at the first that fails."""
    global checks
    checks += 1
    if not said:
        sys.exit(f"formats: {what}: {numbers}")


def near(a, b, what, most=1e-6):
    a, b = np.asarray(a, float), np.asarray(b, float)
    check(a.shape == b.shape and np.abs(a - b).max(initial=0) <= most, what, a, b)


def convert(folder, into, source, *words):
    """Run our program; the result's path."""
    path = folder / into
    run = subprocess.run(
        [CONVERT, str(folder / source), str(path), "--width", str(WIDTH), "--height", str(HEIGHT), *words],
        capture_output=True, text=True)
    check(run.returncode == 0, f"convert {source} {into}", run.stderr)
    return path


def rings_of(path):
    """The outlines of one of our tables: rings by curve, in pixels with the first center at (0, 0)."""
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    names = lines[0].split(",")
    found = {}
    for line in lines[1:]:
        row = dict(zip(names, line.split(",")))
        rings = found.setdefault(row.get("curve", "1"), {})
        rings.setdefault(row.get("ring", "0"), []).append((float(row["x"]), float(row["y"])))
    return {name: [np.array(ring) for ring in rings.values()] for name, rings in found.items()}


def polygon(rings):
    """By the even-odd rule."""
    whole = shapely.Polygon()
    for ring in rings:
        whole = whole.symmetric_difference(shapely.Polygon(ring))
    return whole


def pixels(whole):
    """The pixels whose centers are inside."""
    x, y = np.meshgrid(np.arange(WIDTH), np.arange(HEIGHT))
    return shapely.contains_xy(whole, x, y)


def turned_same(a, b, what, most=1e-6):
    """The same ring, wherever it begins and whichever way it turns."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    check(a.shape == b.shape, f"{what}: points", a.shape, b.shape)
    distances = np.abs(a[:, None] - b[None]).max(axis=2)
    check(distances.min(axis=1).max() <= most, what, distances.min(axis=1).max())
    near(shapely.Polygon(a).area, shapely.Polygon(b).area, f"{what}: area", 1e-3)


def drawn(folder, holes):
    """A table of stars, some with a hole, that goes out to every format."""
    rng = np.random.default_rng(7)
    rows = ["# contour 1, closed", "x,y,curve,ring"]
    for number in range(4):
        center = np.array([20.3 + 45.7 * (number % 2), 19.8 + 37.1 * (number // 2)])
        for ring in range(1 + (holes and number % 2)):
            n = 17 - 6 * ring
            angles = np.arange(n) * 2 * np.pi / n
            radii = rng.uniform(11, 18, n) if ring == 0 else rng.uniform(3, 6, n)
            for angle, radius in zip(angles, radii):
                x, y = center + radius * np.array([np.cos(angle), np.sin(angle)])
                rows.append(f"{x},{y},{number + 1},{ring}")
    path = folder / f"drawn{holes}.csv"
    path.write_text("\n".join(rows) + "\n")
    return path.name, rings_of(path)


def ours_read_by_others(folder):
    for holes in (0, 1):
        source, rings = drawn(folder, holes)
        wholes = {name: polygon(own) for name, own in rings.items()}

        data = json.loads(convert(folder, "a.geojson", source).read_text())
        check(len(data["features"]) == len(rings), "geojson: features")
        for feature in data["features"]:
            whole = shapely.geometry.shape(feature["geometry"])
            check(whole.is_valid and whole.exterior.is_ccw, "geojson: outer rings turn left")
            check(not any(hole.is_ccw for hole in whole.interiors), "geojson: holes turn right")
            same = shapely.affinity.translate(wholes[feature["id"]], 0.5, 0.5)
            near(whole.area, same.area, "geojson: area")
            near(whole.symmetric_difference(same).area, 0, "geojson: place")

        path = convert(folder, "a.zip", source)
        for roi in roifile.roiread(path):
            own = rings[roi.name]
            if len(own) == 1:
                check(roi.roitype == roifile.ROI_TYPE.POLYGON, "imagej: type", roi.roitype)
                near(roi.coordinates(), own[0] + 0.5, "imagej: coordinates", 1e-4)
            else:
                check(roi.composite, "imagej: composite")
                for a, b in zip(roi.coordinates(multi=True), own):
                    a = a[:-1] if np.allclose(a[0], a[-1]) else a
                    near(a, b + 0.5, "imagej: coordinates of a composite", 1e-4)

        path = convert(folder, "a.json", source, "--to", "coco", "--picture", "a.png")
        devnull = open(os.devnull, "w")
        out, sys.stdout = sys.stdout, devnull
        coco = COCO(path)
        sys.stdout = out
        check(coco.imgs[1]["file_name"] == "a.png", "coco: file name")
        for one in coco.anns.values():
            whole = wholes[str(one["id"])]
            mask = coco.annToMask(one).astype(bool)
            check(mask.shape == (HEIGHT, WIDTH), "coco: size", mask.shape)
            if isinstance(one["segmentation"], dict):
                check((mask == pixels(whole)).all(), "coco: runs")
                near(one["area"], mask.sum(), "coco: area of runs")
                near(one["bbox"], coco_mask.toBbox(coco_mask.encode(np.asfortranarray(mask, np.uint8))), "coco: bbox")
            else:
                near(one["area"], whole.area, "coco: area")
                # the reference rounds corners to fifths of a pixel
                check((mask ^ pixels(whole)).sum() <= 0.05 * whole.area, "coco: pixels", (mask ^ pixels(whole)).sum())
                points = np.reshape(one["segmentation"][0], (-1, 2))
                near(points, rings[str(one["id"])][0] + 0.5, "coco: coordinates")
                low, high = points.min(axis=0), points.max(axis=0)
                near(one["bbox"], [*low, *(high - low)], "coco: bbox")

        svg = SVG.parse(convert(folder, "a.svg", source))
        near([svg.viewbox.width, svg.viewbox.height], [WIDTH, HEIGHT], "svg: viewBox")
        found = [one for one in svg.elements() if isinstance(one, SvgPath)]
        check(len(found) == len(rings), "svg: paths", len(found))
        for one in found:
            own = rings[one.values["data-id"]]
            parts = [np.array([[p.end.x, p.end.y] for p in part][:-1]) for part in one.as_subpaths()]
            check(len(parts) == len(own), "svg: parts")
            for a, b in zip(parts, own):
                near(a, b + 0.5, "svg: coordinates")

        if not holes:
            data = json.loads(convert(folder, "b.json", source, "--to", "labelme").read_text())
            near([data["imageWidth"], data["imageHeight"]], [WIDTH, HEIGHT], "labelme: size")
            for one in data["shapes"]:
                check(one["shape_type"] == "polygon", "labelme: type")
                near(one["points"], rings[one["id"]][0] + 0.5, "labelme: coordinates")

        inside = np.zeros((HEIGHT, WIDTH), int)
        for name, whole in wholes.items():
            inside[pixels(whole)] = int(name)
        mask = np.array(Image.open(convert(folder, "a.png", source)))
        check(mask.dtype == np.uint8 and set(np.unique(mask)) == {0, 255}, "mask: values")
        check(((mask > 0) == (inside > 0)).all(), "mask: pixels")
        labels = np.array(Image.open(convert(folder, "l.png", source, "--to", "labels")))
        check((labels == inside).all(), "labels: pixels", labels.dtype)
        deep = tifffile.imread(convert(folder, "l.tif", source, "--to", "deep-labels"))
        check(deep.dtype == np.uint32 and (deep == inside).all(), "deep labels: pixels", deep.dtype)


def others_read_by_us(folder):
    rng = np.random.default_rng(11)
    star = lambda n, x, y, r: np.stack([x + r * np.cos(np.arange(n) * 6.283 / n) * rng.uniform(0.8, 1, n),
                                        y + r * np.sin(np.arange(n) * 6.283 / n) * rng.uniform(0.8, 1, n)], 1)
    # areas of ImageJ from the corner, in floats and in whole numbers
    for points in (star(13, 30.2, 30.4, 14), np.round(star(13, 30, 30, 14))):
        roifile.ImagejRoi.frompoints(points.astype(np.float32)).tofile(folder / "p.roi")
        found = rings_of(convert(folder, "p.csv", "p.roi"))["1"]
        near(found[0], points - 0.5, "roifile: a polygon", 1e-5)
    whole = np.array([[3, 4], [40, 9], [22, 33]], np.int32)
    roifile.ImagejRoi.frompoints(whole).tofile(folder / "i.roi")
    near(rings_of(convert(folder, "i.csv", "i.roi"))["1"][0], whole - 0.5, "roifile: whole numbers")

    rois = []
    for number, kind in enumerate(["POLYLINE", "FREELINE", "FREEHAND", "TRACED", "POINT"]):
        points = star(9, 40, 40, 20 - number).astype(np.float32)
        roi = roifile.ImagejRoi.frompoints(points, name=kind)
        roi.roitype = roifile.ROI_TYPE[kind]
        rois.append((kind, roi, points))
    for kind, roi, points in rois:
        roi.tofile(folder / "k.roi")
        shift = 0 if kind in ("POLYLINE", "FREELINE", "POINT") else 0.5
        found = rings_of(convert(folder, "k.csv", "k.roi"))
        found = np.concatenate([ring for own in found.values() for ring in own])
        near(found, points - shift, f"roifile: {kind}", 1e-5)
    with zipfile.ZipFile(folder / "k.zip", "w", zipfile.ZIP_DEFLATED) as file:
        for number, (kind, roi, points) in enumerate(rois[2:4]):
            file.writestr(f"{number}-{kind}.roi", roi.tobytes())
    check(set(rings_of(convert(folder, "k.csv", "k.zip"))) == {"FREEHAND", "TRACED"}, "roifile: a ZIP")

    box = roifile.ImagejRoi(roitype=roifile.ROI_TYPE.RECT, top=3, left=5, bottom=23, right=45)
    box.tofile(folder / "r.roi")
    found = rings_of(convert(folder, "r.csv", "r.roi"))["1"][0]
    turned_same(found, [[4.5, 2.5], [44.5, 2.5], [44.5, 22.5], [4.5, 22.5]], "roifile: a rectangle")
    oval = roifile.ImagejRoi(roitype=roifile.ROI_TYPE.OVAL, top=3, left=5, bottom=23, right=45)
    oval.tofile(folder / "o.roi")
    found = shapely.Polygon(rings_of(convert(folder, "o.csv", "o.roi"))["1"][0])
    near(found.area, np.pi * 20 * 10, "roifile: an oval", 1.0)
    near([found.centroid.x, found.centroid.y], [24.5, 12.5], "roifile: the middle of an oval", 1e-3)

    # masks of pycocotools, packed and not, with holes and noise
    noise = rng.random((HEIGHT, WIDTH)) < 0.3
    disk = np.hypot(*np.mgrid[-40:40, -48:48]) < 30
    ring = disk & ~(np.hypot(*np.mgrid[-45:35, -50:46]) < 9)
    for name, mask in (("noise", noise), ("disk", disk), ("ring", ring)):
        packed = coco_mask.encode(np.asfortranarray(mask, np.uint8))
        packed["counts"] = packed["counts"].decode()
        counts, last, run = [], 0, 0
        for value in mask.flatten(order="F"):
            if value != last:
                counts.append(run)
                last, run = value, 0
            run += 1
        plain = {"size": [HEIGHT, WIDTH], "counts": counts + [run]}
        for how, segmentation in (("packed", packed), ("plain", plain)):
            one = {"id": 3, "image_id": 8, "category_id": 2, "segmentation": segmentation, "iscrowd": 1}
            other = {**one, "id": 4, "image_id": 9}
            data = {"images": [{"id": 8, "file_name": "x/a.png"}, {"id": 9, "file_name": "b.png"}],
                    "categories": [{"id": 2, "name": "cell"}], "annotations": [one, other]}
            (folder / "m.json").write_text(json.dumps(data))
            path = convert(folder, "m.png", "m.json", "--picture", "a.png")
            check(((np.array(Image.open(path)) > 0) == mask).all(), f"pycocotools: {name}, {how}")

    # pictures of others: areas are numbers of pixels
    labels = np.zeros((HEIGHT, WIDTH), np.uint16)
    for number, (x, y) in enumerate([(20, 20), (70, 25), (45, 60)]):
        labels[np.hypot(*np.mgrid[-y:HEIGHT - y, -x:WIDTH - x]) < 12 + number] = 300 + number
    for name, kind in (("t.tif", np.uint16), ("t.tif", np.uint32), ("t.tif", np.int32), ("t.tif", np.float32)):
        tifffile.imwrite(folder / name, labels.astype(kind))
        found = rings_of(convert(folder, "t.csv", name))
        for number in range(300, 303):
            near(polygon(found[str(number)]).area, (labels == number).sum(), f"labels in {kind}")
    Image.fromarray((labels > 0).astype(np.uint8)).save(folder / "u.png")
    found = rings_of(convert(folder, "u.csv", "u.png"))
    near(sum(polygon(own).area for own in found.values()), (labels > 0).sum(), "a mask of Pillow")

    # a soft disk has the area of the sharp one
    soft = np.clip(20.25 - np.hypot(*np.mgrid[-40:40, -48:48]) + 0.5, 0, 1)
    tifffile.imwrite(folder / "s.tif", soft.astype(np.float32))
    found = polygon(rings_of(convert(folder, "s.csv", "s.tif"))["1"])
    near(found.area, np.pi * 20.25**2, "a soft mask", 3.0)

    # curves, arcs and transforms as svgelements walks them
    data = "M10 10c20-5 40 5 50 20s-10 30-25 30q-20 5-30-15t5-20A12 9 30 1 1 20 12Z"
    turn = "translate(4 3) rotate(10) scale(0.9 1.1)"
    (folder / "c.svg").write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 96 80">'
                                  f'<g transform="{turn}"><path d="{data}"/></g></svg>')
    points = []
    for segment in SvgPath(data):
        if type(segment).__name__ not in ("Move", "Close"):
            # moved as points: that program does not turn and stretch an arc exactly
            points += [Matrix(turn).point_in_matrix_space(segment.point(t)) for t in np.linspace(0, 1, 400)]
    own = shapely.LinearRing([(p.x - 0.5, p.y - 0.5) for p in points])
    found = shapely.LinearRing(rings_of(convert(folder, "c.csv", "c.svg"))["1"][0])
    near(shapely.hausdorff_distance(own, found, 0.5), 0, "svgelements: a path", 0.015)

    # several parts and holes of shapely
    disk = shapely.Point(30.5, 30.5).buffer(15)
    whole = shapely.unary_union([disk - shapely.Point(32.5, 29.5).buffer(5), shapely.Point(70, 60).buffer(9)])
    feature = {"type": "Feature", "id": "b1", "properties": {"classification": {"name": "Tumor"}},
               "geometry": shapely.geometry.mapping(whole)}
    (folder / "g.geojson").write_text(json.dumps([feature]))
    found = polygon(rings_of(convert(folder, "g.csv", "g.geojson"))["1"])
    same = shapely.affinity.translate(whole, -0.5, -0.5)
    near(found.symmetric_difference(same).area, 0, "shapely: parts and holes")


def run(*words):
    """Run one of our programs; what it printed."""
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    check(done.returncode == 0, " ".join(map(str, words)), done.stderr)
    return done.stdout


def story(folder):
    """Stars that move: 1 is away in frame 2, 9 has come from 1 in frame 5."""
    rng = np.random.default_rng(5)
    rows, all_rings = ["frame,id,x,y"], {}
    there = {1: [0, 1, 3, 4], 2: range(7), 9: [5, 6]}
    for number, frames in there.items():
        for frame in frames:
            center = np.array([20.3 + 31 * (number % 3) + 1.7 * frame, 24.6 + 14 * (number % 2) + frame])
            angles = np.arange(19) * 2 * np.pi / 19
            ring = center + rng.uniform(6, 12, 19)[:, None] * np.stack([np.cos(angles), np.sin(angles)], 1)
            all_rings[frame, number] = ring
    for (frame, number), ring in sorted(all_rings.items()):
        rows += [f"{frame},{number},{x},{y}" for x, y in ring]
    path = folder / "story.csv"
    path.write_text("\n".join(rows) + "\n")
    return path, all_rings


def our_tracks_read_by_others(folder):
    source, rings = story(folder)
    ids, frames = sorted({number for _, number in rings}), range(7)
    written = lambda name, kind: (run(TRACKS, source, folder / name, kind, WIDTH, HEIGHT), folder / name)[1]
    inside = {key: pixels(shapely.Polygon(ring)) for key, ring in rings.items()}

    data = json.loads(written("s.geojson", "geojson").read_text())
    check(len(data["features"]) == len(rings), "geojson tracks: features")
    for feature in data["features"]:
        own = feature["properties"]
        whole = shapely.geometry.shape(feature["geometry"])
        same = shapely.affinity.translate(shapely.Polygon(rings[own["frame"], own["track"]]), 0.5, 0.5)
        near(whole.symmetric_difference(same).area, 0, "geojson tracks: place")
        check(own.get("parent") == (1 if own["track"] == 9 else None), "geojson tracks: parent", own)

    for roi in roifile.roiread(written("s.zip", "imagej")):
        frame, number = int(roi.name[5:9]) - 1, int(roi.name.split("_id")[1])
        check(roi.position == frame + 1, "imagej tracks: position", roi.name, roi.position)
        near(roi.coordinates(), rings[frame, number] + 0.5, "imagej tracks: coordinates", 1e-4)
        check(len(roi.stroke_color) == 4 and roi.stroke_color[0] == 255, "imagej tracks: color", roi.stroke_color)

    data = json.loads(written("s.json", "coco").read_text())
    check(data["videos"][0]["length"] == 7 and data["videos"][0]["file_names"][3] == "f3.png", "coco tracks: video")
    check([one["id"] for one in data["annotations"]] == ids, "coco tracks: objects")
    for one in data["annotations"]:
        for frame in frames:
            runs, box = one["segmentations"][frame], one["bboxes"][frame]
            own = inside.get((frame, one["id"]))
            check((runs is None) == (own is None), "coco tracks: null where away", one["id"], frame)
            if runs is None:
                check(box is None and one["areas"][frame] is None, "coco tracks: null where away")
                continue
            packed = coco_mask.frPyObjects(runs, HEIGHT, WIDTH)
            check((coco_mask.decode(packed).astype(bool) == own).all(), "coco tracks: pixels", one["id"], frame)
            near(coco_mask.area(packed), one["areas"][frame], "coco tracks: area")
            near(coco_mask.toBbox(packed), box, "coco tracks: box")

    boxes = np.loadtxt(written("s.txt", "mot"), delimiter=",")
    check(boxes.shape == (len(rings), 10), "mot: lines")
    for frame, number, left, top, width, height, *_ in boxes:
        ring = rings[int(frame) - 1, int(number)] + 1.5
        near([left, top, left + width, top + height], [*ring.min(axis=0), *ring.max(axis=0)], "mot: box")

    # the challenge's rules, by the pixels that tifffile reads
    path = written("RES", "ctc")
    images = [tifffile.imread(path / f"mask{frame:03}.tif") for frame in frames]
    check(all(image.dtype == np.uint16 and image.shape == (HEIGHT, WIDTH) for image in images), "ctc: kind")
    table = np.loadtxt(path / "res_track.txt", dtype=int, ndmin=2)
    labels = {label for image in images for label in np.unique(image) if label}
    check(labels == set(table[:, 0]) and len(labels) == len(table), "ctc: labels are those of the table")
    for label, begin, end, parent in table:
        seen = [frame for frame in frames if (images[frame] == label).any()]
        check(seen == list(range(begin, end + 1)), "ctc: in every frame of the track", label, seen)
        if parent:
            check(table[table[:, 0] == parent, 2][0] < begin, "ctc: a parent has ended", label)
    check(sorted(map(tuple, table[:, 1:3])) == [(0, 1), (0, 6), (3, 4), (5, 6)], "ctc: tracks", table)
    for frame in frames:
        union = np.any([own for key, own in inside.items() if key[0] == frame], axis=0)
        check(((images[frame] > 0) == union).all(), "ctc: pixels", frame)


def their_sequences_read_by_us(folder):
    # labels of the challenge as tifffile writes them, packed or not
    truth = folder / "TRA"
    truth.mkdir()
    expected = {}
    for frame in range(4):
        labels = np.zeros((HEIGHT, WIDTH), np.uint16)
        for number, (x, y) in {7: (20 + frame, 20), 300: (60, 40 + frame)}.items():
            labels[np.hypot(*np.mgrid[-y:HEIGHT - y, -x:WIDTH - x]) < 9] = number
            expected[frame, number] = (labels == number).sum()
        tifffile.imwrite(truth / f"man_track{frame:03}.tif", labels, compression="zlib" if frame % 2 else None)
    np.savetxt(truth / "man_track.txt", [[7, 0, 3, 0], [300, 0, 3, 0]], fmt="%d")
    run(TRACKS, truth, folder / "truth.csv")
    rows = np.loadtxt(folder / "truth.csv", delimiter=",", skiprows=1)
    for (frame, number), area in expected.items():
        own = rows[(rows[:, 0] == frame) & (rows[:, 1] == number), 2:]
        near(shapely.Polygon(own).area, area, "ctc: the area of labels of tifffile")

    # stacks of tifffile, followed; films as Pillow reads them
    disk = lambda frame: np.clip(12.5 - np.hypot(*np.mgrid[-30:HEIGHT - 30, -20 - 3 * frame:WIDTH - 20 - 3 * frame]), 0, 1)
    stack = np.stack([60 + 120 * disk(frame) for frame in range(9)])
    kinds = {"imagej.tif": ((257 * stack).astype(np.uint16), {"imagej": True, "metadata": {"axes": "TYX"}}),
             "ome.ome.tif": (stack.astype(np.uint8), {"metadata": {"axes": "TYX"}, "compression": "zlib"}),
             "big.tif": (stack.astype(np.uint8), {"bigtiff": True, "byteorder": ">"}),
             "floats.tif": ((stack / 255).astype(np.float32), {"photometric": "minisblack"})}
    for name, (pages, how) in kinds.items():
        tifffile.imwrite(folder / name, pages, **how)
        run(SNAKE, "track", folder / name, "--from", "circle:20,30,12", "-q", "-o", folder / "stack.csv",
            "--overlay", folder / "stack.gif")
        rows = np.loadtxt(folder / "stack.csv", delimiter=",", skiprows=1)
        for frame in range(9):
            middle = np.array(shapely.Polygon(rows[rows[:, 0] == frame, 2:]).centroid.coords[0])
            near(middle, [20 + 3 * frame, 30], f"{name}: frame {frame}", 0.3)
        with Image.open(folder / "stack.gif") as film:
            check(film.n_frames == 9, f"{name}: frames of the film", film.n_frames)
    run(SNAKE, "track", folder / "big.tif", "--from", "circle:20,30,12", "-q", "-o", folder / "stack.csv",
        "--overlay", folder / "stack.png")
    with Image.open(folder / "stack.png") as film:
        check(film.n_frames == 9 and film.is_animated, "apng: frames", film.n_frames)
        zoom = film.size[0] // WIDTH
        for frame in range(9):
            film.seek(frame)
            shown = np.array(film.convert("RGB"))
            level = shown[30 * zoom, (20 + 3 * frame) * zoom]
            near(level, [180] * 3, f"apng: the middle of the disk in frame {frame}", 1)


with tempfile.TemporaryDirectory() as name:
    our_tracks_read_by_others(Path(name))
    their_sequences_read_by_us(Path(name))
    ours_read_by_others(Path(name))
    others_read_by_us(Path(name))
print(f"formats: {checks} comparisons with other programs hold")
