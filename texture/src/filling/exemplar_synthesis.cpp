// SPDX-License-Identifier: BSD-3-Clause
#include "filling/exemplar_synthesis.h"
#include "photographs/grid.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/simd.h>
#include <fresco/core/statistics.h>
#include <limits>
#include <opencv2/imgproc.hpp>
namespace fresco::texture {
namespace {
constexpr int reach = 3; // of a window to each side: 7 x 7 hold a structure and still repeat

using Pixel = Eigen::Vector2i;

/// Numbers of Marsaglia 2003, "Xorshift RNGs".
class Random {
public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15ULL + 0x2545F4914F6CDD1DULL) {}
  /// 0 .. n - 1
  int below(int n)
  {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    return (state_ >> 33) % n;
  }

private:
  std::uint64_t state_;
};

/// Sum of squared differences of two rows of a window, in four parts.
simd::Int4 rowDifference(const HolePicture::Color* a, const HolePicture::Color* b)
{
  const std::int16_t *own = a->data(), *other = b->data();
  const auto squares = [&](int k, const simd::Short8& mask) {
    return simd::squaresOf((simd::load<simd::Short8>(own + k) - simd::load<simd::Short8>(other + k)) & mask);
  };
  constexpr simd::Short8 both = {-1, -1, -1, -1, -1, -1, -1, -1}, second = {0, 0, 0, 0, -1, -1, -1, -1};
  static_assert(2 * reach + 1 == 7); // three pairs of colours and one
  return squares(0, both) + squares(8, both) + squares(16, both) + squares(20, second);
}

/// Half as wide and high. A pixel is known where all four are, hole where one is.
HolePicture halved(const HolePicture& in)
{
  HolePicture out;
  out.width = in.width / 2;
  out.height = in.height / 2;
  out.color.resize(cellCount(out.width, out.height), HolePicture::Color{});
  out.state.resize(out.color.size(), HolePicture::outside);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      int known = 0, hole = 0;
      std::array<int, 3> sum{};
      for (int k = 0; k < 4; ++k) {
        const std::size_t i = in.at(2 * x + k % 2, 2 * y + k / 2);
        known += in.state[i] == HolePicture::known;
        hole += in.state[i] == HolePicture::hole;
        for (int c = 0; c < 3; ++c)
          sum[c] += in.color[i][c];
      }
      out.state[out.at(x, y)] = hole > 0 ? HolePicture::hole : known == 4 ? HolePicture::known : HolePicture::outside;
      for (int c = 0; c < 3; ++c)
        out.color[out.at(x, y)][c] = (sum[c] + 2) >> 2;
    }
  return out;
}

/// Windows of one level and which known window each resembles.
class Matching {
public:
  Matching(HolePicture& picture, Random& random) : picture_(picture), random_(random)
  {
    const std::size_t n = picture.state.size();
    std::vector<std::uint8_t> hole(n), other(n);
    for (std::size_t i = 0; i < n; ++i) {
      hole[i] = picture.state[i] == HolePicture::hole;
      other[i] = picture.state[i] != HolePicture::known;
    }
    std::vector<std::uint8_t> outside(n);
    for (std::size_t i = 0; i < n; ++i)
      outside[i] = picture.state[i] == HolePicture::outside;
    for (auto* flags : {&hole, &other, &outside})
      spread(*flags);
    usable_.assign(n, 0);
    slot_.assign(n, -1);
    for (int y = reach; y < picture.height - reach; ++y)
      for (int x = reach; x < picture.width - reach; ++x)
        if (!other[picture.at(x, y)]) {
          usable_[picture.at(x, y)] = 1;
          sources_.emplace_back(x, y);
        }
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x)
        if (hole[picture.at(x, y)] && picture.state[picture.at(x, y)] != HolePicture::outside) {
          slot_[picture.at(x, y)] = targets_.size();
          targets_.emplace_back(x, y);
          whole_.push_back(x >= reach && y >= reach && x + reach < picture.width && y + reach < picture.height &&
                           !outside[picture.at(x, y)]);
        }
    match_.resize(targets_.size());
    error_.resize(targets_.size());
  }

  std::size_t sources() const { return sources_.size(); }
  std::size_t targets() const { return targets_.size(); }

  void start()
  {
    farthest_ = std::max(picture_.width, picture_.height);
    for (Pixel& match : match_)
      match = sources_[random_.below(sources_.size())];
    voteColors(false);
  }

  /// What lies far away was searched for there.
  void startFrom(const Matching& coarse)
  {
    constexpr int few_windows = 32; // pixels
    farthest_ = std::min(few_windows, std::max(picture_.width, picture_.height));
    for (std::size_t t = 0; t < targets_.size(); ++t) {
      const Pixel p = targets_[t],
                  half(std::min(p.x() / 2, coarse.picture_.width - 1), std::min(p.y() / 2, coarse.picture_.height - 1));
      const int slot = coarse.slot_[coarse.picture_.at(half.x(), half.y())];
      match_[t] = sources_[random_.below(sources_.size())];
      if (slot < 0)
        continue;
      const Pixel at = 2 * coarse.match_[slot] + (p - 2 * half);
      if (isUsable(at))
        match_[t] = at;
    }
    voteColors(false);
  }

  void refine(int rounds, int passes)
  {
    for (int round = 0; round < rounds; ++round) {
      search(passes);
      voteColors(false);
    }
  }

  /// Each hole pixel as its own window has it: no mean, so nothing is smoothed away.
  void finish(int passes)
  {
    search(passes);
    voteColors(true);
  }

private:
  /// Maximum over the window around each pixel, in place.
  void spread(std::vector<std::uint8_t>& flags) const
  {
    cv::Mat picture(picture_.height, picture_.width, CV_8U, flags.data());
    cv::dilate(picture, picture, cv::Mat::ones(2 * reach + 1, 2 * reach + 1, CV_8U));
  }

  bool isUsable(const Pixel& p) const
  {
    return p.x() >= 0 && p.y() >= 0 && p.x() < picture_.width && p.y() < picture_.height &&
           usable_[picture_.at(p.x(), p.y())];
  }

  /// Mean squared difference over what of the target's window is in the picture; given up beyond `most`.
  float difference(std::size_t t, const Pixel& source, float most) const
  {
    constexpr int side = 2 * reach + 1;
    const Pixel& target = targets_[t];
    const float limit = most * (side * side);
    if (!whole_[t])
      return differenceInside(target, source, limit);
    const std::size_t own = picture_.at(target.x() - reach, target.y() - reach),
                      other = picture_.at(source.x() - reach, source.y() - reach);
    simd::Int4 sums{};
    for (int row = 0; row < side; ++row) {
      const std::size_t at = row * std::size_t(picture_.width);
      sums += rowDifference(&picture_.color[own + at], &picture_.color[other + at]);
      if (row % 2 == 1 && simd::total(sums) > limit) // adding up costs as much as a row
        return std::numeric_limits<float>::infinity();
    }
    const float sum = simd::total(sums);
    return sum > limit ? std::numeric_limits<float>::infinity() : sum / (side * side);
  }

  /// The same where a part of the window is not.
  float differenceInside(const Pixel& target, const Pixel& source, float limit) const
  {
    int sum = 0, count = 0;
    const int left = std::max(-reach, -target.x()), right = std::min(reach, picture_.width - 1 - target.x());
    for (int j = std::max(-reach, -target.y()); j <= std::min(reach, picture_.height - 1 - target.y()); ++j) {
      const std::size_t first = picture_.at(target.x(), target.y() + j);
      const HolePicture::Color *own = &picture_.color[first],
                               *other = &picture_.color[picture_.at(source.x(), source.y() + j)];
      for (int i = left; i <= right; ++i)
        if (picture_.state[first + i] != HolePicture::outside) {
          for (int c = 0; c < 3; ++c)
            sum += (own[i][c] - other[i][c]) * (own[i][c] - other[i][c]);
          ++count;
        }
      if (sum > limit)
        return std::numeric_limits<float>::infinity();
    }
    return count > 0 ? float(sum) / count : 0.f;
  }

  void attempt(std::size_t t, const Pixel& source)
  {
    if (!isUsable(source) || source == match_[t])
      return;
    const float error = difference(t, source, error_[t]);
    if (error < error_[t]) {
      error_[t] = error;
      match_[t] = source;
    }
  }

  /// Passes in alternating order: what fits the neighbour, moved along, and places at shrinking distance.
  void search(int passes)
  {
    for (std::size_t t = 0; t < targets_.size(); ++t)
      error_[t] = difference(t, match_[t], std::numeric_limits<float>::infinity());
    for (int pass = 0; pass < passes; ++pass) {
      const int step = pass % 2 == 0 ? -1 : 1;
      for (std::size_t k = 0; k < targets_.size(); ++k) {
        const std::size_t t = step < 0 ? k : targets_.size() - 1 - k;
        const Pixel p = targets_[t];
        for (const Pixel& aside : {Pixel(step, 0), Pixel(0, step)}) {
          const Pixel q = p + aside;
          if (q.x() < 0 || q.y() < 0 || q.x() >= picture_.width || q.y() >= picture_.height)
            continue;
          if (const int slot = slot_[picture_.at(q.x(), q.y())]; slot >= 0)
            attempt(t, match_[slot] - aside);
        }
        for (int radius = farthest_; radius >= 1; radius /= 3)
          attempt(t, match_[t] + Pixel(random_.below(2 * radius + 1) - radius, random_.below(2 * radius + 1) - radius));
      }
    }
  }

  /// Colours of the hole from the windows' matches.
  void voteColors(bool own_only)
  {
    float scale = 1e-2f;
    if (!own_only && !error_.empty()) { // the error that a quarter of the windows exceed
      std::vector<float> errors = error_;
      scale = std::max(scale, rankedValue(errors, errors.size() * 3 / 4));
    }
    std::vector<float> weights;
    for (const float error : error_)
      weights.push_back(std::exp(-error / (2 * scale)) + 1e-6f);
    std::vector<HolePicture::Color> result(targets_.size());
    for (std::size_t t = 0; t < targets_.size(); ++t)
      result[t] = own_only ? picture_.color[picture_.at(match_[t].x(), match_[t].y())] : meanAt(targets_[t], weights);
    for (std::size_t t = 0; t < targets_.size(); ++t)
      if (const std::size_t at = picture_.at(targets_[t].x(), targets_[t].y()); picture_.state[at] == HolePicture::hole)
        picture_.color[at] = result[t];
  }

  /// @param weights of the targets' windows
  HolePicture::Color meanAt(const Pixel& p, const std::vector<float>& weights) const
  {
    simd::Float4 sum{};
    float total = 0;
    const int up = std::max(-reach, p.y() - picture_.height + 1), down = std::min(reach, p.y());
    const int left = std::max(-reach, p.x() - picture_.width + 1), right = std::min(reach, p.x());
    for (int j = up; j <= down; ++j)
      for (int i = left; i <= right; ++i) {
        const int slot = slot_[picture_.at(p.x() - i, p.y() - j)];
        if (slot < 0)
          continue;
        const HolePicture::Color& color = picture_.color[picture_.at(match_[slot].x() + i, match_[slot].y() + j)];
        sum += weights[slot] * simd::floatsOf(color.data());
        total += weights[slot];
      }
    const simd::Int4 mean = simd::rounded(sum / total);
    HolePicture::Color out{};
    for (int c = 0; c < 3; ++c)
      out[c] = mean[c];
    return out;
  }

  HolePicture& picture_;
  Random& random_;
  int farthest_ = 0;         ///< reach of the random search, pixels
  std::vector<char> usable_; ///< per pixel: middle of a known window
  std::vector<int> slot_;    ///< per pixel: its number among the targets, -1 = none
  std::vector<Pixel> sources_, targets_, match_;
  std::vector<char> whole_;  ///< of the targets: their window lies in the picture
  std::vector<float> error_; ///< of the matches, squares of stored numbers
};

/// @param matchings fine to coarse
void matchCoarseToFine(std::vector<Matching>& matchings)
{
  constexpr int rounds = 4, passes = 2; // 12 rounds find windows that are 4 % more alike; finer levels need fewer
  matchings.back().start();
  matchings.back().refine(rounds, passes);
  for (std::size_t l = matchings.size() - 1; l-- > 0;) {
    matchings[l].startFrom(matchings[l + 1]);
    if (l > 0)
      matchings[l].refine(2, passes);
  }
  matchings.front().finish(1);
}
} // namespace

int holeRadius(const HolePicture& picture)
{
  cv::Mat hole, distance;
  cv::compare(cv::Mat(picture.height, picture.width, CV_8U, const_cast<std::uint8_t*>(picture.state.data())),
              HolePicture::hole, hole, cv::CMP_EQ);
  cv::copyMakeBorder(hole, hole, 1, 1, 1, 1, cv::BORDER_CONSTANT, 0);
  cv::distanceTransform(hole, distance, cv::DIST_C, 3);
  double largest = 0;
  cv::minMaxLoc(distance, nullptr, &largest);
  return largest;
}

bool synthesizeHole(HolePicture& picture, std::uint64_t seed)
{
  constexpr std::size_t least_windows = 300; // wholly known: fewer would repeat visibly
  constexpr int coarsest_radius = 4;         // of the hole, pixels: about a window
  constexpr std::size_t most_levels = 6;     // a hole of 250 pixels becomes a window
  Random random(seed);
  std::vector<HolePicture> levels;
  std::vector<Matching> matchings; // they refer to the levels
  levels.reserve(most_levels);
  matchings.reserve(most_levels);
  levels.push_back(std::move(picture));
  matchings.emplace_back(levels.back(), random);
  const bool enough = matchings.front().sources() >= least_windows;
  for (int radius = holeRadius(levels.front()); enough && levels.size() < most_levels && radius > coarsest_radius;
       radius /= 2) {
    levels.push_back(halved(levels.back()));
    matchings.emplace_back(levels.back(), random);
    if (matchings.back().sources() < least_windows) {
      matchings.pop_back();
      break;
    }
  }
  if (enough)
    matchCoarseToFine(matchings);
  picture = std::move(levels.front());
  return enough;
}
} // namespace fresco::texture
