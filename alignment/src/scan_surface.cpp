// SPDX-License-Identifier: BSD-3-Clause
#include "scan_surface.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/statistics.h>
#include <fresco/registration/core/surface_points.h>
namespace fresco::alignment {
namespace {
double medianDistance(const Points& points)
{
  const Eigen::VectorXf distances = points.colwise().norm();
  return median(std::vector<float>(distances.begin(), distances.end()));
}
} // namespace

ScanSurface::ScanSurface(const PointSet& scans, int threads)
{
  constexpr double most_points = 150000; // surface in cells of 3 cm of a room of 130 m^2; more cost time alone
  constexpr double first_share = 100;    // voxels per radius
  registration::RawScan raw = registration::finitePoints(scans, Eigen::Vector3d::Zero());
  if (raw.points.cols() == 0)
    throw std::runtime_error("the scans have no finite point");
  Eigen::Vector3f middle;
  for (int k = 0; k < 3; ++k)
    middle[k] = median(std::vector<float>(raw.points.row(k).begin(), raw.points.row(k).end()));
  center_ = scans.origin + middle.cast<double>();
  raw.points.colwise() -= middle;
  raw.viewpoints.setZero();
  double voxel = medianDistance(raw.points) / first_share;
  if (!(voxel > 0))
    throw std::runtime_error("the scans are a single point");
  registration::RawScan thinned = registration::thin(raw, static_cast<float>(voxel));
  voxel *= std::sqrt(thinned.points.cols() / most_points);
  thinned = registration::thin(raw, static_cast<float>(voxel));
  while (thinned.points.cols() * 1.5 > raw.points.cols() && thinned.points.cols() > registration::fewest_points) {
    voxel *= std::sqrt(2.0); // sparse scans: cells are to be wider than the spacing
    thinned = registration::thin(raw, static_cast<float>(voxel));
  }
  if (thinned.points.cols() < registration::fewest_points)
    throw std::runtime_error("the scans have too few points to tell their surface");
  level_.voxel = static_cast<float>(voxel);
  level_.points = thinned.points;
  level_.viewpoints = thinned.viewpoints;
  level_.colors = thinned.colors;
  level_.tree = std::make_shared<PointTree>(level_.points, threads);
  registration::estimateNormals(level_, threads);
  radius_ = medianDistance(level_.points);
  buildCells();
}

void ScanSurface::buildCells()
{
  low_ = level_.points.rowwise().minCoeff();
  high_ = level_.points.rowwise().maxCoeff();
  const Eigen::Vector3d size = (high_ - low_).cast<double>();
  cell_ = 2 * level_.voxel;
  while (((size / cell_).array() + 1).prod() > most_cells)
    cell_ *= 1.2f;
  counts_ = (size / cell_).array().floor().cast<int>() + 1;
  point_of_cell_.assign(static_cast<std::size_t>(counts_.cast<double>().prod()), -1);
  for (Index i = 0; i < level_.points.cols(); ++i)
    if (level_.surface_variation[i] < registration::variation_limit && level_.normals.col(i).squaredNorm() > 0)
      point_of_cell_[cellAt(level_.points.col(i))] = static_cast<int>(i);
}

Index ScanSurface::cellAt(const Eigen::Vector3f& place) const
{
  const Eigen::Array3i at = ((place - low_) / cell_).array().floor().cast<int>();
  if ((at < 0).any() || (at >= counts_).any())
    return -1;
  return (Index{at[2]} * counts_[1] + at[1]) * counts_[0] + at[0];
}

bool ScanSurface::isBlocked(const Eigen::Vector3f& eye, const Eigen::Vector3f& end) const
{
  const Eigen::Vector3f along = end - eye;
  const float length = along.norm(), step = 0.5f * cell_;
  Eigen::Array2f range(0, length); // part of the line within the box of the scans
  for (int k = 0; k < 3; ++k) {
    const float a = (low_[k] - eye[k]) / along[k] * length, b = (high_[k] - eye[k]) / along[k] * length;
    if (along[k] != 0)
      range = {std::max(range[0], std::min(a, b)), std::min(range[1], std::max(a, b))};
    else if (eye[k] < low_[k] || eye[k] > high_[k])
      return false;
  }
  Index last = -1;
  for (float at = range[0]; at < range[1]; at += step) {
    const Eigen::Vector3f place = eye + at / length * along;
    const Index cell = cellAt(place);
    if (cell < 0 || cell == last || point_of_cell_[cell] < 0)
      continue;
    last = cell;
    const Eigen::Vector3f normal = level_.normals.col(point_of_cell_[cell]),
                          on = level_.points.col(point_of_cell_[cell]);
    const float meets = normal.dot(on - eye) / normal.dot(along); // infinite or NaN for a parallel
    if (meets > 0 && meets < 1 && (eye + meets * along - on).squaredNorm() < cell_ * cell_)
      return true;
  }
  return false;
}
} // namespace fresco::alignment
