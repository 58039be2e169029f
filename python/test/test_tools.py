# SPDX-License-Identifier: BSD-3-Clause
"""Each stage gives the bytes that its tool gives."""
import json

import fresco
import numpy as np
import pytest


def same_files(a, b):
    assert a.read_bytes() == b.read_bytes()


@pytest.fixture(scope="module")
def mesh_file(room, oriented, tmp_path_factory):
    path = tmp_path_factory.mktemp("surface") / "mesh.ply"
    fresco.write_mesh(path, fresco.reconstruct(oriented, cell_size=0.05, trim_levels=2.0).mesh)
    return path


def test_filters(room, tool, tmp_path):
    scan = room / "scans/scan_00.pcd"
    points = fresco.read_points(scan)
    for words, result in ((["-veil", 20], fresco.remove_mixed_pixels(points)),
                          (["-outliers", 16, 2], fresco.remove_outliers(points)),
                          (["-voxel", 0.1, "-centroid"], fresco.thin(points, 0.1, centroids=True))):
        tool("filter", scan, tmp_path / "tool.pcd", *words)
        wanted = fresco.read_points(tmp_path / "tool.pcd")
        assert 0 < len(result.kept) < len(points.points)
        assert result.points.points.tobytes() == wanted.points.tobytes()
        assert result.points.colors.tobytes() == wanted.colors.tobytes()


def test_normals(room, tool, tmp_path):
    scan = room / "scans/scan_00.pcd"
    tool("normals", scan, tmp_path / "tool.pcd", "-bilateral", 2)
    points = fresco.read_points(scan)
    smooth = fresco.smooth_normals(points, fresco.estimate_normals(points).normals, rounds=2)
    assert smooth.normals.tobytes() == fresco.read_points(tmp_path / "tool.pcd").normals.tobytes()


def test_registration(room, tool, tmp_path):
    files = sorted((room / "scans").glob("*.pcd"))
    tool("register", *files, "-o", tmp_path / "tool")
    scans = [fresco.read_points(file) for file in files]
    result = fresco.register_scans(scans)
    fresco.write_poses(tmp_path / "poses.txt", result.poses)
    same_files(tmp_path / "poses.txt", tmp_path / "tool/poses.txt")
    fresco.write_points(tmp_path / "registered.pcd", fresco.merge_scans(scans, result.poses))
    same_files(tmp_path / "registered.pcd", tmp_path / "tool/registered.pcd")
    report = json.loads((tmp_path / "tool/registration.json").read_text())
    assert fresco.registration_warnings(result) == report["warnings"] and result.pairs[0].rms == report["pairs"][0]["rms"]
    again = fresco.read_poses(tmp_path / "poses.txt")
    assert all(np.array_equal(a, b) for a, b in zip(fresco.register_scans(scans, again, fixed=True).poses, again))


def test_reconstruction(room, oriented, mesh_file, tool, tmp_path):
    fresco.write_points(tmp_path / "oriented.pcd", oriented)
    tool("reconstruct", tmp_path / "oriented.pcd", tmp_path / "tool.ply", "-cell", 0.05, "-trim_levels", 2)
    same_files(mesh_file, tmp_path / "tool.ply")


def test_optimization(oriented, mesh_file, tool, tmp_path):
    mesh = fresco.read_mesh(mesh_file)
    fresco.write_points(tmp_path / "points.pcd", oriented)
    tool("optimize", mesh_file, tmp_path / "points.pcd", tmp_path / "tool.ply", "-iterations", 3)
    fresco.write_mesh(tmp_path / "python.ply", fresco.optimize(mesh, oriented, iterations=3).mesh)
    same_files(tmp_path / "python.ply", tmp_path / "tool.ply")


def test_texture(room, mesh_file, tool, tmp_path):
    views = fresco.read_views(room / "cameras", room / "images")
    result = fresco.reconstruct_texture(fresco.read_mesh(mesh_file), views, texel=0.1)
    for kind in ("obj", "glb"):
        (tmp_path / "tool").mkdir(exist_ok=True)
        tool("texture", mesh_file, room / "cameras", room / "images", tmp_path / f"tool/model.{kind}", "-texel", 0.1)
        fresco.write_textured_mesh(tmp_path / f"model.{kind}", result.model)
        same_files(tmp_path / f"model.{kind}", tmp_path / f"tool/model.{kind}")
    same_files(tmp_path / "model.png", tmp_path / "tool/model.png")
    fresco.write_image(tmp_path / "mask.png", result.masks[0])
    same_files(tmp_path / "mask.png", tmp_path / "tool/model_mask.png")
    for view in views:  # the same from arrays
        view.image = fresco.read_image(view.path)
    again = fresco.reconstruct_texture(fresco.read_mesh(mesh_file), views, texel=0.1).model.atlases[0]
    assert np.array_equal(again, result.model.atlases[0])


def test_deliverables(mesh_file, tool, tmp_path):
    mesh = fresco.read_mesh(mesh_file)
    tool("simplify", mesh_file, tmp_path / "tool.ply", "-faces", 500)
    fresco.write_mesh(tmp_path / "python.ply", fresco.simplify(mesh, faces=500))
    same_files(tmp_path / "python.ply", tmp_path / "tool.ply")
    tool("simplify", mesh_file, tmp_path / "tool.glb", "-faces", 500, "-texel", 0.1, "-from", mesh_file)
    full = fresco.TexturedMesh(mesh=mesh)
    light = fresco.make_light_model(full, faces=500, texel=0.1)
    assert len(light.normal_maps) == len(light.model.atlases) > 0
    fresco.write_gltf(tmp_path / "python.glb", light, compact=True, jpeg_quality=90, lit=mesh.colors.size == 0)
    same_files(tmp_path / "python.glb", tmp_path / "tool.glb")
    low, middle = mesh.vertices.min(axis=0), mesh.vertices.mean(axis=0)
    (x0, y0, z0), (x1, y1, z1) = (low - 1) + mesh.origin, middle + mesh.origin
    tool("crop", mesh_file, tmp_path / "tool_cut.ply", "-box", x0, y0, z0, x1, y1, z1)
    outline = np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
    cut = fresco.crop(mesh, [outline], low=z0, high=z1)
    fresco.write_mesh(tmp_path / "cut.ply", cut)
    same_files(tmp_path / "cut.ply", tmp_path / "tool_cut.ply")
    with pytest.raises(ValueError):
        fresco.crop(mesh, [outline[[0, 2, 1, 3]]])  # crosses itself


def test_plans(room, mesh_file, tool, tmp_path):
    tool("plan", mesh_file, tmp_path / "tool.svg", "-height", 1)
    plan = fresco.draw_plan(fresco.read_mesh(mesh_file), height=1)
    assert plan.height == 1 and plan.section and all(line.shape[1] == 2 for line in plan.section)
    assert plan._repr_svg_() == fresco.plan_svg(plan) == (tmp_path / "tool.svg").read_text()
    assert fresco.plan_json(plan) == (tmp_path / "tool.json").read_text()
    assert fresco.plan_csv(plan) == (tmp_path / "tool.csv").read_text()
    tool("plan", mesh_file, tmp_path / "tool.dxf", "-height", 1)
    assert fresco.plan_dxf(plan) == (tmp_path / "tool.dxf").read_text()
    drawn = fresco.plan_picture(plan, 0.05)
    tool("plan", mesh_file, tmp_path / "tool.png", "-height", 1, "-pixel", 0.05)
    assert np.array_equal(drawn.image, fresco.read_image(tmp_path / "tool.png"))
    width, height = drawn.pixel * (np.array(drawn.image.shape[1::-1]) - 1)
    x, y = drawn.first_pixel
    assert x <= plan.low[0] and x + width >= plan.high[0] and y >= plan.high[1] and y - height <= plan.low[1]
    cloud = fresco.read_points(room / "scans/scan_00.pcd")
    shown = fresco.orthophoto(cloud, fresco.draw_plan(cloud), 0.1)
    assert (shown.image < 255).any()
    with pytest.raises(ValueError):
        fresco.draw_plan(cloud, height=1e6)
    with pytest.raises(ValueError):
        fresco.plan_picture(plan, -1)


def test_texture_from_points(room, mesh_file, tool, tmp_path):
    scan = room / "scans/scan_00.pcd"
    tool("texture", mesh_file, "-points", scan, tmp_path / "tool.glb", "-texel", 0.1)
    result = fresco.reconstruct_point_texture(fresco.read_mesh(mesh_file), fresco.read_points(scan), texel=0.1)
    assert result.look == "colors"
    fresco.write_textured_mesh(tmp_path / "python.glb", result.model)
    same_files(tmp_path / "python.glb", tmp_path / "tool.glb")


def test_comparison(room, mesh_file, tool, tmp_path):
    tool("compare", mesh_file, room / "truth.ply", "-json", tmp_path / "tool.json", "-samples", 1000)
    wanted = json.loads((tmp_path / "tool.json").read_text())
    result = fresco.compare(fresco.read_mesh(mesh_file), fresco.read_mesh(room / "truth.ply"), samples=1000)
    for kind in ("vertices", "surface"):
        for found, told in ((getattr(result, kind).symmetric, wanted[kind]["symmetric"]),
                            (getattr(result, kind).to_reference, wanted[kind]["mesh_to_reference"])):
            assert (found.max, found.mean, found.rms, found.count) == tuple(told[n] for n in ("max", "mean", "rms", "count"))
    assert result.mesh_topology.boundary_edges == wanted["mesh"]["boundary_edges"]


@pytest.mark.parametrize("words, options", [
    ([], {}), (["-view", "inside", "-shading", "normals"], {"view": "inside", "shading": "normals"}),
    (["-view", "above"], {"view": "above"}),
    (["-eye", 1, 1, 9, "-look", 2, 2, 0, "-up", 0, 1, 0, "-angle", 40, "-shading", "wireframe"],
     {"eye": [1, 1, 9], "look": [2, 2, 0], "up": (0, 1, 0), "angle": 40, "shading": "wireframe"})])
def test_pictures(mesh_file, tool, tmp_path, words, options):
    tool("snapshot", mesh_file, tmp_path / "tool.png", "-size", "200x150", *words)
    picture = fresco.snapshot(fresco.read_mesh(mesh_file), width=200, height=150, **options)
    assert picture.shape == (150, 200, 3) and picture.dtype == np.uint8 and picture.std() > 10
    fresco.write_image(tmp_path / "python.png", picture)
    same_files(tmp_path / "python.png", tmp_path / "tool.png")


def test_pictures_of_errors_and_of_points(room, mesh_file, tool, tmp_path):
    tool("snapshot", mesh_file, tmp_path / "tool.png", "-size", "200x150", "-shading", "error", "-reference",
         room / "truth.ply")
    truth = fresco.read_mesh(room / "truth.ply")
    fresco.write_image(tmp_path / "python.png", fresco.snapshot(fresco.read_mesh(mesh_file), reference=truth, width=200,
                                                                height=150))
    same_files(tmp_path / "python.png", tmp_path / "tool.png")
    scan = room / "scans/scan_00.pcd"
    tool("snapshot", scan, tmp_path / "tool.png", "-size", "200x150", "-transparent")
    picture = fresco.snapshot(fresco.read_points(scan), width=200, height=150, transparent=True)
    assert picture.shape == (150, 200, 4)
    fresco.write_image(tmp_path / "python.png", picture)
    same_files(tmp_path / "python.png", tmp_path / "tool.png")


def test_the_whole_chain(room, tool, tmp_path):
    words = {"cell": 0.15, "width": 160, "height": 120, "texel": 0.1, "optimize": False}
    tool("model", room, tmp_path / "tool", "-cell", 0.15, "-size", "160x120", "-texel", 0.1, "-no_optimize")
    report = fresco.build_model(room, tmp_path / "python", **words)
    assert [stage.name for stage in report.stages][:2] == ["points", "surface"] and report.stages[0].figures
    for name in ("mesh.ply", "model.glb", "model.obj", "poses.txt", *report.pictures):
        same_files(tmp_path / "python" / name, tmp_path / "tool" / name)


def test_depth_images_give_points():
    camera = fresco.CameraModel(width=32, height=24, fx=30, fy=30, cx=16, cy=12)
    wall = [np.full((24, 32), 2, np.float32) for _ in range(3)]
    found = fresco.fuse_depth_images(camera, [np.eye(4)] * 3, wall, cell=0.05).points
    assert len(found.points) > 100 and np.allclose(found.points[:, 2], 2, atol=0.02)
    with pytest.raises(ValueError, match=r"depths\[1\]"):
        fresco.fuse_depth_images(camera, [np.eye(4)] * 3, [wall[0], wall[0][:5], wall[0]])
