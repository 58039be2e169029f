#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Our readers against others, over any folder: readers.py [--bin DIR] FOLDER...

Every file of points is read by fresco_filter (which keeps finite points, in their order) and by a reader of numpy (PLY, PCD,
LAS, text) or Open3D (all that it knows, where python3-open3d is installed). Prints a line per file: same, differs, refused by us,
refused by them, no other reader. Ends with 1 if a file differs."""
import argparse
import multiprocessing
import os
import subprocess
import sys
import tempfile
import numpy as np
try:
    import open3d
except ImportError:
    open3d = None

KINDS = (".ply", ".pcd", ".xyz", ".txt", ".asc", ".csv", ".pts", ".ptx", ".las", ".e57", ".obj", ".stl", ".vtk")
PLY = {"char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2", "uint16": "u2",
       "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4", "double": "f8",
       "float64": "f8"}


def read_ply(path):
    """Columns of the vertices, which come first and have no lists."""
    with open(path, "rb") as file:
        data = file.read()
    begin = data.index(b"\n", data.index(b"end_header")) + 1
    order, count, columns, element = "", 0, [], None
    for words in (line.split() for line in data[:begin].decode("latin1").splitlines()):
        if words[:1] == ["format"]:
            order = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}[words[1]]
        elif words[:1] == ["element"]:
            if element is None and words[1] != "vertex":
                raise ValueError("other elements before the vertices")
            element, count = words[1], int(words[2]) if words[1] == "vertex" else count
        elif words[:1] == ["property"] and element == "vertex":
            columns.append((words[2], PLY[words[1]]))
    if order:
        table = np.frombuffer(data, np.dtype([(name, order + kind) for name, kind in columns]), count, begin)
        return {name: table[name].astype(float) for name, _ in columns}
    values = np.array(data[begin:].split()[: count * len(columns)], float).reshape(count, len(columns))
    return {name: values[:, i] for i, (name, _) in enumerate(columns)}


def read_pcd(path):
    with open(path, "rb") as file:
        data = file.read()
    begin = data.index(b"\n", data.index(b"\nDATA") + 1) + 1
    head = {words[0]: words[1:] for words in map(str.split, data[:begin].decode("latin1").splitlines()) if words}
    names, counts = head["FIELDS"], [int(c) for c in head.get("COUNT", ["1"] * len(head["FIELDS"]))]
    points = int(head["POINTS"][0])
    if head["DATA"][0] == "ascii":
        at = np.cumsum([0] + counts)
        values = np.array(data[begin:].split()[: points * at[-1]], float).reshape(points, -1)
        return {name: values[:, at[i]] for i, name in enumerate(names)}
    if head["DATA"][0] != "binary":
        raise ValueError("compressed")
    kinds = [kind.replace("F", "f").replace("U", "u").replace("I", "i") + size for kind, size in zip(head["TYPE"], head["SIZE"])]
    table = np.frombuffer(data, np.dtype([(f"{i}{name}", "<" + kind, (count,)) for i, (name, kind, count)
                                          in enumerate(zip(names, kinds, counts))]), points, begin)
    return {name: table[f"{i}{name}"][:, 0].astype(float) for i, name in enumerate(names)}


def read_text(path):
    with open(path, encoding="latin1") as file:
        rows = [line.replace(",", " ").replace(";", " ").split() for line in file if line.strip() and line[0] not in "#/"]
    rows = rows[1:] if len(rows[0]) == 1 else rows
    values = np.array(rows, float)
    return dict(zip("xyz", values[:, :3].T))


def read_las(path):
    """Offsets as LAS 1.4 R15 has them, tables 3 and 7 to 17."""
    with open(path, "rb") as file:
        data = file.read()
    begin, kind, size = (int.from_bytes(data[at:at + n], "little") for at, n in ((96, 4), (104, 1), (105, 2)))
    points = int.from_bytes(data[107:111], "little")
    if data[25] == 4:
        points = int.from_bytes(data[247:255], "little") or points
    rows = np.frombuffer(data, np.uint8, points * size, begin).reshape(points, size)
    scale, offset = np.frombuffer(data, "<f8", 3, 131), np.frombuffer(data, "<f8", 3, 155)
    xyz = rows[:, :12].copy().view("<i4") * scale + offset
    columns = dict(zip("xyz", xyz.T))
    at = {2: 20, 3: 28, 5: 28, 7: 30, 8: 30, 10: 30}.get(kind)
    if at:
        colors = rows[:, at:at + 6].copy().view("<u2").astype(int)
        colors = colors if colors.max(initial=0) < 256 else colors // 256
        columns.update(zip(("red", "green", "blue"), colors.T))
    return columns


def read_open3d(path):
    cloud = open3d.io.read_point_cloud(path) if not path.endswith((".obj", ".stl", ".vtk")) else open3d.io.read_triangle_mesh(path)
    points = np.asarray(getattr(cloud, "points", getattr(cloud, "vertices", [])))
    if len(points) == 0:
        raise ValueError("no points")
    columns = dict(zip("xyz", points.T))
    colors = np.asarray(getattr(cloud, "colors", getattr(cloud, "vertex_colors", [])))
    if len(colors) == len(points):
        columns.update(zip(("red", "green", "blue"), np.round(255 * colors.T)))
    return columns


def others(path):
    """(name, columns or error) of each reader that knows the file."""
    kind = os.path.splitext(path)[1].lower()
    by_numpy = {".ply": read_ply, ".pcd": read_pcd, ".las": read_las}
    readers = [("numpy", by_numpy.get(kind, read_text))] if kind in by_numpy or kind in KINDS[2:6] else []
    if kind in (".ply", ".pcd", ".xyz", ".pts", ".obj", ".stl"):
        readers.append(("Open3D", read_open3d))
    for name, read in readers:
        if name != "Open3D" or open3d:
            yield name, alone(read, path)


def alone(read, path):
    """Columns, or the error, of a reader in a process of its own, which it may crash."""
    def work():
        try:
            answer = read(path)
            if not set("xyz") <= set(answer):
                answer = "no columns x y z"
        except Exception as error:  # whatever their reader throws is its refusal
            answer = str(error).splitlines()[0][:80] if str(error) else type(error).__name__
        sender.send(answer)

    receiver, sender = multiprocessing.Pipe(False)
    process = multiprocessing.get_context("fork").Process(target=work)
    process.start()
    sender.close()
    try:
        return receiver.recv()
    except EOFError:
        return "crashes"
    finally:
        process.join()


def difference(ours, theirs, is_mesh):
    """"" = the same; points that are not finite do not count."""
    finite = np.isfinite(np.stack([theirs[axis] for axis in "xyz"])).all(0)
    if is_mesh:  # whose corners others keep apart
        points = [np.sort(np.unique(np.stack([each[axis] for axis in "xyz"]).T[mask].astype(np.float32), axis=0), axis=0)
                  for each, mask in ((ours, slice(None)), (theirs, finite))]
        return "" if points[0].shape == points[1].shape and np.allclose(*points, atol=1e-5) else "other vertices"
    if len(ours["x"]) != finite.sum():
        return f"{len(ours['x'])} points, they have {finite.sum()}"
    for name in ("x", "y", "z", "red", "green", "blue", "nx", "ny", "nz"):
        if name not in theirs or name not in ours:
            continue
        there = theirs[name][finite]
        if name in ("red", "green", "blue") and there.max(initial=0) <= 1:
            there = np.round(255 * there)
        tolerance = 1 if name in ("red", "green", "blue") else 1e-6 * max(1, np.ptp(there)) + 1e-6 * np.abs(there).max()
        worst = np.nanmax(np.abs(ours[name] - there), initial=0)
        if worst > tolerance:
            return f"{name} differs by {worst:g}"
    return ""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+")
    parser.add_argument("--bin", default=os.path.join(os.path.dirname(__file__), "../../build/bin"))
    options = parser.parse_args()
    counts = {}
    with tempfile.TemporaryDirectory() as scratch:
        out = os.path.join(scratch, "out.ply")
        files = sorted(os.path.join(folder, name) for top in options.folders for folder, _, names in os.walk(top)
                       for name in names if name[0] != "." and os.path.splitext(name)[1].lower() in KINDS)
        for path in files:
            run = subprocess.run([os.path.join(options.bin, "fresco_filter"), path, out, "-quiet"], capture_output=True, text=True)
            ours = read_ply(out) if run.returncode == 0 else None
            if run.returncode not in (0, 1):
                verdicts = [f"differs: we ended with {run.returncode}"]
            else:
                verdicts = []
                for name, theirs in others(path):
                    if isinstance(theirs, str):
                        verdicts.append(f"refused by {name}: {theirs}" if ours else f"refused by both ({name})")
                    elif ours is None:
                        verdicts.append(f"refused by us, {name} has {len(theirs['x'])} points: {run.stderr.strip()[:120]}")
                    else:
                        found = difference(ours, theirs, path.lower().endswith((".obj", ".stl")))
                        verdicts.append(f"differs from {name}: {found}" if found else f"same as {name}")
            for verdict in verdicts or ["no other reader"]:
                print(f"{path}: {verdict}", flush=True)
                kind = verdict.split(":")[0].split(",")[0]
                counts[kind] = counts.get(kind, 0) + 1
    for kind, count in sorted(counts.items()):
        print(f"{count:6} {kind}")
    return any(kind.startswith("differs") for kind in counts)


if __name__ == "__main__":
    sys.exit(main())
