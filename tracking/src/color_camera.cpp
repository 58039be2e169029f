// SPDX-License-Identifier: BSD-3-Clause
#include "color_camera.h"
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <limits>
namespace fresco::tracking {
namespace {
constexpr int level = 1;      // a quarter of the pixels: the reach of the steps is larger
constexpr double scale = 10;  // grey levels: residuals of a colour camera that is about right
constexpr int parameters = 5; // log of the focal length, centre (in image widths), offset to the right and downwards
using Parameters = Eigen::Matrix<double, parameters, 1>;
using Normal = Eigen::Matrix<double, parameters, parameters>;

/// Where devices are built: colour lenses differ by a tenth from depth lenses, and lie some centimetres beside them.
const Parameters expected = (Parameters() << 0.1, 0.02, 0.02, 0.03, 0.01).finished();
/// Over which differences are taken: half a pixel each.
const Parameters steps = (Parameters() << 0.005, 0.002, 0.002, 0.003, 0.003).finished();

RgbdCameras with(RgbdCameras cameras, const Parameters& x)
{
  cameras.color.fx *= std::exp(x[0]);
  cameras.color.fy *= std::exp(x[0]);
  cameras.color.cx += x[1] * cameras.color.width;
  cameras.color.cy += x[2] * cameras.color.width;
  cameras.color_from_depth += Eigen::Vector3f(float(x[3]), float(x[4]), 0.f);
  return cameras;
}

float intensity(const Plane& gray, const Pinhole& C, const Eigen::Vector3f& q)
{
  const float u = q.x() / q.z() * C.fx + C.cx, v = q.y() / q.z() * C.fy + C.cy;
  if (!(q.z() > 0.f && u >= 0.f && v >= 0.f && u < gray.width - 1 && v < gray.height - 1))
    return std::numeric_limits<float>::quiet_NaN(); // unseen
  const int x = static_cast<int>(u), y = static_cast<int>(v);
  const float fu = u - x, fv = v - y;
  const float *upper = gray.row(y) + x, *lower = upper + gray.width;
  return (upper[0] * (1 - fu) + upper[1] * fu) * (1 - fv) + (lower[0] * (1 - fu) + lower[1] * fu) * fv;
}

/// Points of the reference that the current frame sees, too, in both frames.
struct SharedPoints {
  std::vector<Eigen::Vector3f> reference, current;
};

SharedPoints sharedPoints(const CalibrationPair& pair, const RgbdCameras& cameras)
{
  const RgbdLevel& fine = pair.current.levels[level];
  const Pinhole K = halved(cameras.depth, fine.depth_halvings);
  const ReferenceLevel points(pair.reference.levels[level], cameras);
  const Eigen::Isometry3f T = pair.T_current_reference.cast<float>();
  SharedPoints shared;
  for (Index i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f p = points.point(i), q = T * p;
    const int u = static_cast<int>(std::floor(q.x() / q.z() * K.fx + K.cx + 0.5f));
    const int v = static_cast<int>(std::floor(q.y() / q.z() * K.fy + K.cy + 0.5f));
    if (!(q.z() > 0.f) || u < 0 || v < 0 || u >= fine.depth.width || v >= fine.depth.height ||
        std::fabs(fine.depth.row(v)[u] - q.z()) > one_surface * q.z())
      continue;
    shared.reference.push_back(p);
    shared.current.push_back(q);
  }
  return shared;
}

class Calibration {
public:
  Calibration(const std::vector<CalibrationPair>& pairs, const RgbdCameras& start, int threads)
      : pairs_(pairs), start_(start), threads_(threads), points_(pairs.size())
  {
    parallelFor(
        pairs.size(), threads, [&](Index i) { points_[i] = sharedPoints(pairs[i], start); }, 1);
  }

  Parameters run()
  {
    constexpr int iterations = 20;
    Parameters x = bestFocalLength();
    for (int k = 0; k < iterations; ++k) {
      const Equations sum = equations(x);
      Normal H = sum.H;
      Parameters g = sum.g;
      // As if so much had been seen before: a thousandth of the pixels, since residuals of neighbours are not independent.
      const double prior = 1e-3 * sum.count;
      H.diagonal() += prior * expected.cwiseAbs2().cwiseInverse();
      g += prior * x.cwiseQuotient(expected.cwiseAbs2());
      const Parameters step = -H.ldlt().solve(g);
      x += step.cwiseMax(-2 * steps).cwiseMin(2 * steps);
      if ((step.cwiseAbs().array() < 0.02 * steps.array()).all())
        break;
    }
    return x;
  }

private:
  /// The steps reach no farther than the texture is fine: the focal length is tried out first.
  Parameters bestFocalLength() const
  {
    constexpr int tries = 9; // each way, 2.5 % apart
    Parameters best = Parameters::Zero();
    double least = cost(best);
    for (int k = -tries; k <= tries; ++k) {
      const Parameters x = 0.025 * k * Parameters::Unit(0);
      const double value = cost(x);
      if (value < least) {
        least = value;
        best = x;
      }
    }
    return best;
  }

  /// Mean logarithm of the t distribution's density over all points that are seen, up to constants.
  double cost(const Parameters& x) const
  {
    std::vector<std::pair<double, double>> parts(pairs_.size());
    const auto sum = [&](Index pair) {
      double gain = 1;
      for (const float r : residuals(pair, x, gain, true))
        if (std::isfinite(r)) {
          parts[pair].first += std::log(1 + r * r / (5 * scale * scale));
          parts[pair].second += 1;
        }
    };
    parallelFor(pairs_.size(), threads_, sum, 1);
    double total = 0, count = 0;
    for (const auto& [value, seen] : parts) {
      total += value;
      count += seen;
    }
    return total / std::max(1.0, count);
  }

  struct Equations {
    Normal H = Normal::Zero();
    Parameters g = Parameters::Zero();
    double count = 0;
  };

  std::vector<float> residuals(Index pair, const Parameters& x, double& gain, bool update_gain) const
  {
    const RgbdCameras cameras = with(start_, x);
    const RgbdLevel &a = pairs_[pair].reference.levels[level], &b = pairs_[pair].current.levels[level];
    const Pinhole C = halved(cameras.color, a.gray_halvings);
    const SharedPoints& points = points_[pair];
    std::vector<float> first(points.reference.size()), second(first.size());
    double ii = 0, ij = 0;
    for (std::size_t i = 0; i < first.size(); ++i) {
      first[i] = intensity(a.gray, C, points.reference[i] + cameras.color_from_depth);
      second[i] = intensity(b.gray, C, points.current[i] + cameras.color_from_depth);
      if (std::isfinite(first[i] + second[i])) {
        ii += first[i] * first[i];
        ij += first[i] * second[i];
      }
    }
    if (update_gain)
      gain = ii > 0 ? ij / ii : 1;
    for (std::size_t i = 0; i < first.size(); ++i)
      second[i] -= static_cast<float>(gain) * first[i];
    return second;
  }

  Equations equationsOf(Index pair, const Parameters& x) const
  {
    double gain = 1;
    const std::vector<float> r = residuals(pair, x, gain, true);
    // On both sides: texture that is finer than a step makes residuals larger to either.
    std::vector<float> before[parameters], after[parameters];
    for (int k = 0; k < parameters; ++k) {
      before[k] = residuals(pair, x - steps[k] * Parameters::Unit(k), gain, false);
      after[k] = residuals(pair, x + steps[k] * Parameters::Unit(k), gain, false);
    }
    Equations sum;
    for (std::size_t i = 0; i < r.size(); ++i) {
      Parameters J;
      for (int k = 0; k < parameters; ++k)
        J[k] = (after[k][i] - before[k][i]) / (2 * steps[k] * scale);
      const double e = r[i] / scale;
      if (!J.allFinite() || !std::isfinite(e))
        continue;
      const double weight = 6 / (5 + e * e);
      sum.H += weight * J * J.transpose();
      sum.g += weight * e * J;
      sum.count += 1;
    }
    return sum;
  }

  Equations equations(const Parameters& x) const
  {
    std::vector<Equations> parts(pairs_.size());
    parallelFor(
        pairs_.size(), threads_, [&](Index i) { parts[i] = equationsOf(i, x); }, 1);
    Equations sum;
    for (const Equations& part : parts) {
      sum.H += part.H;
      sum.g += part.g;
      sum.count += part.count;
    }
    return sum;
  }

  const std::vector<CalibrationPair>& pairs_;
  const RgbdCameras& start_;
  int threads_;
  std::vector<SharedPoints> points_;
};
} // namespace

RgbdCameras calibrateColorCamera(const std::vector<CalibrationPair>& pairs, const RgbdCameras& start, int threads)
{
  return pairs.empty() ? start : with(start, Calibration(pairs, start, threads).run());
}
} // namespace fresco::tracking
