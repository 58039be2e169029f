// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/picture_parts.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/require.h>
namespace fresco::rendering {
void validatePictureOptions(const PictureOptions& options)
{
  require(options.width >= 1 && options.height >= 1, "picture: size ", options.width, "x", options.height,
          " is not positive");
  require(options.crease_angle >= 0 && options.crease_angle <= 180, "picture: crease angle ", options.crease_angle,
          " is not in 0..180 degrees");
  require(options.point_size >= 0 && options.point_size <= 1000, "picture: point size ", options.point_size,
          " is not in 0..1000 pixels");
  require(options.error_limit >= 0 && std::isfinite(options.error_limit), "picture: error limit ", options.error_limit,
          " is negative or not finite");
  require(options.oversampling >= 1 && options.oversampling <= 4, "picture: oversampling ", options.oversampling,
          " is not in 1..4");
  if (options.view)
    validateViewpoint(*options.view);
}

void setPictureBackground(Canvas& canvas, const PictureOptions& options)
{
  if (options.transparent)
    canvas.setTransparentBackground();
  else
    canvas.setBackground(options.background);
}

Image finishPicture(const Image& rgba, const PictureOptions& options)
{
  if (options.transparent)
    return rgba;
  Image rgb(rgba.width, rgba.height, 3);
  for (int y = 0; y < rgb.height; ++y)
    for (int x = 0; x < rgb.width; ++x)
      std::copy_n(rgba.pixel(x, y), 3, rgb.pixel(x, y));
  return rgb;
}
} // namespace fresco::rendering
