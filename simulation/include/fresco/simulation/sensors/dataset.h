// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/progress.h>
#include <fresco/simulation/sensors/laser.h>
#include <fresco/simulation/sensors/photograph.h>
#include <string>
namespace fresco::simulation {
/// What the virtual scanner and camera produce.
struct DatasetOptions {
  int stations = 6; ///< laser scans, >= 1
  LaserOptions laser;
  int rooms = 8;                  ///< of a storey of the scene office, 4..32
  int storeys = 1;                ///< of the scene office, 1..2
  bool turned = false;            ///< each scan in a frame turned arbitrarily: its z axis tells nothing
  int views = 60;                 ///< photographs, >= 1; 0 = none
  int width = 1280, height = 960; ///< pixels of a photograph, 16..20000
  bool panoramas = false;         ///< one from each station, JPEG
  int panorama_height = 2048;     ///< pixels, 8..10000; twice as wide
  bool survey = false;            ///< also all of it as one file, survey.e57
  bool labels = false;            ///< scans have a field `label`, see PointLabel
  double focal = 0.9;             ///< focal length / width, > 0.1
  float exposure_spread = 0.2f;   ///< brightness of photographs is 1 +- this, 0..0.9
  float sensor_noise = 0.6f;      ///< deviation, grey levels of 0..255, >= 0
  float vignetting = 1.f;         ///< light in the photographs' corners / in their middle, 0.1..1
  float response = 0.f;           ///< strength of the photographs' S-shaped tone curve, 0..1
  float blur = 0.f;               ///< deviation of the photographs' blur, pixels, 0..20
  int intruder = 0;               ///< somebody stands in every Nth photograph, >= 0; 0 = in none
  double pose_noise = 0;          ///< deviation of the written cameras' positions, metres, 0..1
  double turn_noise = 0;          ///< deviation of their directions, degrees, 0..10
  double photographed = 1;        ///< share of the scene along x that photographs show, 0.05..1
  int sparse = 0;                 ///< points of the cameras' model as structure from motion finds, >= 0
  double sparse_noise = 0.01;     ///< deviation of a point from the surface per axis, metres, 0..1
  double sparse_outliers = 0.1;   ///< share of wrong points, 0..1
  int own_frame = 0;              ///< > 0: seed of a frame and a scale of the cameras' own; 0 = that of the scans
  int jpeg_quality = 95;          ///< 1..100
  int rgbd_frames = 0;            ///< of an RGB-D camera carried around, in rgbd/; 0..100000
  int rgbd_width = 640, rgbd_height = 480; ///< pixels, 16..20000
  bool truth_images = false;               ///< also the photographs as exact ones with the same tone curve, as PNG
  float max_edge = 0.1f;                   ///< metres, longest side of the faces of rooms, 0.02..10
  std::uint64_t seed = 1;
  int threads = 0; ///< 0 = all cores; the result does not depend on it
};

/// Writes the dataset of `scene` (conference_room, apartment, office, or a mesh file) into `folder`:
/// scans/scan_NN.pcd, panoramas/scan_NN.jpg, images/view_NNN.jpg, truth_images/view_NNN.png, truth.ply (vertex colours; field `returns`: laser
/// points on the faces around a vertex), exposures.txt, cameras/ (COLMAP text), own_frame.txt, survey.e57, poses.txt. Files appear whole;
/// poses.txt comes last and is removed first, so a folder that has it is complete.
/// @throws std::invalid_argument for an option out of range
/// @throws std::runtime_error "PATH: reason" for a file that cannot be read or written, or a scene without free place
void writeDataset(const std::string& scene, const std::string& folder, const DatasetOptions& options,
                  const Progress& progress = {});

/// The scene of that name or file. @throws as writeDataset
Scene loadScene(const std::string& scene, float max_edge);
} // namespace fresco::simulation
