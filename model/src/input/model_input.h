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

/// What a model is made from: a folder of scans and photographs, or a folder of RGB-D frames.
struct ModelInput {
  std::string folder;
  std::vector<ScanPath> scans;       ///< in the order of the names of their files; empty for RGB-D
  std::vector<Pose> poses;           ///< world from scan; empty where neither folder nor scans have any
  CameraSet cameras;                 ///< photographs; no view where the folder has none
  SparsePoints sparse;               ///< points of the model that `cameras` are of; none where it has none
  std::string images;                ///< folder of the photographs
  std::vector<std::string> unplaced; ///< names of photographs that have no cameras, which are still to be found
  std::vector<Panorama> panoramas;
  ScanPictures inside; ///< pictures in the files of the scans
  std::optional<RgbdFolder> rgbd;

  bool hasPictures() const
  {
    return rgbd || !cameras.views.empty() || !unplaced.empty() || !panoramas.empty() || !inside.pictures.empty();
  }
  /// Whether cameras are yet to be brought into the frame of the scans, or to be found there.
  bool alignsCameras() const { return !unplaced.empty() || !sparse.empty(); }
  std::vector<std::string> files() const;    ///< everything that the model depends on
  std::vector<PictureFile> pictures() const; ///< photographs or colour images of the frames, then panoramas
};

/// Looks at a folder and reads everything small (poses, cameras). Folder of scans: `scans/*.pcd` (or another format; each
/// scan of a file of several is one), `panoramas/` (named as their scans), `poses.txt` (else the poses that the scans themselves have), `cameras/`,
/// `images/` (without `cameras/`: photographs whose cameras are to be found).
/// RGB-D: see readRgbdFolder(). In place of a folder: a file of scans (.e57, .ptx). Pictures
/// inside of an .e57 are taken too.
/// @throws std::runtime_error naming what is missing or does not fit together: neither kind, no scan, more or fewer
///         poses than scans, a photograph that is missing
ModelInput readModelInput(const std::string& folder);

/// "6 scans, 60 photographs".
std::string describe(const ModelInput& input);

/// Decodes every photograph, panorama and mask once, so that a damaged one is found before hours of work, not after.
/// @throws std::runtime_error naming the first that is damaged, has another size than its camera or photograph or is a panorama not
///         twice as wide as high
void checkPhotographs(const ModelInput& input, int threads);
} // namespace fresco::model
