// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/surface/core/mesh_distance.h>
#include <pcl/surface/processing.h>
#include <string>
#include <utility>
namespace fresco {
/// PCL face of measureMeshDistance(); setters: see MeshDistanceOptions. process() puts out the input mesh coloured by
/// its distance to the reference (red = zero, green, blue = large), with the distances as field "distance".
class FRESCO_EXPORT MeshDistance : public pcl::MeshProcessing {
public:
  using Ptr = pcl::shared_ptr<MeshDistance>;
  using ConstPtr = pcl::shared_ptr<const MeshDistance>;

  void setReferenceMesh(const pcl::PolygonMeshConstPtr& reference) { reference_ = reference; }
  pcl::PolygonMeshConstPtr getReferenceMesh() const { return reference_; }
  void setVertexToVertex(bool vertex_to_vertex) { options_.vertex_to_vertex = vertex_to_vertex; }
  bool getVertexToVertex() const { return options_.vertex_to_vertex; }
  void setNumberOfSamples(int samples) { options_.samples = samples; }
  int getNumberOfSamples() const { return options_.samples; }
  void setNumberOfNormalSamples(int samples) { options_.normal_samples = samples; }
  int getNumberOfNormalSamples() const { return options_.normal_samples; }
  void setSeed(std::uint64_t seed) { options_.seed = seed; }
  std::uint64_t getSeed() const { return options_.seed; }
  void setNumberOfThreads(int threads) { options_.threads = threads; }
  int getNumberOfThreads() const { return options_.threads; }
  /// As setNumberOfThreads().
  void setThreads(int threads) { options_.threads = threads; }
  int getThreads() const { return options_.threads; }
  void setOptions(const MeshDistanceOptions& options) { options_ = options; }
  const MeshDistanceOptions& getOptions() const { return options_; }
  /// Called between steps. If it answers false, Cancelled is thrown.
  void setProgress(Progress progress) { progress_ = std::move(progress); }

  /// The distance that is blue; 0 = the largest that occurs.
  void setLargestColor(float largest) { largest_color_ = largest; }
  float getLargestColor() const { return largest_color_; }

  /// Hides MeshProcessing::process(), which is not virtual and crashes without an input. `output` may be the input
  /// mesh.
  /// @throws std::invalid_argument without input or reference mesh, and as measureMeshDistance()
  void process(pcl::PolygonMesh& output);

  /// Measures without making a mesh. @throws as process()
  const MeshDistanceResult& compute();

  /// Of the last process() or compute().
  const MeshDistanceResult& getResult() const { return result_; }

protected:
  void performProcessing(pcl::PolygonMesh& output) override;
  std::string getClassName() const override { return "MeshDistance"; }

private:
  TriangleMesh measureInput();
  pcl::PolygonMeshConstPtr reference_;
  MeshDistanceOptions options_;
  Progress progress_;
  float largest_color_ = 0.f;
  MeshDistanceResult result_;
};
} // namespace fresco
#include <fresco/surface/impl/mesh_distance.hpp>
