# SPDX-License-Identifier: BSD-3-Clause
"""Whatever is wrong with an argument, the exception names it."""
import inspect
import re

import fresco
import numpy as np
import pytest

FLOATS = np.zeros((4, 3), np.float32)


@pytest.mark.parametrize("value, error, said", [
    (np.zeros((4, 3), complex), TypeError, "points: of type complex128, wanted float32"),
    (np.zeros((4, 3), bool), TypeError, "points: of type bool"),
    ("abc", TypeError, "points: "),
    (object(), TypeError, "points: "),
    (np.zeros((4, 2), np.float32), ValueError, r"points: of shape \(4, 2\), wanted \(N, 3\)"),
    (np.zeros(12, np.float32), ValueError, r"points: of shape \(12,\)"),
])
def test_arrays_that_do_not_fit_are_named(value, error, said):
    with pytest.raises(error, match=said):
        fresco.PointSet(value)
    points = fresco.PointSet(FLOATS)
    with pytest.raises(error, match=said):
        points.points = value
    assert points.points is FLOATS


@pytest.mark.parametrize("attribute, value", [
    ("normals", np.zeros((4, 2))), ("colors", FLOATS + 2), ("intensities", ["a"] * 4), ("confidences", FLOATS),
    ("viewpoints", np.zeros(3, np.float32)), ("origin", np.zeros(2)), ("origin", "here")])
def test_attributes_of_points_are_named(attribute, value):
    with pytest.raises((TypeError, ValueError), match=f"^{attribute}: "):
        fresco.PointSet(FLOATS, **{attribute: value})


@pytest.mark.parametrize("attribute, value", [
    ("faces", np.zeros((4, 3))), ("normals", np.zeros(4)), ("fields", [1]), ("fields", {"height": np.zeros((4, 2))})])
def test_attributes_of_meshes_are_named(attribute, value):
    with pytest.raises((TypeError, ValueError), match=f"^{attribute}"):
        fresco.TriangleMesh(FLOATS, **{attribute: value})


STAGES = [name for name in fresco.__all__
          if inspect.isbuiltin(getattr(fresco, name)) and "points" in inspect.signature(getattr(fresco, name)).parameters]


@pytest.mark.parametrize("name", STAGES)
def test_empty_sets_and_other_things_are_named_by_every_stage(name, tmp_path):
    function = getattr(fresco, name)
    given = {"mesh": fresco.TriangleMesh(FLOATS, np.array([[0, 1, 2]], np.int32)), "path": tmp_path / "out.pcd", "cell": 1.0,
             "indices": np.arange(1), "T_target_source": np.eye(4)}
    required = {p.name: given.get(p.name) for p in inspect.signature(function).parameters.values()
                if p.default is inspect.Parameter.empty}
    with pytest.raises(ValueError, match="^points: no points"):
        function(**{**required, "points": fresco.PointSet()})
    with pytest.raises(TypeError, match="^points: ndarray, wanted PointSet"):
        function(**{**required, "points": FLOATS})


def test_empty_models_are_named(tmp_path):
    for call in (lambda: fresco.write_mesh(tmp_path / "a.ply", fresco.TriangleMesh()),
                 lambda: fresco.write_textured_mesh(tmp_path / "a.obj", fresco.TexturedMesh()),
                 lambda: fresco.snapshot(fresco.PointSet()), lambda: fresco.write_image(tmp_path / "a.png", None)):
        with pytest.raises(ValueError, match="^(mesh|model|image): no "):
            call()
    assert not list(tmp_path.iterdir())


def test_attributes_of_unequal_length_are_refused():
    points = fresco.PointSet(FLOATS, normals=FLOATS[:2])
    with pytest.raises(ValueError, match="4 points, 2 normals"):
        fresco.reconstruct(points)


def test_faces_out_of_range_are_refused():
    mesh = fresco.TriangleMesh(FLOATS, np.array([[0, 1, 9]], np.int32))
    for call in (fresco.mesh_topology, lambda m: fresco.compare(m, m), fresco.snapshot, fresco.vertex_normals):
        with pytest.raises(ValueError, match="vertex 9 of 4"):
            call(mesh)


@pytest.mark.parametrize("option, value, error", [
    ("depth", 8.5, TypeError), ("depth", "8", TypeError), ("depth", True, TypeError), ("depth", 10**30, ValueError),
    ("depth", 99, ValueError), ("scale", "1", TypeError), ("scale", float("nan"), ValueError), ("confidence", 1, TypeError),
    ("threads", -1, ValueError), ("progress", 5, TypeError)])
def test_options_are_named(sphere, option, value, error):
    with pytest.raises(error, match=option):
        fresco.reconstruct(sphere, **{option: value})


def test_numbers_of_numpy_are_numbers(sphere):
    assert fresco.reconstruct(sphere, depth=np.int64(4), scale=np.float32(1.2), confidence=np.bool_(False)).depth == 4


def test_unknown_keywords_get_the_nearest_name(sphere):
    with pytest.raises(TypeError, match="reconstruct.* no argument 'dept'; did you mean 'depth'"):
        fresco.reconstruct(sphere, dept=5)
    with pytest.raises(TypeError, match="did you mean 'normals'"):
        fresco.PointSet(FLOATS, normal=FLOATS)
    with pytest.raises(AttributeError, match="has no 'color'"):
        sphere.color = FLOATS


@pytest.mark.parametrize("call, said", [
    (lambda s: fresco.reconstruct(), "wants 'points'"), (lambda s: fresco.reconstruct(s, s), "takes 1"),
    (lambda s: fresco.reconstruct(s, points=s), "'points' twice"), (lambda s: fresco.register_scans(s), "scans: "),
    (lambda s: fresco.snapshot(s, "here", width=160, height=120), "here")])
def test_calls_that_do_not_fit_are_refused(sphere, call, said):
    with pytest.raises((TypeError, ValueError), match=said):
        call(sphere)


def test_defaults_are_those_of_the_core(sphere):
    signature = inspect.signature(fresco.reconstruct)
    assert signature.parameters["depth"].default == fresco.reconstruct(sphere).depth
    named = {n: p.default for n, p in signature.parameters.items() if p.default is not p.empty}
    assert np.array_equal(fresco.reconstruct(sphere, **named).mesh.vertices, fresco.reconstruct(sphere).mesh.vertices)


def test_files_that_fail_are_oserrors_that_name_them(tmp_path, sphere):
    for read in (fresco.read_points, fresco.read_mesh, fresco.read_textured_mesh, fresco.read_image, fresco.read_poses,
                 fresco.read_cameras, fresco.describe_input):
        with pytest.raises(OSError, match="missing.ply") as caught:
            read(tmp_path / "missing.ply")
        assert isinstance(caught.value, fresco.Error)
    (tmp_path / "torn.ply").write_bytes(b"ply\nformat ascii 1.0\nelement vertex 5\n")
    with pytest.raises(OSError, match="torn.ply"):
        fresco.read_points(tmp_path / "torn.ply")
    with pytest.raises(OSError, match="nowhere"):
        fresco.write_points(tmp_path / "nowhere/out.pcd", sphere)
    with pytest.raises(OSError, match="fresco"):
        fresco.read_points(b"fresco\xff.ply")  # names of files are any bytes
    with pytest.raises(fresco.Error):
        fresco.build_model(tmp_path / "nothing", tmp_path / "out")


def test_help_tells_shapes_units_ranges_and_errors():
    text = fresco.reconstruct.__doc__
    for part in ("octree depth, 2..16", "unit of the points", "ValueError if there are no normals", "Cancelled"):
        assert part in re.sub(r"\s+", " ", text)
    assert "(N, 3)" in fresco.PointSet.__slots__["points"]
