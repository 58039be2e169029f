// SPDX-License-Identifier: BSD-3-Clause
// A closed surface from points with normals, then its rounded edges made sharp again.
#include <fresco/surface/surface_optimization.h>
#include <fresco/surface/volumetric_reconstruction.h>
#include <iostream>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>
int main(int argc, char** argv)
try {
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  if (argc != 4 || pcl::io::loadPCDFile(argv[1], *cloud) != 0) {
    std::cerr << "usage: optimization POINTS_WITH_NORMALS.pcd CELL OUT.ply   (CELL in the unit of the points)\n";
    return 2;
  }

  fresco::VolumetricReconstruction<pcl::PointNormal> reconstruction;
  reconstruction.setInputCloud(cloud);
  reconstruction.setCellSize(std::stod(argv[2]));
  auto rounded = pcl::make_shared<pcl::PolygonMesh>();
  reconstruction.reconstruct(*rounded);

  fresco::SurfaceOptimization optimization; // a pcl::MeshProcessing
  optimization.setInputMesh(rounded);
  optimization.setInputCloud(cloud); // what the mesh was made of
  optimization.setFlipEdges(true);   // else the triangles keep their vertices
  pcl::PolygonMesh sharp;
  optimization.process(sharp);

  const fresco::NormalFilteringResult& result = optimization.getResult();
  std::cout << sharp.polygons.size() << " triangles, " << result.iterations << " iterations, " << result.flipped_edges
            << " edges flipped\n";
  return pcl::io::savePLYFileBinary(argv[3], sharp) == 0 ? 0 : 1;
} catch (const std::exception& error) {
  std::cerr << "optimization: " << error.what() << "\n";
  return 1;
}
