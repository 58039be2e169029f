// SPDX-License-Identifier: BSD-3-Clause
#include "points/point_values.h"
#include "photometry/color_ratios.h"
#include "photometry/exposure.h"
#include "views/patch_visibility.h"
#include "views/picture_evidence.h"
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/robust_weights.h>
#include <fresco/core/statistics.h>
#include <fresco/search/batch_knn.h>
#include <numeric>
namespace fresco::texture {
namespace {
constexpr float overlap_radius = 2; // spacings: several samples of each scan, on nearly one place

/// What one scan shows of a place.
struct ScanPatch {
  int scan;
  Eigen::Vector3f value = Eigen::Vector3f::Zero(); ///< mean
  float count = 0;
};

/// Means by scan around places spread over the samples; places that a single scan shows are left out.
std::vector<std::vector<ScanPatch>> findOverlaps(const SurfaceSamples& samples, const Points& values, int threads)
{
  const Index places = std::min(samples.size(), most_compared);
  const SurfaceGaussian around(samples, overlap_radius / SurfaceGaussian::reach);
  std::vector<std::vector<ScanPatch>> overlaps(places);
  parallelFor(places, threads, [&](Index k) {
    const Index i = k * samples.size() / places;
    std::vector<int> found;
    around.gather(samples.places.col(i), 0, found);
    std::vector<ScanPatch>& patches = overlaps[k];
    for (const int j : found) {
      if ((samples.places.col(j) - samples.places.col(i)).norm() > overlap_radius * samples.spacing[i] ||
          samples.normals.col(j).dot(samples.normals.col(i)) < 0.9f) // 26 degrees: one plane, seen likewise
        continue;
      auto at = std::find_if(patches.begin(), patches.end(), [&](auto& p) { return p.scan == samples.scan[j]; });
      if (at == patches.end())
        at = patches.insert(at, {samples.scan[j]});
      at->value += values.col(j);
      ++at->count;
    }
    for (ScanPatch& patch : patches)
      patch.value /= patch.count;
    std::sort(patches.begin(), patches.end(), [](const auto& a, const auto& b) { return a.scan < b.scan; });
  });
  const auto alone = [](const auto& patches) { return patches.size() < 2; };
  overlaps.erase(std::remove_if(overlaps.begin(), overlaps.end(), alone), overlaps.end());
  return overlaps;
}

/// Scans are to each other as photographs are: what they show of one place gives their gains.
void bringTogether(const SurfaceSamples& samples, int threads, Points& values, PointTextureResult& result)
{
  Candidates candidates;
  candidates.begin = {0};
  for (const auto& patches : findOverlaps(samples, values, threads)) {
    for (const ScanPatch& patch : patches) {
      const Eigen::Array3f color = patch.value.array().max(0.f).min(255.f) + 0.5f;
      Candidate candidate{};
      candidate.view = patch.scan;
      candidate.color = {std::uint8_t(color[0]), std::uint8_t(color[1]), std::uint8_t(color[2])};
      candidate.quality = 1;
      candidates.list.push_back(candidate);
    }
    candidates.begin.push_back(candidates.list.size());
  }
  std::vector<int> scans(samples.stations.cols());
  std::iota(scans.begin(), scans.end(), 0);
  result.gains = solveGains(candidates, scans);
  for (Index i = 0; i < samples.size(); ++i)
    values.col(i) = values.col(i).cwiseProduct(result.gains.col(samples.scan[i]));
}

/// Logarithms of a sample's intensity, range and cosine of incidence; not finite where there is none.
Points logarithms(const PointSet& set, const SurfaceSamples& samples)
{
  Points out(3, samples.size());
  for (Index i = 0; i < samples.size(); ++i) {
    const Eigen::Vector3f beam = samples.stations.col(samples.scan[i]) - samples.places.col(i);
    const float cosine = std::abs(samples.normals.col(i).dot(beam.normalized()));
    out.col(i) << std::log(set.intensities[samples.points[i]]), std::log(beam.norm()),
        std::log(std::max(cosine, least_cosine));
  }
  return out;
}

/// log intensity = what the place reflects + gain of the scan + a log range + b log cosine.
struct IntensityModel {
  Eigen::VectorXd x; ///< gains, a, b
  double error = 0;  ///< median of what is left of the differences between scans
};

/// Cauchy-weighted least squares over the differences between scans at the same places.
IntensityModel fitIntensities(const std::vector<std::vector<ScanPatch>>& overlaps, Index scans, bool with_exponents)
{
  constexpr double regularization = 1e-3; // holds scans without partners at 1; nothing beside a pair's weight
  const Index size = scans + 2;
  IntensityModel model{Eigen::VectorXd::Zero(size), 0};
  for (int round = 0; round < reweightings; ++round) {
    Eigen::MatrixXd A = regularization * Eigen::MatrixXd::Identity(size, size);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(size), row(size);
    std::vector<double> errors;
    for (const auto& patches : overlaps)
      for (std::size_t k = 1; k < patches.size(); ++k) {
        const Eigen::Vector3d d = (patches[k].value - patches[k - 1].value).cast<double>();
        row.setZero();
        row[patches[k].scan] = 1;
        row[patches[k - 1].scan] = -1;
        if (with_exponents)
          row.tail<2>() = d.tail<2>();
        const double error = d[0] - row.dot(model.x), scale = std::max(model.error, 1e-6);
        if (!std::isfinite(error))
          continue;
        const double weight = round == 0 ? 1 : cauchyWeight(error * error / (scale * scale));
        A.noalias() += weight * row * row.transpose();
        b += weight * d[0] * row;
        errors.push_back(std::abs(error));
      }
    if (errors.empty())
      break;
    model.error = median(errors);
    model.x = A.ldlt().solve(b);
  }
  return model;
}

/// Takes out of the intensities what scanner, range and angle of incidence make of them, as far as scans that see the
/// same surface tell.
void equalizeIntensities(const PointSet& set, const SurfaceSamples& samples, Eigen::VectorXf& values,
                         const PointTextureOptions& options, PointTextureResult& result)
{
  const Points logs = logarithms(set, samples);
  const Index scans = samples.stations.cols();
  const auto overlaps = findOverlaps(samples, logs, options.threads);
  IntensityModel model = fitIntensities(overlaps, scans, false);
  const IntensityModel full = fitIntensities(overlaps, scans, true);
  if (full.error < clear_gain * model.error)
    model = full;
  const double mean = model.x.head(scans).mean();
  result.range_exponent = model.x[scans];
  result.incidence_exponent = model.x[scans + 1];
  for (Index s = 0; s < scans; ++s)
    result.gains.col(s).setConstant(std::exp(mean - model.x[s]));
  std::vector<float> ranges(logs.row(1).begin(), logs.row(1).end());
  const float typical = median(ranges);
  for (Index i = 0; i < samples.size(); ++i)
    values[i] *= result.gains(0, samples.scan[i]) *
                 std::exp(-result.range_exponent * (logs(1, i) - typical) - result.incidence_exponent * logs(2, i));
}

/// Intensities as grey: all but the darkest and the brightest hundredth fill the range. Those that fall with the range are
/// powers of light, of which displays take the power 1 / 2.2.
Points greyValues(const PointSet& set, const SurfaceSamples& samples, const PointTextureOptions& options,
                  PointTextureResult& result)
{
  Eigen::VectorXf values(samples.size());
  for (Index i = 0; i < samples.size(); ++i)
    values[i] = std::isfinite(set.intensities[samples.points[i]]) ? set.intensities[samples.points[i]] : 0.f;
  const auto quantile = [&](double share) {
    return rankedValue(std::vector<float>(values.begin(), values.end()), Index(share * (values.size() - 1)));
  };
  if (options.exposure && quantile(0.01) > 0) // numbers below 0 are no measure of light
    equalizeIntensities(set, samples, values, options, result);
  const float low = quantile(0.01), high = std::max(quantile(0.99), std::nextafter(low, 1e38f));
  values = ((values.array() - low) / (high - low)).max(0.f).min(1.f);
  constexpr double falling = -1; // between the square of the range and none
  const float power = result.range_exponent < falling ? 1 / 2.2f : 1.f;
  return (255.f * values.array().pow(power)).matrix().transpose().replicate<3, 1>();
}

/// Samples that none of their neighbours resembles get the mean of these: a beam that met two surfaces may have the
/// range of one and the colour of the other.
void replaceStrays(const SurfaceSamples& samples, int threads, Points& values)
{
  constexpr int neighbors = 9, least_others = 4; // those around a sample of a grid, and itself
  const Points given = values;
  forNearest(*samples.tree, neighbors, threads, [&](Index at, const int* found, Index count) {
    const std::vector<int>& columns = samples.tree->columns();
    const int i = columns[at];
    Eigen::Vector4f sum = Eigen::Vector4f::Zero();
    for (Index k = 0; k < count; ++k) {
      const int other = columns[found[k]];
      if (other == i || !(samples.normals.col(i).dot(samples.normals.col(other)) > SurfaceGaussian::same_side))
        continue;
      if ((given.col(i) - given.col(other)).cwiseAbs().maxCoeff() < one_octave) // noise and the grain of a material
        return;
      sum += given.col(other).homogeneous();
    }
    if (sum.w() >= least_others)
      values.col(i) = sum.head<3>() / sum.w();
  });
}

template <typename Values>
bool areEqual(const Values& values)
{
  return values == values.col(0).replicate(1, values.cols());
}
} // namespace

Points sampleValues(const PointSet& set, const SurfaceSamples& samples, const PointTextureOptions& options,
                    PointTextureResult& result)
{
  result.gains = Points::Ones(3, samples.stations.cols());
  Points values(3, samples.size());
  if (result.look == PointLook::intensities) {
    values = greyValues(set, samples, options, result);
  } else {
    for (Index i = 0; i < samples.size(); ++i)
      values.col(i) = set.colors.col(samples.points[i]).cast<float>();
    if (options.exposure)
      bringTogether(samples, options.threads, values, result);
  }
  replaceStrays(samples, options.threads, values);
  return values;
}
} // namespace fresco::texture

fresco::PointLook fresco::lookOf(const PointSet& points, std::vector<std::string>* warnings)
{
  const auto warn = [&](const char* text) {
    if (warnings)
      warnings->emplace_back(text);
  };
  if (points.colors.cols() > 0 && !texture::areEqual(points.colors))
    return PointLook::colors;
  if (points.colors.cols() > 0)
    warn(points.colors.maxCoeff() == 0 ? "the points' colours are all black and not used"
                                       : "the points' colours are all the same and not used");
  if (points.intensities.size() > 0 && !texture::areEqual(points.intensities.transpose()))
    return PointLook::intensities;
  if (points.intensities.size() > 0)
    warn("the points' intensities are all equal and not used");
  return PointLook::none;
}
