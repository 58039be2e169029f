// SPDX-License-Identifier: BSD-3-Clause
#include "optimization/normal_filtering/face_normals.h"
#include <fresco/core/parallel.h>
namespace fresco::optimization {
namespace {
// A face that agrees with less than this share of the area around it is an artefact and takes the normal of the
// neighbour that agrees most with its own.
constexpr float lonely_share = 0.65f;

using Eigen::Vector3f;

// Tukey's biweight, 0 from `reach` on.
float biweight(float squared, float squared_reach)
{
  const float rest = 1.f - squared / squared_reach;
  return rest > 0.f ? rest * rest : 0.f;
}
} // namespace

Eigen::Matrix3Xf filterNormals(const MeshGraph& graph, const Eigen::Matrix3Xd& areas, const Eigen::Matrix3Xf& given,
                               const NormalFilterOptions& options)
{
  const Index faces = graph.faceCount();
  Eigen::Matrix3Xf normals(3, faces), next(3, faces);
  Eigen::VectorXf area(faces);
  const Eigen::VectorXf weight_given = given.colwise().norm().transpose();
  parallelFor(faces, options.threads, [&](Index f) {
    const double length = areas.col(f).norm();
    area[f] = static_cast<float>(length);
    normals.col(f) = length > 1e-12 ? (areas.col(f) / length).cast<float>().eval() : Vector3f::Zero().eval();
  });
  const float reach = 5.0 * options.sigma * options.sigma;
  Eigen::VectorXf agreement(faces);
  for (int round = 0; round < options.rounds; ++round) {
    parallelFor(faces, options.threads, [&](Index f) {
      const Vector3f own = normals.col(f);
      Vector3f sum = area[f] * own;
      float all = 0.f, agree = 0.f;
      if (graph.face_edges(0, f) >= 0)
        for (int k = 0; k < 3; ++k)
          for (const int g : facesAround(graph, graph.faces(k, f))) {
            const float weight = area[g] * biweight((normals.col(g) - own).squaredNorm(), reach);
            sum += weight * normals.col(g);
            all += area[g];
            agree += weight;
            const float stands_for = weight_given[g];
            if (stands_for > 0.f)
              sum += biweight((given.col(g) / stands_for - own).squaredNorm(), reach) * given.col(g);
          }
      agreement[f] = all > 0.f ? agree / all : 0.f;
      const float length = sum.norm();
      next.col(f) = length > 1e-12f ? (sum / length).eval() : own;
    });
    normals = next;
    parallelFor(faces, options.threads, [&](Index f) {
      if (graph.face_edges(0, f) < 0 || agreement[f] >= lonely_share)
        return;
      float best = agreement[f];
      for (int k = 0; k < 3; ++k)
        for (const int g : facesAround(graph, graph.faces(k, f)))
          if (agreement[g] > best) {
            best = agreement[g];
            next.col(f) = normals.col(g);
          }
    });
    normals.swap(next);
  }
  return normals;
}
} // namespace fresco::optimization
