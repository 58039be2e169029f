// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/parse_file.h"
#include "io/points/scan_reader.h"
#include <fresco/core/pcl_cloud_table.h>
#include <fresco/io/cloud_file.h>
#include <fresco/io/scan_file.h>
namespace fresco {
namespace {
bool knowsPose(const CloudFile& file)
{
  return file.has_sensor_pose || !file.sensor_origin.head<3>().isZero(0) ||
         file.sensor_orientation.coeffs() != Eigen::Quaternionf::Identity().coeffs();
}

io::PointTable tableOf(const CloudFile& file, bool always_pose)
{
  io::PointTable table = io::tableOfCloud(file.cloud);
  if (always_pose || knowsPose(file))
    table.sensor = io::SensorPose{file.sensor_origin.head<3>().cast<double>(), file.sensor_orientation};
  return table;
}

CloudFile fileOf(io::PointTable table)
{
  CloudFile file;
  if (table.sensor) {
    file.sensor_origin.head<3>() = table.sensor->position.cast<float>();
    file.sensor_orientation = table.sensor->orientation;
    file.has_sensor_pose = true;
  }
  file.cloud = io::cloudOfTable(std::move(table));
  return file;
}
} // namespace

CloudFile readCloud(const std::string& path) { return readCloud(ScanPath{path}); }

CloudFile readCloud(const ScanPath& path)
{
  io::PointTable table = io::readTable(path);
  expect(table.rows != 0, path.name(), ": no points");
  io::packColors(table);
  return fileOf(std::move(table));
}

void writeCloud(const std::string& path, const CloudFile& file, bool compressed)
{
  io::writeTable(path, tableOf(file, extension(path) == ".pcd"), compressed);
}

PointSet toPointSet(const CloudFile& file)
{
  try {
    return io::tableToPoints(tableOf(file, false));
  } catch (const std::runtime_error& error) {
    throw std::invalid_argument(std::string("cloud: ") + error.what());
  }
}

CloudFile toCloudFile(const PointSet& set) { return fileOf(io::pointsToTable(set)); }
} // namespace fresco
