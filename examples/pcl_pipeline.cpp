// SPDX-License-Identifier: BSD-3-Clause
// fresco's classes inside a PCL pipeline: points -> oriented normals -> bilateral smoothing -> closed surface.
#include <cmath>
#include <fresco/filters/bilateral_normal_filter.h>
#include <fresco/filters/oriented_normal_estimation.h>
#include <fresco/surface/volumetric_reconstruction.h>
#include <iostream>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>
namespace {
/// Points on a cylinder with a lid, seen from outside: something to work on where no file is given.
pcl::PointCloud<pcl::PointXYZ>::Ptr drum()
{
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (int i = 0; i < 30000; ++i) {
    const double u = std::fmod(i * 0.6180339887498949, 1.0), angle = 2 * M_PI * std::fmod(i * 0.7548776662466927, 1.0);
    const double r = i % 2 == 0 ? 0.5 : 0.5 * std::sqrt(u), z = i % 2 == 0 ? u - 0.5 : (i % 4 == 1 ? 0.5 : -0.5);
    cloud->emplace_back(static_cast<float>(r * std::cos(angle)), static_cast<float>(r * std::sin(angle)),
                        static_cast<float>(z));
  }
  return cloud;
}
} // namespace

int main(int argc, char** argv)
{
  if (argc < 2 || argc > 3) {
    std::cerr << "usage: pcl_pipeline OUT.ply [IN.pcd]\n";
    return 2;
  }
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud = drum();
  if (argc == 3 && pcl::io::loadPCDFile(argv[2], *cloud) != 0)
    return 1;

  fresco::OrientedNormalEstimation<pcl::PointXYZ, pcl::PointNormal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setKSearch(16);
  auto oriented = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  estimation.compute(*oriented);

  fresco::BilateralNormalFilter<pcl::PointNormal> smoothing;
  smoothing.setInputCloud(oriented);
  auto smooth = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  smoothing.filter(*smooth);

  fresco::VolumetricReconstruction<pcl::PointNormal> reconstruction; // stands where pcl::Poisson stood
  reconstruction.setDepth(7);
  reconstruction.setInputCloud(smooth);
  pcl::PolygonMesh mesh;
  reconstruction.reconstruct(mesh);
  std::cout << mesh.polygons.size() << " triangles\n";
  return pcl::io::savePLYFileBinary(argv[1], mesh) == 0 && !mesh.polygons.empty() ? 0 : 1;
}
