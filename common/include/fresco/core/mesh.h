// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <fresco/core/export.h>
#include <fresco/core/types.h>
#include <map>
#include <string>
namespace fresco {
/// Indexed triangle mesh. Matrices of attributes are empty (0 columns) where the mesh has none.
struct FRESCO_EXPORT TriangleMesh {
  Points vertices;                                  ///< 3xV, relative to `origin`
  Faces faces;                                      ///< 3xF
  Points normals;                                   ///< 3xV unit, or 3x0
  Colors colors;                                    ///< 3xV, or 3x0
  std::map<std::string, Eigen::VectorXf> fields;    ///< further scalars per vertex, V each
  Eigen::Vector3d origin = Eigen::Vector3d::Zero(); ///< world = origin + vertex: keeps large coordinates exact

  Index vertexCount() const { return vertices.cols(); }
  Index faceCount() const { return faces.cols(); }
};

/// Corner `k` (0..2) of a face, without the mesh's origin.
inline Eigen::Vector3d faceCorner(const TriangleMesh& mesh, Index face, int k)
{
  return mesh.vertices.col(mesh.faces(k, face)).cast<double>();
}

/// Normal of the triangle a, b, c, which is counter-clockwise seen from its tip; its length is twice the area.
inline Eigen::Vector3d areaVector(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
{
  return (b - a).cross(c - a);
}

/// The same of a face.
inline Eigen::Vector3d areaVector(const TriangleMesh& mesh, Index face)
{
  return areaVector(faceCorner(mesh, face, 0), faceCorner(mesh, face, 1), faceCorner(mesh, face, 2));
}

/// @throws std::invalid_argument unless every index is in range, every referenced vertex finite, attributes 0 or V
FRESCO_EXPORT void validateMesh(const TriangleMesh& mesh);

/// 3xV, unit, mean of the adjacent face normals weighted by area; (0,0,0) at vertices without area.
FRESCO_EXPORT Points vertexNormals(const TriangleMesh& mesh, int threads = 0);

/// 3xF, unit; (0,0,0) for faces without area.
FRESCO_EXPORT Points faceNormals(const TriangleMesh& mesh, int threads = 0);

/// Sum of signed tetrahedra, length^3; positive for a closed mesh with faces counter-clockwise from outside.
FRESCO_EXPORT double signedVolume(const TriangleMesh& mesh);

/// length^2
FRESCO_EXPORT double surfaceArea(const TriangleMesh& mesh);

struct MeshTopology {
  Index edges = 0;
  Index boundary_edges = 0;       ///< one face
  Index nonmanifold_edges = 0;    ///< three faces or more
  Index inconsistent_edges = 0;   ///< two faces that run through it in the same direction
  Index nonmanifold_vertices = 0; ///< more than one fan of faces
  Index components = 0;           ///< of vertices joined by edges, unreferenced vertices left out
  Index referenced_vertices = 0;
  Index euler = 0;         ///< V - E + F over referenced vertices
  bool watertight = false; ///< closed, 2-manifold, consistently oriented, not empty
};

/// Faces with a repeated index are left out.
FRESCO_EXPORT MeshTopology meshTopology(const TriangleMesh& mesh);

/// 3xF: the faces with each corner moved to the first vertex of equal coordinates, so that neighbours share vertices.
FRESCO_EXPORT Faces weldedFaces(const TriangleMesh& mesh);

/// `mesh` without the vertices that no face names; attributes follow.
FRESCO_EXPORT TriangleMesh removeUnreferencedVertices(const TriangleMesh& mesh);
} // namespace fresco
