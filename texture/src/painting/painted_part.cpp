// SPDX-License-Identifier: BSD-3-Clause
#include "painting/painted_part.h"
namespace fresco::texture {
Points knownColors(const PaintScene& scene, const PaintedPart& part, const std::vector<Image>& atlases)
{
  Points colors = patchColors(scene, atlases);
  for (Index i = part.patches; part.fill_colors && i < colors.cols(); ++i)
    if (scene.view[i] < 0)
      colors.col(i) = part.fill_colors->col(i);
  return colors;
}

Points takeOwn(const PaintScene& scene, const PaintedPart& part, TextureResult& result)
{
  const Eigen::VectorXi all = Eigen::VectorXi::Zero(scene.view.size());
  Points colors = patchColors({scene.patches, scene.charts, all, scene.slots, scene.threads}, result.model.atlases);
  for (Index i = 0; i < part.patches; ++i)
    for (int k = 0; k < 4 && colors(0, i) < 0; ++k)
      if (k == 3) // no texels, and no neighbour with some
        colors.col(i).setConstant(mid_grey);
      else if (const int other = scene.patches.neighbors(k, i); other >= 0)
        colors.col(i) = colors.col(other).eval();
  const int own = result.model.face_atlas.maxCoeff() + 1;
  result.model.atlases.resize(own);
  result.masks.resize(own);
  return colors.leftCols(part.patches);
}
} // namespace fresco::texture
