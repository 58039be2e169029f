# SPDX-License-Identifier: BSD-3-Clause
"""Raw indoor scans to photo-realistic textured models, from numpy arrays.

Every stage is a function: read_points, remove_mixed_pixels, estimate_normals, smooth_normals, register_scans, reconstruct,
optimize, reconstruct_texture, compare, snapshot; build_model runs all of them. help(fresco.reconstruct) tells what one takes.
Points and meshes are PointSet and TriangleMesh, whose attributes are numpy arrays, a row per point."""
from . import _fresco
from ._base import Cancelled, Error, FileError, Record
from ._fresco import *
from ._fresco import __version__
from .convert import from_arrays, from_open3d, to_open3d

__all__ = [name for name in dir(_fresco) if not name.startswith("_")]
__all__ += ["Cancelled", "Error", "FileError", "Record", "__version__", "from_arrays", "from_open3d", "to_open3d"]
