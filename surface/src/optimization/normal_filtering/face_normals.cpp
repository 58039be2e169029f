// SPDX-License-Identifier: BSD-3-Clause
#include "optimization/normal_filtering/face_normals.h"
#include <algorithm>
#include <fresco/core/parallel.h>
#include <fresco/core/simd.h>
namespace fresco::optimization {
namespace {
using namespace simd;
using Eigen::Vector3f;

// Normal of a face; of a small one also that of the faces around its corners.
Eigen::Vector3d startNormal(const MeshGraph& graph, const Eigen::Matrix3Xd& areas, Index f)
{
  const double length = areas.col(f).norm();
  Eigen::Vector3d sum = areas.col(f), around = sum;
  if (length < small_area) {
    for (int k = 0; k < 3; ++k)
      for (const int g : facesAround(graph, graph.faces(k, f)))
        around += areas.col(g);
    sum += (small_area - length) * around.normalized();
  }
  return sum.normalized();
}

// A face and what the data on it say, interleaved, so that both are weighed at once.
struct Sample {
  float x[2], y[2], z[2]; // normal of the face, that of its data; unit or zero
  float area[2];
  Vector3f normal() const { return {x[0], y[0], z[0]}; }
  void setNormal(const Vector3f& n)
  {
    x[0] = n.x();
    y[0] = n.y();
    z[0] = n.z();
  }
};

// Two samples: lanes of the first, lanes of the second.
struct SamplePair {
  SamplePair(const Sample& a, const Sample& b)
  {
    const auto a0 = load<Float4>(a.x), a1 = load<Float4>(a.z), b0 = load<Float4>(b.x), b1 = load<Float4>(b.z);
    x = __builtin_shufflevector(a0, b0, 0, 1, 4, 5);
    y = __builtin_shufflevector(a0, b0, 2, 3, 6, 7);
    z = __builtin_shufflevector(a1, b1, 0, 1, 4, 5);
    area = __builtin_shufflevector(a1, b1, 2, 3, 6, 7);
  }
  Float4 x, y, z, area;
};

float ofFaces(const Float4& lanes) { return lanes[0] + lanes[2]; }
float ofAll(const Float4& lanes) { return ofFaces(lanes) + (lanes[1] + lanes[3]); }

// The faces around the corners of each face, as often as they share one with it, itself three times; an even number,
// filled up with `none`.
class Neighbours {
public:
  Neighbours(const MeshGraph& graph, int none, int threads) : begin_(graph.faceCount() + 1, 0)
  {
    for (Index f = 0; f < graph.faceCount(); ++f) {
      Index count = 0;
      for (int k = 0; k < 3 && graph.face_edges(0, f) >= 0; ++k)
        count += facesAround(graph, graph.faces(k, f)).size();
      begin_[f + 1] = begin_[f] + (count + 1) / 2 * 2;
    }
    faces_.resize(begin_.back(), none);
    parallelFor(graph.faceCount(), threads, [&](Index f) {
      auto next = faces_.begin() + begin_[f];
      for (int k = 0; k < 3 && graph.face_edges(0, f) >= 0; ++k) {
        const IntRange around = facesAround(graph, graph.faces(k, f));
        next = std::copy(around.begin(), around.end(), next);
      }
    });
  }

  IntRange of(Index f) const { return {faces_.data() + begin_[f], faces_.data() + begin_[f + 1]}; }

private:
  std::vector<Index> begin_;
  std::vector<int> faces_;
};

class NormalFilter {
public:
  NormalFilter(const MeshGraph& graph, const NormalFilterOptions& options)
      : graph_(graph), threads_(options.threads), squared_cutoff_(5.0 * options.sigma * options.sigma),
        neighbours_(graph, graph.faceCount(), options.threads), samples_(graph.faceCount() + 1, Sample{}),
        mean_(Eigen::Matrix3Xf::Zero(3, graph.faceCount() + 1)),
        agreement_(Eigen::VectorXf::Constant(graph.faceCount() + 1, -1.f))
  {}

  void start(const Eigen::Matrix3Xd& areas, const Eigen::Matrix3Xf& given)
  {
    parallelFor(graph_.faceCount(), threads_, [&](Index f) {
      Sample& sample = samples_[f];
      sample.area[0] = areas.col(f).norm();
      sample.area[1] = given.col(f).norm();
      const Vector3f data = sample.area[1] > 0.f ? (given.col(f) / sample.area[1]).eval() : Vector3f::Zero().eval();
      sample.x[1] = data.x();
      sample.y[1] = data.y();
      sample.z[1] = data.z();
      sample.setNormal(sample.area[0] > 1e-12f ? startNormal(graph_, areas, f).cast<float>().eval()
                                               : Vector3f::Zero().eval());
    });
  }

  void round()
  {
    parallelFor(graph_.faceCount(), threads_, [&](Index f) { findMean(f); });
    parallelFor(graph_.faceCount(), threads_, [&](Index f) { samples_[f].setNormal(replaced(f)); });
  }

  Eigen::Matrix3Xf normals() const
  {
    Eigen::Matrix3Xf normals(3, graph_.faceCount());
    parallelFor(graph_.faceCount(), threads_, [&](Index f) { normals.col(f) = samples_[f].normal(); });
    return normals;
  }

private:
  // Mean of f and the faces around it, by areas and likeness, and the share of the area around it that is like it.
  void findMean(Index f)
  {
    // Tukey's biweight (1 - t^2 / s^2)^2 of the difference t, 0 from s on. With s^2 = 5 sigma^2 the influence of a
    // difference is greatest at t = sigma, and falls beyond (Black, Sapiro, Marimont, Heeger 1998, "Robust anisotropic
    // diffusion", sec. IV). Of unit vectors t^2 = 2 - 2 cos; zero vectors have no weight.
    const float slope = 2.f / squared_cutoff_, offset = 1.f - slope;
    const Vector3f own = samples_[f].normal();
    Float4 x{}, y{}, z{}, area{}, alike{};
    const IntRange around = neighbours_.of(f);
    for (const int* g = around.begin(); g != around.end(); g += 2) {
      const SamplePair pair(samples_[g[0]], samples_[g[1]]);
      const Float4 cosines = pair.x * own.x() + pair.y * own.y() + pair.z * own.z();
      const Float4 rest = larger(offset + slope * cosines, Float4{}), weight = pair.area * rest * rest;
      x += weight * pair.x;
      y += weight * pair.y;
      z += weight * pair.z;
      area += pair.area;
      alike += weight;
    }
    agreement_[f] = ofFaces(area) > 0.f ? ofFaces(alike) / ofFaces(area) : 0.f;
    const Vector3f sum = samples_[f].area[0] * own + Vector3f(ofAll(x), ofAll(y), ofAll(z));
    const float length = sum.norm();
    mean_.col(f) = length > 1e-12f ? (sum / length).eval() : own;
  }

  // The mean; for an outlier, that of the neighbours that agree most with their own, within `close`.
  Vector3f replaced(Index f) const
  {
    // A face that agrees with less of the area around it is an outlier. Of 0.45, 0.55 and 0.65 the best on fandisk.
    constexpr double outlier_share = 0.6, agreeing_share = 0.7, close = 0.05;
    const double outlier = ramp(agreement_[f], agreeing_share, outlier_share);
    const IntRange around = neighbours_.of(f);
    if (around.size() == 0 || outlier == 0.0)
      return mean_.col(f);
    double best = agreement_[f];
    for (const int g : around)
      best = std::max<double>(best, agreement_[g]);
    Vector3f sum = Vector3f::Zero();
    for (const int g : around)
      sum += static_cast<float>(ramp(agreement_[g], best - close, best)) * mean_.col(g);
    const double by = outlier * ramp(best, agreement_[f], agreement_[f] + close);
    const Vector3f mixed = static_cast<float>(1.0 - by) * mean_.col(f) + static_cast<float>(by) * sum.normalized();
    return mixed.normalized();
  }

  const MeshGraph& graph_;
  int threads_;
  float squared_cutoff_;
  Neighbours neighbours_;
  std::vector<Sample> samples_; // the last one, without area, fills up neighbours
  Eigen::Matrix3Xf mean_;       // unit
  Eigen::VectorXf agreement_;   // share of the area around a face; negative for what fills up
};
} // namespace

Eigen::Matrix3Xf filterNormals(const MeshGraph& graph, const Eigen::Matrix3Xd& areas, const Eigen::Matrix3Xf& given,
                               const NormalFilterOptions& options)
{
  NormalFilter filter(graph, options);
  filter.start(areas, given);
  for (int round = 0; round < options.rounds; ++round)
    filter.round();
  return filter.normals();
}
} // namespace fresco::optimization
