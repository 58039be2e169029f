// SPDX-License-Identifier: BSD-3-Clause
#include "painting/seam_levelling.h"
#include "painting/conjugate_gradient.h"
#include "views/picture_evidence.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/robust_weights.h>
namespace fresco::texture {
namespace {
class Levelling {
public:
  Levelling(const BlendInput& input, const Groups& around, const VertexViews& shares)
      : patches_(input.patches), around_(around), shares_(shares), input_(input), photometry_(input.photometry)
  {
    out_.begin.assign(1, 0);
    for (const auto& list : shares_)
      out_.begin.push_back(out_.begin.back() + list.size());
  }

  SeamOffsets run(const BlendOptions& options)
  {
    const Index n = out_.begin.back();
    right_ = Points::Zero(3, n);
    constexpr float regularization = 1e-3f; // small against smoothness: offsets fade over tens of edges
    diagonal_ = Eigen::VectorXf::Constant(n, regularization);
    for (std::size_t v = 0; v < shares_.size(); ++v)
      addSeams(v);
    addSmoothness();
    if (options.border)
      holdBorder(*options.border);
    constexpr int iterations = 300;
    constexpr float tolerance = 1e-3f; // of a grey level, about
    out_.offsets = solveSymmetric({diagonal_, std::move(entries_)}, right_, {iterations, tolerance, options.threads});
    if (options.border)
      keepBorder(*options.border);
    return std::move(out_);
  }

private:
  /// Pulls the offsets that another tile has found to what they are.
  void holdBorder(const BorderOffsets& border)
  {
    constexpr float strong = 1e3f; // beside the equations, which sum up to some tens
    border.forKnown(patches_, shares_, [&](Index v, std::size_t share, const Eigen::Vector3f& offset) {
      const Index i = out_.begin[v] + share;
      diagonal_[i] += strong;
      right_.col(i) += strong * offset;
    });
  }

  void keepBorder(BorderOffsets& border)
  {
    border.forKnown(patches_, shares_, [&](Index v, std::size_t share, const Eigen::Vector3f& offset) {
      out_.offsets.col(out_.begin[v] + share) = offset;
    });
    border.add(patches_, shares_,
               [&](Index v, std::size_t share) -> Eigen::Vector3f { return out_.offsets.col(out_.begin[v] + share); });
  }

  /// weight * (x_i - x_j - difference)^2
  void addEquation(int i, int j, float weight, const Eigen::Vector3f& difference)
  {
    diagonal_[i] += weight;
    diagonal_[j] += weight;
    entries_.push_back({i, j, -weight});
    right_.col(i) += weight * difference;
    right_.col(j) -= weight * difference;
  }

  /// What two views at a vertex differ by is to go. Steps of more than two octaves rather come from something that moved or
  /// stood in the way.
  void addSeams(std::size_t v)
  {
    const auto& list = shares_[v];
    for (std::size_t a = 0; a < list.size(); ++a)
      for (std::size_t b = a + 1; b < list.size(); ++b) {
        Eigen::Vector3f step = Eigen::Vector3f::Zero();
        float count = 0;
        for (int k = around_.begin[v]; k < around_.begin[v + 1]; ++k) {
          const Candidate *ca = input_.usable(around_.list[k], list[a].view),
                          *cb = input_.usable(around_.list[k], list[b].view);
          if (!ca || !cb || ca->clipped || cb->clipped)
            continue;
          step += cb->corrected(photometry_) - ca->corrected(photometry_);
          ++count;
        }
        if (!(count > 0))
          continue;
        step /= count;
        const float trust = cauchyWeight(step.squaredNorm() / (4 * one_octave * one_octave));
        addEquation(out_.begin[v] + a, out_.begin[v] + b, 4 * trust * std::min(list[a].weight, list[b].weight), step);
      }
  }

  /// Along every edge, for each view that takes part at both ends.
  void addSmoothness()
  {
    constexpr float smoothness = 0.3f; // against a step between views: steps vanish, what they change spreads
    entries_.reserve(entries_.size() + 2 * patches_.size());
    for (Index i = 0; i < patches_.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const int other = patches_.neighbors(k, i);
        if (other >= 0 && other < i)
          continue;
        const float weight = other >= 0 ? 2 * smoothness : smoothness; // of both patches
        const int p = patches_.faces(k, i), q = patches_.faces((k + 1) % 3, i);
        const auto &a = shares_[p], &b = shares_[q];
        for (std::size_t s = 0, t = 0; s < a.size() && t < b.size();) {
          if (a[s].view == b[t].view)
            addEquation(out_.begin[p] + s, out_.begin[q] + t, weight, Eigen::Vector3f::Zero());
          const bool next_a = a[s].view <= b[t].view, next_b = b[t].view <= a[s].view;
          s += next_a;
          t += next_b;
        }
      }
  }

  const PatchMesh& patches_;
  const Groups& around_;
  const VertexViews& shares_;
  const BlendInput& input_;
  const Photometry& photometry_;
  SeamOffsets out_;
  std::vector<OffDiagonal> entries_;
  Eigen::VectorXf diagonal_;
  Points right_; ///< 3xN
};
} // namespace

SeamOffsets levelSeams(const BlendInput& input, const Groups& around, const VertexViews& shares,
                       const BlendOptions& options)
{
  return Levelling(input, around, shares).run(options);
}
} // namespace fresco::texture
