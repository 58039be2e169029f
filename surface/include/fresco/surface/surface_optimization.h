// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/point_set.h>
#include <fresco/surface/core/normal_filtering.h>
#include <fresco/surface/core/surface_energy.h>
#include <pcl/point_cloud.h>
#include <pcl/surface/processing.h>
#include <string>
#include <utility>
namespace fresco {
/// PCL face of filterSurface() and minimizeSurfaceEnergy(); setters: see NormalFilteringOptions and EnergyOptions.
/// process() puts out the input mesh with moved vertices; its other attributes are kept.
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

  void setMode(OptimizationMode mode) { mode_ = mode; } ///< default: normal_filtering
  OptimizationMode getMode() const { return mode_; }

  /// Each mode has its own options; these do not choose the mode.
  void setOptions(const NormalFilteringOptions& options) { filtering_ = options; }
  void setOptions(const EnergyOptions& options) { energy_ = options; }
  const NormalFilteringOptions& getNormalFilteringOptions() const { return filtering_; }
  const EnergyOptions& getEnergyOptions() const { return energy_; }

  /// These set the option of both modes; the getters return that of the chosen mode.
  void setMaximumIterations(int iterations) { filtering_.iterations = energy_.iterations = iterations; }
  int getMaximumIterations() const { return isEnergy() ? energy_.iterations : filtering_.iterations; }
  void setTolerance(double tolerance) { filtering_.tolerance = energy_.tolerance = tolerance; }
  double getTolerance() const { return isEnergy() ? energy_.tolerance : filtering_.tolerance; }
  /// NormalFilteringOptions::smoothness_weight and EnergyOptions::kappa1.
  void setKappa1(double kappa1) { filtering_.smoothness_weight = energy_.kappa1 = kappa1; }
  double getKappa1() const { return isEnergy() ? energy_.kappa1 : filtering_.smoothness_weight; }
  /// NormalFilteringOptions::tangential_weight and EnergyOptions::kappa2.
  void setKappa2(double kappa2) { filtering_.tangential_weight = energy_.kappa2 = kappa2; }
  double getKappa2() const { return isEnergy() ? energy_.kappa2 : filtering_.tangential_weight; }
  void setNumberOfThreads(int threads) { filtering_.threads = energy_.threads = threads; }
  int getNumberOfThreads() const { return isEnergy() ? energy_.threads : filtering_.threads; }
  void setThreads(int threads) { setNumberOfThreads(threads); } ///< the name that pcl::Poisson has
  int getThreads() const { return getNumberOfThreads(); }

  void setFlipEdges(bool flip) { filtering_.flip = flip; } ///< mode normal_filtering only
  bool getFlipEdges() const { return filtering_.flip; }

  /// Told of each step; process() throws Cancelled if it asks to stop.
  void setProgress(Progress progress) { progress_ = std::move(progress); }

  /// Hides MeshProcessing::process(), which is not virtual and crashes without an input. `output` may be the
  /// input mesh.
  /// @throws std::invalid_argument without input mesh or cloud, and as filterSurface()
  void process(pcl::PolygonMesh& output);

  /// Of the last process(), whichever mode; its mesh is empty.
  const SurfaceOptimizationResult& getResult() const;
  /// Of the last process() in this mode; its mesh is empty.
  const NormalFilteringResult& getNormalFilteringResult() const { return filtering_result_; }
  const EnergyResult& getEnergyResult() const { return energy_result_; }

protected:
  void performProcessing(pcl::PolygonMesh& output) override;
  std::string getClassName() const override { return "SurfaceOptimization"; }

private:
  bool isEnergy() const { return mode_ == OptimizationMode::energy; }

  PointSet points_;
  OptimizationMode mode_ = OptimizationMode::normal_filtering;
  OptimizationMode result_mode_ = OptimizationMode::normal_filtering;
  NormalFilteringOptions filtering_;
  EnergyOptions energy_;
  Progress progress_;
  NormalFilteringResult filtering_result_;
  EnergyResult energy_result_;
};
} // namespace fresco
#include <fresco/surface/impl/surface_optimization.hpp>
