// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/point_set.h>
#include <fresco/core/point_stream.h>
#include <functional>
#include <memory>
#include <string>
#include <vector>
namespace fresco::model {
/// The points that a model is made of: a file per scan in a folder, all in one frame, with normals. All together may be
/// more than memory holds; no more than one file is in memory at a time.
class PlacedPoints {
public:
  explicit PlacedPoints(std::string folder) : folder_(std::move(folder)) {}

  /// An empty folder. @throws std::runtime_error if it cannot be made
  void clear() const;

  /// @param scan its number, >= 0; the others' files stay
  void write(Index scan, const PointSet& points) const;

  /// Waits for files that other ranks have written: a network drive may show them late.
  /// @throws std::runtime_error if there are fewer than `count` after a minute and a half
  void await(Index count) const;

  /// All points in windows, without viewpoints. @throws std::runtime_error if there is no file
  std::unique_ptr<PointStream> stream() const;

  /// Hands over file after file, with all that it has. @throws as stream()
  void forEach(const std::function<void(const PointSet&)>& receive) const;

  /// All points, or up to `most` of them where there are more, with the attributes that all files have: as many from each
  /// part of space, as far as it has them.
  PointSet sample(Index most) const;

  /// All points as one file, in windows. @throws as stream(), and if it cannot be written
  void writePly(const std::string& path) const;

private:
  std::vector<std::string> files() const;

  std::string folder_;
};

Index countPoints(const PointStream& points);
} // namespace fresco::model
