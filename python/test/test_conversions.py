# SPDX-License-Identifier: BSD-3-Clause
"""From arrays of any type, and to and from Open3D where it is installed."""
import fresco
import numpy as np
import pytest

FACES = [[0, 1, 2], [0, 2, 3]]


def test_arrays_that_fit_are_kept_and_others_converted():
    rows = np.random.default_rng(1).random((4, 3)).astype(np.float32)
    assert fresco.from_arrays(rows).points is rows
    mesh = fresco.from_arrays(rows.astype(np.float64), FACES, colors=np.full((4, 3), 0.5))
    assert isinstance(mesh, fresco.TriangleMesh) and mesh.faces.dtype == np.int32 and (mesh.colors == 128).all()
    assert np.array_equal(mesh.vertices, rows) and not mesh.origin.any()


def test_large_coordinates_are_kept_exact():
    exact = np.array([5e5, 4e6, 100]) + np.random.default_rng(1).random((1000, 3)) * 10
    points = fresco.from_arrays(exact)
    assert np.abs(points.points + points.origin - exact).max() < 1e-6
    assert np.abs(exact.astype(np.float32) - exact).max() > 1e-2


def test_open3d_there_and_back(sphere):
    open3d = pytest.importorskip("open3d")
    sphere = fresco.PointSet(sphere.points, normals=sphere.normals, colors=np.full((5000, 3), 77, np.uint8),
                             origin=[1, 2, 3])
    cloud = fresco.to_open3d(sphere)
    assert isinstance(cloud, open3d.geometry.PointCloud) and np.allclose(cloud.get_center(), sphere.origin, atol=0.1)
    back = fresco.from_open3d(cloud)
    assert np.allclose(back.points + back.origin, sphere.points + sphere.origin, atol=1e-6)
    assert np.array_equal(back.normals, sphere.normals) and np.array_equal(back.colors, sphere.colors)
    mesh = fresco.reconstruct(sphere, depth=4).mesh
    again = fresco.from_open3d(fresco.to_open3d(mesh))
    assert np.array_equal(again.faces, mesh.faces) and fresco.mesh_topology(again).watertight


def test_importing_fresco_imports_no_open3d():
    import subprocess
    import sys
    subprocess.run([sys.executable, "-c", "import fresco, sys; assert 'open3d' not in sys.modules"], check=True)


def test_meshes_are_written_as_gltf(tmp_path):
    mesh = fresco.from_arrays([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    fresco.write_mesh(tmp_path / "mesh.glb", mesh)
    read = fresco.read_textured_mesh(tmp_path / "mesh.glb").mesh
    assert read.is_watertight() and abs(read.volume - mesh.volume) < 1e-6
