// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "photographs/view_parts.h"
#include <list>
#include <memory>
#include <mutex>
namespace fresco::texture {
/// Photographs and parts of panoramas as 8-bit RGB, read when first asked for; the ones asked for last are kept within a limit of memory. May
/// be used by several threads at a time.
class PhotoStore {
public:
  /// What a file holds: RGB without its fringe, and blankPixels().
  struct Photo {
    std::shared_ptr<const Image> image, unblank;
    int fringe = 0; ///< fringeWidth()
  };

  PhotoStore(const std::vector<ViewPart>& views, std::size_t most_bytes);

  /// @throws std::runtime_error naming the photograph if it cannot be read or is of another size than its camera
  std::shared_ptr<const Image> get(Index view);

  /// Where the photograph is to be used, one channel: 255, else 0, as for its blank pixels. Not kept. Empty: everywhere.
  /// @throws std::runtime_error as get(), naming the mask
  Image mask(Index view);

  /// blankPixels() of what was given, a whole panorama.
  std::shared_ptr<const Image> unblank(Index view);

  /// fringeWidth() of the same.
  int fringe(Index view);

  std::size_t mostBytes() const { return most_bytes_; }
  /// Keeps so much less while something else made of the photographs needs memory.
  void setAside(std::size_t bytes);
  /// Forgets all photographs unless every one is kept: the next pass in the same order would find none in time.
  void dropUnlessAll();

private:
  void drop();
  void dropOldest();
  Photo load(Index view);
  Photo panoramaOf(Index view);
  void keep(Index view, Photo photo);

  /// Null: not read, or no longer kept; that nothing is blank stays known.
  struct Slot : Photo {
    std::list<Index>::iterator recent;
  };
  const std::vector<ViewPart>& views_;
  Photo panorama_; ///< the one cut last, wrapped
  int panorama_view_ = -1;
  std::size_t most_bytes_, aside_ = 0, bytes_ = 0;
  std::vector<Slot> slots_;
  std::list<Index> recent_; ///< kept views, the one asked for last in front
  std::mutex mutex_;
};

constexpr double clear_gain = 0.9;     ///< share of an error that is left: what lowers it less may be chance
constexpr Index fewest_samples = 12;   ///< for a median to count
constexpr Index median_samples = 2000; ///< of a view or a pair of views: more hardly change a median
constexpr std::uint8_t mid_grey = 128; ///< where nothing is known; masks and alpha use what is not darker
constexpr int interpolation_reach = 2; ///< pixels to either side of a place that a colour there is made of

/// 0 also where interpolation would reach what is.
Image withinReach(Image mask);

/// Colour at a place in pixels, 0..255, by Catmull-Rom interpolation; places outside are moved to the border.
Eigen::Vector3f samplePhoto(const Image& photo, float x, float y);

/// The same by bilinear interpolation.
Eigen::Vector3f samplePhotoQuickly(const Image& photo, float x, float y);

/// Rounded to a pixel's three bytes.
inline void storeColor(const Eigen::Vector3f& color, std::uint8_t* pixel)
{
  for (int c = 0; c < 3; ++c)
    pixel[c] = std::clamp(color[c], 0.f, 255.f) + 0.5f;
}
} // namespace fresco::texture
