// SPDX-License-Identifier: BSD-3-Clause
// A chain of PCL's classes with each of them replaced; behind "was" is the class that stood there. docs/migration.md has
// the table.
#include <algorithm>
#include <fresco/core/pcl_conversions.h>
#include <fresco/deliverables/mesh_simplification.h>
#include <fresco/filters/bilateral_normal_filter.h>
#include <fresco/filters/core/outliers.h>
#include <fresco/filters/core/voxel_thinning.h>
#include <fresco/filters/oriented_normal_estimation.h>
#include <fresco/registration/point_to_plane_registration.h>
#include <fresco/surface/volumetric_reconstruction.h>
#include <iostream>
#include <pcl/common/io.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>
namespace {
using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using OrientedCloud = pcl::PointCloud<pcl::PointNormal>;

/// The points that fresco's functions name, in PCL's type.
Cloud::Ptr subset(const Cloud& cloud, const std::vector<fresco::Index>& kept)
{
  auto out = pcl::make_shared<Cloud>();
  pcl::copyPointCloud(cloud, pcl::Indices(kept.begin(), kept.end()), *out);
  return out;
}

/// Was pcl::StatisticalOutlierRemoval, setMeanK(16), setStddevMulThresh(2).
Cloud::Ptr withoutOutliers(const Cloud& cloud)
{
  fresco::OutlierOptions options;
  options.k = 16;
  options.sigma = 2;
  return subset(cloud, fresco::withoutOutliers(fresco::toPointSet(cloud).points, options));
}

/// Was pcl::VoxelGrid, setLeafSize(leaf, leaf, leaf): points that were measured, not means of both sides of a board.
Cloud::Ptr thinned(const Cloud& cloud, float leaf)
{
  return subset(cloud, fresco::thinByVoxel(fresco::toPointSet(cloud).points, leaf).kept);
}

/// Was pcl::NormalEstimationOMP, setKSearch(16), then pcl::MovingLeastSquares: edges stay, and normals look to the scanner.
OrientedCloud::Ptr withNormals(const Cloud::ConstPtr& cloud)
{
  fresco::OrientedNormalEstimation<pcl::PointXYZ, pcl::PointNormal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setKSearch(16);
  auto oriented = pcl::make_shared<OrientedCloud>();
  estimation.compute(*oriented);
  fresco::BilateralNormalFilter<pcl::PointNormal> smoothing;
  smoothing.setInputCloud(oriented);
  smoothing.setMoveRounds(1); // as MovingLeastSquares moves points; 0 leaves them where they were measured
  auto smooth = pcl::make_shared<OrientedCloud>();
  smoothing.filter(*smooth);
  return smooth;
}

/// Was pcl::IterativeClosestPoint, setMaxCorrespondenceDistance(0.3).
Eigen::Matrix4f aligned(const Cloud::ConstPtr& source, const Cloud::ConstPtr& target)
{
  fresco::PointToPlaneRegistration<pcl::PointXYZ, pcl::PointXYZ> registration;
  registration.setInputSource(source);
  registration.setInputTarget(target);
  registration.setMaxCorrespondenceDistance(0.3);
  Cloud moved;
  registration.align(moved);
  return registration.getFinalTransformation();
}

/// Was pcl::GreedyProjectionTriangulation or pcl::MarchingCubesHoppe, then pcl::MeshQuadricDecimationVTK.
void mesh(const OrientedCloud::ConstPtr& cloud, pcl::PolygonMesh& out)
{
  fresco::VolumetricReconstruction<pcl::PointNormal> reconstruction;
  reconstruction.setInputCloud(cloud);
  reconstruction.setCellSize(0.1);
  reconstruction.setTrimLevels(2); // no surface where nothing was measured: GreedyProjection leaves holes there
  auto full = pcl::make_shared<pcl::PolygonMesh>();
  reconstruction.reconstruct(*full);
  fresco::MeshSimplification simplification;
  simplification.setInputMesh(full);
  simplification.setNumberOfFaces(std::max<fresco::Index>(1, static_cast<fresco::Index>(full->polygons.size()) / 2));
  simplification.process(out);
  std::cout << full->polygons.size() << " faces, simplified " << out.polygons.size() << "\n";
}
} // namespace

int main(int argc, char** argv)
try {
  auto scan = pcl::make_shared<Cloud>();
  if (argc != 3 || pcl::io::loadPCDFile(argv[1], *scan) != 0) {
    std::cerr << "usage: from_pcl SCAN.pcd OUT.ply\n";
    return 2;
  }
  const Cloud::Ptr clean = withoutOutliers(*scan), thin = thinned(*clean, 0.03f);
  thin->sensor_origin_ = scan->sensor_origin_; // where the scanner stood tells which side is free
  std::cout << scan->size() << " points, " << clean->size() << " without outliers, " << thin->size() << " thinned\n"
            << aligned(thin, clean) << "\n";
  pcl::PolygonMesh out;
  mesh(withNormals(thin), out);
  return pcl::io::savePLYFileBinary(argv[2], out) == 0 ? 0 : 1;
} catch (const std::exception& error) {
  std::cerr << "from_pcl: " << error.what() << "\n";
  return 1;
}
