// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <fresco/simulation/sensors/picture.h>
#include <memory>
#include <string>
namespace fresco::simulation {
using PicturePtr = std::shared_ptr<const Picture>;

struct PictureSize {
  int width = 800, height = 600; ///< pixels
};

/// A picture that hangs, lies or shines in the rooms, drawn by rules from a seed.
/// @param name whiteboard, flip_chart, landscape (hills, water, sky), abstract (overlapping shapes with gradients),
///             poster (title, diagram, text), map (land, streets, labels), sheet (printed page), screen (windows on a
///             computer screen), keyboard, clock, calendar, spine (back of a book), view (what is outside of a window),
///             rug (woven pattern), label (on a parcel) or door (wooden leaf with panels)
/// @throws std::out_of_range if there is none of that name
PicturePtr drawPicture(const std::string& name, const PictureSize& size, std::uint64_t seed);
} // namespace fresco::simulation
