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
  require(input_mesh_ != nullptr, "TextureReconstruction: no input mesh");
  result_ = reconstructTexture(toTriangleMesh(*input_mesh_), views_, options_, progress_);
  toTextureMesh(result_.model, output);
  output.header = input_mesh_->header;
}

inline void TextureReconstruction::saveAtlases(const std::string& folder) const
{
  for (std::size_t i = 0; i < result_.model.atlases.size(); ++i)
    writeImage(concat(folder, "/texture_", i, ".png"), result_.model.atlases[i]);
}
} // namespace fresco
