// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/simulation/scene/scene.h>
#include <map>
#include <string>
#include <tuple>
#include <vector>
namespace fresco::simulation {
/// Materials of the six sides of a box: -x +x -y +y -z +z, as seen from outside.
using BoxMaterials = std::array<int, 6>;

inline BoxMaterials allSides(int material) { return {material, material, material, material, material, material}; }

/// Axis-aligned box of a union of boxes. Later boxes override earlier ones.
struct Box {
  Eigen::Vector3f min, max;
  BoxMaterials materials;
  bool solid = true; ///< false: carves free space
};

/// Ring of a body of revolution, in its own frame.
struct ProfilePoint {
  float radius = 0, z = 0; ///< metres
};

/// Knot of a swept body: position, half width and half thickness of the cross section.
struct SweepKnot {
  Eigen::Vector3f position;
  float half_width = 0.01f, half_thickness = 0.01f; ///< metres
};

/// Puts a scene together from closed solids with outward faces. Bodies are described in a local frame,
/// which place() and beginObject() set.
class SceneBuilder {
public:
  SceneBuilder(std::string name, float max_edge);

  int add(const Material& material);

  /// Bodies that follow stand in `T_world_object` and are patterned in the object's frame.
  void beginObject(const std::string& name, const Eigen::Isometry3f& T_world_object = Eigen::Isometry3f::Identity());

  /// Frame of the bodies that follow within the object.
  void place(const Eigen::Isometry3f& T_object_body) { T_world_body_ = T_world_object_ * T_object_body; }

  /// Surface of the union of boxes without any face inside it;
  /// no side of a cell is longer than the longest edge allowed.
  /// @param background_solid true for rooms: boxes with solid = false are the free space
  void boxes(const std::vector<Box>& boxes, bool background_solid = false);

  /// Body of revolution about z. The profile runs from the axis at the bottom
  /// to the axis at the top with the body on its left.
  void lathe(const std::vector<ProfilePoint>& profile, int material, int segments = 24);

  /// Elliptic cross sections along a line of knots, closed at both ends.
  /// @param width_axis direction that half_width is measured along; made perpendicular to the line
  void sweep(const std::vector<SweepKnot>& knots, const Eigen::Vector3f& width_axis, int material);
  void tube(const std::vector<Eigen::Vector3f>& line, float radius, int material);

  /// Ellipsoid-like cushion: |x/a|^p + |y/b|^p + |z/c|^p = 1 about the local origin, p = 4.
  void cushion(const Eigen::Vector3f& half_axes, int material);

  void lamp(const Lamp& lamp) { scene_.lamps.push_back(lamp); }
  Scene finish();

private:
  struct Corner {
    Eigen::Vector3f position, normal; ///< in the body's frame
  };
  using Lattice = std::vector<std::vector<Corner>>;
  void cell(const std::array<Corner, 4>& corners, int material);
  void closedLattice(const Lattice& rows, int material);
  int vertex(const Eigen::Vector3f& local);
  int part(int material);

  Scene scene_;
  float max_edge_;
  std::vector<Eigen::Vector3f> vertices_;
  std::vector<std::array<int, 3>> faces_;
  std::map<std::tuple<int, int, int>, int> welded_; ///< of the current body, keys in units of 10 micrometres
  std::map<int, int> part_of_material_;             ///< of the current object
  Eigen::Isometry3f T_world_object_ = Eigen::Isometry3f::Identity(), T_world_body_ = Eigen::Isometry3f::Identity();
};

/// Rotation about z by `degrees`, then a shift.
Eigen::Isometry3f standing(const Eigen::Vector3f& at, float degrees = 0.f);
} // namespace fresco::simulation
