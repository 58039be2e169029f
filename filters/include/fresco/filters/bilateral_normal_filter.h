// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/filters/core/bilateral_normals.h>
#include <optional>
#include <pcl/filters/filter.h>
#include <pcl/type_traits.h>
namespace fresco {
/// PCL face of smoothNormals(); setters: see BilateralOptions. Honours setIndices(): the output then has those points
/// alone, and only they count as neighbours. All other fields, the header, the sensor pose and the order of organised
/// clouds stay; nothing is removed. Points that are not finite, or have no finite normal, stay as they are.
/// filter() throws std::invalid_argument for an option out of range and an index that is not there.
/// @tparam PointNT a point type with x y z and normal_x normal_y normal_z
template <typename PointNT>
class BilateralNormalFilter : public pcl::Filter<PointNT> {
public:
  using Ptr = pcl::shared_ptr<BilateralNormalFilter>;
  using ConstPtr = pcl::shared_ptr<const BilateralNormalFilter>;
  using PointCloud = pcl::PointCloud<PointNT>;

  explicit BilateralNormalFilter(bool extract_removed_indices = false) : pcl::Filter<PointNT>(extract_removed_indices)
  {
    static_assert(pcl::traits::has_normal<PointNT>::value, "PointNT has no normals; pcl::PointNormal has");
    this->filter_name_ = "BilateralNormalFilter";
  }

  void setRounds(int rounds) { options_.rounds = rounds; }
  int getRounds() const { return options_.rounds; }
  void setSigmaD(float length) { options_.sigma_d = length; } ///< 0 = from the local sampling
  float getSigmaD() const { return options_.sigma_d; }
  void setSpacings(float spacings) { options_.spacings = spacings; }
  float getSpacings() const { return options_.spacings; }
  void setSigmaN(float degrees) { options_.sigma_n = degrees; }
  float getSigmaN() const { return options_.sigma_n; }
  void setMoveRounds(int rounds) { options_.move_rounds = rounds; } ///< 0 = points stay where they are
  int getMoveRounds() const { return options_.move_rounds; }
  /// Where the cloud was seen from, and its normals point to: points beside creases then select among the normals
  /// around.
  void setViewPoint(float x, float y, float z) { viewpoint_ = Eigen::Vector3f(x, y, z), known_ = true; }
  void useSensorOriginAsViewPoint() { viewpoint_.reset(), known_ = true; } ///< vp_x vp_y vp_z, else sensor_origin_
  void setViewPointUnknown() { viewpoint_.reset(), known_ = false; }       ///< the default: the bilateral filter alone
  void setOptions(const BilateralOptions& options) { options_ = options; }
  const BilateralOptions& getOptions() const { return options_; }
  void setNumberOfThreads(int threads) { options_.threads = threads; } ///< 0 = all cores
  int getNumberOfThreads() const { return options_.threads; }
  void setThreads(int threads) { setNumberOfThreads(threads); } ///< as pcl::Poisson has it
  int getThreads() const { return getNumberOfThreads(); }
  /// filter() throws Cancelled where it returns false.
  void setProgress(const Progress& progress) { progress_ = progress; }

protected:
  void applyFilter(PointCloud& output) override;

private:
  BilateralOptions options_;
  std::optional<Eigen::Vector3f> viewpoint_;
  bool known_ = false;
  Progress progress_;
};
} // namespace fresco
#include <fresco/filters/impl/bilateral_normal_filter.hpp>
