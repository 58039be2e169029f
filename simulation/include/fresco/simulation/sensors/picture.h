// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <vector>
namespace fresco::simulation {
/// RGB picture, display values 0..1, with all its halvings, so that it can be looked up without aliasing.
class Picture {
public:
  Picture(int width, int height, const Eigen::Vector3f& color);

  int width() const { return levels_.front().width; }
  int height() const { return levels_.front().height; }
  Eigen::Vector3f& pixel(int x, int y) { return levels_.front().at(x, y); }
  const Eigen::Vector3f& pixel(int x, int y) const { return levels_.front().at(x, y); }

  /// To be called once all pixels are set.
  void buildLevels();

  /// Trilinear lookup; outside of 0..1 the border is repeated.
  /// @param u, v  0..1 from the left and from the top
  /// @param footprint of the asking pixel, in pixels of this picture
  Eigen::Vector3f sample(float u, float v, float footprint) const;

private:
  struct Level {
    int width = 0, height = 0;
    std::vector<Eigen::Vector3f> data;
    Eigen::Vector3f& at(int x, int y) { return data[y * width + x]; }
    const Eigen::Vector3f& at(int x, int y) const { return data[y * width + x]; }
  };
  static Level halve(const Level& fine);
  static Eigen::Vector3f bilinear(const Level& level, float u, float v);
  std::vector<Level> levels_;
};
} // namespace fresco::simulation
