// SPDX-License-Identifier: BSD-3-Clause
#include "optimization/normal_filtering/face_normals.h"
#include <fresco/core/parallel.h>
namespace fresco::optimization {
namespace {
using Eigen::Vector3f;

// Tukey's biweight (1 - t^2 / s^2)^2, 0 from s on, of a squared difference.
float biweight(float squared, float squared_cutoff)
{
  const float rest = 1.f - squared / squared_cutoff;
  return rest > 0.f ? rest * rest : 0.f;
}

// Normal of a face; of a small one also that of the faces around its corners.
Eigen::Vector3d startNormal(const MeshGraph& graph, const Eigen::Matrix3Xd& areas, Index f)
{
  const double length = areas.col(f).norm();
  Eigen::Vector3d sum = areas.col(f), around = sum;
  if (length < small_area) {
    for (int k = 0; k < 3; ++k)
      for (const int g : facesAround(graph, graph.faces(k, f)))
        around += areas.col(g);
    sum += (small_area - length) * around.normalized();
  }
  return sum.normalized();
}

// Of f and the faces around its corners.
float bestAgreement(const MeshGraph& graph, const Eigen::VectorXf& agreement, Index f)
{
  float best = agreement[f];
  for (int k = 0; k < 3; ++k)
    for (const int g : facesAround(graph, graph.faces(k, f)))
      best = std::max(best, agreement[g]);
  return best;
}
} // namespace

Eigen::Matrix3Xf filterNormals(const MeshGraph& graph, const Eigen::Matrix3Xd& areas, const Eigen::Matrix3Xf& given,
                               const NormalFilterOptions& options)
{
  const Index faces = graph.faceCount();
  Eigen::Matrix3Xf normals(3, faces), next(3, faces);
  Eigen::VectorXf area(faces);
  const Eigen::VectorXf given_areas = given.colwise().norm().transpose();
  parallelFor(faces, options.threads, [&](Index f) {
    const double length = areas.col(f).norm();
    area[f] = length;
    normals.col(f) = length > 1e-12 ? startNormal(graph, areas, f).cast<float>().eval() : Vector3f::Zero().eval();
  });
  // With s^2 = 5 sigma^2 the influence t (1 - t^2 / s^2)^2 of a difference t is greatest at t = sigma, and falls beyond
  // (Black, Sapiro, Marimont, Heeger 1998, "Robust anisotropic diffusion", sec. IV).
  const float cutoff = 5.0 * options.sigma * options.sigma;
  // A face that agrees with less of the area around it is an outlier. Of 0.45, 0.55 and 0.65 the best on fandisk.
  constexpr double outlier_share = 0.6, agreeing_share = 0.7, close = 0.05;
  Eigen::VectorXf agreement(faces);
  for (int round = 0; round < options.rounds; ++round) {
    parallelFor(faces, options.threads, [&](Index f) {
      const Vector3f own = normals.col(f);
      Vector3f sum = area[f] * own;
      float all = 0.f, agree = 0.f;
      if (graph.face_edges(0, f) >= 0)
        for (int k = 0; k < 3; ++k)
          for (const int g : facesAround(graph, graph.faces(k, f))) {
            const float weight = area[g] * biweight((normals.col(g) - own).squaredNorm(), cutoff);
            sum += weight * normals.col(g);
            all += area[g];
            agree += weight;
            const float given_area = given_areas[g];
            if (given_area > 0.f)
              sum += biweight((given.col(g) / given_area - own).squaredNorm(), cutoff) * given.col(g);
          }
      agreement[f] = all > 0.f ? agree / all : 0.f;
      const float length = sum.norm();
      next.col(f) = length > 1e-12f ? (sum / length).eval() : own;
    });
    normals = next;
    // An outlier takes the normal of the neighbours that agree most with their own: the mean of those within `close`.
    parallelFor(faces, options.threads, [&](Index f) {
      const double outlier = ramp(agreement[f], agreeing_share, outlier_share);
      if (graph.face_edges(0, f) < 0 || outlier == 0.0)
        return;
      const double best = bestAgreement(graph, agreement, f),
                   by = outlier * ramp(best, agreement[f], agreement[f] + close);
      Vector3f sum = Vector3f::Zero();
      for (int k = 0; k < 3; ++k)
        for (const int g : facesAround(graph, graph.faces(k, f)))
          sum += static_cast<float>(ramp(agreement[g], best - close, best)) * normals.col(g);
      const Vector3f mixed = static_cast<float>(1.0 - by) * normals.col(f) + static_cast<float>(by) * sum.normalized();
      next.col(f) = mixed.normalized();
    });
    normals.swap(next);
  }
  return normals;
}
} // namespace fresco::optimization
