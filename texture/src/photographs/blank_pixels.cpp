// SPDX-License-Identifier: BSD-3-Clause
#include "photographs/blank_pixels.h"
#include "photographs/distance_field.h"
#include "photographs/photo_store.h"
#include <algorithm>
#include <fresco/core/statistics.h>
#include <map>
#include <vector>
namespace fresco::texture {
namespace {
constexpr int block = 16;   // pixels: of JPEG with halved colours. Noise breaks runs of one value sooner
constexpr int ringing = 12; // grey levels, of JPEG beside an edge
constexpr int faint = 2;    // grey levels: a sensor's noise on black, JPEG's on either end

using Color = cv::Vec3b;

/// With what pixels were filled.
struct Filling {
  Color value;
  int tolerance; ///< grey levels

  bool isExtreme() const { return value == Color(0, 0, 0) || value == Color(255, 255, 255); }
  int differenceAt(const cv::Mat& photo, const cv::Point& p) const
  {
    const Color& color = photo.at<Color>(p);
    int out = 0;
    for (int c = 0; c < 3; ++c)
      out = std::max(out, std::abs(color[c] - value[c]));
    return out;
  }
  /// 255 where the photograph differs by that much at most.
  cv::Mat within(const cv::Mat& photo, int levels) const
  {
    cv::Mat out;
    const cv::Scalar middle(value[0], value[1], value[2]), spread = cv::Scalar::all(levels);
    cv::inRange(photo, middle - spread, middle + spread, out);
    return out;
  }
};

std::vector<cv::Point> ringOf(const cv::Mat& photo)
{
  std::vector<cv::Point> ring;
  const int steps[4] = {photo.cols - 1, photo.rows - 1, photo.cols - 1, photo.rows - 1};
  const cv::Point along[4] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  cv::Point at(0, 0);
  for (int side = 0; side < 4; ++side)
    for (int k = 0; k < steps[side]; ++k, at += along[side])
      ring.push_back(at);
  return ring;
}

/// Runs of a block and more along the image's border of pixels that are like the first one of the run: it, their number.
template <typename Alike>
std::vector<std::pair<cv::Point, std::size_t>> longRuns(const std::vector<cv::Point>& ring, const Alike& alike)
{
  std::vector<std::pair<cv::Point, std::size_t>> out;
  for (std::size_t i = 0, end = 0; i < ring.size(); i = std::max(end, i + 1)) {
    for (end = i; end < ring.size() && alike(ring[i], ring[end]); ++end)
      ;
    if (end - i >= block)
      out.emplace_back(ring[i], end - i);
  }
  return out;
}

/// What pixels beyond the picture may have been filled with: values that the image's border has in runs. Surfaces without
/// noise have several.
std::vector<Filling> fillingsOf(const cv::Mat& photo)
{
  const std::vector<cv::Point> ring = ringOf(photo);
  std::vector<Filling> out;
  for (const int value : {0, 255})
    if (const Filling f{Color::all(value), faint};
        !longRuns(ring, [&](auto&, auto& p) { return f.differenceAt(photo, p) <= ringing; }).empty())
      out.push_back(f);
  std::map<std::array<uchar, 3>, std::size_t> counts;
  std::size_t all = 0;
  const auto same = [&](auto& p, auto& q) { return photo.at<Color>(p) == photo.at<Color>(q); };
  for (const auto& [first, count] : longRuns(ring, same)) {
    const Color& c = photo.at<Color>(first);
    counts[{c[0], c[1], c[2]}] += count;
    all += count;
  }
  for (const auto& [color, count] : counts)
    if (const Filling f{{color[0], color[1], color[2]}, 0}; !f.isExtreme() && 3 * count > 2 * all)
      out.push_back(f);
  return out;
}

/// A connected region of pixels like the filling.
struct LabelledRegion {
  std::size_t pixels = 0, exact = 0;
  std::size_t ring = 0, outline = 0; ///< pixels along the image's border, sides of pixels along the picture
};

/// Whether it lies along the image's border, as what is beyond a picture does: things in the picture are bounded by it.
bool isBeyondPicture(const LabelledRegion& r, std::size_t ring)
{
  return r.outline > 0 && r.ring >= block && 2 * r.exact >= r.pixels && (2 * r.ring >= r.outline || 2 * r.ring >= ring);
}

std::vector<LabelledRegion> measureRegions(const cv::Mat& labels, const cv::Mat& exact, int count)
{
  std::vector<LabelledRegion> out(count);
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x) {
      const int label = labels.at<int>(y, x);
      LabelledRegion& r = out[label];
      ++r.pixels;
      r.exact += exact.at<uchar>(y, x) != 0;
      r.ring += x == 0 || y == 0 || x + 1 == labels.cols || y + 1 == labels.rows;
      for (const cv::Point& next : {cv::Point(x + 1, y), cv::Point(x, y + 1)})
        if (next.x < labels.cols && next.y < labels.rows && labels.at<int>(next) != label) {
          ++r.outline;
          ++out[labels.at<int>(next)].outline;
        }
    }
  return out;
}

/// 255 where the filling reaches from the image's border inwards; what JPEG has made of it lies within a block of it.
cv::Mat filledFromBorder(const cv::Mat& photo, const Filling& filling)
{
  const cv::Mat exact = filling.within(photo, filling.tolerance);
  cv::Mat near, labels;
  cv::dilate(exact, near, cv::Mat::ones(2 * block + 1, 2 * block + 1, CV_8U));
  const int count = cv::connectedComponents(filling.within(photo, ringing) & near, labels, 4, CV_32S);
  const std::vector<LabelledRegion> regions = measureRegions(labels, exact, count);
  const std::size_t ring = 2 * (photo.cols + photo.rows) - 4;
  cv::Mat out(photo.size(), CV_8U, cv::Scalar(0));
  for (int y = 0; y < out.rows; ++y)
    for (int x = 0; x < out.cols; ++x)
      if (const int label = labels.at<int>(y, x); label > 0 && isBeyondPicture(regions[label], ring))
        out.at<uchar>(y, x) = 255;
  return out;
}

/// How filled regions pass into the picture: resampling mixes the two over some pixels, a vignette over many.
class Transition {
public:
  Transition(const cv::Mat& photo, const cv::Mat& filled, const Filling& filling)
      : photo_(photo), filling_(filling), field_(filled), margins_(field_.mostLabel() + 1, -1)
  {}

  /// Finds of each region how many pixels wide it is. Negative: wider, or there is no step to the picture.
  void measure(int widest)
  {
    std::vector<std::vector<cv::Point>> at(widest + 2);
    field_.forNear(widest + 1, [&](const cv::Point& p, int distance) { at[distance].push_back(p); });
    for (int k = 1; k <= widest + 1 && endAt(k, at[k]); ++k)
      ;
  }

  /// Sets to 0 what is filled, or mixed with what is.
  void hide(cv::Mat& used) const
  {
    for (int y = 0; y < used.rows; ++y)
      for (int x = 0; x < used.cols; ++x)
        if (const int margin = margins_[field_.label({x, y})]; margin >= 0 && field_.at({x, y}) < margin + 0.5f)
          used.at<uchar>(y, x) = 0;
  }

private:
  /// Regions whose pixels at the distance differ from the filling as those further in do end there.
  /// @return whether there were some that had not ended before
  bool endAt(int k, const std::vector<cv::Point>& pixels)
  {
    constexpr float whole = 0.85f; // share of the difference further in: below, a pixel is a mixture
    std::vector<std::vector<float>> shares(margins_.size());
    std::vector<std::size_t> flat(margins_.size(), 0);
    bool any = false;
    for (const cv::Point& p : pixels)
      if (const int label = field_.label(p); margins_[label] < 0)
        if (const cv::Point q = field_.further(p, k + 2); q.x >= 0) {
          any = true;
          const int all = filling_.differenceAt(photo_, q);
          if (all > 2 * ringing) // a picture, not JPEG's noise
            shares[label].push_back(1.f * filling_.differenceAt(photo_, p) / all);
          else
            ++flat[label];
        }
    for (std::size_t label = 0; label < margins_.size(); ++label) {
      const std::size_t count = shares[label].size();
      if (count >= fewest_samples && count > flat[label] && median(shares[label]) >= whole)
        margins_[label] = k - 1;
    }
    return any;
  }

  const cv::Mat& photo_;
  const Filling& filling_;
  DistanceField field_;
  std::vector<int> margins_; ///< by label
};

bool reachesAllCorners(const cv::Mat& filled)
{
  const int right = filled.cols - 1, bottom = filled.rows - 1;
  return filled.at<uchar>(0, 0) && filled.at<uchar>(0, right) && filled.at<uchar>(bottom, 0) &&
         filled.at<uchar>(bottom, right);
}

/// What is clipped passes into the picture by degrees, as a vignette does, but hardly ever in all corners.
void hideFilled(const cv::Mat& photo, const Filling& filling, cv::Mat& used)
{
  const cv::Mat filled = filledFromBorder(photo, filling);
  if (cv::countNonZero(filled) == 0)
    return;
  Transition transition(photo, filled, filling);
  const bool vignette = filling.value == Color(0, 0, 0) && reachesAllCorners(filled);
  transition.measure(vignette ? std::min(photo.cols, photo.rows) / 6 : 2 * interpolation_reach);
  transition.hide(used);
}

/// Colours below what is transparent are mixed into the picture where they are one value.
void hideTransparent(const cv::Mat& photo, const cv::Mat& alpha, cv::Mat& used)
{
  const cv::Mat clear = alpha < mid_grey;
  const auto first = std::find(clear.begin<uchar>(), clear.end<uchar>(), 255);
  if (first == clear.end<uchar>())
    return;
  used.setTo(0, clear);
  const Filling filling{photo.at<Color>(first.pos()), faint};
  if (10 * cv::countNonZero(filling.within(photo, faint) & clear) < 9 * cv::countNonZero(clear))
    return;
  Transition transition(photo, clear, filling);
  transition.measure(2 * interpolation_reach);
  transition.hide(used);
}
} // namespace

Image blankPixels(const Image& photo)
{
  Image out(photo.width, photo.height, 1, 255);
  cv::Mat used(photo.height, photo.width, CV_8U, out.data.data());
  const cv::Mat given = matOf(photo);
  cv::Mat color = given;
  if (photo.channels == 4) {
    cv::Mat alpha;
    cv::cvtColor(given, color, cv::COLOR_RGBA2RGB);
    cv::extractChannel(given, alpha, 3);
    hideTransparent(color, alpha, used);
  }
  for (const Filling& filling : fillingsOf(color))
    hideFilled(color, filling, used);
  return cv::countNonZero(used) < used.rows * used.cols ? std::move(out) : Image();
}
} // namespace fresco::texture
