// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <fresco/core/image.h>
#include <vector>
namespace fresco::deliverables {
/// Half as large, rounded up: each pixel is the mean of the painted ones among the four that it stands for.
/// @param painted 0 or 1 of each pixel; becomes that of the result
Image halved(const Image& image, std::vector<std::uint8_t>& painted);

/// Gives pixels that are not painted the colour of the painted ones around, by pull and push (Gortler et al. 1996, "The
/// Lumigraph"), so that coarser levels of a texture do not mix its charts with an empty ground.
void fillUnpainted(Image& image, std::vector<std::uint8_t> painted);
} // namespace fresco::deliverables
