# SPDX-License-Identifier: BSD-3-Clause
"""Points and meshes of others: arrays of any type, and open3d.geometry."""
from __future__ import annotations

from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._fresco import PointSet, TriangleMesh

# As the readers of fresco do it: what float may lose of coordinates, as a share of their extent.
MOST_LOST = 1e-6


def _shareable(values: ArrayLike, dtype: Any) -> NDArray[Any]:
    """Of that type, contiguous and not read-only: the array itself, or a copy."""
    return np.require(values, dtype, ["C", "W"])


def _split(points: ArrayLike) -> tuple[NDArray[np.float32], NDArray[np.float64]]:
    """Coordinates as float32 and the origin that they are relative to: zero where float32 is enough."""
    given = np.asarray(points)
    if given.dtype == np.float32:
        return _shareable(given, np.float32), np.zeros(3)
    exact = np.asarray(given, np.float64)
    finite = exact[np.isfinite(exact).all(axis=1)] if exact.ndim == 2 else exact
    origin = np.zeros(3)
    if len(finite) > 0:
        low, high = finite.min(axis=0), finite.max(axis=0)
        farthest = max(abs(low).max(), abs(high).max())
        if farthest * np.finfo(np.float32).eps / 2 > MOST_LOST * (high - low).max():
            origin = np.round((low + high) / 2)
    return np.ascontiguousarray(exact - origin, np.float32), origin


def _bytes(colors: ArrayLike) -> NDArray[np.uint8]:
    """Colours 0..255 from such, or from 0..1."""
    given = np.asarray(colors)
    if given.dtype == np.uint8:
        return _shareable(given, np.uint8)
    if given.dtype.kind == "f":
        return np.clip(np.round(given * 255), 0, 255).astype(np.uint8)
    return np.ascontiguousarray(given.astype(np.uint8))


def from_arrays(points: ArrayLike, faces: ArrayLike | None = None, *, normals: ArrayLike | None = None,
                colors: ArrayLike | None = None, **others: Any) -> Union[PointSet, TriangleMesh]:
    """A PointSet, or with `faces` a TriangleMesh, of arrays of any type and order; anything with __array_interface__ will do.

    Arrays that fit are kept as they are: float32 (float64 makes a copy), contiguous. Where float32 would lose more than 1e-6
    of the extent of the points, `origin` is chosen so that it does not. Colours are 0..255, or 0..1 as float.
    `others` are further attributes of the result."""
    vertices, origin = _split(points)
    shared: dict[str, Any] = {"origin": origin, **others}
    if normals is not None:
        shared["normals"] = _shareable(normals, np.float32)
    if colors is not None:
        shared["colors"] = _bytes(colors)
    if faces is None:
        return PointSet(vertices, **shared)
    return TriangleMesh(vertices, _shareable(faces, np.int32), **shared)


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
    import open3d  # only here: it takes seconds

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
