// SPDX-License-Identifier: BSD-3-Clause
// One scan through a chain of filters, PCL's and fresco's side by side: thinned, cleaned, with smooth oriented normals.
#include <fresco/filters/bilateral_normal_filter.h>
#include <fresco/filters/oriented_normal_estimation.h>
#include <fresco/filters/veil_point_removal.h>
#include <iostream>
#include <pcl/filters/statistical_outlier_removal.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>
int main(int argc, char** argv)
{
  using Cloud = pcl::PointCloud<pcl::PointXYZ>;
  auto scan = pcl::make_shared<Cloud>();
  if (argc != 3 || pcl::io::loadPCDFile(argv[1], *scan) != 0) {
    std::cerr << "usage: filter_chain SCAN.pcd OUT.pcd\n";
    return 2;
  }

  fresco::VeilPointRemoval<pcl::PointXYZ> veil; // points in the air at depth jumps; the scanner stood at sensor_origin_
  veil.setInputCloud(scan);
  auto solid = pcl::make_shared<Cloud>();
  veil.filter(*solid);

  pcl::StatisticalOutlierRemoval<pcl::PointXYZ> outliers;
  outliers.setInputCloud(solid);
  outliers.setMeanK(16);
  outliers.setStddevMulThresh(3.0);
  auto clean = pcl::make_shared<Cloud>();
  outliers.filter(*clean);

  pcl::VoxelGrid<pcl::PointXYZ> thinning;
  thinning.setInputCloud(clean);
  thinning.setLeafSize(0.02f, 0.02f, 0.02f);
  auto thin = pcl::make_shared<Cloud>();
  thinning.filter(*thin);
  thin->sensor_origin_ = scan->sensor_origin_; // PCL's VoxelGrid forgets where the scanner stood

  fresco::OrientedNormalEstimation<pcl::PointXYZ, pcl::PointNormal> estimation;
  estimation.setInputCloud(thin);
  estimation.setKSearch(16);
  auto oriented = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  estimation.compute(*oriented);

  fresco::BilateralNormalFilter<pcl::PointNormal> smoothing;
  smoothing.setInputCloud(oriented);
  pcl::PointCloud<pcl::PointNormal> smooth;
  smoothing.filter(smooth);

  std::cout << scan->size() << " points, " << solid->size() << " without veil, " << clean->size()
            << " without outliers, " << thin->size() << " thinned, " << smooth.size() << " with normals\n";
  return pcl::io::savePCDFileBinary(argv[2], smooth) == 0 ? 0 : 1;
}
