// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "simulation/sensors/picture.h"
#include <cstdint>
#include <memory>
#include <string>
namespace fresco::simulation {
using PicturePtr = std::shared_ptr<const Picture>;

/// Pictures that hang, lie or shine in the rooms. All are drawn by rules from a seed; sizes are pixels.
struct PictureSize {
  int width = 800, height = 600;
};

PicturePtr drawWhiteboard(const PictureSize& size, std::uint64_t seed);
PicturePtr drawFlipChart(const PictureSize& size, std::uint64_t seed);
PicturePtr drawLandscape(const PictureSize& size, std::uint64_t seed); ///< hills, water, sky
PicturePtr drawAbstract(const PictureSize& size, std::uint64_t seed);  ///< overlapping shapes with gradients
PicturePtr drawPoster(const PictureSize& size, std::uint64_t seed);    ///< title, diagram, text
PicturePtr drawMap(const PictureSize& size, std::uint64_t seed);       ///< land, streets, labels
PicturePtr drawSheet(const PictureSize& size, std::uint64_t seed);     ///< printed page
PicturePtr drawScreen(const PictureSize& size, std::uint64_t seed);    ///< windows on a computer screen
PicturePtr drawKeyboard(const PictureSize& size, std::uint64_t seed);
PicturePtr drawClock(const PictureSize& size, std::uint64_t seed);
PicturePtr drawCalendar(const PictureSize& size, std::uint64_t seed);
PicturePtr drawSpine(const PictureSize& size, std::uint64_t seed); ///< back of a book
PicturePtr drawView(const PictureSize& size, std::uint64_t seed);  ///< what is outside of a window
PicturePtr drawRug(const PictureSize& size, std::uint64_t seed);   ///< woven pattern
PicturePtr drawLabel(const PictureSize& size, std::uint64_t seed); ///< on a parcel
PicturePtr drawDoor(const PictureSize& size, std::uint64_t seed);  ///< wooden leaf with panels
} // namespace fresco::simulation
