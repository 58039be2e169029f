// SPDX-License-Identifier: BSD-3-Clause
#include "bilateral/crease_normals.h"
#include "bilateral/candidate_score.h"
#include "bilateral/direction_grid.h"
#include "normals/view_direction.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/statistics.h>
namespace fresco::filters {
namespace {
constexpr float cell_spacings = 64.f; // edge of the cells in which directions are counted

class CreaseNormals {
public:
  CreaseNormals(const SmoothingField& field, const Points& viewpoints, const Points& normals, int threads)
      : field_(field), viewpoints_(viewpoints), normals_(normals),
        grid_(cell_spacings * std::sqrt(typicalArea(field.areas)))
  {
    markCreases(threads);
    grid_.finish(threads);
  }

  void compare(int threads, const UseNormalCandidates& use) const
  {
    parallelFor(field_.lists.size(), threads, [&](Index range) {
      const CompressedLists& lists = field_.lists[range];
      CompressedReader reader(lists);
      std::vector<int> list;
      std::vector<NormalCandidate> candidates;
      std::vector<CandidateNeighbor> near;
      NormalCandidateFeatures features;
      for (Index i = lists.begin; i < lists.end; ++i) {
        reader.next(list);
        if (!at_crease_[i])
          continue;
        const Eigen::Vector3f ray = beam(i);
        const DirectionGrid::Surroundings& around = grid_.at(field_.tree->point(i));
        setCandidates(i, ray, around, candidates);
        if (candidates.size() < 2)
          continue;
        setNeighbors(i, list, near);
        features.set(near, ray, around.noise);
        use(i, candidates, features);
      }
    });
  }

private:
  static float typicalArea(const Eigen::VectorXf& areas)
  {
    std::vector<float> sorted;
    for (const float area : areas)
      if (area > 0 && std::isfinite(area))
        sorted.push_back(area);
    return sorted.empty() ? 1.f : median(sorted);
  }

  void markCreases(int threads)
  {
    constexpr float agreeing = 0.94f;      // cosine between normals of one surface
    constexpr float part_at_crease = 0.3f; // that a normal counts for a direction where its neighbours do not agree
    at_crease_.assign(normals_.cols(), 0);
    std::vector<float> noises(at_crease_.size());
    parallelFor(field_.lists.size(), threads, [&](Index range) {
      const CompressedLists& lists = field_.lists[range];
      CompressedReader reader(lists);
      std::vector<int> list;
      for (Index i = lists.begin; i < lists.end; ++i) {
        reader.next(list);
        const Eigen::Vector3f normal = normals_.col(i);
        const bool crease =
            std::any_of(list.begin(), list.end(), [&](int j) { return !(normals_.col(j).dot(normal) > agreeing); });
        at_crease_[i] = crease;
        noises[i] = crease ? 0.f : noiseAt(i, list);
      }
    });
    for (Index i = 0; i < normals_.cols(); ++i) {
      const float weight = field_.areas[i] * (at_crease_[i] ? part_at_crease : 1.f);
      grid_.add({field_.tree->point(i), normals_.col(i), weight, noises[i]});
    }
  }

  /// Deviation of the neighbours across the plane of a point, along its beam; 0 where the beam grazes.
  float noiseAt(Index i, const std::vector<int>& list) const
  {
    constexpr std::size_t fewest = 8; // neighbours that tell the noise
    const Eigen::Vector3f normal = normals_.col(i);
    const float cosine = -normal.dot(beam(i));
    if (cosine < 0.3f || list.size() <= fewest)
      return 0;
    double sum = 0, squares = 0;
    for (const int j : list) {
      const double off = normal.dot(field_.tree->point(j) - field_.tree->point(i));
      sum += off;
      squares += off * off;
    }
    const double count = list.size();
    return std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count))) / cosine;
  }

  /// From the viewer to the point, unit; zero where unknown.
  Eigen::Vector3f beam(Index i) const
  {
    return -viewDirection(viewpoints_, field_.tree->columns()[i], field_.tree->point(i)).normalized();
  }

  void setNeighbors(Index i, const std::vector<int>& list, std::vector<CandidateNeighbor>& near) const
  {
    near.clear();
    for (const int j : list)
      if (j != i)
        near.push_back({field_.tree->point(j) - field_.tree->point(i), normals_.col(j), at_crease_[j] != 0});
  }

  /// The own normal first; none where it does not face the viewer or the noise is unknown.
  void setCandidates(Index i, const Eigen::Vector3f& ray, const DirectionGrid::Surroundings& around,
                     std::vector<NormalCandidate>& all) const
  {
    constexpr float grazing = 0.08f; // cosine to the beam at least
    const Eigen::Vector3f own = normals_.col(i);
    all.clear();
    if (!(around.noise > 0) || -own.dot(ray) < grazing)
      return;
    all.push_back({own, 0, 1});
    for (std::size_t k = 0; k < around.directions.size(); ++k) {
      const Eigen::Vector3f& direction = around.directions[k];
      const float to_own = direction.dot(own);
      if (to_own > same_direction)
        all.front().share = std::max(all.front().share, around.shares[k]);
      else if (-direction.dot(ray) >= grazing)
        all.push_back({direction, around.shares[k], to_own});
    }
  }

  const SmoothingField& field_;
  const Points& viewpoints_;
  const Points& normals_;
  DirectionGrid grid_;
  std::vector<char> at_crease_; ///< by position
};

} // namespace

void forCreaseCandidates(const SmoothingField& field, const Points& viewpoints, const Points& normals, int threads,
                         const UseNormalCandidates& use)
{
  CreaseNormals(field, viewpoints, normals, threads).compare(threads, use);
}

Points selectCreaseNormals(const SmoothingField& field, const Points& viewpoints, const Points& normals, int threads)
{
  Points chosen = normals;
  forCreaseCandidates(field, viewpoints, normals, threads,
                      [&](Index i, const std::vector<NormalCandidate>& candidates, NormalCandidateFeatures& features) {
                        const NormalCandidateFeatures::Features own = features.of(candidates.front());
                        const CandidateScore score(own);
                        float most = score.of(own);
                        for (std::size_t k = 1; k < candidates.size(); ++k)
                          if (const float its = score.of(features.of(candidates[k])); its > most) {
                            most = its;
                            chosen.col(i) = candidates[k].direction;
                          }
                      });
  return chosen;
}
} // namespace fresco::filters
