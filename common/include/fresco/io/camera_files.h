// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/camera.h>
#include <fresco/core/export.h>
#include <string>
namespace fresco {
/// Photographs with their cameras as a program of photogrammetry hands them over.
struct CameraFile {
  CameraSet set;
  SparsePoints points; ///< that it found them with; none where the format has none
};

/// A COLMAP model (a folder), Metashape, Bundler, VisualSfM (NVM), NeRF's transforms.json or OpenMVG (a file), told by what is
/// in it: docs/inputs.md. Cameras without a pose are left out.
/// @param path    that folder or file, or a folder in which there is one such file
/// @param images  folder of the photographs: names are those of files below it, whatever folders the program saw them in,
///                and with another extension where only that is there; "" = not known, names are as told
/// @throws std::runtime_error "PATH: reason" if there is none, if it is malformed, tells too little or names a photograph that is
///         not there
FRESCO_EXPORT CameraFile readCameraFile(const std::string& path, const std::string& images);

/// What readCameraFile() would read: `path`, or the file in it; "" if nothing is recognised.
FRESCO_EXPORT std::string cameraFileIn(const std::string& path);

/// "COLMAP (folder), Metashape (.xml) ...", for messages.
FRESCO_EXPORT std::string cameraFormats();
} // namespace fresco
