// SPDX-License-Identifier: BSD-3-Clause
#include "bilateral/smoothing_field.h"
#include <Eigen/Geometry>
#include <cmath>
#include <fresco/filters/core/local_sampling.h>
namespace fresco::filters {
namespace {

bool usable(const Eigen::Vector3f& normal) { return normal.allFinite() && normal.squaredNorm() > 0; }

std::unique_ptr<PointTree> usableTree(const Points& points, const Points& normals, int threads)
{
  Points counted;
  for (Index i = 0; i < points.cols(); ++i)
    if (!usable(normals.col(i))) {
      if (counted.cols() == 0)
        counted = points;
      counted.col(i).setConstant(NAN); // which the tree leaves out
    }
  return std::make_unique<PointTree>(counted.cols() > 0 ? counted : points, threads);
}
} // namespace

SmoothingField makeSmoothingField(const Points& points, const Points& normals, const BilateralOptions& options)
{
  SmoothingField field;
  field.tree = usableTree(points, normals, options.threads);
  field.areas = sampleAreas(*field.tree, 8, options.threads);
  if (options.sigma_d > 0)
    field.radii = Eigen::VectorXf::Constant(1, 2 * options.sigma_d);
  else
    field.radii = 2 * options.spacings * field.areas.cwiseSqrt();
  field.lists = compressedRadiusLists(*field.tree, field.radii, most_within, options.threads);
  field.normals.resize(3, field.tree->size());
  for (Index i = 0; i < field.normals.cols(); ++i)
    field.normals.col(i) = normals.col(field.tree->columns()[i]).normalized();
  return field;
}
} // namespace fresco::filters
