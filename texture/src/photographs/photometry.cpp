// SPDX-License-Identifier: BSD-3-Clause
#include "photographs/photometry.h"
#include <algorithm>
#include <cmath>
namespace fresco::texture {
PixelGain::PixelGain(const Photometry& photometry, int view, const CameraModel& camera)
    : camera_(camera), curve_(photometry.responseOf(view)), gain_(photometry.gains.col(view))
{
  const LensFalloff falloff = photometry.falloffOf(view);
  if (falloff.a.isZero(0))
    return;
  for (int i = 0; i <= 255; ++i) // the largest stored radius
    table_.push_back(std::exp(-falloff.logTransmission(static_cast<float>(i) / radius_steps)));
}

std::vector<int> lensNumbers(const std::vector<ViewPart>& views)
{
  constexpr double same_focal = 0.1; // share: programs that calibrate each photograph alone differ by a few per cent
  std::vector<const CameraModel*> lenses;
  std::vector<int> out;
  for (const ViewPart& view : views) {
    if (view.ofPanorama()) {
      out.push_back(-1);
      continue;
    }
    const CameraModel& c = view.camera;
    const auto same = [&](const CameraModel* l) {
      return l->width == c.width && l->height == c.height && l->projection == c.projection &&
             std::abs(l->fx - c.fx) <= same_focal * c.fx;
    };
    const auto at = std::find_if(lenses.begin(), lenses.end(), same);
    out.push_back(static_cast<int>(at - lenses.begin()));
    if (at == lenses.end())
      lenses.push_back(&c);
  }
  return out;
}
} // namespace fresco::texture
