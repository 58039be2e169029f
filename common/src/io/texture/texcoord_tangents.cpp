// SPDX-License-Identifier: BSD-3-Clause
#include <fresco/core/require.h>
#include <fresco/io/gltf.h>
namespace fresco {
Eigen::Matrix4Xf texcoordTangents(const TexturedMesh& model)
{
  const TriangleMesh& mesh = model.mesh;
  require(mesh.normals.cols() == mesh.vertexCount(), "tangents: the mesh has no normals");
  Eigen::Matrix4Xd sums = Eigen::Matrix4Xd::Zero(4, model.texcoords.cols());
  std::vector<int> vertex(model.texcoords.cols(), -1);
  for (Index f = 0; f < model.texcoord_faces.cols(); ++f) {
    if (model.face_atlas[f] < 0)
      continue;
    const auto at = [&](int k) { return model.texcoords.col(model.texcoord_faces(k, f)).cast<double>().eval(); };
    const Eigen::Vector2d u = at(1) - at(0), v = at(2) - at(0);
    const Eigen::Vector3d a = faceCorner(mesh, f, 1) - faceCorner(mesh, f, 0);
    const Eigen::Vector3d b = faceCorner(mesh, f, 2) - faceCorner(mesh, f, 0);
    const double turned = u.x() * v.y() - u.y() * v.x();
    const Eigen::Vector3d tangent = (a * v.y() - b * u.y()) * (turned < 0 ? -1 : 1);
    if (!(tangent.norm() > 0))
      continue;
    const double area = areaVector(mesh, f).norm();
    Eigen::Vector4d part;
    part << area * tangent.normalized(), turned < 0 ? -area : area;
    for (int k = 0; k < 3; ++k) {
      sums.col(model.texcoord_faces(k, f)) += part;
      vertex[model.texcoord_faces(k, f)] = mesh.faces(k, f);
    }
  }
  Eigen::Matrix4Xf tangents(4, sums.cols());
  for (Index i = 0; i < sums.cols(); ++i) {
    const Eigen::Vector3d normal =
        vertex[i] < 0 ? Eigen::Vector3d::UnitZ().eval() : mesh.normals.col(vertex[i]).cast<double>().eval();
    Eigen::Vector3d tangent = sums.col(i).head<3>();
    tangent -= normal.dot(tangent) * normal;
    if (!(tangent.norm() > 1e-6 * sums.col(i).head<3>().norm()))
      tangent = normal.unitOrthogonal();
    tangents.col(i) << tangent.normalized().cast<float>(), sums(3, i) < 0 ? -1.f : 1.f;
  }
  return tangents;
}
} // namespace fresco
