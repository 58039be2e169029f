// SPDX-License-Identifier: BSD-3-Clause
// Scans whose poses nobody knows into one frame. Prints a pose per scan and writes all of them as one cloud.
#include <fresco/registration/scan_registration.h>
#include <iostream>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>
int main(int argc, char** argv)
{
  if (argc < 4) {
    std::cerr << "usage: registration OUT.pcd SCAN.pcd SCAN.pcd ...\n";
    return 2;
  }
  fresco::ScanRegistration<pcl::PointXYZRGB> registration;
  for (int i = 2; i < argc; ++i) {
    auto scan = pcl::make_shared<pcl::PointCloud<pcl::PointXYZRGB>>();
    if (pcl::io::loadPCDFile(argv[i], *scan) != 0)
      return 1;
    registration.addPointCloud(scan); // a second argument would be a start pose
  }

  const fresco::ScanRegistrationResult& result = registration.compute();
  for (std::size_t i = 0; i < registration.getNumberOfPointClouds(); ++i) {
    const fresco::ScanResult& scan = result.scans[i];
    std::cout << argv[i + 2] << ": ";
    if (registration.isPlaced(i))
      std::cout << "rms " << scan.rms << " m, uncertain by " << scan.translation_deviation << " m\n"
                << registration.getTransformation(i) << "\n";
    else
      std::cout << "no place found: " << scan.problem << "\n";
  }
  for (const fresco::PairResult& pair : result.pairs)
    if (pair.accepted)
      std::cout << "scans " << pair.a << " and " << pair.b << ": overlap " << 100 * pair.overlap << " %, rms "
                << pair.rms << " m\n";
  return pcl::io::savePCDFileBinaryCompressed(argv[1], registration.getConcatenatedCloud()) == 0 ? 0 : 1;
}
