// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/scene/furniture.h"
#include <cmath>
namespace fresco::simulation {
using Eigen::Vector3f;

namespace {
constexpr float gap = 0.003f; // metres between a wall and what hangs on it
Box solid(const Vector3f& min, const Vector3f& max, int material) { return {min, max, allSides(material), true}; }
} // namespace

void framedPicture(SceneBuilder& b, const Palette& p, const Spot& spot, const PicturePtr& picture)
{
  const float half_z = 0.3f, half_x = half_z * picture->width() / picture->height();
  b.beginObject("picture", spot.pose());
  const float bar = 0.025f;
  const PictureBox sheet{{-half_x, gap, -half_z}, {half_x, 0.012f, half_z}, 3, picture, p.black};
  const int frame = spot.seed % 2 ? p.walnut : p.black;
  b.boxes({solid({-half_x - bar, gap, -half_z - bar}, {half_x + bar, 0.028f, half_z + bar}, frame),
           {{-half_x, 0.012f, -half_z}, {half_x, 0.028f, half_z}, allSides(frame), false},
           {sheet.min, sheet.max, pictureSides(b, sheet), true}});
}

void whiteboard(SceneBuilder& b, const Palette& p, const Spot& spot)
{
  b.beginObject("whiteboard", spot.pose());
  const float x = 1.2f, z = 0.6f;
  const PictureBox board{{-x, gap, -z}, {x, 0.016f, z}, 3, drawWhiteboard({2400, 1200}, spot.seed), p.white_plastic};
  b.boxes({solid({-x - 0.02f, gap, -z - 0.02f}, {x + 0.02f, 0.024f, z + 0.02f}, p.chrome),
           {{-x, 0.016f, -z}, {x, 0.024f, z}, allSides(p.chrome), false},
           {board.min, board.max, pictureSides(b, board), true},
           solid({-0.6f, gap, -z - 0.035f}, {0.6f, 0.09f, -z - 0.02f}, p.chrome)});
  const Vector3f colors[] = {{0.12f, 0.2f, 0.6f}, {0.75f, 0.12f, 0.1f}, {0.1f, 0.45f, 0.2f}};
  for (int pen = 0; pen < 3; ++pen) {
    const float at = -0.4f + 0.21f * pen;
    b.tube({{at, 0.06f, -z - 0.0115f}, {at + 0.13f, 0.062f, -z - 0.0115f}}, 0.0085f, addPaint(b, colors[pen]));
  }
  b.box({0.3f, 0.035f, -z - 0.02f}, {0.44f, 0.085f, -z + 0.015f}, p.fabric_blue);
}

void wallClock(SceneBuilder& b, const Palette& p, const Spot& spot)
{
  b.beginObject("clock", spot.pose());
  b.place(Eigen::Isometry3f(Eigen::AngleAxisf(-1.5707963f, Vector3f::UnitX())));
  Material face;
  face.finish = Finish::picture;
  face.picture = drawClock({512, 512}, spot.seed);
  face.corner = {0.15f, 0.03f, 0.15f};
  face.right = {-0.3f, 0, 0}, face.down = {0, 0, -0.3f};
  b.lathe({{0, gap}, {0.15f, gap}, {0.165f, 0.01f}, {0.165f, 0.04f}, {0.15f, 0.045f}, {0.148f, 0.03f}, {0, 0.03f}},
          p.black, 48);
  const int dial = b.add(face);
  b.lathe({{0, 0.029f}, {0.148f, 0.029f}, {0.148f, 0.032f}, {0, 0.032f}}, dial, 48);
}

void socket(SceneBuilder& b, const Palette& p, const Spot& spot)
{
  b.beginObject("socket", spot.pose());
  b.boxes({solid({-0.04f, 0, -0.04f}, {0.04f, 0.01f, 0.04f}, p.white_plastic),
           solid({-0.026f, 0.01f, -0.026f}, {0.026f, 0.014f, 0.026f}, p.white_plastic)});
}

void radiator(SceneBuilder& b, const Palette& p, const Spot& spot, float width)
{
  b.beginObject("radiator", spot.pose());
  const int ribs = std::lround(width / 0.06f);
  const float half = width / 2;
  std::vector<Box> boxes = {solid({-half, 0.045f, 0.14f}, {half, 0.075f, 0.18f}, p.frame),
                            solid({-half, 0.045f, 0.66f}, {half, 0.075f, 0.7f}, p.frame)};
  for (int k = 0; k < ribs; ++k) {
    const float x = -half + (k + 0.1f) * width / ribs;
    boxes.push_back(solid({x, 0.03f, 0.12f}, {x + 0.046f, 0.09f, 0.72f}, p.frame));
  }
  b.boxes(boxes);
  for (const float z : {0.16f, 0.68f})
    b.tube({{half, 0.06f, z}, {half + 0.05f, 0.06f, z}, {half + 0.05f, 0.06f, 0.f}}, 0.009f, p.chrome);
}

void cable(SceneBuilder& b, const Palette& p, const std::vector<Eigen::Vector2f>& line)
{
  b.beginObject("cable");
  std::vector<Vector3f> smooth; // Catmull-Rom spline through the points
  const auto at = [&](std::size_t k) { return line[std::min(k, line.size() - 1)]; };
  for (std::size_t k = 0; k + 1 < line.size(); ++k)
    for (int i = 0; i < 6; ++i) {
      const float t = i / 6.f;
      const Eigen::Vector2f a = at(k == 0 ? 0 : k - 1), c = at(k), d = at(k + 1), e = at(k + 2);
      const Eigen::Vector2f q =
          0.5f * (2 * c + t * (d - a) + t * t * (2 * a - 5 * c + 4 * d - e) + t * t * t * (3 * c - a - 3 * d + e));
      smooth.push_back({q.x(), q.y(), 0.0055f});
    }
  smooth.push_back({line.back().x(), line.back().y(), 0.0055f});
  std::vector<SweepKnot> knots;
  for (const Vector3f& q : smooth)
    knots.push_back({q, 0.005f, 0.005f});
  b.sweep(knots, Vector3f::UnitZ(), p.rubber);
}
} // namespace fresco::simulation
