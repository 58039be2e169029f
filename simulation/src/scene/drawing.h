// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/simulation/sensors/picture.h>
#include <fresco/simulation/sensors/random.h>
#include <string>
#include <vector>
namespace fresco::simulation {
struct Pen {
  Eigen::Vector3f color = {0.1f, 0.1f, 0.15f};
  float width = 4.f; ///< pixels
  float shake = 0.f; ///< pixels that a hand strays
};

/// Draws into a picture with smooth edges. Lengths are pixels, (0,0) is the upper left corner.
class Drawing {
public:
  Drawing(Picture& picture, std::uint64_t seed) : picture_(picture), random_(seed, 77, 0) {}

  void line(const std::vector<Eigen::Vector2f>& points, const Pen& pen);
  void rectangle(const Eigen::Vector2f& min, const Eigen::Vector2f& max, const Eigen::Vector3f& color);
  void disc(const Eigen::Vector2f& center, float radius, const Eigen::Vector3f& color);

  /// Capital letters, digits and a few signs; a newline starts a new line.
  /// @param at     upper left corner
  /// @param height of a letter
  void text(const std::string& words, Eigen::Vector2f at, float height, const Pen& pen);

  CounterRandom& random() { return random_; }

private:
  void segment(const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Pen& pen);
  void blend(int x, int y, const Eigen::Vector3f& color, float share);
  Picture& picture_;
  CounterRandom random_;
};
} // namespace fresco::simulation
