// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/surface/core/mesh_distance.h>
#include <nlohmann/json.hpp>
#include <string>
namespace fresco {
/// What was compared with what.
struct Comparison {
  std::string mesh_file, reference_file;
  Index mesh_vertices = 0, mesh_faces = 0, reference_vertices = 0, reference_faces = 0;
  MeshDistanceOptions options;
  MeshDistanceResult result;
};

/// The table of distances (absolute and in % of the diagonal), normals and topology, for people.
std::string comparisonText(const Comparison& comparison);

/// All numbers; distances in the unit of the meshes, angles in degrees.
nlohmann::json comparisonJson(const Comparison& comparison);
} // namespace fresco
