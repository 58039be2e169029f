// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/point_set.h>
#include <fresco/surface/core/normal_filtering.h>
#include <pcl/point_cloud.h>
#include <pcl/surface/processing.h>
#include <string>
#include <utility>
namespace fresco {
/// PCL face of filterSurface(); setters: see NormalFilteringOptions. process() puts out the input mesh with moved
/// vertices; its other attributes are kept.
class FRESCO_EXPORT SurfaceOptimization : public pcl::MeshProcessing {
public:
  using Ptr = pcl::shared_ptr<SurfaceOptimization>;
  using ConstPtr = pcl::shared_ptr<const SurfaceOptimization>;

  /// The points that the mesh was made of; copied.
  /// @tparam PointT with x y z, with or without a normal
  template <typename PointT>
  void setInputCloud(const pcl::shared_ptr<const pcl::PointCloud<PointT>>& cloud);
  template <typename PointT>
  void setInputCloud(const pcl::shared_ptr<pcl::PointCloud<PointT>>& cloud);

  void setOptions(const NormalFilteringOptions& options) { options_ = options; }
  const NormalFilteringOptions& getOptions() const { return options_; }
  void setMaximumIterations(int iterations) { options_.iterations = iterations; }
  int getMaximumIterations() const { return options_.iterations; }
  void setTolerance(double tolerance) { options_.tolerance = tolerance; }
  double getTolerance() const { return options_.tolerance; }
  void setKappa1(double kappa1) { options_.smoothness_weight = kappa1; }
  double getKappa1() const { return options_.smoothness_weight; }
  void setKappa2(double kappa2) { options_.tangential_weight = kappa2; }
  double getKappa2() const { return options_.tangential_weight; }
  void setFlipEdges(bool flip) { options_.flip = flip; }
  bool getFlipEdges() const { return options_.flip; }
  void setNumberOfThreads(int threads) { options_.threads = threads; }
  int getNumberOfThreads() const { return options_.threads; }
  void setThreads(int threads) { setNumberOfThreads(threads); } ///< the name that pcl::Poisson has
  int getThreads() const { return getNumberOfThreads(); }

  /// Told of each step; process() throws Cancelled if it asks to stop.
  void setProgress(Progress progress) { progress_ = std::move(progress); }

  /// Hides MeshProcessing::process(), which is not virtual and crashes without an input. `output` may be the
  /// input mesh.
  /// @throws std::invalid_argument without input mesh or cloud, and as filterSurface()
  void process(pcl::PolygonMesh& output);

  /// Of the last process(); its mesh is empty.
  const NormalFilteringResult& getResult() const { return result_; }

protected:
  void performProcessing(pcl::PolygonMesh& output) override;
  std::string getClassName() const override { return "SurfaceOptimization"; }

private:
  PointSet points_;
  NormalFilteringOptions options_;
  Progress progress_;
  NormalFilteringResult result_;
};
} // namespace fresco
#include <fresco/surface/impl/surface_optimization.hpp>
