// SPDX-License-Identifier: BSD-3-Clause
// Registration against known poses: of pairs from features (pairs), of all scans (map), of pairs from disturbed poses
// (converge); which pairs would be tried (candidates).
#include "experiments/registration_input.h"
#include "pair/pair_alignment.h"
#include "pair/pair_ranking.h"
#include "pair/self_alignment.h"
#include "support/tool.h"
#include <fresco/io/file.h>
#include <fresco/registration/core/scan_registration.h>
#include <iomanip>
#include <iostream>
using namespace fresco::registration;
namespace {
using fresco::benchmark::errorOf;
using fresco::benchmark::PoseError;
using fresco::benchmark::processorSeconds;
using fresco::benchmark::RegistrationInput;

// Near enough for refinement: metres, degrees.
bool isRight(const PoseError& error) { return error.distance < 0.2 && error.degrees < 6.0; }

/// Counts of one class of overlap.
struct Class {
  double least = 0.0;
  int pairs = 0, right = 0, certain_right = 0, certain_wrong = 0;
};

std::vector<Class> overlapClasses() { return {{0.5}, {0.3}, {0.1}, {0.0}}; }

Class& classOf(std::vector<Class>& classes, double overlap)
{
  return *std::find_if(classes.begin(), classes.end(), [&](const Class& c) { return overlap >= c.least; });
}

/// As registerScans() thins.
Thinning thinningForFeatures(const RegistrationInput& input)
{
  double size = 0.0, narrowness = 0.0;
  for (const fresco::PointSet& scan : input.scans) {
    size = std::max(size, scanSize(scan));
    narrowness += fresco::registration::narrowness(scan) / input.scans.size();
  }
  return {input.voxel, size, narrowness};
}

std::vector<PreparedScan> prepareAll(const RegistrationInput& input, const Thinning& thinning)
{
  std::vector<PreparedScan> scans;
  for (const fresco::PointSet& scan : input.scans)
    scans.push_back(prepareScan(scan, thinning, 0));
  return scans;
}

/// Of two scans at their true relative pose.
double trueOverlap(const std::vector<PreparedScan>& scans, const RegistrationInput& input, std::size_t a, std::size_t b)
{
  const Eigen::Isometry3d T_a(Eigen::Translation3d(scans[a].center)), T_b(Eigen::Translation3d(scans[b].center));
  return checkPair(scans[a], scans[b], T_a.inverse() * input.relative(a, b) * T_b, check_level).overlap;
}

void countPair(const PairAlignment& pair, const PoseError& error, Class& own)
{
  ++own.pairs;
  if (pair.hypotheses.empty())
    return;
  own.right += isRight(error) ? 1 : 0;
  own.certain_right += isRight(error) && !pair.ambiguous ? 1 : 0;
  own.certain_wrong += !isRight(error) && !pair.ambiguous ? 1 : 0;
}

void measurePairs(const RegistrationInput& input, const std::string& overlap_file)
{
  const double start = processorSeconds();
  std::vector<PreparedScan> scans = prepareAll(input, thinningForFeatures(input));
  std::vector<ScanFeatures> features;
  for (PreparedScan& scan : scans) {
    features.push_back(describeScan(scan, {}));
    scan.aliases = findAliases(scan, features.back());
  }
  const double prepared = processorSeconds();
  std::vector<Class> classes = overlapClasses();
  std::string overlaps;
  int tried = 0;
  double aligning = 0.0;
  for (std::size_t a = 0; a < scans.size(); ++a)
    for (std::size_t b = a + 1; b < scans.size(); ++b, ++tried) {
      const double before = processorSeconds();
      const auto pair = alignPair({scans[a], features[a]}, {scans[b], features[b]}, {});
      aligning += processorSeconds() - before;
      const double overlap = trueOverlap(scans, input, a, b);
      overlaps += fresco::concat(a, " ", b, " ", overlap, "\n");
      const Eigen::Isometry3d T_a(Eigen::Translation3d(scans[a].center)), T_b(Eigen::Translation3d(scans[b].center));
      const Eigen::Isometry3d found =
          pair.hypotheses.empty() ? Eigen::Isometry3d::Identity() : T_a * pair.hypotheses[0].T_a_b * T_b.inverse();
      countPair(pair, errorOf(found, input.relative(a, b), input.middles[b]), classOf(classes, overlap));
    }
  if (!overlap_file.empty())
    fresco::writeFile(overlap_file, overlaps);
  std::cout << "overlap  pairs  right  held certain: right  wrong\n";
  for (const Class& c : classes)
    std::cout << "> " << std::setw(3) << 100.0 * c.least << " %  " << std::setw(5) << c.pairs << "  " << std::setw(5)
              << c.right << "  " << std::setw(19) << c.certain_right << "  " << std::setw(5) << c.certain_wrong << '\n';
  std::cout << "processor time: preparation " << (prepared - start) / scans.size() << " s a scan, alignment "
            << aligning / tried << " s a pair\n";
}

/// Relative poses of all scans in one group, by their true overlap.
void measureMap(const RegistrationInput& input)
{
  const double start = processorSeconds();
  const auto result = fresco::registerScans(input.scans);
  const double spent = processorSeconds() - start;
  const std::vector<PreparedScan> scans = prepareAll(input, thinningForFeatures(input));
  std::vector<Class> classes = overlapClasses();
  for (std::size_t a = 0; a < scans.size(); ++a)
    for (std::size_t b = a + 1; b < scans.size(); ++b) {
      Class& own = classOf(classes, trueOverlap(scans, input, a, b));
      ++own.pairs;
      if (result.scans[a].group < 0 || result.scans[a].group != result.scans[b].group)
        continue;
      const Eigen::Isometry3d found(result.scans[a].T_group_scan.inverse() * result.scans[b].T_group_scan);
      const bool right = isRight(errorOf(found, input.relative(a, b), input.middles[b]));
      own.certain_right += right ? 1 : 0;
      own.certain_wrong += right ? 0 : 1;
    }
  const auto placed = std::count_if(result.scans.begin(), result.scans.end(), [](const auto& s) { return s.placed; });
  std::cout << placed << " of " << scans.size() << " scans placed, " << result.groups << " groups, processor time "
            << spent << " s\noverlap  pairs  in one group: right  wrong\n";
  for (const Class& c : classes)
    std::cout << "> " << std::setw(3) << 100.0 * c.least << " %  " << std::setw(5) << c.pairs << "  " << std::setw(19)
              << c.certain_right << "  " << std::setw(5) << c.certain_wrong << '\n';
}

/// @param tolerance of success, metres and degrees
void measureConvergence(const RegistrationInput& input, const PoseError& tolerance)
{
  const std::vector<PreparedScan> scans = prepareAll(input, Thinning(input.voxel));
  int tried = 0, good = 0;
  double worst = 0.0;
  fresco::benchmark::Disturbances disturbances(0.3, 15.0);
  for (std::size_t a = 0; a < scans.size(); ++a)
    for (std::size_t b = a + 1; b < scans.size(); ++b) {
      if (trueOverlap(scans, input, a, b) < 0.5)
        continue;
      for (int k = 0; k < 4; ++k, ++tried) {
        const Eigen::Isometry3d guess = input.relative(a, b) * disturbances.next();
        const Eigen::Isometry3d found(fresco::alignPointToPlane(scans[b], scans[a], guess.matrix()).T_target_source);
        const PoseError error = errorOf(found, input.relative(a, b), input.middles[b]);
        const bool ok = error.distance < tolerance.distance && error.degrees < tolerance.degrees;
        good += ok ? 1 : 0;
        worst = ok ? std::max(worst, error.distance) : worst;
      }
    }
  std::cout << "from 0.3 m and 15 degrees off, pairs of more than 50 % overlap, 4 times each: " << good << " of "
            << tried << " within " << tolerance.distance << " m and " << tolerance.degrees
            << " degrees, the worst of them " << 1000.0 * worst << " mm\n";
}

/// Share of the true links among the pairs that are among the `most` best of one of their scans; also how many those are.
std::pair<double, int> recall(const std::vector<RankedPair>& ranked, const Eigen::MatrixXd& overlaps, int most,
                              double least_overlap)
{
  std::vector<int> taken(overlaps.rows(), 0);
  int pairs = 0;
  double links = 0.0, found = 0.0;
  for (const RankedPair& pair : ranked) {
    const bool link = overlaps(pair.a, pair.b) >= least_overlap;
    const bool tried = std::min(taken[pair.a]++, taken[pair.b]++) < most;
    links += link ? 1 : 0;
    found += link && tried ? 1 : 0;
    pairs += tried ? 1 : 0;
  }
  return {found / std::max(1.0, links), pairs};
}

/// Whether pairs of overlapping scans come first.
void measureCandidates(const RegistrationInput& input)
{
  const std::vector<PreparedScan> scans = prepareAll(input, thinningForFeatures(input));
  std::vector<ScanFeatures> features;
  for (const PreparedScan& scan : scans)
    features.push_back(describeScan(scan, {}));
  const fresco::Index n = scans.size();
  Eigen::MatrixXd overlaps = Eigen::MatrixXd::Zero(n, n);
  std::vector<RankedPair> pairs;
  for (fresco::Index a = 0; a < n; ++a)
    for (fresco::Index b = a + 1; b < n; ++b) {
      overlaps(a, b) = overlaps(b, a) = trueOverlap(scans, input, a, b);
      pairs.push_back({a, b, 0.0});
    }
  std::cout << "by        best  pairs  links above 15 %  above 30 %\n";
  for (const bool by_place : {false, true}) {
    const double start = processorSeconds();
    rankPairs(pairs, scans, features, {by_place, false, 0});
    const double spent = processorSeconds() - start;
    for (const int most : {2, 4, 8, 12, 16, 24}) {
      const auto [all, tried] = recall(pairs, overlaps, most, 0.15);
      std::cout << (by_place ? "place   " : "features") << std::setw(6) << most << std::setw(7) << tried
                << std::setw(16) << 100.0 * all << " %" << std::setw(10)
                << 100.0 * recall(pairs, overlaps, most, 0.3).first << " %\n";
    }
    std::cout << "processor time " << spent / pairs.size() << " s a pair\n";
  }
}

void run(int argc, char** argv)
{
  fresco::Args args("fresco_benchmark_registration pairs|map|converge|candidates TRUTH.txt SCAN SCAN...",
                    "pairs: aligns each pair of scans from features; counts by overlap how many are right.\n"
                    "map: registers all scans at once; counts the same of the scans of each group.\n"
                    "converge: aligns pairs of more than 50 % overlap from 0.3 m and 15 degrees off.\n"
                    "candidates: ranks all pairs; prints the share of overlapping ones among the best of each scan.\n"
                    "TRUTH.txt: world from scan, one pose for each SCAN, in their order.");
  std::string overlap_file;
  PoseError tolerance{0.05, 1.0};
  args.option("overlaps", overlap_file, "pairs: file for the true overlaps, written; none by default");
  args.option("distance", tolerance.distance, fresco::Range::above(0),
              "converge: largest error that counts as right, metres");
  args.option("degrees", tolerance.degrees, fresco::Range::above(0), "converge: the same of the rotation");
  const std::vector<std::string> words = args.parse(argc, argv, 4, 100000);
  const RegistrationInput input = fresco::benchmark::readRegistrationInput({words.begin() + 1, words.end()});
  std::cout << std::setprecision(3);
  if (words[0] == "pairs")
    measurePairs(input, overlap_file);
  else if (words[0] == "map")
    measureMap(input);
  else if (words[0] == "candidates")
    measureCandidates(input);
  else if (words[0] == "converge")
    measureConvergence(input, tolerance);
  else
    throw fresco::UsageError("the first word is pairs, map, converge or candidates");
}
} // namespace

int main(int argc, char** argv)
{
  return fresco::runTool("fresco_benchmark_registration", [&] { run(argc, argv); });
}
