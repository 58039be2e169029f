// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <fresco/core/mesh.h>
#include <fresco/simulation/sensors/material.h>
#include <string>
#include <vector>
namespace fresco::simulation {
/// One material in one place.
struct Part {
  int material = 0;
  Eigen::Isometry3f T_part_world = Eigen::Isometry3f::Identity(); ///< patterns are fixed to the object
  float scale = 1.f;                                              ///< metres of pattern per unit of the scene
};

/// A quadrilateral (or a triangle: corner 3 equals corner 2), counter-clockwise from the free side. It is the unit that
/// light is stored for. Coordinates (s, t) of its corners: (0,0) (1,0) (1,1) (0,1),
/// affine on each of its two triangles.
struct Cell {
  std::array<int, 4> corners;             ///< columns of the mesh's vertices
  std::array<Eigen::Vector3f, 4> normals; ///< unit, of the smooth shape that the cell is a facet of
  int part = 0;
};

/// A lamp or a window: a rectangle that gives light.
struct Lamp {
  Eigen::Vector3f center, half_u, half_v; ///< metres; half_u x half_v points to the lit side
  Eigen::Vector3f color;                  ///< radiance, RGB, linear
};

/// Closed solid of the scene, as a range of faces: [begin, end).
struct SceneObject {
  std::string name;
  Index begin = 0, end = 0;
};

/// What the scanner and the camera look at. Metres, z up, origin on the floor.
struct Scene {
  std::string name;
  TriangleMesh mesh; ///< the truth: each face belongs to one cell
  std::vector<Cell> cells;
  std::vector<int> face_cell; ///< per face: 2 * cell + half
  std::vector<Part> parts;
  std::vector<Material> materials;
  std::vector<Lamp> lamps;
  std::vector<SceneObject> objects;
  float detail = 1.f;                ///< of light and of the places for stations, 0..1: whole floors get by with less
  bool furnished = true;             ///< a room of makeScene(): metres, stations stand on the floor
  std::vector<float> floors = {0.f}; ///< heights of the floors that stations stand on
  std::vector<Eigen::Vector3f> stations; ///< places that are scanned from before others are chosen
};

/// Unit; of a face as it lies in the frame of the vertices.
inline Eigen::Vector3f faceNormal(const TriangleMesh& mesh, Index face)
{
  const Eigen::Vector3i v = mesh.faces.col(face);
  const Eigen::Vector3f a = mesh.vertices.col(v[0]), b = mesh.vertices.col(v[1]), c = mesh.vertices.col(v[2]);
  return (b - a).cross(c - a).normalized();
}

/// Places on a cell, s and t in 0..1.
struct CellPoint {
  float s = 0, t = 0;
};

/// (s, t) of a point of a face. @param beta, gamma barycentric weights of the face's corners 1 and 2
inline CellPoint cellPoint(int half, float beta, float gamma)
{
  return half == 0 ? CellPoint{beta + gamma, gamma} : CellPoint{beta, beta + gamma};
}

/// Weights of the four corners at (s, t).
inline std::array<float, 4> cornerWeights(const CellPoint& at)
{
  if (at.s >= at.t)
    return {1 - at.s, at.s - at.t, at.t, 0};
  return {1 - at.t, 0, at.s, at.t - at.s};
}

inline Eigen::Vector3f cellPosition(const Scene& scene, const Cell& cell, const CellPoint& at)
{
  const auto weights = cornerWeights(at);
  Eigen::Vector3f position = Eigen::Vector3f::Zero();
  for (int k = 0; k < 4; ++k)
    position += weights[k] * scene.mesh.vertices.col(cell.corners[k]);
  return position;
}

/// @throws std::invalid_argument if `name` is not conference_room or apartment
Scene makeScene(const std::string& name, float max_edge = 0.1f);

struct OfficeOptions {
  int rooms = 8; ///< of a storey, 4..32
  std::uint64_t seed = 1;
  int storeys = 1; ///< 1..2
};

/// A floor of an office, see officeFloor(). @throws std::invalid_argument if an option is out of range
Scene makeOffice(const OfficeOptions& options, float max_edge = 0.4f);

/// A mesh as scene: with the colours of its vertices, or with a pattern by position under light from the sky. Faces
/// that have no area are left out.
/// @throws std::runtime_error if no face is left or a coordinate is not finite
Scene meshScene(const TriangleMesh& mesh);
} // namespace fresco::simulation
