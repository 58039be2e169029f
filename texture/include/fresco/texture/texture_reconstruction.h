// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/texture/core/texture_reconstruction.h>
#include <memory>
#include <pcl/PolygonMesh.h>
#include <pcl/TextureMesh.h>
#include <string>
#include <vector>
namespace fresco {
/// PCL face of reconstructTexture(); setters: see TextureOptions.
///
///   TextureReconstruction texture;
///   texture.setInputMesh(mesh);
///   for (each photograph)
///     texture.addView(camera, T_camera_world, "photo.jpg");
///   pcl::TextureMesh out;
///   texture.process(out);
///   texture.saveAtlases(folder); // the images that the materials of `out` name
class FRESCO_EXPORT TextureReconstruction {
public:
  using Ptr = std::shared_ptr<TextureReconstruction>;
  using ConstPtr = std::shared_ptr<const TextureReconstruction>;

  void setOptions(const TextureOptions& options) { options_ = options; }
  const TextureOptions& getOptions() const { return options_; }

  void setInputMesh(const pcl::PolygonMeshConstPtr& mesh)
  {
    input_mesh_ = mesh;
    input_layout_.reset();
  }
  /// A mesh whose texture coordinates are kept. Its images are not read: they are as large as the photographs ask for, or
  /// have setAtlasSize() texels on the longest side.
  void setInputMesh(const pcl::TextureMesh::ConstPtr& mesh)
  {
    input_layout_ = mesh;
    input_mesh_.reset();
  }
  pcl::PolygonMeshConstPtr getInputMesh() const { return input_mesh_; }
  pcl::TextureMesh::ConstPtr getInputLayout() const { return input_layout_; } ///< null where a layout is made

  void addView(TextureView view) { views_.push_back(std::move(view)); }
  /// @param T_camera_world axes of the camera: x right, y down, z forward
  /// @param file           photograph, read when needed
  void addView(const CameraModel& camera, const Eigen::Isometry3d& T_camera_world, const std::string& file)
  {
    views_.push_back({camera, T_camera_world, Image(), file, true, false, Image(), ""});
  }
  void clearViews() { views_.clear(); }
  const std::vector<TextureView>& getViews() const { return views_; }

  void setTexelSize(double texel) { options_.texel = texel; }
  double getTexelSize() const { return options_.texel; }
  void setAtlasSize(int side) { options_.atlas = side; }
  int getAtlasSize() const { return options_.atlas; }
  void setBorder(int texels) { options_.border = texels; }
  int getBorder() const { return options_.border; }
  void setSmoothness(double smoothness) { options_.smoothness = smoothness; }
  double getSmoothness() const { return options_.smoothness; }
  void setMargin(double pixels) { options_.margin = pixels; }
  double getMargin() const { return options_.margin; }
  void setDepthTolerance(double share) { options_.depth_tolerance = share; }
  double getDepthTolerance() const { return options_.depth_tolerance; }
  void setRefineCameras(bool refine) { options_.refine = refine; }
  bool getRefineCameras() const { return options_.refine; }
  void setAdjustExposure(bool adjust) { options_.exposure = adjust; }
  bool getAdjustExposure() const { return options_.exposure; }
  void setCheckConsistency(bool check) { options_.consistency = check; }
  bool getCheckConsistency() const { return options_.consistency; }
  void setLevelSeams(bool level) { options_.level = level; }
  bool getLevelSeams() const { return options_.level; }
  void setBlendWidth(double pixels) { options_.blend_width = pixels; }
  double getBlendWidth() const { return options_.blend_width; }
  void setBlendStrip(double pixels) { setBlendWidth(pixels); } ///< old name of setBlendWidth()
  double getBlendStrip() const { return getBlendWidth(); }     ///< old name of getBlendWidth()
  void setBackProjectionRounds(int rounds) { options_.rounds = rounds; }
  int getBackProjectionRounds() const { return options_.rounds; }
  void setMemory(int megabytes) { options_.memory = megabytes; }
  int getMemory() const { return options_.memory; }
  void setNumberOfThreads(int threads) { options_.threads = threads; }
  int getNumberOfThreads() const { return options_.threads; }
  void setThreads(int threads) { setNumberOfThreads(threads); } ///< as pcl::Poisson names it
  int getThreads() const { return getNumberOfThreads(); }       ///< as pcl::Poisson names it
  void setProgress(const Progress& progress) { progress_ = progress; }

  /// @throws std::invalid_argument without input mesh or as reconstructTexture() does; std::runtime_error likewise
  void process(pcl::TextureMesh& output);

  /// All that the last process() found out, its images among them.
  const TextureResult& getResult() const { return result_; }

  /// Writes the atlases of the last process() under the names that its materials carry ("texture_0.png" ...).
  void saveAtlases(const std::string& folder) const;

private:
  pcl::PolygonMeshConstPtr input_mesh_;
  pcl::TextureMesh::ConstPtr input_layout_;
  std::vector<TextureView> views_;
  TextureOptions options_;
  Progress progress_;
  TextureResult result_;
};
} // namespace fresco
#include <fresco/texture/impl/texture_reconstruction.hpp>
