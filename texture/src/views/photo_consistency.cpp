// SPDX-License-Identifier: BSD-3-Clause
#include "views/photo_consistency.h"
#include <algorithm>
#include <fresco/core/parallel.h>
#include <fresco/core/statistics.h>
namespace fresco::texture {
namespace {
constexpr float one_octave = 20; // grey levels of difference that cost an octave: well above noise

/// Median per channel over the views with a vote; false if they are too few, or two that disagree.
bool consensus(const Candidates& candidates, Index patch, const Photometry& photometry, Eigen::Vector3f& color)
{
  constexpr std::size_t least_views = 3; // for a majority
  constexpr float trusted = 0.1f;        // of the best quality: views that show much less blur the colour
  const Candidate* list = candidates.of(patch);
  const Index n = candidates.count(patch);
  const float best = candidates.bestQuality(patch);
  std::vector<float> values[3];
  for (Index i = 0; i < n; ++i)
    if (list[i].quality() >= trusted * best && !list[i].clipped)
      for (int c = 0; c < 3; ++c)
        values[c].push_back(list[i].corrected(photometry)[c]);
  if (values[0].size() + 1 < least_views)
    return false;
  bool agree = true;
  for (int c = 0; c < 3; ++c) {
    agree = agree && std::fabs(values[c][0] - values[c][1]) < one_octave;
    color[c] = median(values[c]);
  }
  return values[0].size() >= least_views || agree;
}

/// What one photograph shows of the patches, by place.
class PictureEvidence {
public:
  explicit PictureEvidence(const CameraModel& camera)
      : cell_(std::max(camera.width, camera.height) / cells_across), columns_(camera.width / cell_ + 1),
        rows_(camera.height / cell_ + 1), cells_(columns_ * rows_)
  {}

  struct Sample {
    Eigen::Vector2f pixel;
    Eigen::Vector3f color;
    float difference; ///< grey levels, from what other photographs show
  };

  void add(const Sample& sample)
  {
    constexpr std::size_t most = 12; // per cell: what is beside looks alike
    if (std::vector<Sample>& cell = cells_[column(sample.pixel) + columns_ * row(sample.pixel)]; cell.size() < most)
      cell.push_back(sample);
  }

  /// Difference to expect of a place: that of places nearby which look like it.
  float expected(const Eigen::Vector2f& pixel, const Eigen::Vector3f& color) const
  {
    constexpr float alike = 20;       // grey levels (Gaussian)
    constexpr float innocence = 0.5f; // weight of no difference: of half a sample at the place itself
    float sum = 0, weights = innocence;
    const int x = column(pixel), y = row(pixel);
    for (int j = std::max(y - reach, 0); j <= std::min(y + reach, rows_ - 1); ++j)
      for (int i = std::max(x - reach, 0); i <= std::min(x + reach, columns_ - 1); ++i)
        for (const Sample& s : cells_[i + columns_ * j]) {
          const float w = std::exp(-0.5f * ((s.pixel - pixel).squaredNorm() / (4 * cell_ * cell_) +
                                            (s.color - color).squaredNorm() / (alike * alike)));
          sum += w * s.difference;
          weights += w;
        }
    return sum / weights;
  }

private:
  static constexpr float cells_across = 40; // a cell is some patches wide
  static constexpr int reach = 4;           // cells: two deviations of the Gaussian
  int column(const Eigen::Vector2f& p) const { return std::clamp<int>(p.x() / cell_, 0, columns_ - 1); }
  int row(const Eigen::Vector2f& p) const { return std::clamp<int>(p.y() / cell_, 0, rows_ - 1); }

  float cell_;
  int columns_, rows_;
  std::vector<std::vector<Sample>> cells_;
};

/// Patches and candidates of a view.
struct Shown {
  Index patch, candidate;
};

std::vector<std::vector<Shown>> shownByView(const PatchMesh& patches, const Candidates& candidates, Index views)
{
  std::vector<std::vector<Shown>> out(views);
  for (Index i = 0; i < patches.size(); ++i)
    for (Index c = candidates.begin[i]; c < candidates.begin[i + 1]; ++c)
      out[candidates.list[c].view].push_back({i, c});
  return out;
}

/// Differences of a view's candidates that nothing contradicts, from those around them in the photograph.
/// @param difference of each candidate; negative where it is to be found
void inferFromPicture(const PatchMesh& patches, const Candidates& candidates, const Projector& view,
                      const std::vector<Shown>& shown, std::vector<float>& difference)
{
  PictureEvidence evidence(view.camera());
  const auto colorOf = [&](Index c) {
    const auto& color = candidates.list[c].color;
    return Eigen::Vector3f(color[0], color[1], color[2]);
  };
  const auto pixelOf = [&](Index patch) { return Eigen::Vector2f(view(patches.middle(patch)).head<2>()); };
  for (const Shown& s : shown)
    if (difference[s.candidate] >= 0)
      evidence.add({pixelOf(s.patch), colorOf(s.candidate), difference[s.candidate]});
  for (const Shown& s : shown)
    if (difference[s.candidate] < 0)
      difference[s.candidate] = evidence.expected(pixelOf(s.patch), colorOf(s.candidate));
}

/// Mean with the same view's values on neighbouring patches.
std::vector<float> smoothed(const PatchMesh& patches, const Candidates& candidates, const std::vector<float>& value,
                            int threads)
{
  std::vector<float> out(value.size());
  parallelFor(patches.size(), threads, [&](Index i) {
    for (Index c = candidates.begin[i]; c < candidates.begin[i + 1]; ++c) {
      float sum = value[c], count = 1;
      for (int side = 0; side < 3; ++side)
        if (const int other = patches.neighbors(side, i); other >= 0)
          if (const Candidate* same = candidates.find(other, candidates.list[c].view)) {
            sum += value[same - candidates.list.data()];
            ++count;
          }
      out[c] = sum / count;
    }
  });
  return out;
}

/// Grey levels, from what most views show; -1 where too few of them see the patch.
std::vector<float> differencesFromConsensus(const PatchMesh& patches, const Candidates& candidates,
                                            const Photometry& photometry, int threads)
{
  std::vector<float> difference(candidates.list.size(), -1.f);
  parallelFor(patches.size(), threads, [&](Index i) {
    Eigen::Vector3f usual;
    if (consensus(candidates, i, photometry, usual))
      for (Index c = candidates.begin[i]; c < candidates.begin[i + 1]; ++c)
        difference[c] = (candidates.list[c].corrected(photometry) - usual).cwiseAbs().maxCoeff();
  });
  return difference;
}
} // namespace

PhotoConsistency photoConsistency(const PatchMesh& patches, const Candidates& candidates, const Photometry& photometry,
                                  const VisibilityInput& input)
{
  constexpr int smoothing_rounds = 2;  // what differs is a region; single patches differ by small errors of alignment
  constexpr float most_octaves = 5;    // by difference: a view that alone shows the patch well keeps a chance
  constexpr float clipped_octaves = 6; // loses to all that are not
  constexpr float certain = 3 * one_octave; // of another thing: few surfaces differ so much by the light alone
  const int threads = input.options.threads;
  std::vector<float> difference = differencesFromConsensus(patches, candidates, photometry, threads);
  PhotoConsistency out;
  out.foreign.resize(difference.size());
  std::transform(difference.begin(), difference.end(), out.foreign.begin(), [](float d) { return d < 0; });
  const auto shown = shownByView(patches, candidates, input.views.projectors.size());
  parallelFor(
      shown.size(), threads,
      [&](Index v) { inferFromPicture(patches, candidates, input.views.projectors[v], shown[v], difference); }, 1);
  for (std::size_t c = 0; c < difference.size(); ++c)
    out.foreign[c] = out.foreign[c] && difference[c] > certain;
  for (int round = 0; round < smoothing_rounds; ++round)
    difference = smoothed(patches, candidates, difference, threads);
  out.penalties.resize(difference.size());
  parallelFor(difference.size(), threads, [&](Index c) {
    const float octaves = difference[c] / one_octave;
    out.penalties[c] = std::min(octaves * octaves, most_octaves) + (candidates.list[c].clipped ? clipped_octaves : 0.f);
  });
  return out;
}
} // namespace fresco::texture
