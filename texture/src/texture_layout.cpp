// SPDX-License-Identifier: BSD-3-Clause
#include "charts/texture_atlas.h"
#include "photographs/input_checks.h"
#include <fresco/core/require.h>
#include <fresco/texture/core/texture_layout.h>
#include <limits>
namespace fresco {
using namespace texture;

TexturedMesh layOutTexture(TriangleMesh mesh, const TextureLayoutOptions& options)
{
  require(options.texel > 0, "texture: a texel of ", options.texel);
  const TextureOptions shared = layoutOptions(options);
  validate(mesh, {}, shared);
  TextureResult result;
  result.model.mesh = std::move(mesh);
  const Faces faces = result.model.mesh.faces;
  weld(result);
  const PatchMesh patches = cutFaces(result.model.mesh, std::numeric_limits<float>::infinity(), options.threads);
  makeAtlas(patches, Eigen::VectorXf::Zero(patches.size()), shared, result, faces.cols());
  result.model.mesh.faces = faces;
  return std::move(result.model);
}
} // namespace fresco
