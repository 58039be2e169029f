// SPDX-License-Identifier: BSD-3-Clause
#include "cases/point_normals.h"
#include <pcl/features/normal_3d_omp.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
namespace fresco::benchmark {
Points principalNormals(const Points& points, const Points& facing, int neighbours)
{
  const auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (Index i = 0; i < points.cols(); ++i)
    cloud->emplace_back(points(0, i), points(1, i), points(2, i));
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
  estimation.setKSearch(neighbours);
  pcl::PointCloud<pcl::Normal> found;
  estimation.compute(found);
  Points normals(3, points.cols());
  for (Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3f normal = found[i].getNormalVector3fMap();
    const Eigen::Vector3f side = facing.col(i);
    if (!normal.allFinite())
      normals.col(i) = side.normalized();
    else
      normals.col(i) = normal.dot(side) < 0.f ? Eigen::Vector3f(-normal) : normal;
  }
  return normals;
}
} // namespace fresco::benchmark
