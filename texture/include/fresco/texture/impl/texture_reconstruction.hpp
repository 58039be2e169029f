// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/pcl_conversions.h>
#include <fresco/core/require.h>
#include <fresco/io/image_io.h>
#include <fresco/io/texture_mesh_conversions.h>
#include <fresco/texture/texture_reconstruction.h>
namespace fresco {
inline void TextureReconstruction::process(pcl::TextureMesh& output)
{
  require(input_mesh_ || input_layout_, "TextureReconstruction: no input mesh");
  if (input_layout_) {
    const std::vector<Image> sizeless(input_layout_->tex_polygons.size(), Image(1, 1, 3, 0));
    result_ = reconstructTexture(toTexturedMesh(*input_layout_, "", sizeless), views_, options_, progress_);
  } else {
    result_ = reconstructTexture(toTriangleMesh(*input_mesh_), views_, options_, progress_);
  }
  const pcl::PCLHeader header = input_layout_ ? input_layout_->header : input_mesh_->header;
  toTextureMesh(result_.model, output);
  output.header = header;
}

inline void TextureReconstruction::saveAtlases(const std::string& folder) const
{
  for (std::size_t i = 0; i < result_.model.atlases.size(); ++i)
    writeImage(concat(folder, "/texture_", i, ".png"), result_.model.atlases[i]);
}
} // namespace fresco
