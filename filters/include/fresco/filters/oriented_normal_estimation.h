// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/filters/core/oriented_normals.h>
#include <optional>
#include <pcl/features/feature.h>
namespace fresco {
/// PCL face of estimateNormals(), to be used like pcl::NormalEstimation: setKSearch() or setRadiusSearch() (neither: k
/// of NormalOptions), setInputCloud(), setIndices(), compute(). Neighbours are points of the whole cloud; of organised
/// clouds and with k, those around the pixel. With setSearchSurface() each point takes the normal of the nearest point
/// of the surface. After setSearchMethod() neighbours come from that search, otherwise from our own. The scan was seen from setViewPoint(), else from
/// the points' own vp_x vp_y vp_z, else from the cloud's sensor_origin_; after setViewPointUnknown() normals agree with
/// each other and point out of closed objects. Fields that input and output share (x y z ...) are copied. compute()
/// throws std::invalid_argument for an option out of range and an index that is not there.
/// @tparam PointInT  a point type with x y z
/// @tparam PointOutT a point type with normal_x normal_y normal_z curvature
template <typename PointInT, typename PointOutT>
class OrientedNormalEstimation : public pcl::Feature<PointInT, PointOutT> {
public:
  using Ptr = pcl::shared_ptr<OrientedNormalEstimation>;
  using ConstPtr = pcl::shared_ptr<const OrientedNormalEstimation>;
  using PointCloudOut = pcl::PointCloud<PointOutT>;

  explicit OrientedNormalEstimation(int threads = 0)
  {
    this->feature_name_ = "OrientedNormalEstimation";
    options_.threads = threads;
  }

  void setOptions(const NormalOptions& options) { options_ = options; } ///< setKSearch(), setRadiusSearch() go first
  const NormalOptions& getOptions() const { return options_; }
  void setNumberOfThreads(int threads) { options_.threads = threads; } ///< 0 = all cores
  int getNumberOfThreads() const { return options_.threads; }
  void setThreads(int threads) { setNumberOfThreads(threads); } ///< as pcl::Poisson has it
  int getThreads() const { return getNumberOfThreads(); }
  /// compute() throws Cancelled where it returns false.
  void setProgress(const Progress& progress) { progress_ = progress; }
  void setKeepEdges(bool keep) { options_.edges = keep; }
  bool getKeepEdges() const { return options_.edges; }
  void setViewPoint(float x, float y, float z) { viewpoint_ = Eigen::Vector3f(x, y, z), unknown_ = false; }
  void setViewPointUnknown() { viewpoint_.reset(), unknown_ = true; }
  void useSensorOriginAsViewPoint() { viewpoint_.reset(), unknown_ = false; } ///< back to what the cloud says
  /// Of the points of the last output, 0..1, see NormalField.
  const Eigen::VectorXf& getConfidences() const { return confidences_; }

protected:
  bool initCompute() override;

private:
  void computeFeature(PointCloudOut& output) override;
  PointSet scanOf(const pcl::PointCloud<PointInT>& cloud) const;
  std::vector<Index> placesOnSurface(const PointSet& surface) const;
  pcl::Indices searchNeighbors(const PointInT& point, const NormalOptions& options) const;
  NeighborLists searchAllNeighbors(const NormalOptions& options) const;
  NormalOptions options_;
  std::optional<Eigen::Vector3f> viewpoint_;
  bool unknown_ = false;
  Progress progress_;
  Eigen::VectorXf confidences_;
};
} // namespace fresco
#include <fresco/filters/impl/oriented_normal_estimation.hpp>
