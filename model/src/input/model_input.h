// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "input/rgbd.h"
#include "input/scan_pictures.h"
#include <fresco/core/camera.h>
#include <fresco/io/pose_file.h>
#include <fresco/io/scan_file.h>
#include <optional>
#include <string>
#include <vector>
namespace fresco::model {
/// A picture of all directions, taken where a scan was.
struct Panorama {
  std::string file;
  Index scan = 0;
};

/// A photograph or panorama as a file.
struct PictureFile {
  std::string file, mask;              ///< mask: "" = none, see maskFileOf()
  const CameraModel* camera = nullptr; ///< nullptr: of any size
  bool panorama = false;
};

/// What a model is made from, however it was laid out: scans or one cloud, or RGB-D frames, with or without photographs.
struct ModelInput {
  std::string folder;                ///< as given: a folder or a file
  std::string layout;                ///< what it was taken for, see Layout::name
  std::vector<std::string> found;    ///< a line for each thing in it and what it is taken for
  std::vector<std::string> warnings; ///< what was left out, a sentence each
  std::vector<ScanPath> scans;       ///< in the order of the names of their files; empty for RGB-D
  /// The scans are parts of one cloud in the frame of the world, seen from places that are not known or that the points
  /// themselves tell: nothing is registered, and no scanner stands at the origin. Without scans: the points that structure
  /// from motion finds are the cloud.
  bool is_cloud = false;
  std::vector<Eigen::Vector3d> sensor_path; ///< of a cloud: where the sensor was, world; may be empty
  std::vector<double> sensor_times;         ///< when it was there, ascending, by the clock of the points; or empty
  std::vector<Pose> poses;                  ///< world from scan; empty where neither folder nor scans have any
  CameraSet cameras;                        ///< photographs; no view where the folder has none
  SparsePoints sparse;                      ///< points of the model that `cameras` are of; none where it has none
  std::string camera_folder;                ///< of the model that `cameras` and `sparse` are of
  std::string images;                       ///< folder of the photographs
  std::vector<std::string> unplaced;        ///< names of photographs that have no cameras, which are still to be found
  std::string video; ///< file whose frames are the photographs, or the colours of the RGB-D frames
  std::vector<Panorama> panoramas;
  ScanPictures inside; ///< pictures in the files of the scans
  std::optional<RgbdFolder> rgbd;

  bool hasPictures() const
  {
    return rgbd || !cameras.views.empty() || !unplaced.empty() || !panoramas.empty() || !inside.pictures.empty();
  }
  /// Whether cameras are yet to be brought into the frame of the scans, or to be found there.
  bool alignsCameras() const { return !scans.empty() && (!unplaced.empty() || !sparse.empty()); }
  /// Whether cameras are yet to be found, of photographs or of frames of a video.
  bool findsCameras() const { return !unplaced.empty() || (!video.empty() && !rgbd); }
  std::vector<std::string> files() const;    ///< all that later stages read
  std::vector<PictureFile> pictures() const; ///< photographs or colour images of the frames, then panoramas
};

/// Looks at a folder or file, tells its layout (docs/inputs.md) and reads everything small (poses, cameras).
/// @param as what it is taken for: scans, cloud, rgbd or photographs; "" = what it looks like
/// @param depth_unit of RGB-D, metres; 0 = that of the layout
/// @throws std::runtime_error naming what is missing or does not fit together, what two layouts claim, or, where no layout
///         fits, what was found
ModelInput readModelInput(const std::string& path, const std::string& as = "", double depth_unit = 0);

/// "6 scans, 60 photographs".
std::string describe(const ModelInput& input);

/// Decodes every photograph, panorama and mask once, so that a damaged one is found before hours of work, not after.
/// @throws std::runtime_error naming the first that is damaged, has another size than its camera or photograph or is a panorama not
///         twice as wide as high
void checkPhotographs(const ModelInput& input, int threads);
} // namespace fresco::model
