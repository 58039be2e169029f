// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/surface/core/volumetric_reconstruction.h>
#include <pcl/PolygonMesh.h>
#include <pcl/Vertices.h>
#include <pcl/surface/reconstruction.h>
#include <pcl/type_traits.h>
#include <vector>
namespace fresco {
/// PCL face of reconstructVolumetric(), in place of pcl::Poisson: changing the type's name is all a user does. Beyond
/// pcl::Poisson it has a cell size in the unit of the points, trimming, progress and cancellation. It honours indices,
/// leaves out and counts unusable points, and carries colours and intensities to the vertices. It uses all cores by
/// default; the result is the same for any number of threads. Setters without a comment: see VolumetricOptions.
///
/// setSearchMethod() of the base class is accepted, without effect: the solver searches no neighbours.
template <typename PointNT>
class VolumetricReconstruction : public pcl::SurfaceReconstruction<PointNT> {
public:
  using Ptr = pcl::shared_ptr<VolumetricReconstruction<PointNT>>;
  using ConstPtr = pcl::shared_ptr<const VolumetricReconstruction<PointNT>>;
  using PointCloudPtr = typename pcl::PointCloud<PointNT>::Ptr;
  using KdTree = pcl::KdTree<PointNT>;
  using KdTreePtr = typename KdTree::Ptr;

  VolumetricReconstruction()
  {
    static_assert(pcl::traits::has_normal<PointNT>::value, "PointNT has no normals; pcl::PointNormal has");
    this->check_tree_ = false; // no neighbour search, so PCL need not build a tree
  }

  void setDepth(int depth) { options_.depth = depth; }
  int getDepth() const { return options_.depth; }
  /// Side of the finest cell in the unit of the points; it then sets the depth. 0 = from setDepth().
  void setCellSize(double cell_size) { options_.cell_size = cell_size; }
  double getCellSize() const { return options_.cell_size; }
  void setMinDepth(int min_depth) { options_.min_depth = min_depth; }
  int getMinDepth() const { return options_.min_depth; }
  void setPointWeight(float point_weight) { options_.point_weight = point_weight; }
  float getPointWeight() const { return options_.point_weight; }
  void setScale(float scale) { options_.scale = scale; }
  float getScale() const { return options_.scale; }
  void setSamplesPerNode(float samples_per_node) { options_.samples_per_node = samples_per_node; }
  float getSamplesPerNode() const { return options_.samples_per_node; }
  /// The length of a normal (or the field `confidence`, where the point type has one) is the point's weight.
  void setConfidence(bool confidence) { options_.confidence = confidence; }
  bool getConfidence() const { return options_.confidence; }
  void setTrim(float trim) { options_.trim = trim; }
  float getTrim() const { return options_.trim; }
  void setTrimLevels(float levels) { options_.trim_levels = levels; }
  float getTrimLevels() const { return options_.trim_levels; }
  /// Where beams passed; no surface is made there. nullptr: beams are not asked.
  void setFreeSpace(std::shared_ptr<const FreeSpaceMap> free_space) { options_.free_space = std::move(free_space); }
  const std::shared_ptr<const FreeSpaceMap>& getFreeSpace() const { return options_.free_space; }
  /// Solver sweeps per octree depth.
  void setMaximumIterations(int iterations) { options_.iterations = iterations; }
  int getMaximumIterations() const { return options_.iterations; }
  void setNumberOfThreads(int threads) { options_.threads = threads; }
  int getNumberOfThreads() const { return options_.threads; }
  /// As setNumberOfThreads(); pcl::Poisson's name for it.
  void setThreads(int threads) { options_.threads = threads; }
  int getThreads() const { return options_.threads; }

  /// Kept for pcl::Poisson's users, without effect: all depths are solved with the same method.
  void setSolverDivide(int solver_divide) { solver_divide_ = solver_divide; }
  int getSolverDivide() const { return solver_divide_; }
  /// Kept for pcl::Poisson's users, without effect: the level set is cut in one pass.
  void setIsoDivide(int iso_divide) { iso_divide_ = iso_divide; }
  int getIsoDivide() const { return iso_divide_; }
  /// Kept for pcl::Poisson's users, without effect: the result consists of triangles.
  void setOutputPolygons(bool output_polygons) { output_polygons_ = output_polygons; }
  bool getOutputPolygons() const { return output_polygons_; }
  /// Kept for pcl::Poisson's users, without effect: the B-splines have degree 1.
  void setDegree(int degree) { degree_ = degree; }
  int getDegree() const { return degree_; }
  /// Kept for pcl::Poisson's users, without effect: the mesh is always manifold.
  void setManifold(bool manifold) { manifold_ = manifold; }
  bool getManifold() const { return manifold_; }

  /// Called between steps. If it answers false, Cancelled is thrown.
  void setProgress(Progress progress) { progress_ = std::move(progress); }
  void setOptions(const VolumetricOptions& options) { options_ = options; }
  const VolumetricOptions& getOptions() const { return options_; }

  /// Of the last reconstruction; its mesh is empty.
  const VolumetricResult& getResult() const { return result_; }

  /// Bytes that reconstruct() needs at most beside the cloud.
  std::size_t estimateMemory();

  /// Hides the base class's function, which cannot be overridden, reads a missing input and copies the cloud.
  /// @throws std::invalid_argument, Cancelled as reconstructVolumetric(), and std::invalid_argument without input
  void reconstruct(pcl::PolygonMesh& output);
  /// @param points vertices with normals, and colours and intensity where the point type has them
  void reconstruct(pcl::PointCloud<PointNT>& points, std::vector<pcl::Vertices>& polygons);

  void performReconstruction(pcl::PolygonMesh& output) override;
  void performReconstruction(pcl::PointCloud<PointNT>& points, std::vector<pcl::Vertices>& polygons) override;

protected:
  std::string getClassName() const override { return "VolumetricReconstruction"; }

private:
  void begin();
  TriangleMesh computeMesh();

  VolumetricOptions options_;
  VolumetricResult result_;
  Progress progress_;
  int solver_divide_ = 8, iso_divide_ = 8, degree_ = 2;
  bool output_polygons_ = false, manifold_ = true;
};
} // namespace fresco
#include <fresco/surface/impl/volumetric_reconstruction.hpp>
