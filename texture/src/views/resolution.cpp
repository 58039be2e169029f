// SPDX-License-Identifier: BSD-3-Clause
#include "views/resolution.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/statistics.h>
namespace fresco::texture {
Eigen::VectorXf patchResolutions(const PatchMesh& patches, const std::vector<Projector>& views,
                                 const Eigen::VectorXi& view)
{
  Eigen::VectorXf out = Eigen::VectorXf::Zero(patches.size());
  for (Index i = 0; i < patches.size(); ++i) {
    if (view[i] < 0)
      continue;
    Eigen::Vector3f middle = Eigen::Vector3f::Zero();
    for (int k = 0; k < 3; ++k)
      middle += patches.vertices.col(patches.faces(k, i)) / 3;
    const Projector& camera = views[view[i]];
    const Eigen::Vector3f ray = camera.center() - middle;
    const float cosine = std::abs(patches.normals.col(i).dot(ray.normalized()));
    out[i] = camera.focal() / ray.norm() * std::sqrt(cosine); // geometric mean of 1 and the cosine
  }
  return out;
}

double pixelSize(const Eigen::VectorXf& resolution)
{
  std::vector<float> sizes;
  for (const float r : resolution)
    if (r > 0)
      sizes.push_back(1 / r);
  return sizes.empty() ? 0 : median(sizes);
}

Eigen::VectorXf wantedDensities(const PatchMesh& patches, Index faces, const Eigen::VectorXf& resolution, double texel)
{
  if (texel > 0)
    return Eigen::VectorXf::Constant(faces, 1 / texel);
  Eigen::VectorXf sum = Eigen::VectorXf::Zero(faces), area = sum;
  for (Index i = 0; i < patches.size(); ++i)
    if (resolution[i] > 0) {
      sum[patches.parent[i]] += patches.areas[i] * resolution[i];
      area[patches.parent[i]] += patches.areas[i];
    }
  std::vector<float> seen;
  for (Index f = 0; f < faces; ++f)
    if (area[f] > 0)
      seen.push_back(sum[f] / area[f]);
  constexpr float oversampling = 1.4f;      // texels per pixel: interpolating a second time would blur otherwise
  constexpr float unseen_share = 0.25f;     // of the typical density: there is no detail
  constexpr double side_without_views = 64; // texels along the root of the area: any number does
  const float typical =
      seen.empty() ? side_without_views / std::sqrt(patches.areas.cast<double>().sum()) : median(seen);
  Eigen::VectorXf out(faces);
  for (Index f = 0; f < faces; ++f)
    out[f] = oversampling * std::max(unseen_share * typical, area[f] > 0 ? sum[f] / area[f] : 0.f);
  return out;
}
} // namespace fresco::texture
