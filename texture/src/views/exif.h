// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
namespace fresco::texture {
/// Orientation that a JPEG file carries in its EXIF block: 1 = as stored (also where there is none, or no JPEG), 2..8
/// turned or mirrored. CIPA DC-008-2012, "Exchangeable image file format", tag 274.
int exifOrientation(const std::string& path);
} // namespace fresco::texture
