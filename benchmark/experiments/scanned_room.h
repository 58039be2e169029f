// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/simulation/scene/places.h>
#include <fresco/simulation/sensors/dataset.h>
using namespace fresco::simulation;
namespace fresco {
/// A scene that is scanned and not photographed: light is coarse.
struct ScannedRoom {
  /// @param name as loadScene()
  /// @param closed a mesh is a closed room in metres, its floor at z = 0
  ScannedRoom(const std::string& name, int station_count, int threads, bool closed = false)
      : scene(load(name, closed)), rays(scene.mesh), light(bakeLight(scene, rays, coarse()))
  {
    const ScenePlaces places = sampleSurface(scene, 4000, 1);
    stations = chooseStations({scene, rays, places, 1, threads}, station_count);
  }
  LitScene lit() const { return {scene, rays, light}; }

  struct PlacedScan {
    LaserScan scan;
    Eigen::Matrix4d T_room_scan; ///< in the frame of the scene's vertices
  };
  /// A scan from a station, at any yaw and a small tilt.
  PlacedScan scanFrom(Index station, const LaserOptions& laser) const
  {
    const auto number = static_cast<int>(station);
    const Eigen::Vector3d place = stations.col(station).cast<double>() + scene.mesh.origin;
    Eigen::Matrix4d pose = randomPose(place, laser.seed, number);
    LaserScan scan = scanScene(lit(), pose, laser, number);
    pose.topRightCorner<3, 1>() -= scene.mesh.origin;
    return {std::move(scan), pose};
  }

  Scene scene;
  RayScene rays;
  Lightmap light;
  Points stations; ///< 3xN, in the frame of the scene's vertices

private:
  static Scene load(const std::string& name, bool closed)
  {
    Scene scene = loadScene(name, 0.1f);
    scene.furnished |= closed;
    return scene;
  }
  static LightingOptions coarse()
  {
    LightingOptions lighting;
    lighting.spacing = 0.5f;
    lighting.gather_packets = 1;
    return lighting;
  }
};
} // namespace fresco
