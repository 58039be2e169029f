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

/// Text model (cameras.txt, images.txt, points3D.txt) into `folder`, which is created.
/// @throws std::invalid_argument for a spherical camera, which COLMAP does not have
FRESCO_EXPORT void writeColmap(const std::string& folder, const CameraSet& set);
} // namespace fresco
