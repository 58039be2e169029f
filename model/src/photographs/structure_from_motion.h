// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/camera.h>
#include <fresco/core/progress.h>
#include <string>
#include <vector>
namespace fresco::model {
/// Cameras of photographs by the program `colmap` (Schoenberger & Frahm 2016, "Structure-from-Motion Revisited"), in steps
/// that leave files in `folder`, so that a finished one need not be done again.
class StructureFromMotion {
public:
  /// @param images of the photographs @param names of these, relative to `images`
  StructureFromMotion(std::string images, std::vector<std::string> names, std::string folder, int threads);

  std::string database() const { return folder_ + "/database.db"; }
  std::string model() const { return folder_ + "/model"; } ///< cameras.txt, images.txt, points3D.txt

  void findFeatures(const Progress& progress) const;
  void matchFeatures(const Progress& progress) const;
  /// Writes the largest model that is found. @return what there is to say of the others and of photographs without a place
  std::vector<std::string> findCameras(const Progress& progress) const;

private:
  void run(std::vector<std::string> words, const std::string& counted, const Progress& progress) const;
  std::string images_;
  std::vector<std::string> names_;
  std::string folder_;
  int threads_;
};

/// @throws std::runtime_error with a line that tells what is missing, the program or photographs: two at least
void requireStructureFromMotion(const std::string& images, std::size_t count);

/// How many pairs of photographs are matched: all of up to 200, else the neighbours in order of names.
std::size_t pairsToMatch(std::size_t photographs);

/// Whether photographs are to share one camera: they are of one size, and none tells by EXIF what took it. Else colmap takes
/// one for each kind that EXIF tells, and one for each photograph without.
bool isOneCamera(const std::string& images, const std::vector<std::string>& names, int threads);

/// Share of the work that a line of the program's output tells by "... [k/n...]" or "(k)": 0..1, or -1.
double shareToldBy(const std::string& line, std::size_t count);
} // namespace fresco::model
