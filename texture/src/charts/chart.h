// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "charts/texel_spans.h"
#include "views/patch_mesh.h"
#include <memory>
#include <vector>
namespace fresco::texture {
constexpr int least_atlas = 64;     ///< texels along a side where no photograph tells
constexpr int largest_atlas = 8192; ///< texels along a side: every graphics card takes it

/// Faces projected along one direction into a rectangle of texels.
struct Chart {
  std::vector<int> faces; ///< of the mesh, joined by edges, those that decided on the axis first
  Eigen::Vector3f axis;   ///< unit; every face is turned towards it
  Eigen::Matrix<double, 2, 3> T_texel =
      Eigen::Matrix<double, 2, 3>::Zero(); ///< texel = T_texel * vertex + offset; texel i covers i .. i+1
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();
  /// F, of a layout that was given: texel of the atlas = map * (vertex, 1) of each face; null otherwise.
  std::shared_ptr<const std::vector<Eigen::Matrix<double, 2, 4>>> given;
  int width = 0, height = 0;    ///< texels, border included
  OwnedTexels texels;           ///< by the patches that give them their colours
  int atlas = -1, x = 0, y = 0; ///< place of the upper left texel

  Eigen::Vector2d texel(const Eigen::Vector3f& vertex) const { return T_texel * vertex.cast<double>() + offset; }
};

/// Faces with what segmentation asks of them.
struct FaceGraph {
  Points normals;             ///< 3xF unit; (0,0,0) without area
  Points smooth_normals;      ///< 3xF, of the surroundings
  Eigen::VectorXf areas;      ///< F
  Eigen::Matrix3Xi neighbors; ///< 3xF
  std::vector<int> seeds;     ///< faces with area, from the flattest surroundings to the roughest
};

FaceGraph buildFaceGraph(const TriangleMesh& mesh, int threads);

/// The value that `share` of all the weight does not exceed.
/// @param values with their weights, at least one
double weightedQuantile(std::vector<std::pair<double, double>> values, double share);

/// Groups `faces` into charts whose faces are all turned towards the chart's axis, large ones first.
/// @param faces subset of graph.seeds, in that order
std::vector<Chart> segmentFaces(const FaceGraph& graph, const std::vector<int>& faces);
} // namespace fresco::texture
