// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/image.h>
namespace fresco::texture {
/// Width in pixels of the violet fringe that a lens leaves beside what is clipped (chromatic aberration): a photograph has
/// one where many pixels between what is clipped and what is dark are more violet than either; on one side only, for
/// lenses spread colours outwards. 0: none.
/// @param photo RGB
int fringeWidth(const Image& photo);

/// The photograph with the red and blue of its fringe, against green, as they are beyond it.
Image withoutFringe(const Image& photo, int width);
} // namespace fresco::texture
