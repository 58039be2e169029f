// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <fresco/search/ray_scene.h>
#include <fresco/simulation/scene/scene.h>
namespace fresco::simulation {
/// Points spread over the surface, equally dense everywhere, some of which a good set of places should see.
struct ScenePlaces {
  Points positions, normals; ///< 3xN
};
ScenePlaces sampleSurface(const Scene& scene, int count, std::uint64_t seed);

/// A scene with what planning needs.
struct PlanningInput {
  const Scene& scene;
  const RayScene& rays;
  const ScenePlaces& samples;
  std::uint64_t seed = 1;
  int threads = 0;
};

/// Where a sensor may stand: in free space (the faces around look at it), away from surfaces.
struct PlaceRules {
  std::vector<float> heights = {1.5f}; ///< metres above the floor, of furnished scenes
  float spacing = 0.4f;                ///< metres between places
  float clearance = 0.5f;              ///< metres to the nearest surface
  bool on_floor = true;                ///< nothing but the floor below
};

/// Of scenes that are meshes, places lie all around and inside; spacing and clearance follow the size of the mesh.
/// @return 3xP
/// @throws std::runtime_error if there is no such place
Points freePlaces(const PlanningInput& input, const PlaceRules& rules);

/// `count` laser stations: those that the scene gives, then others. Together they see as much as possible, each overlaps
/// with one chosen before.
/// @return 3xcount
/// @throws std::invalid_argument if the scene gives more
/// @throws std::runtime_error if there are fewer free places
Points chooseStations(const PlanningInput& input, int count);

/// Row p, column s: how well place p sees sample s, 0 not at all, 1 frontally from close by.
Eigen::MatrixXf viewQuality(const PlanningInput& input, const Points& places, float good_distance);

/// Middle-sized length of the scene: metres in rooms, else in proportion to the mesh.
float sceneUnit(const Scene& scene);
} // namespace fresco::simulation
