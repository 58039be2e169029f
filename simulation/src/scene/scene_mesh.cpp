// SPDX-License-Identifier: BSD-3-Clause
#include <fresco/core/require.h>
#include <fresco/simulation/scene/scene.h>
namespace fresco::simulation {
using Eigen::Vector3f;

namespace {
constexpr float pattern_size = 5.f; // metres that the bounding box's diagonal has for the pattern

void addFaces(Scene& scene, const TriangleMesh& mesh)
{
  std::vector<Index> kept;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const Eigen::Vector3i v = mesh.faces.col(f);
    const Vector3f normal = faceNormal(mesh, f);
    if (!(normal.squaredNorm() > 0.5f)) // no area, no unit normal
      continue;
    const bool smooth = mesh.normals.cols() > 0;
    const auto at = [&](int k) -> Vector3f { return smooth ? Vector3f(mesh.normals.col(v[k])) : normal; };
    scene.face_cell.push_back(2 * scene.cells.size());
    scene.cells.push_back({{v[0], v[1], v[2], v[2]}, {at(0), at(1), at(2), at(2)}, 0});
    kept.push_back(f);
  }
  scene.mesh.faces = mesh.faces(Eigen::all, kept);
}
} // namespace

Scene meshScene(const TriangleMesh& mesh)
{
  if (!mesh.vertices.allFinite())
    throw std::runtime_error("the mesh has a coordinate that is not finite");
  Scene scene;
  scene.name = "mesh";
  scene.furnished = false;
  scene.mesh.vertices = mesh.vertices;
  scene.mesh.colors = mesh.colors;
  scene.mesh.origin = mesh.origin;
  addFaces(scene, mesh);
  if (scene.cells.empty())
    throw std::runtime_error("the mesh has no face with an area");
  Material material;
  material.finish = Finish::leaf;
  material.color = {0.42f, 0.36f, 0.3f}, material.accent = {0.85f, 0.8f, 0.7f};
  material.emission = mesh.colors.cols() > 0 ? 1.f : 0.f; // colours of vertices hold their light already
  scene.materials.push_back(material);
  const float diagonal = (mesh.vertices.rowwise().maxCoeff() - mesh.vertices.rowwise().minCoeff()).norm();
  Part part;
  part.scale = pattern_size / diagonal;
  scene.parts.push_back(part);
  scene.objects.push_back({"mesh", 0, scene.mesh.faceCount()});
  return scene;
}
} // namespace fresco::simulation
