// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/point_set.h>
#include <fresco/core/textured_mesh.h>
#include <vector>
namespace fresco::rendering {
/// Triangles in the form that a graphics system draws: every attribute once per vertex or once per face, no vertex that
/// is not used. Without faces the vertices are drawn as points. Empty matrices where there is no such attribute.
struct DrawMesh {
  Points vertices;                ///< 3xV
  Faces faces;                    ///< 3xF
  Points normals;                 ///< 3xV, unit
  Colors colors;                  ///< 3xV
  Colors face_colors;             ///< 3xF
  Eigen::Matrix2Xf texcoords;     ///< 2xV, v up
  std::vector<int> source;        ///< V, vertex of the mesh that it was made from
  std::vector<Index> face_source; ///< F, face of the mesh that it was made from; empty: all, in their order
};

/// F: what hangs on culled walls and ceilings, as sills and lamps do, and would float. A wall is connected surface seen from behind, a
/// tenth of the model at least and nearer than the rest; what is seen from the front, grows from it and is less than a tenth of it hangs.
/// @param eye in the world
std::vector<char> hangingFaces(const TriangleMesh& mesh, const Eigen::Vector3d& eye);

/// Shrinks faces of the mesh that it was made from to points, so that they are not seen.
void leaveOut(DrawMesh& drawn, const std::vector<char>& hidden);

/// The referenced vertices with their colours.
DrawMesh plainMesh(const TriangleMesh& mesh);

/// plainMesh() with normals: means of the adjacent faces, weighted by area, but not across edges that bend by more than
/// `crease_angle` (degrees), where a vertex is drawn once per face.
DrawMesh creasedMesh(const TriangleMesh& mesh, double crease_angle, int threads);

/// plainMesh() with the colour (n + 1) / 2 of the unit normal n as the colour of each face.
DrawMesh normalColoredMesh(const TriangleMesh& mesh, int threads);

/// (n + 1) / 2 of unit vectors as colours.
Colors normalColors(const Points& normals);

/// The faces that show atlas number `atlas`, with texture coordinates; -1: the faces without texture.
DrawMesh texturedPart(const TexturedMesh& model, int atlas);

/// The finite points; colours are its own, else grey by intensity, else (without normals) by height along z.
DrawMesh drawPoints(const PointSet& set);
} // namespace fresco::rendering
