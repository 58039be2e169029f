// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/camera.h>
#include <fresco/core/export.h>
#include <string>
namespace fresco {
/// COLMAP model in `folder`: cameras.txt and images.txt, else cameras.bin and images.bin; rigs and frames, since COLMAP 3.12
/// beside them, say nothing that the images do not. Views in the order of their image id.
/// @throws std::runtime_error "PATH: reason" if missing, malformed, of another camera model or not finite
FRESCO_EXPORT CameraSet readColmap(const std::string& folder);

/// The points of the same model, of points3D.txt or points3D.bin; none if there is no such file. Tracks name views of
/// readColmap(); pixels are those of images.txt or images.bin.
/// @throws std::runtime_error "PATH: reason" if malformed, truncated, not finite or naming an image that is not there
FRESCO_EXPORT SparsePoints readColmapPoints(const std::string& folder);

/// Text model (cameras.txt, images.txt, points3D.txt) into `folder`, which is created. Observations without a pixel are
/// left out.
/// @throws std::invalid_argument as requireColmapCameras()
FRESCO_EXPORT void writeColmap(const std::string& folder, const CameraSet& set, const SparsePoints& points = {});

/// @throws std::invalid_argument for a camera that COLMAP has no model for: a spherical one, with skew, or with r^8 in perspective
FRESCO_EXPORT void requireColmapCameras(const CameraSet& set);
} // namespace fresco
