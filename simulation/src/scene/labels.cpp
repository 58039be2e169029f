// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>
#include <fresco/io/cloud_file.h>
#include <fresco/simulation/scene/labels.h>
namespace fresco::simulation {
std::vector<PointLabel> labelPoints(const LaserScan& scan, const TriangleTree& truth,
                                    const Eigen::Matrix4d& T_truth_scan)
{
  std::vector<PointLabel> labels(scan.mixed.size(), PointLabel::surface);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (!scan.mixed[i])
      continue;
    const Eigen::Vector3d point = scan.points.points.col(static_cast<Index>(i)).cast<double>();
    const double distance = truth.closest((T_truth_scan * point.homogeneous()).head<3>()).distance;
    labels[i] =
        distance > mixed_pixel_deviations * scan.deviations[i] ? PointLabel::mixed_pixel : PointLabel::near_surface;
  }
  return labels;
}

void writeLabelledScan(const std::string& path, const PointSet& points, const std::vector<PointLabel>& labels)
{
  CloudFile file = toCloudFile(points);
  pcl::PCLPointCloud2& cloud = file.cloud;
  const std::size_t step = cloud.point_step, wide = step + sizeof(PointLabel);
  std::vector<std::uint8_t> data(labels.size() * wide);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    std::memcpy(data.data() + i * wide, cloud.data.data() + i * step, step);
    std::memcpy(data.data() + i * wide + step, &labels[i], sizeof(PointLabel));
  }
  pcl::PCLPointField field;
  field.name = "label";
  field.offset = cloud.point_step;
  field.datatype = pcl::PCLPointField::UINT32;
  field.count = 1;
  cloud.fields.push_back(field);
  cloud.data.swap(data);
  cloud.point_step = static_cast<std::uint32_t>(wide);
  cloud.row_step = cloud.point_step * cloud.width;
  writeCloud(path, file);
}
} // namespace fresco::simulation
