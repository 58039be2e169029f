# SPDX-License-Identifier: BSD-3-Clause
"""Bases of PointSet, TriangleMesh and TexturedMesh: what users of numpy, Open3D and trimesh expect of such classes."""
from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, TypeVar, Union

import numpy as np

from ._base import Record

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ._fresco import PointSet, TriangleMesh

# As the readers of fresco do it: what float32 may lose of coordinates, as a share of their extent.
MOST_LOST = 1e-6
Self = TypeVar("Self", bound="Geometry")


def _module() -> Any:
    from . import _fresco  # which builds on this file
    return _fresco


def _limits(rows: NDArray[Any]) -> NDArray[np.float64]:
    """(2, 3): least and largest of the finite rows. NaN where there are none."""
    finite = rows[np.isfinite(rows).all(axis=1)]
    if len(finite) == 0:
        return np.full((2, 3), np.nan)
    return np.array([finite.min(axis=0), finite.max(axis=0)], np.float64)


def _loses(limits: NDArray[np.float64]) -> bool:
    """Whether coordinates within these limits are too far from zero for float32."""
    extent = float((limits[1] - limits[0]).max())
    return bool(np.abs(limits).max() * np.finfo(np.float32).eps / 2 > MOST_LOST * extent > 0)


def _exact(values: Any) -> Union[NDArray[np.float64], None]:
    """Coordinates that are no float32 yet, or None where there is nothing to decide."""
    try:
        array = np.asarray(values)
    except ValueError:  # rows of unequal length, which the attribute names
        return None
    if array.dtype == np.float32 or array.dtype.kind not in "fiu" or array.ndim != 2 or array.shape[1] != 3:
        return None
    return array.astype(np.float64)


class Geometry(Record):
    """Coordinates, whatever else their class calls them, with `origin`: the world is origin + coordinates."""

    __slots__ = ()
    _rows = "points"
    origin: NDArray[np.float64]
    normals: NDArray[np.float32]
    colors: NDArray[np.uint8]

    def __init__(self, *values: Any, **named: Any) -> None:
        given = dict(zip(self._checks, values))
        exact = _exact(given.get(self._rows, named.get(self._rows)))
        if exact is not None and "origin" not in {**given, **named} and _loses(limits := _limits(exact)):
            origin = np.round(limits.mean(axis=0))
            moved = {name: np.asarray(rows, np.float64) - origin for name, rows in {**given, **named}.items()
                     if name in (self._rows, "viewpoints") and rows is not None and len(np.asarray(rows))}
            values = tuple(moved.get(name, value) for name, value in zip(self._checks, values))
            named = {**named, **{name: rows for name, rows in moved.items() if name not in given}, "origin": origin}
        super().__init__(*values, **named)

    def __setattr__(self, name: str, value: Any) -> None:
        if name == self._rows and (exact := _exact(value)) is not None and _loses(_limits(exact)):
            raise ValueError(f"{name}: float32 cannot hold these coordinates: make a {type(self).__name__} of them, which "
                             "chooses an origin, or subtract one")
        super().__setattr__(name, value)

    def __array__(self, dtype: Any = None, copy: Any = None) -> NDArray[Any]:
        return self.world() if dtype is None else self.world().astype(dtype)

    __array_priority__ = 1000.0  # T @ points comes to __rmatmul__

    def world(self) -> NDArray[np.float64]:
        """(N, 3) float64: origin + coordinates."""
        return np.asarray(getattr(self, self._rows) + self.origin, np.float64)

    def copy(self: Self) -> Self:
        """One that shares no array with this one."""
        import copy
        return copy.deepcopy(self)

    @property
    def bounds(self) -> NDArray[np.float64]:
        """(2, 3): least and largest world coordinates of what is finite; NaN where nothing is."""
        return np.asarray(_limits(getattr(self, self._rows)) + self.origin)

    @property
    def extents(self) -> NDArray[np.float64]:
        """(3,): edges of the box of `bounds`."""
        low, high = self.bounds
        return np.asarray(high - low)

    @property
    def centroid(self) -> NDArray[np.float64]:
        """(3,): mean of the finite world coordinates."""
        rows = self.world()
        return np.asarray(rows[np.isfinite(rows).all(axis=1)].mean(axis=0))

    @property
    def has_normals(self) -> bool:
        return len(self.normals) > 0

    @property
    def has_colors(self) -> bool:
        return len(self.colors) > 0

    def __rmatmul__(self: Self, matrix: Any) -> Self:
        return self.transform(matrix)

    def transform(self: Self, T_target_source: Any) -> Self:
        """R p + t, as a new object; (4, 4), rigid."""
        raise NotImplementedError

    def show(self, **options: Any) -> Any:
        """A picture, by snapshot(**options): in a notebook it appears, elsewhere it opens in the viewer of pictures."""
        return Shown(_picture(self, **options)).open()

    def _repr_png_(self) -> Union[bytes, None]:
        return _picture(self) if len(getattr(self, self._rows)) else None


class PointSetBase(Geometry):
    """A set is a sequence of points: len(), masks, slices and indices, `+`, iteration over rows of coordinates."""

    __slots__ = ()
    points: NDArray[np.float32]

    def __len__(self) -> int:
        return len(self.points)

    @property
    def shape(self) -> tuple[int, ...]:
        return tuple(self.points.shape)

    def __iter__(self) -> Iterator[NDArray[np.float64]]:
        return iter(self.world())

    def __getitem__(self, which: Any) -> Any:
        """A set for a mask, a slice or indices; the world coordinates of one point for a number."""
        if isinstance(which, (int, np.integer)):
            return self.points[which] + self.origin
        rows = np.arange(len(self))[which]
        if rows.ndim != 1:
            raise IndexError(f"points are chosen by a mask of {len(self)} entries, a slice or indices")
        return _module().select_points(self, rows)

    def __add__(self, other: Any) -> PointSet:
        if not isinstance(other, PointSetBase):
            return NotImplemented
        merged: PointSet = _module().merge_points(self, other)
        return merged

    def __radd__(self, other: Any) -> PointSetBase:
        if not isinstance(other, int) or other != 0:  # sum() begins with 0
            return NotImplemented
        return self

    def transform(self, T_target_source: Any) -> Any:
        return _module().transform_points(self, T_target_source)


class TriangleMeshBase(Geometry):
    """A mesh as trimesh and Open3D have it: area, volume, is_watertight(), submesh(), `+`."""

    __slots__ = ()
    _rows = "vertices"
    vertices: NDArray[np.float32]
    faces: NDArray[np.int32]
    fields: dict[str, NDArray[np.float32]]

    @property
    def triangles(self) -> NDArray[np.float64]:
        """(F, 3, 3): world coordinates of the corners."""
        return self.world()[self.faces]

    def _area_vectors(self) -> NDArray[np.float64]:
        a, b, c = self.vertices.astype(np.float64)[self.faces].transpose(1, 0, 2)
        return np.asarray(np.cross(b - a, c - a))

    @property
    def face_normals(self) -> NDArray[np.float32]:
        """(F, 3) unit; zero where a face has no area."""
        vectors = self._area_vectors()
        lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
        return np.divide(vectors, lengths, out=np.zeros_like(vectors), where=lengths > 0).astype(np.float32)

    @property
    def area(self) -> float:
        return float(np.linalg.norm(self._area_vectors(), axis=1).sum() / 2)

    @property
    def volume(self) -> float:
        """Sum of signed tetrahedra: positive for a closed mesh whose faces are counter-clockwise from outside."""
        a, b, c = self.vertices.astype(np.float64)[self.faces].transpose(1, 0, 2)
        return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)

    def is_watertight(self) -> bool:
        """Closed, 2-manifold, consistently oriented, not empty."""
        return bool(_module().mesh_topology(self).watertight)

    def submesh(self, faces: Any) -> TriangleMesh:
        """Those faces, by a mask, a slice or indices, with the vertices that they name."""
        chosen = np.asarray(self.faces[faces])
        if chosen.ndim != 2:
            raise IndexError(f"faces are chosen by a mask of {len(self.faces)} entries, a slice or indices")
        used, corners = np.unique(chosen, return_inverse=True)
        return self._of(corners.reshape(-1, 3), lambda rows: rows[used] if len(rows) else rows)

    def _of(self, faces: Any, vertices: Any) -> TriangleMesh:
        made: TriangleMesh = _module().TriangleMesh(
            vertices(self.vertices), faces.astype(np.int32), normals=vertices(self.normals), colors=vertices(self.colors),
            fields={name: vertices(values) for name, values in self.fields.items()}, origin=self.origin)
        return made

    def __add__(self, other: Any) -> TriangleMesh:
        """Both, side by side, in the frame (origin) of this one. An attribute is kept where both have it."""
        if not isinstance(other, TriangleMeshBase):
            return NotImplemented
        moved = (other.vertices + (other.origin - self.origin)).astype(np.float32)
        pairs: dict[str, tuple[Any, Any]] = {
            "vertices": (self.vertices, moved),
            "faces": (self.faces, other.faces + np.int32(len(self.vertices))),
            "normals": (self.normals, other.normals), "colors": (self.colors, other.colors)}
        joined: dict[str, Any] = {name: np.concatenate(pair) for name, pair in pairs.items()
                                  if name in ("vertices", "faces") or all(len(rows) for rows in pair)}
        fields = {name: np.concatenate([values, other.fields[name]]) for name, values in self.fields.items()
                  if name in other.fields}
        made: TriangleMesh = _module().TriangleMesh(**joined, fields=fields, origin=self.origin)
        return made

    def __radd__(self, other: Any) -> TriangleMeshBase:
        if not isinstance(other, int) or other != 0:
            return NotImplemented
        return self

    def transform(self, T_target_source: Any) -> Any:
        points = _module().PointSet(self.vertices, normals=self.normals, origin=self.origin)
        moved = _module().transform_points(points, T_target_source)
        return _module().TriangleMesh(moved.points, self.faces, normals=moved.normals, colors=self.colors, fields=self.fields,
                                      origin=moved.origin)


class TexturedMeshBase(Record):
    __slots__ = ()
    mesh: TriangleMesh

    @property
    def bounds(self) -> NDArray[np.float64]:
        """(2, 3): as TriangleMesh.bounds"""
        return self.mesh.bounds

    def show(self, **options: Any) -> Any:
        """As TriangleMesh.show(), with its texture."""
        return Shown(_picture(self, **options)).open()

    def _repr_png_(self) -> Union[bytes, None]:
        return _picture(self) if len(self.mesh.vertices) else None


class FloorPlanBase(Record):
    __slots__ = ()

    def _repr_svg_(self) -> str:
        return str(_module().plan_svg(self))


class Shown:
    """A picture that a notebook draws."""

    def __init__(self, png: bytes) -> None:
        self.png = png

    def _repr_png_(self) -> bytes:
        return self.png

    def open(self) -> Shown:
        """Outside of a notebook: in the desktop's viewer, where there is a display."""
        try:
            in_notebook = get_ipython() is not None  # type: ignore[name-defined]
        except NameError:
            in_notebook = False
        if not in_notebook and (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
            import webbrowser
            with tempfile.NamedTemporaryFile(suffix=".png", prefix="fresco_", delete=False) as file:
                file.write(self.png)
            webbrowser.open(f"file://{file.name}")
        return self


def _picture(model: Any, **options: Any) -> bytes:
    """PNG of a snapshot, of a size that suits a page."""
    if isinstance(model, TexturedMeshBase):
        options.setdefault("shading", "texture")
    image = _module().snapshot(model, **{"width": 800, "height": 600, **options})
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "picture.png")
        _module().write_image(path, image)
        with open(path, "rb") as file:
            return file.read()
