# SPDX-License-Identifier: BSD-3-Clause
"""Arrays go in and out without a copy, and live as long as somebody looks at them."""
import copy
import gc
import pickle

import fresco
import numpy as np
import pytest


def address(array: np.ndarray) -> int:
    return array.__array_interface__["data"][0]


def test_a_million_points_go_in_and_out_without_a_copy():
    rows = np.random.default_rng(1).random((1_000_000, 3), np.float32)
    points = fresco.PointSet(rows, normals=rows, viewpoints=rows[:1])
    assert points.points is rows and points.normals is rows
    seen = fresco._fresco._addresses(points)
    assert seen["points"] == seen["normals"] == seen["viewpoints"] == address(rows)
    kept = fresco.select_points(points, np.arange(1_000_000))
    assert kept.points.base is not None and not kept.points.flags.owndata  # on the memory of C++
    assert fresco._fresco._addresses(kept)["points"] == address(kept.points)
    assert np.array_equal(kept.points, rows)


def test_what_is_written_into_an_array_is_what_the_core_sees(sphere):
    points = copy.deepcopy(sphere)
    before = fresco.reconstruct(points, depth=4).mesh.vertices
    points.points[:] *= 2
    assert np.abs(fresco.reconstruct(points, depth=4).mesh.vertices).max() > 1.8 * np.abs(before).max()


def test_arrays_outlive_their_set_and_a_new_array_leaves_the_old_one():
    rows = np.ones((100, 3), np.float32)
    points = fresco.select_points(fresco.PointSet(rows), np.arange(50))
    first = points.points
    points.points = np.zeros((7, 3), np.float32)
    assert first.shape == (50, 3) and (first == 1).all()
    second = points.points
    del points
    gc.collect()
    assert (first == 1).all() and (second == 0).all()


def test_results_outlive_what_they_came_from(sphere):
    vertices = fresco.reconstruct(sphere, depth=4).mesh.vertices
    copied = vertices.copy()
    gc.collect()
    [np.full((10000, 3), i, np.float32) for i in range(100)]  # would overwrite memory that was freed
    assert np.array_equal(vertices, copied)
    vertices[0] = 5  # it is the user's
    assert vertices[0, 0] == 5


@pytest.mark.parametrize("begin", range(1, 5))
def test_slices_that_begin_anywhere_in_memory_give_the_same(sphere, begin):
    rows = sphere.points[begin:]
    points = fresco.PointSet(rows, normals=sphere.normals[begin:])
    aligned = fresco.PointSet(rows.copy(), normals=points.normals.copy())
    assert points.points is rows
    assert np.array_equal(fresco.reconstruct(points, depth=4).mesh.vertices,
                          fresco.reconstruct(aligned, depth=4).mesh.vertices)


def test_files_in_memory_are_taken_and_read_only_arrays_copied(sphere, tmp_path):
    np.save(tmp_path / "points.npy", sphere.points)
    mapped = np.load(tmp_path / "points.npy", mmap_mode="c")  # pages are copied when they are written
    points = fresco.PointSet(mapped, normals=sphere.normals)
    assert points.points is mapped
    assert np.array_equal(fresco.reconstruct(points, depth=4).mesh.faces, fresco.reconstruct(sphere, depth=4).mesh.faces)
    fixed = np.load(tmp_path / "points.npy", mmap_mode="r")
    points.points = fixed
    assert np.array_equal(points.points, fixed) and points.points.flags.writeable


def test_whatever_shows_itself_as_an_array_is_taken_as_it_is():
    class Foreign:
        def __init__(self, rows):
            self.rows = rows
            self.__array_interface__ = rows.__array_interface__

    rows = np.ones((4, 3), np.float32)
    assert address(fresco.PointSet(Foreign(rows)).points) == address(rows)


def test_sets_are_copied_and_pickled(sphere):
    for twin in (copy.deepcopy(sphere), pickle.loads(pickle.dumps(sphere))):
        assert type(twin) is fresco.PointSet and twin.points is not sphere.points
        assert np.array_equal(twin.points, sphere.points) and np.array_equal(twin.normals, sphere.normals)


def test_calls_keep_nothing(sphere):
    import sys
    rows = sphere.points.copy()
    points = fresco.PointSet(rows, normals=sphere.normals)
    before = sys.getrefcount(rows)
    fresco.estimate_normals(points)
    with pytest.raises(ValueError):
        fresco.reconstruct(points, depth=99)
    assert sys.getrefcount(rows) == before
