// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/progress.h>
#include <fresco/search/ray_scene.h>
#include <fresco/simulation/scene/scene.h>
namespace fresco::simulation {
struct LightingOptions {
  float spacing = 0.034f;   ///< metres between places on a surface where light is computed, > 0
  int gather_packets = 4;   ///< bundles of 16 rays that look for light coming from other surfaces, 1..64
  float brightness = 0.80f; ///< display value that white has under the scene's mean light
  int threads = 0;          ///< 0 = all cores; the result does not depend on it
};

/// Light that falls on every cell, on a lattice of its own: diffuse light from area lamps with soft shadows and one
/// gathered bounce over a two-bounce estimate. Surfaces are matt, so the light does not depend on the onlooker.
class Lightmap {
public:
  /// Display factor (power 1/2.2 of the irradiance) per channel; multiply with a display albedo.
  Eigen::Vector3f at(int cell, const CellPoint& where) const;

  struct Lattice {
    std::size_t first = 0;
    int columns = 2, rows = 2; ///< nodes, both borders included
  };

private:
  friend Lightmap bakeLight(const Scene&, const RayScene&, const LightingOptions&, const Progress&);
  void layOut(const Scene& scene, float spacing);
  void expose(const LightingOptions& options);
  std::vector<Lattice> lattices_; ///< per cell
  std::vector<Eigen::Vector3f> nodes_;
};

/// @throws std::runtime_error if `progress` asks to stop
Lightmap bakeLight(const Scene& scene, const RayScene& rays, const LightingOptions& options,
                   const Progress& progress = {});

/// Display value after the shoulder that keeps lamps from clipping: x up to 0.62, then up to 0.82 at most, so that a
/// photograph that is 20 % brighter still shows everything.
Eigen::Vector3f toneCurve(const Eigen::Vector3f& x);

/// A scene with its light: what every sensor sees.
struct LitScene {
  const Scene& scene;
  const RayScene& rays;
  const Lightmap& light;
};

const Material& materialAt(const Scene& scene, int face);

/// Display albedo 0..1 of the surface at a hit. @param footprint metres, size of the asking pixel on the surface
Eigen::Vector3f surfaceAlbedo(const Scene& scene, const RayHit& hit, float footprint);

/// Display colour 0..1 of the lit surface at a hit. @param footprint metres, size of the asking pixel on the surface
Eigen::Vector3f surfaceColor(const LitScene& lit, const RayHit& hit, float footprint);
} // namespace fresco::simulation
