// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "input/layout.h"
#include <map>
#include <string>
namespace fresco::model {
/// Number that a name begins with ("0000001-000033.png", "depth/17.png") or ends with; -1 = none.
Index numberOfName(const std::string& name);

/// Frames of the files of two folders: depth images and the colour images of the same name, or else of the same number. What
/// has no partner is left out, with a warning in `input`.
/// @param color, depth patterns of Survey::match()
/// @throws std::runtime_error if fewer than half have a partner
std::vector<RgbdFrame> pairedFrames(const Survey& found, const std::string& color, const std::string& depth,
                                    ModelInput& input);

/// The input that is these frames: puts them together and tells of them.
ModelInput rgbdInput(RgbdParts parts, ModelInput input);

/// Depth cameras of structured light whose layouts say nothing of the camera: fx = fy = 525 at 640x480, as the makers of the
/// layouts recommend. @throws std::runtime_error naming `wanted` if the images have another size
CameraModel usualCamera(const std::string& depth, const std::string& wanted);
} // namespace fresco::model
