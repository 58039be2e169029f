// SPDX-License-Identifier: BSD-3-Clause
// Registration of places that look alike: pairs held together rightly and wrongly.
#include "experiments/registration_input.h"
#include "pair/pair_alignment.h"
#include "pair/self_alignment.h"
#include "registration/look_alike_scenes.h"
#include "support/tool.h"
#include <iomanip>
#include <iostream>
using namespace fresco::registration;
namespace {
using fresco::benchmark::processorSeconds;

/// What is found for each pair of scans by itself.
void printPairs(const fresco::test::LookAlikeScene& place)
{
  std::vector<PreparedScan> scans;
  std::vector<ScanFeatures> features;
  float voxel = 0.f;
  for (const fresco::PointSet& scan : place.scene.scans)
    voxel = std::max(voxel, fresco::registrationVoxel(scan));
  for (const fresco::PointSet& scan : place.scene.scans) {
    scans.push_back(prepareScan(scan, Thinning(voxel), 0));
    features.push_back(describeScan(scans.back(), {}));
    scans.back().aliases = findAliases(scans.back(), features.back());
  }
  for (std::size_t a = 0; a < scans.size(); ++a)
    for (std::size_t b = a + 1; b < scans.size(); ++b) {
      const auto pair = alignPair({scans[a], features[a]}, {scans[b], features[b]}, {});
      std::cout << a << ' ' << b << (pair.ambiguous ? " ambiguous" : "") << '\n';
      const Eigen::Isometry3d truth = place.scene.truth[a].inverse() * place.scene.truth[b];
      for (const VerifiedHypothesis& hypothesis : pair.hypotheses) {
        const auto error = fresco::benchmark::errorOf(hypothesis.T_a_b, truth, Eigen::Vector3d::Zero());
        std::cout << "    off by " << error.distance << " m, " << error.degrees << " degrees; overlap "
                  << hypothesis.check.overlap << ", violation " << hypothesis.check.violation << ", colour "
                  << hypothesis.check.color.value_or(NAN) << ", votes " << hypothesis.votes
                  << (hypothesis.has_alias ? ", has an alias" : "") << '\n';
      }
    }
}

void measure(const fresco::test::LookAlikeScene& place, const fresco::ScanRegistrationOptions& options)
{
  const double before = processorSeconds();
  const auto result = fresco::registerScans(place.scene.scans, {}, options);
  const double spent = processorSeconds() - before;
  const fresco::test::HeldPairs held = fresco::test::heldPairs(result, place.scene);
  const auto placed = std::count_if(result.scans.begin(), result.scans.end(), [](const auto& s) { return s.placed; });
  std::cout << std::left << std::setw(56) << place.name << std::setw(12) << (place.decidable ? "yes" : "no")
            << std::right << std::setw(6) << held.right << std::setw(7) << held.wrong << std::setw(8) << placed
            << " of " << place.scene.scans.size() << std::setw(8) << result.groups << std::setw(9)
            << std::setprecision(3) << spent << " s\n"
            << std::flush;
}

void run(int argc, char** argv)
{
  fresco::Args args(
      "fresco_benchmark_aliases [WORD]",
      "Registers scans of places that look alike, without poses; with WORD, those that have it in their\n"
      "names. Counted are pairs of overlapping scans in one group that lie to each other as they should.");
  fresco::ScanRegistrationOptions options;
  int rays = 30000;
  args.option("rays", rays, "of each scan, at least 1000");
  args.option("threads", options.threads, "0 = all cores");
  bool pairs = false;
  args.flag("pairs", pairs, "also what is found for each pair");
  const std::vector<std::string> words = args.parse(argc, argv, 0, 1);
  std::cout << std::left << std::setw(56) << "scene" << std::setw(12) << "decidable"
            << " pairs: right  wrong  placed  "
            << "groups  processor\n";
  for (const auto& place : fresco::test::lookAlikeScenes(rays))
    if (words.empty() || place.name.find(words[0]) != std::string::npos) {
      measure(place, options);
      if (pairs)
        printPairs(place);
    }
}
} // namespace

int main(int argc, char** argv)
{
  return fresco::runTool("fresco_benchmark_aliases", [&] { run(argc, argv); });
}
