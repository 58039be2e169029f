// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/image.h>
namespace fresco::texture {
/// Pixels that are no picture: what undistortion, cropping or masking has filled along the image's border with one value,
/// and what resampling or JPEG has mixed with it. A sensor's noise varies from pixel to pixel, and what is clipped passes
/// into its surroundings by degrees: neither is blank. Scanners leave ends of panoramas black. Transparent pixels (alpha below one half) are.
/// @param photo RGB or RGBA @return one channel, 0 where blank, else 255; empty: nowhere
Image blankPixels(const Image& photo);
} // namespace fresco::texture
