// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/camera.h>
#include <fresco/core/export.h>
#include <string>
namespace fresco {
/// COLMAP model in `folder`: cameras.txt and images.txt, else cameras.bin and images.bin. All
/// camera models but FOV. Views in the order of their image id.
/// @throws std::runtime_error "PATH: reason" if missing, malformed, of another camera model or not finite
FRESCO_EXPORT CameraSet readColmap(const std::string& folder);

/// The points of the same model, of points3D.txt or points3D.bin; none if there is no such file. Tracks name views of
/// readColmap(); pixels are those of images.txt or images.bin.
/// @throws std::runtime_error "PATH: reason" if malformed, truncated, not finite or naming an image that is not there
FRESCO_EXPORT SparsePoints readColmapPoints(const std::string& folder);

/// Text model (cameras.txt, images.txt, points3D.txt) into `folder`, which is created. Observations without a pixel are
/// left out.
/// @throws std::invalid_argument for a spherical camera, which COLMAP does not have
FRESCO_EXPORT void writeColmap(const std::string& folder, const CameraSet& set, const SparsePoints& points = {});
} // namespace fresco
