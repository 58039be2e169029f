// SPDX-License-Identifier: BSD-3-Clause
#include "pair/plan_correlation.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/statistics.h>
#include <opencv2/core.hpp>
namespace fresco::registration {
namespace {
using Complex = std::complex<float>;

Index columnsOf(int side) { return side / 2 + 1; }

// Of a layer, turned by `turns` times 90 degrees; only the columns that do not follow by symmetry.
void transform(const FloorPlan::Layer& layer, int side, int turns, Complex* out)
{
  cv::Mat cells(side, side, CV_32F), spectrum;
  const int mask = side - 1;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      cells.at<float>(y, x) = turns == 0 ? layer[y * side + x] : layer[(-x & mask) * side + y];
  cv::dft(cells, spectrum, cv::DFT_COMPLEX_OUTPUT);
  const Index columns = columnsOf(side);
  for (int y = 0; y < side; ++y)
    std::copy_n(reinterpret_cast<const Complex*>(spectrum.ptr(y)), columns, out + y * columns);
}

// Spectrum of the blur [1 2 1] / 2 along x and y.
std::vector<float> blurOf(int side)
{
  std::vector<float> factors(side);
  for (int k = 0; k < side; ++k)
    factors[k] = 1.f + std::cos(2.f * static_cast<float>(M_PI) * k / side);
  return factors;
}

// A shift of the second plan, cells, after turns of 90 degrees.
struct PlanShift {
  float score = 0.f;
  int turns = 0, x = 0, y = 0;
};

class PlanScores {
public:
  PlanScores(int side, const Complex* a, const Complex* b) : side_(side), a_(a), b_(b), blur_(blurOf(side)) {}

  // Real part: the second plan as it is; imaginary part: turned by 180 degrees, whose spectrum is the conjugate.
  cv::Mat compute() const;

private:
  // Scores in the frequency domain for both, at one frequency.
  std::pair<Complex, Complex> at(Index row, Index column) const;

  int side_;
  const Complex *a_, *b_;
  std::vector<float> blur_;
};

std::pair<Complex, Complex> PlanScores::at(Index row, Index column) const
{
  constexpr float contradiction = 3.f, both_free = 0.05f; // against a matched cell
  const Index plane = side_ * columnsOf(side_), place = row * columnsOf(side_) + column;
  const float blur = blur_[row] * blur_[column];
  Complex plain(0.f, 0.f), turned(0.f, 0.f);
  for (int layer = 0; layer < plan_layers; ++layer) {
    const Complex oa = a_[2 * layer * plane + place], fa = a_[(2 * layer + 1) * plane + place];
    const Complex ob = b_[2 * layer * plane + place], fb = b_[(2 * layer + 1) * plane + place];
    const Complex to_occupied = blur * oa - contradiction * fa, to_free = both_free * fa - contradiction * oa;
    const auto add = [](Complex& sum, const Complex& x, const Complex& y, float sign) {
      sum +=
          Complex(x.real() * y.real() + sign * x.imag() * y.imag(), x.imag() * y.real() - sign * x.real() * y.imag());
    };
    add(plain, to_occupied, ob, 1.f);
    add(plain, to_free, fb, 1.f);
    add(turned, to_occupied, ob, -1.f);
    add(turned, to_free, fb, -1.f);
  }
  return {plain, turned};
}

cv::Mat PlanScores::compute() const
{
  cv::Mat spectrum(side_, side_, CV_32FC2), scores;
  for (int y = 0; y < side_; ++y)
    for (int x = 0; x <= side_ / 2; ++x) {
      const auto [plain, turned] = at(y, x);
      spectrum.at<Complex>(y, x) = Complex(plain.real() - turned.imag(), plain.imag() + turned.real());
      if (x > 0 && x < side_ / 2) // conjugates at the opposite frequency
        spectrum.at<Complex>((side_ - y) % side_, side_ - x) =
            Complex(plain.real() + turned.imag(), turned.real() - plain.imag());
    }
  cv::dft(spectrum, scores, cv::DFT_INVERSE | cv::DFT_SCALE);
  return scores;
}

// The highest of their neighbourhood, best first.
void addPeaks(const cv::Mat& scores, int turns, std::size_t most, std::vector<PlanShift>& peaks)
{
  const int side = scores.rows, mask = side - 1;
  for (const int half : {0, 1}) {
    const auto score = [&](int x, int y) { return scores.at<cv::Vec2f>(y & mask, x & mask)[half]; };
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const float here = score(x, y);
        if (here <= 0.f || (peaks.size() >= most && here <= peaks.back().score) || here < score(x - 1, y) ||
            here < score(x + 1, y) || here < score(x, y - 1) || here < score(x, y + 1))
          continue;
        const PlanShift peak{here, turns + 2 * half, x < side / 2 ? x : x - side, y < side / 2 ? y : y - side};
        const auto better = [](const PlanShift& p, const PlanShift& q) { return p.score > q.score; };
        peaks.insert(std::upper_bound(peaks.begin(), peaks.end(), peak, better), peak);
        peaks.resize(std::min(most, peaks.size()));
      }
  }
}

Eigen::Isometry3f shiftedBy(const PlanShift& shift, float cell)
{
  static constexpr std::array<std::array<float, 2>, 4> cosine_sine = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  const auto [c, s] = cosine_sine[shift.turns];
  Eigen::Isometry3f T = Eigen::Isometry3f::Identity();
  T.linear() << c, -s, 0.f, s, c, 0.f, 0.f, 0.f, 1.f;
  T.translation() << cell * shift.x, cell * shift.y, 0.f;
  return T;
}
} // namespace

PlanGrid makePlanGrid(float height, double extent, int most_side)
{
  constexpr float cells_per_height = 8.f;
  PlanGrid grid;
  grid.height = height;
  grid.cell = height / cells_per_height;
  grid.side = 1;
  while (grid.side < most_side && grid.side * grid.cell < extent)
    grid.side *= 2;
  return grid;
}

PlanGrid choosePlanGrid(const std::vector<std::optional<PlanFrame>>& frames, const std::vector<PreparedScan>& scans)
{
  constexpr float reach = 12.f; // of median ranges: twice what the farthest walls take
  std::vector<double> heights, sizes;
  for (std::size_t k = 0; k < frames.size(); ++k)
    if (frames[k]) {
      heights.push_back(frames[k]->height);
      sizes.push_back(scans[k].size);
    }
  PlanGrid grid;
  if (!heights.empty())
    grid = makePlanGrid(median(heights), reach * median(sizes), 512);
  grid.inner_free = std::any_of(scans.begin(), scans.end(), [](const auto& scan) { return scan.spares_doubtful; });
  return grid;
}

PlanSpectrum::PlanSpectrum(const FloorPlan& plan, const PlanFrame& frame, const PlanGrid& grid)
    : frame_(frame), grid_(grid)
{
  const Index plane = grid.side * columnsOf(grid.side);
  for (const int turns : {0, 1}) {
    values_[turns].resize(2 * plan_layers * plane);
    for (int layer = 0; layer < plan_layers; ++layer) {
      transform(plan.occupied[layer], grid.side, turns, values_[turns].data() + 2 * layer * plane);
      transform(plan.free[layer], grid.side, turns, values_[turns].data() + (2 * layer + 1) * plane);
    }
  }
}

PoseHypotheses matchPlans(const PlanSpectrum& a, const PlanSpectrum& b, std::size_t most)
{
  PoseHypotheses found;
  if (a.empty() || b.empty())
    return found;
  std::vector<PlanShift> peaks;
  for (const int turns : {0, 1})
    addPeaks(PlanScores(a.grid_.side, a.values_[0].data(), b.values_[turns].data()).compute(), turns, most, peaks);
  for (const PlanShift& peak : peaks) {
    PoseHypothesis next;
    const Eigen::Isometry3f T = a.frame_.T_plan_scan.inverse() * shiftedBy(peak, a.grid_.cell) * b.frame_.T_plan_scan;
    next.T_a_b = T.cast<double>();
    next.score = peak.score;
    found.push_back(next);
  }
  return found;
}
} // namespace fresco::registration
