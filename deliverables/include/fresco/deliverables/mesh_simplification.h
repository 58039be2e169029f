// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/deliverables/core/simplification.h>
#include <pcl/surface/processing.h>
#include <string>
#include <utility>
namespace fresco {
/// PCL face of simplifyMesh(); setters: see SimplificationOptions. Colours, normals and fields of the input mesh are kept.
class FRESCO_EXPORT MeshSimplification : public pcl::MeshProcessing {
public:
  using Ptr = pcl::shared_ptr<MeshSimplification>;
  using ConstPtr = pcl::shared_ptr<const MeshSimplification>;

  void setNumberOfFaces(Index faces) { options_.faces = faces; }
  Index getNumberOfFaces() const { return options_.faces; }
  void setMaximumError(double error) { options_.error = error; }
  double getMaximumError() const { return options_.error; }
  void setNumberOfThreads(int threads) { options_.threads = threads; }
  int getNumberOfThreads() const { return options_.threads; }
  void setThreads(int threads) { options_.threads = threads; } ///< as setNumberOfThreads()
  int getThreads() const { return options_.threads; }
  void setOptions(const SimplificationOptions& options) { options_ = options; }
  const SimplificationOptions& getOptions() const { return options_; }
  /// Called between steps. If it answers false, Cancelled is thrown.
  void setProgress(Progress progress) { progress_ = std::move(progress); }

  /// Hides MeshProcessing::process(), which is not virtual and crashes without an input. `output` may be the input mesh.
  /// @throws std::invalid_argument without input mesh, and as simplifyMesh()
  void process(pcl::PolygonMesh& output);

  /// Of the last process().
  const SimplificationFigures& getFigures() const { return figures_; }

protected:
  void performProcessing(pcl::PolygonMesh& output) override;
  std::string getClassName() const override { return "MeshSimplification"; }

private:
  SimplificationOptions options_;
  SimplificationFigures figures_;
  Progress progress_;
};
} // namespace fresco
#include <fresco/deliverables/impl/mesh_simplification.hpp>
