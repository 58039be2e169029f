// SPDX-License-Identifier: BSD-3-Clause
#include "compare_report.h"
#include <cstdio>
#include <fresco/core/require.h>
namespace fresco {
namespace {
template <typename... Values>
std::string format(const char* pattern, Values... values)
{
  char line[256];
  std::snprintf(line, sizeof(line), pattern, values...);
  return line;
}

std::string distanceLine(const char* label, const DistanceStatistics& d, double diagonal)
{
  const double percent = 100.0 / diagonal;
  return format("%-20s %11.6g %11.6g %11.6g  %10.6g %10.6g %10.6g\n", label, d.max, d.mean, d.rms, percent * d.max,
                percent * d.mean, percent * d.rms);
}

std::string distanceLines(const std::string& title, const TwoSidedDistance& distance, double diagonal)
{
  return format("%-20s %11s %11s %11s  %10s %10s %10s\n", title.c_str(), "max", "mean", "RMS", "max", "mean", "RMS") +
         distanceLine("  mesh to reference", distance.to_reference, diagonal) +
         distanceLine("  reference to mesh", distance.from_reference, diagonal) +
         distanceLine("  symmetric", distance.symmetric, diagonal);
}

std::string normalLine(const char* label, const NormalDeviation& n)
{
  return format("%-20s %11.4f %11.4f %11.4f  %10.4f\n", label, n.mean, n.median, n.percentile95,
                100.0 * n.share_above_20);
}

std::string topologyLine(const char* label, Index vertices, Index faces, const MeshTopology& t)
{
  return concat(format("%-12s", label), " V ", vertices, "  F ", faces, "  boundary edges ", t.boundary_edges,
                "  non-manifold edges ", t.nonmanifold_edges, "  components ", t.components, "  watertight ",
                t.watertight ? "yes" : "no", "\n");
}

nlohmann::json distanceJson(const DistanceStatistics& d, double diagonal)
{
  const double percent = 100.0 / diagonal;
  return {{"max", d.max},
          {"mean", d.mean},
          {"rms", d.rms},
          {"max_percent", percent * d.max},
          {"mean_percent", percent * d.mean},
          {"rms_percent", percent * d.rms},
          {"count", d.count}};
}

nlohmann::json distanceJson(const TwoSidedDistance& distance, double diagonal)
{
  return {{"mesh_to_reference", distanceJson(distance.to_reference, diagonal)},
          {"reference_to_mesh", distanceJson(distance.from_reference, diagonal)},
          {"symmetric", distanceJson(distance.symmetric, diagonal)}};
}

nlohmann::json normalJson(const NormalDeviation& n)
{
  return {{"mean", n.mean},
          {"median", n.median},
          {"percentile95", n.percentile95},
          {"percent_above_20", 100.0 * n.share_above_20},
          {"count", n.count}};
}

nlohmann::json meshJson(const std::string& file, Index vertices, Index faces, const MeshTopology& t)
{
  return {{"file", file},
          {"vertices", vertices},
          {"faces", faces},
          {"referenced_vertices", t.referenced_vertices},
          {"edges", t.edges},
          {"boundary_edges", t.boundary_edges},
          {"nonmanifold_edges", t.nonmanifold_edges},
          {"nonmanifold_vertices", t.nonmanifold_vertices},
          {"inconsistent_edges", t.inconsistent_edges},
          {"components", t.components},
          {"euler", t.euler},
          {"watertight", t.watertight}};
}
} // namespace

std::string comparisonText(const Comparison& c)
{
  const MeshDistanceResult& r = c.result;
  const double diagonal = r.reference_diagonal;
  std::string text = format("%-20s %35s  %32s\n", "", "absolute distance", "w.r.t. b-box diagonal (%)");
  text += distanceLines(c.options.vertex_to_vertex ? "vertex to vertex" : "vertices", r.vertices, diagonal);
  if (r.surface.symmetric.count > 0)
    text += distanceLines("surface samples", r.surface, diagonal);
  text += format("reference diagonal   %11.6g\n", diagonal);
  if (r.normals_to_reference.count > 0) {
    text += format("\n%-20s %11s %11s %11s  %10s\n", "normals (degrees)", "mean", "median", "95 %", "% above 20");
    text += normalLine("  mesh to reference", r.normals_to_reference);
    text += normalLine("  reference to mesh", r.normals_from_reference);
    if (r.inside_out)
      text += "  the mesh is inside out; the angles are those of the turned mesh\n";
  }
  return text + "\n" + topologyLine("mesh", c.mesh_vertices, c.mesh_faces, r.mesh_topology) +
         topologyLine("reference", c.reference_vertices, c.reference_faces, r.reference_topology);
}

nlohmann::json comparisonJson(const Comparison& c)
{
  const MeshDistanceResult& r = c.result;
  const double diagonal = r.reference_diagonal;
  nlohmann::json json = {
      {"mesh", meshJson(c.mesh_file, c.mesh_vertices, c.mesh_faces, r.mesh_topology)},
      {"reference", meshJson(c.reference_file, c.reference_vertices, c.reference_faces, r.reference_topology)},
      {"reference_diagonal", diagonal},
      {"vertex_to_vertex", c.options.vertex_to_vertex},
      {"seed", c.options.seed},
      {"vertices", distanceJson(r.vertices, diagonal)}};
  if (r.surface.symmetric.count > 0)
    json["surface"] = distanceJson(r.surface, diagonal);
  if (r.normals_to_reference.count > 0)
    json["normals"] = {{"mesh_to_reference", normalJson(r.normals_to_reference)},
                       {"reference_to_mesh", normalJson(r.normals_from_reference)},
                       {"inside_out", r.inside_out}};
  return json;
}
} // namespace fresco
