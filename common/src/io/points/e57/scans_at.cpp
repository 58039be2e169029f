// SPDX-License-Identifier: BSD-3-Clause
#include <fresco/core/require.h>
#include <fresco/io/scan_writer.h>
#include <map>
namespace fresco {
namespace {
/// A scan of a file, as it will be written.
struct Written {
  Index number = -1;                ///< in the new file
  Eigen::Isometry3d T_world_before; ///< from the frame of its old file
};
} // namespace

void writeScansAt(const std::string& path, const std::vector<ScanPath>& scans, const std::vector<Pose>& poses)
{
  require(scans.size() == poses.size(), "writeScansAt: a pose for each scan is needed");
  std::vector<PlacedCloud> clouds;
  std::map<std::string, std::map<Index, Written>> written; // by file and scan
  std::map<std::string, std::vector<ScanInfo>> infos;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (!poses[i])
      continue;
    const auto& [file, scan, index] = scans[i];
    Written& entry = written[file][scan];
    const Eigen::Isometry3d T_world_scan(*poses[i]);
    entry = {Index(clouds.size()), T_world_scan};
    std::string name = scans[i].name();
    if (holdsScans(file) && scan >= 0) {
      if (infos.count(file) == 0)
        infos[file] = readScanInfos(scans[i]);
      const ScanInfo& info = infos[file].at(scan);
      entry.T_world_before = T_world_scan * info.T_file_scan.inverse();
      name = info.name.empty() ? name : info.name;
    }
    clouds.push_back({name, T_world_scan, readCloud(scans[i])});
  }
  std::vector<ScanPicture> pictures;
  for (const auto& [file, places] : written)
    for (ScanPicture& picture : readScanPictures(file))
      if (const auto place = places.find(picture.description.scan); place != places.end()) {
        ScanImage& said = picture.description;
        said.scan = place->second.number;
        if (said.T_file_image)
          said.T_file_image = place->second.T_world_before * *said.T_file_image;
        pictures.push_back(std::move(picture));
      }
  writeScans(path, clouds, pictures);
}
} // namespace fresco
