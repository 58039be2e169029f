# SPDX-License-Identifier: BSD-3-Clause
"""What trimming.py and thin_rods.py share: surface samples, distances, rods in a truth mesh."""
import numpy as np
import open3d as o3d


def read_mesh(path):
    mesh = o3d.io.read_triangle_mesh(path)
    if not mesh.has_triangles():
        raise SystemExit(path + ": no faces")
    return mesh


def sample(mesh, count, seed=1):
    """Area-uniform samples (count x 3) and the area that each stands for, m^2."""
    vertices, faces = np.asarray(mesh.vertices), np.asarray(mesh.triangles)
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    random = np.random.default_rng(seed)
    chosen = random.choice(len(faces), count, p=areas / areas.sum())
    u, v = random.random((2, count, 1))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    return a[chosen] + u * (b - a)[chosen] + v * (c - a)[chosen], areas.sum() / count


def distances_to_mesh(points, mesh):
    scene = o3d.t.geometry.RaycastingScene()
    scene.add_triangles(o3d.t.geometry.TriangleMesh.from_legacy(mesh))
    return scene.compute_distance(o3d.core.Tensor(points.astype(np.float32))).numpy()


def distances_to_cloud(points, cloud):
    search = o3d.core.nns.NearestNeighborSearch(o3d.core.Tensor(np.asarray(cloud.points, dtype=np.float32)))
    search.knn_index()
    return np.sqrt(search.knn_search(o3d.core.Tensor(points.astype(np.float32)), 1)[1].numpy().ravel())


def rods(mesh, thickest, shortest):
    """Connected parts of a mesh no more than `thickest` m across on two axes and at least `shortest` m long."""
    mesh = o3d.geometry.TriangleMesh(mesh)
    mesh.merge_close_vertices(1e-6)
    cluster = np.asarray(mesh.cluster_connected_triangles()[0])
    faces, vertices = np.asarray(mesh.triangles), np.asarray(mesh.vertices)
    found = []
    for k in range(cluster.max() + 1):
        corners = vertices[faces[cluster == k].ravel()]
        sides = np.sort(corners.max(0) - corners.min(0))
        if sides[1] <= thickest and sides[2] >= shortest:
            found.append(k)
    mesh.triangles = o3d.utility.Vector3iVector(faces[np.isin(cluster, found)])
    mesh.remove_unreferenced_vertices()
    return mesh, len(found)
