// SPDX-License-Identifier: BSD-3-Clause
// mesh_of_message SCAN.pcd MESH.ply: from a cloud as a ROS 2 topic carries it to a mesh. pcl_conversions::toPCL() turns a
// sensor_msgs::msg::PointCloud2 into the pcl::PCLPointCloud2 that is read from a file here.
#include <fresco/filters/bilateral_normal_filter.h>
#include <fresco/filters/oriented_normal_estimation.h>
#include <fresco/surface/volumetric_reconstruction.h>
#include <iostream>
#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

int main(int argc, char** argv)
try {
  pcl::PCLPointCloud2 message;
  if (argc != 3 || pcl::io::loadPCDFile(argv[1], message) < 0) {
    std::cerr << "usage: mesh_of_message SCAN.pcd MESH.ply\n";
    return 2;
  }
  const pcl::PointCloud<pcl::PointXYZ>::Ptr scan(new pcl::PointCloud<pcl::PointXYZ>);
  pcl::fromPCLPointCloud2(message, *scan);

  const pcl::PointCloud<pcl::PointNormal>::Ptr oriented(new pcl::PointCloud<pcl::PointNormal>),
      smooth(new pcl::PointCloud<pcl::PointNormal>);
  fresco::OrientedNormalEstimation<pcl::PointXYZ, pcl::PointNormal>
      estimation; // the sensor stands in the message's origin
  estimation.setInputCloud(scan);
  estimation.setKSearch(16);
  estimation.compute(*oriented);
  fresco::BilateralNormalFilter<pcl::PointNormal> smoothing;
  smoothing.setInputCloud(oriented);
  smoothing.filter(*smooth);

  pcl::PolygonMesh mesh;
  fresco::VolumetricReconstruction<pcl::PointNormal> reconstruction;
  reconstruction.setCellSize(0.02); // metres
  reconstruction.setInputCloud(smooth);
  reconstruction.reconstruct(mesh);
  return pcl::io::savePLYFileBinary(argv[2], mesh) == 0 ? 0 : 1;
} catch (const std::exception& error) {
  std::cerr << "mesh_of_message: " << error.what() << "\n";
  return 1;
}
