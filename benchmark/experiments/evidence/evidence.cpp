// SPDX-License-Identifier: BSD-3-Clause
// The evidence of benchmark/experiments/evidence/ beside today's decisions, on the same proposals and against known poses.
#include "evidence/evidence_input.h"
#include "refinement/placement.h"
#include "support/tool.h"
#include <iostream>
#include <map>
#include <numeric>
using namespace fresco::registration;
namespace {
using fresco::Index;
using fresco::benchmark::EvidenceInput;
using fresco::benchmark::Poses;

std::vector<ScanPatches> patchesOf(const EvidenceInput& input)
{
  std::vector<ScanPatches> patches(input.scans.size());
  fresco::parallelFor(
      patches.size(), 0, [&](Index i) { patches[i] = makePatches(input.scans[i]); }, 1);
  return patches;
}

void printSide(const ScanEvidence& evidence)
{
  for (const RoomAgreement& room : evidence.rooms) {
    if (room.compared == 0.0)
      continue;
    std::cout << (room.own ? " own" : " other");
    for (const double count : room.confirmed)
      std::cout << ' ' << count;
    std::cout << ' ' << room.compared;
  }
  std::cout << " groups";
  for (const double count : evidence.contradicted)
    std::cout << ' ' << count;
}

// A line per proposal: error, then the evidence of both sides.
void printPairs(const EvidenceInput& input)
{
  const std::vector<ScanPatches> patches = patchesOf(input);
  std::vector<std::array<ScanEvidence, 2>> sides(input.proposals.size());
  fresco::parallelFor(
      sides.size(), 0,
      [&](Index k) {
        const ProposedPlace& p = input.proposals[k];
        const PatchVotes of_b = votesOf(input.scans[p.a], patches[p.b], p.T_a_b),
                         of_a = votesOf(input.scans[p.b], patches[p.a], p.T_a_b.inverse());
        sides[k] = {judge(patches[p.a], {&of_a}), judge(patches[p.b], {&of_b})};
      },
      1);
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const ProposedPlace& p = input.proposals[k];
    const auto error =
        fresco::benchmark::errorOf(p.T_a_b, input.truth[p.a].inverse() * input.truth[p.b], Eigen::Vector3d::Zero());
    std::cout << "pair " << p.a << ' ' << p.b << ' ' << error.distance << ' ' << error.degrees << " sides";
    for (const ScanEvidence& side : sides[k])
      printSide(side);
    std::cout << '\n';
  }
}

// Smaller share of the surfaces that two scans have in common, at their true poses.
double trueOverlap(const EvidenceInput& input, Index a, Index b)
{
  const ScanLevel &level_a = input.scans[a].levels[check_level], &level_b = input.scans[b].levels[check_level];
  const Eigen::Isometry3f T = (input.truth[a].inverse() * input.truth[b]).cast<float>();
  OverlapTest test;
  test.distance = 2.f * level_a.voxel;
  return std::min(overlapShare(level_b, level_a, T, test), overlapShare(level_a, level_b, T.inverse(), test));
}

// A line per pair of scans: true overlap, proposals, whether one of them is right; then the largest set of scans that pairs of
// at least a tenth connect.
void printRecall(const EvidenceInput& input)
{
  const Index n = input.scans.size();
  std::vector<Index> root(n);
  std::iota(root.begin(), root.end(), Index(0));
  for (Index a = 0; a < n; ++a)
    for (Index b = a + 1; b < n; ++b) {
      const double overlap = trueOverlap(input, a, b);
      int proposals = 0, right = 0;
      for (const ProposedPlace& p : input.proposals)
        if (p.a == a && p.b == b) {
          const auto error =
              fresco::benchmark::errorOf(p.T_a_b, input.truth[a].inverse() * input.truth[b], Eigen::Vector3d::Zero());
          ++proposals;
          right += error.distance < 0.2 && error.degrees < 3.0 ? 1 : 0;
        }
      std::cout << "overlap " << overlap << ' ' << proposals << ' ' << right << '\n';
      if (overlap >= 0.1)
        std::replace(root.begin(), root.end(), Index(root[b]), Index(root[a]));
    }
  Index largest = 0;
  for (const Index r : root)
    largest = std::max<Index>(largest, std::count(root.begin(), root.end(), r));
  std::cout << "bound " << largest << " of " << n << '\n';
}

/// Poses of one frame against the truth.
struct FrameResult {
  int scans = 0, wrong = 0;
};

// Frames whose poses are refined as registerScans() does; wrong: more than 5 cm or 1 degree off the largest set that agrees.
FrameResult compareFrame(const EvidenceInput& input, const ScanCluster& frame)
{
  Placement placement;
  placement.members = frame.scans;
  placement.poses = frame.poses;
  refinePlacement(input.scans, input.options, placement, {});
  int most = 0;
  for (std::size_t i = 0; i < frame.scans.size(); ++i) {
    int right = 0;
    for (std::size_t k = 0; k < frame.scans.size(); ++k) {
      const auto error = fresco::benchmark::errorOf(placement.poses[i].inverse() * placement.poses[k],
                                                    input.truth[frame.scans[i]].inverse() * input.truth[frame.scans[k]],
                                                    Eigen::Vector3d::Zero());
      right += error.distance < 0.05 && error.degrees < 1.0 ? 1 : 0;
    }
    most = std::max(most, right);
  }
  const int count = frame.scans.size();
  return {count, count - most};
}

// Remembers frames: their refinement is what takes time.
void printFrames(const EvidenceInput& input, const Arrangement& arrangement)
{
  static std::map<std::vector<Index>, FrameResult> known;
  for (const ScanCluster& frame : arrangement.frames)
    if (frame.scans.size() > 1 && !input.truth.empty()) {
      std::vector<Index> key = frame.scans;
      for (const Eigen::Isometry3d& pose : frame.poses)
        for (int k = 0; k < 3; ++k)
          key.push_back(std::lround(10.0 * (frame.poses[0].inverse() * pose).translation()[k]));
      const auto [slot, fresh] = known.try_emplace(key);
      if (fresh)
        slot->second = compareFrame(input, frame);
      std::cout << ' ' << slot->second.scans << '/' << slot->second.wrong;
    }
  std::cout << std::endl;
}

// Which scans of a part lie in their frame as they should: all, relative to the rest.
bool isRight(const EvidenceInput& input, const Arrangement& arrangement, const PartMargin& part)
{
  const ScanCluster& frame = arrangement.frames[part.frame];
  const auto off = [&](std::size_t i, std::size_t k) {
    const auto error = fresco::benchmark::errorOf(frame.poses[i].inverse() * frame.poses[k],
                                                  input.truth[frame.scans[i]].inverse() * input.truth[frame.scans[k]],
                                                  Eigen::Vector3d::Zero());
    return error.distance > 0.3 || error.degrees > 6.0;
  };
  int wrong = 0, all = 0;
  for (std::size_t i = 0; i < frame.scans.size(); ++i)
    for (std::size_t k = 0; k < frame.scans.size(); ++k) {
      const auto in = [&](std::size_t x) {
        return std::find(part.scans.begin(), part.scans.end(), frame.scans[x]) != part.scans.end();
      };
      if (!in(i) || in(k))
        continue;
      ++all;
      wrong += off(i, k) ? 1 : 0;
    }
  return 2 * wrong < all;
}

// What speaks for and against the true arrangement.
void printTruth(FrameJudge& judge, const EvidenceInput& input)
{
  ScanCluster truth;
  for (std::size_t i = 0; i < input.truth.size(); ++i) {
    truth.scans.push_back(i);
    truth.poses.push_back(input.truth[i]);
  }
  std::array<double, group_bins> groups{};
  for (std::size_t i = 0; i < truth.scans.size(); ++i) {
    const ScanEvidence evidence = judge.evidenceOf(truth, i);
    for (int bin = 0; bin < group_bins; ++bin)
      groups[bin] += evidence.contradicted[bin];
  }
  std::cout << "truth log-odds " << judge.logOdds(truth) << " contradicted groups";
  for (const double count : groups)
    std::cout << ' ' << count;
  std::cout << '\n';
}

// The best arrangement, and what is left of it at several margins, for several priors of a join.
void printSearch(const EvidenceInput& input)
{
  SearchOptions options;
  options.tolerance = 4.0 * input.options.voxel;
  EvidenceModel model = fittedModel();
  const double fitted_prior = model.prior;
  for (const double shift : {0.0, 2.0, 3.0, 4.0}) {
    const double start = fresco::benchmark::processorSeconds();
    model.prior = fitted_prior + shift;
    FrameJudge judge(input.scans, input.proposals, model, 0);
    if (shift == 0.0 && !input.truth.empty())
      printTruth(judge, input);
    const Arrangement best = findArrangement(judge, input.proposals, options);
    std::cout << "shift " << shift << " room " << judge.roomBound() << " log-odds " << best.log_odds << " s "
              << fresco::benchmark::processorSeconds() - start << " frames";
    printFrames(input, best);
    for (const PartMargin& part : findMargins(judge, input.proposals, options, best))
      std::cout << "margin " << shift << ' ' << part.margin << " scans " << part.scans.size() << " right "
                << isRight(input, best, part) << '\n';
    for (const double least : {0.5, 1.0, 2.0, 3.0, 4.0, 5.0}) {
      std::cout << "certain " << shift << ' ' << least << " frames";
      printFrames(input, keepCertain(judge, input.proposals, options, best, least));
    }
  }
}

void run(int argc, char** argv)
{
  fresco::Args args(
      "fresco_benchmark_evidence freeze|pairs|recall|search TRUTH.txt PROPOSALS.txt SCAN SCAN...",
      "freeze: writes PROPOSALS.txt, the places that registration finds for pairs.\n"
      "pairs: prints the evidence for each proposal, with its error.\n"
      "recall: prints for each pair of scans its true overlap, proposals, right ones; the bound of recall.\n"
      "search: finds the best arrangement; prints its frames (scans / wrong ones) at several margins.");
  const std::vector<std::string> words = args.parse(argc, argv, 5, 100000);
  EvidenceInput input = fresco::benchmark::prepareInput({words.begin() + 3, words.end()}, words[1]);
  if (words[0] == "freeze") {
    const double start = fresco::benchmark::processorSeconds();
    const ScanGraph today = fresco::benchmark::freezeProposals(input, words[2]);
    std::cout << "today s " << fresco::benchmark::processorSeconds() - start << " frames";
    printFrames(input, {today.clusters, 0.0});
    return;
  }
  fresco::benchmark::readProposals(words[2], input);
  if (words[0] == "pairs")
    printPairs(input);
  else if (words[0] == "recall")
    printRecall(input);
  else if (words[0] == "search")
    printSearch(input);
  else
    throw fresco::UsageError("the first word is freeze, pairs, recall or search");
}
} // namespace

int main(int argc, char** argv)
{
  return fresco::runTool("fresco_benchmark_evidence", [&] { run(argc, argv); });
}
