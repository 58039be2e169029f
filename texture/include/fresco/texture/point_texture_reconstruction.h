// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/pcl_conversions.h>
#include <fresco/core/require.h>
#include <fresco/io/texture_mesh_conversions.h>
#include <fresco/texture/core/point_texture.h>
#include <memory>
#include <pcl/PolygonMesh.h>
#include <pcl/TextureMesh.h>
#include <pcl/point_cloud.h>
namespace fresco {
/// PCL face of reconstructPointTexture(); setters: see PointTextureOptions.
class FRESCO_EXPORT PointTextureReconstruction {
public:
  using Ptr = std::shared_ptr<PointTextureReconstruction>;
  using ConstPtr = std::shared_ptr<const PointTextureReconstruction>;

  void setOptions(const PointTextureOptions& options) { options_ = options; }
  const PointTextureOptions& getOptions() const { return options_; }

  void setInputMesh(const pcl::PolygonMeshConstPtr& mesh) { input_mesh_ = mesh; }
  pcl::PolygonMeshConstPtr getInputMesh() const { return input_mesh_; }

  /// The points that the mesh was made of; copied.
  /// @tparam PointT with x y z and rgb or intensity, with or without normal and vp_x vp_y vp_z
  template <typename PointT>
  void setInputCloud(const pcl::PointCloud<PointT>& cloud)
  {
    points_ = toPointSet(cloud);
  }

  void setTexelSize(double texel) { options_.texel = texel; }
  double getTexelSize() const { return options_.texel; }
  void setWidth(double spacings) { options_.width = spacings; }
  double getWidth() const { return options_.width; }
  void setRounds(int rounds) { options_.rounds = rounds; }
  int getRounds() const { return options_.rounds; }
  void setAdjustExposure(bool adjust) { options_.exposure = adjust; }
  bool getAdjustExposure() const { return options_.exposure; }
  void setNumberOfThreads(int threads) { options_.threads = threads; }
  int getNumberOfThreads() const { return options_.threads; }
  void setThreads(int threads) { setNumberOfThreads(threads); } ///< as pcl::Poisson names it
  int getThreads() const { return getNumberOfThreads(); }       ///< as pcl::Poisson names it
  void setProgress(const Progress& progress) { progress_ = progress; }

  /// @throws std::invalid_argument without input mesh or cloud or as reconstructPointTexture() does
  void process(pcl::TextureMesh& output)
  {
    require(input_mesh_ != nullptr, "PointTextureReconstruction: no input mesh");
    require(points_.size() > 0, "PointTextureReconstruction: no input cloud");
    result_ = reconstructPointTexture(toTriangleMesh(*input_mesh_), points_, options_, progress_);
    toTextureMesh(result_.model, output);
    output.header = input_mesh_->header;
  }

  /// All that the last process() found out, its images among them.
  const PointTextureResult& getResult() const { return result_; }

private:
  pcl::PolygonMeshConstPtr input_mesh_;
  PointSet points_;
  PointTextureOptions options_;
  Progress progress_;
  PointTextureResult result_;
};
} // namespace fresco
