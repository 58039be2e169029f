// SPDX-License-Identifier: BSD-3-Clause
#include "scene/drawing.h"
#include <algorithm>
#include <cmath>
#include <string_view>
namespace fresco::simulation {
using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {
/// Of each letter the strokes: pairs of digits x y on a grid of 5 x 7, y down; a space lifts the pen.
constexpr std::string_view glyphs =
    ";A 062046 1434;B 00063645443303 0030414233;C 4130100105163645;D 00062644422000;E 40000646 0333"
    ";F 400006 0333;G 41301001051636454323;H 0006 4046 0343;I 2026;J 4045361605;K 0006 400346;L 000646"
    ";M 0600234046;N 06004640;O 103041453616050110;P 06003041423303;Q 103041453616050110 2446"
    ";R 06003041423303 2346;S 413010010213334445361605;T 0040 2026;U 000516364540;V 002640;W 0016233640"
    ";X 0046 4006;Y 002340 2326;Z 00400646;0 103041453616050110 3115;1 112026;2 01103041420646"
    ";3 0110304142334445361605 1333;4 36300444;5 400002324345361605;6 4130100105163645443303;7 004026"
    ";8 103041423313020110 1304051636454433;9 43130201103041453616;- 1333;+ 2125 0343;. 2526;, 2617"
    ";: 2122 2526;= 0242 0444;% 4006 0111 3545;/ 4006;? 011030414223 24 2526;";

std::string_view strokesOf(char letter)
{
  const std::size_t found = glyphs.find(std::string{';', letter, ' '});
  if (found == std::string_view::npos)
    return {};
  const std::size_t first = found + 3;
  return glyphs.substr(first, glyphs.find(';', first) - first);
}
} // namespace

void Drawing::blend(int x, int y, const Vector3f& color, float share)
{
  if (x < 0 || y < 0 || x >= picture_.width() || y >= picture_.height() || share <= 0.f)
    return;
  Vector3f& pixel = picture_.pixel(x, y);
  pixel += std::min(share, 1.f) * (color - pixel);
}

void Drawing::segment(const Vector2f& a, const Vector2f& b, const Pen& pen)
{
  const float reach = 0.5f * pen.width + 1.f;
  const Vector2f low = a.cwiseMin(b).array() - reach, high = a.cwiseMax(b).array() + reach, along = b - a;
  const float square = std::max(along.squaredNorm(), 1e-6f);
  const int x0 = std::max<int>(0, low.x()), x1 = std::min<int>(picture_.width() - 1, high.x());
  const int y0 = std::max<int>(0, low.y()), y1 = std::min<int>(picture_.height() - 1, high.y());
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const Vector2f p(x + 0.5f, y + 0.5f);
      const float t = std::clamp((p - a).dot(along) / square, 0.f, 1.f);
      blend(x, y, pen.color, 0.5f * pen.width + 0.5f - (p - a - t * along).norm());
    }
}

void Drawing::line(const std::vector<Vector2f>& points, const Pen& pen)
{
  const auto stray = [&](const Vector2f& p) -> Vector2f {
    return p + pen.shake * Vector2f(random_.uniformFloat(-1, 1), random_.uniformFloat(-1, 1));
  };
  if (points.empty())
    return;
  Vector2f last = stray(points.front());
  for (std::size_t k = 1; k < points.size(); ++k) {
    const Vector2f next = stray(points[k]);
    segment(last, next, pen);
    last = next;
  }
}

void Drawing::rectangle(const Vector2f& min, const Vector2f& max, const Vector3f& color)
{
  const auto covered = [](float low, float high, int at) {
    const float from = at;
    return std::clamp(std::min(high, from + 1.f) - std::max(low, from), 0.f, 1.f);
  };
  const int right = std::min<int>(picture_.width() - 1, max.x());
  const int below = std::min<int>(picture_.height() - 1, max.y());
  for (int y = std::max<int>(0, min.y()); y <= below; ++y)
    for (int x = std::max<int>(0, min.x()); x <= right; ++x)
      blend(x, y, color, covered(min.x(), max.x(), x) * covered(min.y(), max.y(), y));
}

void Drawing::disc(const Vector2f& center, float radius, const Vector3f& color)
{
  segment(center, center, {color, 2.f * radius, 0.f});
}

void Drawing::text(const std::string& words, Vector2f at, float height, const Pen& pen)
{
  const float unit = height / 6.f, left = at.x();
  for (const char letter : words) {
    if (letter == '\n') {
      at = {left, at.y() + 1.55f * height};
      continue;
    }
    std::vector<Vector2f> stroke;
    const std::string_view strokes = strokesOf(letter);
    for (std::size_t k = 0; k <= strokes.size(); ++k) {
      if (k == strokes.size() || strokes[k] == ' ') {
        line(stroke, pen);
        stroke.clear();
      } else if (k + 1 < strokes.size() && strokes[k + 1] != ' ') {
        stroke.push_back(at + unit * Vector2f(strokes[k] - '0', strokes[k + 1] - '0'));
        ++k;
      }
    }
    at.x() += 5.6f * unit;
  }
}
} // namespace fresco::simulation
