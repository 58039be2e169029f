# SPDX-License-Identifier: BSD-3-Clause
"""Points and meshes of others: arrays of any type, and open3d.geometry."""
from __future__ import annotations

from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._fresco import PointSet, TriangleMesh


def from_arrays(points: ArrayLike, faces: ArrayLike | None = None, *, normals: ArrayLike | None = None,
                colors: ArrayLike | None = None, **others: Any) -> Union[PointSet, TriangleMesh]:
    """A PointSet, or with `faces` a TriangleMesh, of arrays of any type and order; anything with __array_interface__ will do.

    `others` are further attributes of the result."""
    shared: dict[str, Any] = {"normals": normals, "colors": colors, **others}
    if faces is None:
        return PointSet(points, **shared)
    return TriangleMesh(points, faces, **shared)


def from_open3d(geometry: Any) -> Union[PointSet, TriangleMesh]:
    """A PointSet of an open3d.geometry.PointCloud, a TriangleMesh of a TriangleMesh.

    Open3D keeps doubles, so that one pass over the arrays remains."""
    is_mesh = hasattr(geometry, "triangles")
    points = np.asarray(geometry.vertices if is_mesh else geometry.points)
    normals = np.asarray(geometry.vertex_normals if is_mesh else geometry.normals)
    colors = np.asarray(geometry.vertex_colors if is_mesh else geometry.colors)
    return from_arrays(points, np.asarray(geometry.triangles) if is_mesh else None,
                       normals=normals if len(normals) else None, colors=colors if len(colors) else None)


def to_open3d(model: Union[PointSet, TriangleMesh]) -> Any:
    """An open3d.geometry.PointCloud or TriangleMesh, in world coordinates."""
    import open3d  # type: ignore[import]  # only here: it takes seconds

    def vectors(array: NDArray[Any]) -> Any:
        return open3d.utility.Vector3dVector(array.astype(np.float64))

    if isinstance(model, PointSet):
        result = open3d.geometry.PointCloud(vectors(model.points + model.origin))
        result.normals, result.colors = vectors(model.normals), vectors(model.colors / 255)
        return result
    if not isinstance(model, TriangleMesh):
        raise TypeError(f"model: {type(model).__name__}, wanted PointSet or TriangleMesh")
    result = open3d.geometry.TriangleMesh(vectors(model.vertices + model.origin),
                                          open3d.utility.Vector3iVector(model.faces))
    result.vertex_normals, result.vertex_colors = vectors(model.normals), vectors(model.colors / 255)
    return result
