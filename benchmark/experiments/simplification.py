#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""fresco_simplify beside Open3D, meshoptimizer and MeshLab, with the same number of faces:
simplification.py BIN_DIR MESH.ply WORK_DIR [--faces N...]

Each program is a process of its own, files included. Errors and edges are fresco_compare's. A face is flipped where its normal
points away from that of the face of MESH next to its middle. Needs python3-open3d, which reads no triangle
strips; meshoptimizer's library and meshlabserver are left out where they are not installed."""
import argparse
import ctypes.util
import json
import os
import shutil
import subprocess
import sys
import time

MESHLAB = """<!DOCTYPE FilterScript><FilterScript>
<filter name="Simplification: Quadric Edge Collapse Decimation">
<Param type="RichInt" value="{}" name="TargetFaceNum"/><Param type="RichFloat" value="0" name="TargetPerc"/>
<Param type="RichBool" value="true" name="PreserveBoundary"/><Param type="RichBool" value="true" name="PreserveTopology"/>
<Param type="RichBool" value="true" name="PreserveNormal"/></filter></FilterScript>
"""


def open3d_simplify(mesh, out, faces):
    import open3d as o3d

    o3d.io.write_triangle_mesh(out, o3d.io.read_triangle_mesh(mesh).simplify_quadric_decimation(faces))


def meshoptimizer_simplify(mesh, out, faces):
    """meshopt_simplify() of version 0.18, with as large an error as the number asks for."""
    import numpy as np
    import open3d as o3d

    library = ctypes.CDLL(ctypes.util.find_library("meshoptimizer"))
    library.meshopt_simplify.restype = ctypes.c_size_t
    full = o3d.io.read_triangle_mesh(mesh)
    places = np.ascontiguousarray(full.vertices, np.float32)
    corners = np.ascontiguousarray(full.triangles, np.uint32)
    kept = np.empty_like(corners)
    size = ctypes.c_size_t
    count = library.meshopt_simplify(
        kept.ctypes.data_as(ctypes.c_void_p), corners.ctypes.data_as(ctypes.c_void_p), size(corners.size),
        places.ctypes.data_as(ctypes.c_void_p), size(len(places)), size(12), size(3 * faces), ctypes.c_float(1), 0, None)
    full.triangles = o3d.utility.Vector3iVector(kept.reshape(-1)[:count].reshape(-1, 3).astype(np.int32))
    full.remove_unreferenced_vertices()
    o3d.io.write_triangle_mesh(out, full)


def flipped(mesh, out):
    import numpy as np
    import open3d as o3d

    full, light = (o3d.t.geometry.TriangleMesh.from_legacy(o3d.io.read_triangle_mesh(name)) for name in (mesh, out))
    scene = o3d.t.geometry.RaycastingScene()
    scene.add_triangles(full)
    corners = light.vertex["positions"].numpy()[light.triangle["indices"].numpy()]
    near = scene.compute_closest_points(o3d.core.Tensor(corners.mean(axis=1).astype(np.float32)))
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return int((np.einsum("ij,ij->i", normals, near["primitive_normals"].numpy()) < 0).sum())


def measured(command):
    """Wall clock, CPU in seconds and peak memory in MB of a process; nothing where it could not do it."""
    start = time.time()
    with open(os.devnull, "w", encoding="utf8") as nowhere:
        child = subprocess.Popen(command, stdout=nowhere, stderr=nowhere, env={**os.environ, "QT_QPA_PLATFORM": "offscreen"})
        _, status, used = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        print(f"{' '.join(command)}: ended with {child.returncode}", file=sys.stderr)
        return None
    return time.time() - start, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def main():
    if len(sys.argv) == 6 and sys.argv[1] == "--peer":
        return {"Open3D": open3d_simplify, "meshoptimizer": meshoptimizer_simplify}[sys.argv[2]](
            sys.argv[3], sys.argv[4], int(sys.argv[5]))
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin")
    parser.add_argument("mesh")
    parser.add_argument("work")
    parser.add_argument("--faces", type=int, nargs="+", default=[100000])
    arguments = parser.parse_args()
    os.makedirs(arguments.work, exist_ok=True)
    print("| faces | program | left | RMS to full, mm | RMS from full, mm | largest, mm | normals, degrees | not manifold "
          "edges | flipped faces | wall, s | CPU, s | MB |\n|" + "---|" * 12)
    for faces in arguments.faces:
        script = os.path.join(arguments.work, "meshlab.mlx")
        with open(script, "w", encoding="utf8") as file:
            file.write(MESHLAB.format(faces))
        out = {name: os.path.join(arguments.work, f"{name}_{faces}.ply")
               for name in ("fresco", "Open3D", "meshoptimizer", "MeshLab")}
        peer = [sys.executable, os.path.abspath(__file__), "--peer"]
        commands = {"fresco": [os.path.join(arguments.bin, "fresco_simplify"), arguments.mesh, out["fresco"], "-faces",
                               str(faces), "-quiet"],
                    "Open3D": peer + ["Open3D", arguments.mesh, out["Open3D"], str(faces)]}
        if ctypes.util.find_library("meshoptimizer"):
            commands["meshoptimizer"] = peer + ["meshoptimizer", arguments.mesh, out["meshoptimizer"], str(faces)]
        if shutil.which("meshlabserver"):
            commands["MeshLab"] = ["meshlabserver", "-i", arguments.mesh, "-o", out["MeshLab"], "-s", script]
        for name, command in commands.items():
            costs = measured(command)
            if not costs:
                continue
            wall, cpu, megabytes = costs
            figures = os.path.join(arguments.work, "compare.json")
            subprocess.run([os.path.join(arguments.bin, "fresco_compare"), out[name], arguments.mesh, "-json", figures,
                            "-samples", "300000", "-quiet"], check=True, stdout=subprocess.DEVNULL)
            with open(figures, encoding="utf8") as file:
                found = json.load(file)
            distance = found["surface"]
            to, back = (1000 * distance[way]["rms"] for way in ("mesh_to_reference", "reference_to_mesh"))
            print(f"| {faces} | {name} | {found['mesh']['faces']} | {to:.3g} | {back:.3g} | "
                  f"{1000 * distance['symmetric']['max']:.3g} | {found['normals']['reference_to_mesh']['mean']:.2f} | "
                  f"{found['mesh']['nonmanifold_edges']} | {flipped(arguments.mesh, out[name])} | {wall:.1f} | {cpu:.1f} | "
                  f"{megabytes:.0f} |", flush=True)
    return None


if __name__ == "__main__":
    main()
