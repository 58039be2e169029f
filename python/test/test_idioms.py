# SPDX-License-Identifier: BSD-3-Clause
"""What users of numpy, Open3D and trimesh write without looking into a page: a line each, which must hold."""
import copy
import pickle

import fresco
import numpy as np
import pytest

CORNERS = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
FACES = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]  # a tetrahedron, counter-clockwise from outside
UTM = np.array([500000.25, 5400000.5, 100.125])
TURN = np.array([[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1.0]])


def rows(count=6):
    return np.random.default_rng(3).random((count, 3))


def full():
    return fresco.PointSet(rows(), normals=np.tile([0.0, 0, 1], (6, 1)), colors=np.arange(18).reshape(6, 3),
                           intensities=np.arange(6), origin=[10, 20, 30])


def mesh():
    return fresco.TriangleMesh(CORNERS, FACES, colors=np.eye(4)[:, :3], fields={"height": [0, 0, 0, 1]})


MADE = [
    "PointSet(rows())", "PointSet(rows().tolist())", "PointSet(np.asfortranarray(rows()))", "PointSet(rows()[::2])",
    "PointSet(rows().astype('>f4'))", "PointSet(rows().astype(np.float16))", "PointSet(CORNERS)", "PointSet([])", "PointSet(None)",
    "PointSet(rows(), normals=rows())", "PointSet(rows(), colors=rows())", "PointSet(rows(), colors=np.zeros((6, 3), int))",
    "PointSet(rows(), intensities=[1, 2, 3, 4, 5, 6])", "PointSet(rows(), viewpoints=[[0, 0, 1]])", "PointSet(points=rows())",
    "PointSet(np.broadcast_to(np.float32(1), (4, 3)))", "PointSet(full().points, normals=full().normals)",
    "PointSet(np.c_[rows()[:, 0], rows()[:, 1], rows()[:, 2]])", "TriangleMesh(CORNERS, FACES)",
    "TriangleMesh(rows(4), np.array(FACES, np.int64))", "TriangleMesh(rows(4), np.array(FACES, np.uint32))",
    "TriangleMesh(CORNERS, FACES, fields={'height': [0, 0, 0, 1]})", "TriangleMesh(vertices=CORNERS, faces=FACES)",
    "TriangleMesh(CORNERS, FACES, colors=[[255, 0, 0]] * 4)", "from_arrays(CORNERS, FACES)", "from_arrays(rows())",
]


@pytest.mark.parametrize("line", MADE)
def test_sets_and_meshes_are_made_of(line):
    made = eval("fresco." + line)
    attribute = made.points if isinstance(made, fresco.PointSet) else made.vertices
    assert attribute.dtype == np.float32 and attribute.flags.c_contiguous and attribute.flags.writeable
    given = eval(line.split("(", 1)[1].split(",")[0].rstrip(")") or "None") if line.startswith("PointSet([") else None
    assert given is None or len(made) == len(given)


HELD = [
    # a set is a sequence of points
    "len(p) == 6", "bool(p)", "not fresco.PointSet()", "p.shape == (6, 3)", "len(p[p.points[:, 2] > 0.5]) < 6",
    "len(p[2:4]) == 2", "len(p[::2]) == 3", "len(p[[0, 5]]) == 2", "len(p[np.array([0, 5])]) == 2", "len(p[-2:]) == 2",
    "np.allclose(p[0], p.points[0] + p.origin)", "np.allclose(p[-1], p.world()[-1])", "len(list(p)) == 6",
    "all(row.shape == (3,) for row in p)", "np.array_equal(p[1:].intensities, p.intensities[1:])",
    "np.array_equal(p[p.intensities > 2].colors, p.colors[3:])", "(p[1:3].origin == p.origin).all()",
    "len(p[np.random.default_rng(1).permutation(len(p))[:3]]) == 3", "len(p[~np.isnan(p.points).any(axis=1)]) == 6",
    # several of them
    "len(p + p) == 12", "len(sum([p, p, p])) == 18", "len(fresco.merge_points([p, p, p])) == 18",
    "len(fresco.merge_points(p, p)) == 12", "len(fresco.merge_points((p,))) == 6", "(p + p).has_colors",
    "len(fresco.merge_points(s for s in (p, p))) == 12",
    # numpy takes them
    "np.asarray(p).shape == (6, 3)", "np.asarray(p).dtype == np.float64", "np.array(p, np.float32).dtype == np.float32",
    "np.allclose(np.mean(p, axis=0), p.centroid)", "np.allclose(np.linalg.norm(p, axis=1), np.linalg.norm(p.world(), axis=1))",
    "np.vstack([p, p]).shape == (12, 3)", "np.allclose(np.min(p, axis=0), p.bounds[0])",
    # measures
    "p.bounds.shape == (2, 3)", "(p.bounds[0] <= p.bounds[1]).all()", "(p.extents > 0).all()", "p.centroid.shape == (3,)",
    "p.has_normals and p.has_colors", "not fresco.PointSet(rows()).has_normals", "np.isnan(fresco.PointSet().bounds).all()",
    # motions
    "np.allclose((TURN @ p).world(), p.world() @ TURN[:3, :3].T + TURN[:3, 3], atol=1e-4)",
    "np.allclose(p.transform(TURN).world(), (TURN @ p).world())", "(TURN @ p) is not p", "np.allclose((np.eye(4) @ p).world(), p.world())",
    # copies
    "np.array_equal(p.copy().points, p.points) and p.copy().points is not p.points",
    "np.array_equal(copy.deepcopy(p).colors, p.colors)", "copy.copy(p).points is p.points",
    "np.array_equal(pickle.loads(pickle.dumps(p)).points, p.points)", "'6x3' in repr(p)",
    # functions take masks and lists
    "len(fresco.select_points(p, p.intensities > 2)) == 3", "len(fresco.select_points(p, [0, 1])) == 2",
    "len(fresco.select_points(p, range(3))) == 3", "len(fresco.select_points(p, np.arange(2, dtype=np.int32))) == 2",
    "len(fresco.transform_points(p, TURN.tolist())) == 6",
    # meshes
    "m.is_watertight()", "abs(m.volume - 1 / 6) < 1e-6", "abs(m.area - 1.5 - np.sqrt(3) / 2) < 1e-6", "m.triangles.shape == (4, 3, 3)",
    "np.allclose(np.linalg.norm(m.face_normals, axis=1), 1)", "np.allclose(m.face_normals[0], [0, 0, -1])",
    "len(m.submesh([0]).vertices) == 3", "len(m.submesh(m.face_normals[:, 2] < -0.5).faces) == 1", "not m.submesh(slice(0, 2)).is_watertight()",
    "len((m + m).faces) == 8", "len((m + m).vertices) == 8", "abs((m + m).volume - 2 * m.volume) < 1e-6", "len(sum([m, m, m]).faces) == 12",
    "(m + m).has_colors and 'height' in (m + m).fields", "np.allclose(m.bounds, [[0, 0, 0], [1, 1, 1]])", "np.allclose(m.extents, 1)",
    "abs((TURN @ m).volume - m.volume) < 1e-5", "m.vertices[m.faces].shape == (4, 3, 3)", "np.array_equal(m.copy().faces, m.faces)",
    "m.colors.max() == 255", "np.allclose(fresco.nearest_on_mesh(m, [[0.1, 0.1, -1]]).distances, 1)",
    "fresco.cast_rays(m, [[0.1, 0.1, -1]], [[0, 0, 1]]).faces[0] == 0", "fresco.cast_rays(m, [[5, 5, 5]], [[0, 0, 1]]).faces[0] == -1",
    "m._repr_png_().startswith(b'\\x89PNG')", "p._repr_png_().startswith(b'\\x89PNG')", "m.show()._repr_png_().startswith(b'\\x89PNG')",
]


@pytest.mark.parametrize("line", HELD)
def test_it_holds_that(line):
    assert eval(line, {**globals(), "p": full(), "m": mesh()})


def test_a_line_that_assigns_is_converted_too():
    points = fresco.PointSet(rows())
    points.normals = rows()
    points.colors = [[1.0, 0.5, 0.0]] * 6
    points.intensities = range(6)
    assert points.normals.dtype == np.float32 and (points.colors == [255, 128, 0]).all() and points.intensities[5] == 5


def test_large_coordinates_are_kept_by_an_origin_and_never_lost_silently():
    exact = UTM + rows(1000)
    points = fresco.PointSet(exact, viewpoints=UTM[None] + 1)
    assert np.abs(points.world() - exact).max() < 1e-6 and np.abs(points.viewpoints + points.origin - UTM - 1).max() < 1e-6
    assert np.abs(points.bounds[0] - exact.min(axis=0)).max() < 1e-6
    with pytest.raises(ValueError, match="points: float32 cannot hold"):
        points.points = exact
    with pytest.raises(ValueError, match="points: float32 cannot hold"):
        fresco.PointSet(exact, origin=[0, 0, 0])
    assert not fresco.PointSet(rows()).origin.any()


@pytest.mark.parametrize("made, error, said", [
    (lambda: full()[np.ones(5, bool)], IndexError, ""), (lambda: full()[99], IndexError, ""), (lambda: full()["x"], IndexError, ""),
    (lambda: full() + 1, TypeError, ""), (lambda: full() + mesh(), TypeError, ""), (lambda: fresco.merge_points([]), ValueError, "no sets"),
    (lambda: fresco.merge_points(full()), TypeError, "sequence"), (lambda: np.eye(3) @ full(), ValueError, "T_target_source"),
    (lambda: fresco.PointSet(rows(), colors=rows() * 300), ValueError, "colors: from .* wanted 0 to 1"),
    (lambda: fresco.PointSet(rows(), colors=np.full((6, 3), 256)), ValueError, "wanted 0 to 255"),
    (lambda: fresco.TriangleMesh(CORNERS, np.array(FACES, float)), TypeError, "faces: of type float64, wanted int32"),
    (lambda: fresco.TriangleMesh(CORNERS, np.array(FACES) + 2**40), ValueError, "faces: from"),
    (lambda: fresco.PointSet(rows() + 1j), TypeError, "points: of type complex128"),
    (lambda: fresco.PointSet([[0, 1], [2]]), TypeError, "points"),
    (lambda: fresco.cast_rays(mesh(), [[0, 0, 0]], [[0, 0, 0]]), ValueError, "directions: one is zero"),
    (lambda: fresco.nearest_on_mesh(mesh(), [[np.nan, 0, 0]]), ValueError, "places: a row is not finite"),
])
def test_what_cannot_be_meant_is_named(made, error, said):
    with pytest.raises(error, match=said):
        made()


def test_rays_and_nearest_places_agree_with_what_is_computed_by_hand():
    generator = np.random.default_rng(5)
    directions = generator.normal(size=(200, 3))
    hits = fresco.cast_rays(mesh(), np.full((200, 3), 0.15), directions)  # from inside: each meets one face
    assert (hits.faces >= 0).all() and np.isfinite(hits.distances).all()
    assert np.abs(fresco.nearest_on_mesh(mesh(), hits.points).distances).max() < 1e-6
    normals = mesh().face_normals[hits.faces]
    corner = mesh().vertices[mesh().faces[hits.faces, 0]]
    assert np.abs(np.einsum("ij,ij->i", hits.points - corner, normals)).max() < 1e-5
    assert np.array_equal(hits.faces, fresco.cast_rays(mesh(), np.full((200, 3), 0.15), directions, threads=1).faces)


def test_two_scans_are_aligned_from_a_guess(room):
    scan = fresco.remove_mixed_pixels(fresco.read_points(room / "scans/scan_00.pcd")).points
    wrong = np.array([[1, -0.02, 0, 0.05], [0.02, 1, 0, -0.05], [0, 0, 1, 0.02], [0, 0, 0, 1]])
    found = fresco.align_scans(scan[::2], scan[1::2], wrong)
    assert found.converged and np.abs(found.T_target_source - np.eye(4)).max() < 0.01


def test_cameras_and_video_name_what_is_wrong(room, tmp_path):
    surface = fresco.read_points(room / "scans/scan_00.pcd")
    with pytest.raises(fresco.Error):
        fresco.align_cameras(room / "cameras", surface)  # no sparse points in it, or too few
    camera = fresco.CameraModel(width=4, height=3, fx=4, fy=4, cx=2, cy=1.5)
    with pytest.raises(TypeError, match="depths"):
        fresco.track_rgbd(camera, [np.zeros((3, 4))])
    with pytest.raises(ValueError, match="depths: 1, colors: 2"):
        fresco.track_rgbd(camera, [np.zeros((3, 4), np.uint16)], [np.zeros((3, 4, 3), np.uint8)] * 2)
    with pytest.raises(ValueError, match="too small"):
        fresco.track_rgbd(camera, [np.zeros((3, 4), np.uint16)])
