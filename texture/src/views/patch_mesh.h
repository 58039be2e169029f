// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/mesh.h>
#include <vector>
namespace fresco::texture {
constexpr float steep_cosine = 0.25f;  ///< of 75 degrees: beyond, pixels smear over four times their size
constexpr float crease_cosine = 0.77f; ///< of 40 degrees: normals of patches on scanned planes differ by less

/// The input mesh with its large faces cut into patches, each small enough to be seen or hidden as a whole.
struct PatchMesh {
  Points vertices;            ///< 3xV, those of the mesh first
  Points colors;              ///< 3xV 0..255, or 3x0 where the mesh has none
  Faces faces;                ///< 3xP
  Eigen::VectorXi parent;     ///< P, face of the mesh that the patch is part of
  Eigen::Matrix3Xi neighbors; ///< 3xP, patch across the edge from corner k to corner k+1, -1 = none or not unique
  Points normals;             ///< 3xP unit; (0,0,0) without area
  Eigen::VectorXf areas;      ///< P

  Index size() const { return faces.cols(); }
  Eigen::Matrix3f corners(Index i) const { return vertices(Eigen::all, faces.col(i)); } ///< columns
  Eigen::Vector3f middle(Index i) const
  {
    return vertices.col(faces(0, i)) / 3 + vertices.col(faces(1, i)) / 3 + vertices.col(faces(2, i)) / 3;
  }
};

/// Cuts every edge longer than `longest_edge` at its middle until none is left; the cuts of two neighbours meet.
PatchMesh cutFaces(const TriangleMesh& mesh, float longest_edge, int threads);

/// Cuts the marked patches into four, and their neighbours so that the cuts meet.
/// @param marked P
PatchMesh cutPatches(const PatchMesh& patches, const std::vector<char>& marked, int threads);

/// 3xF, face across the edge from corner k to corner k+1; -1 at boundaries and where more than two faces meet.
Eigen::Matrix3Xi faceNeighbors(const Faces& faces, int threads);
} // namespace fresco::texture
