// SPDX-License-Identifier: BSD-3-Clause
#include "kept_faces.h"
namespace fresco::deliverables {
namespace {
void dropUnusedTexcoords(TexturedMesh& model)
{
  std::vector<int> number(model.texcoords.cols(), -1);
  for (const int texcoord : model.texcoord_faces.reshaped())
    if (texcoord >= 0)
      number[texcoord] = 0;
  Index kept = 0;
  for (std::size_t i = 0; i < number.size(); ++i)
    if (number[i] == 0) {
      model.texcoords.col(kept) = model.texcoords.col(i).eval();
      number[i] = kept++;
    }
  model.texcoords.conservativeResize(2, kept);
  for (int& texcoord : model.texcoord_faces.reshaped())
    texcoord = texcoord < 0 ? -1 : number[texcoord];
}
} // namespace

void keepFaces(const std::vector<bool>& keep, TexturedMesh& model)
{
  const bool textured = model.texcoord_faces.cols() > 0;
  Index kept = 0;
  for (Index f = 0; f < model.mesh.faceCount(); ++f) {
    if (!keep[f])
      continue;
    model.mesh.faces.col(kept) = model.mesh.faces.col(f).eval();
    if (textured) {
      model.texcoord_faces.col(kept) = model.texcoord_faces.col(f).eval();
      model.face_atlas[kept] = model.face_atlas[f];
    }
    ++kept;
  }
  model.mesh.faces.conservativeResize(3, kept);
  model.mesh = removeUnreferencedVertices(model.mesh);
  if (!textured)
    return;
  model.texcoord_faces.conservativeResize(3, kept);
  model.face_atlas.conservativeResize(kept);
  dropUnusedTexcoords(model);
}
} // namespace fresco::deliverables
