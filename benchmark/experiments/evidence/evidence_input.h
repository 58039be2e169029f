// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "evidence/arrangement.h"
#include "experiments/registration_input.h"
#include "global_alignment.h"
#include "graph/scan_exchange.h"
#include "scan/scan_survey.h"
#include <fresco/core/parallel.h>
#include <fresco/io/file.h>
#include <iomanip>
#include <sstream>
namespace fresco::benchmark {
/// A job as registerScans() has it before anything is decided.
struct EvidenceInput {
  ScanRegistrationOptions options;
  std::vector<registration::PreparedScan> scans;
  Poses truth;                            ///< world from working frame; empty = unknown
  registration::ProposedPlaces proposals; ///< all that were accepted for pairs, of working frames
};

inline ScanSource sourceOf(const std::vector<std::string>& files)
{
  return {static_cast<Index>(files.size()), [files](Index i) { return readPoints(files[i]); }};
}

/// Prepared as registerScans() does.
inline EvidenceInput prepareInput(const std::vector<std::string>& files, const std::string& truth_file)
{
  using namespace registration;
  EvidenceInput input;
  const ScanSource source = sourceOf(files);
  Exchange alone;
  const ScanSurvey survey = surveyScans(source, alone, input.options);
  const double size = commonSize(survey, input.options);
  input.options.voxel = chooseVoxel(survey, size);
  input.options.max_distance = 20.f * input.options.voxel;
  for (Index i = 0; i < source.count; ++i)
    input.scans.push_back(
        prepareScan(source.read(i), Thinning(input.options.voxel, size, survey.narrowness), input.options.threads));
  if (!truth_file.empty()) {
    const auto poses = readPoses(truth_file);
    require(poses.size() == files.size(), truth_file, ": ", poses.size(), " poses for ", files.size(), " scans");
    for (std::size_t i = 0; i < poses.size(); ++i) {
      require(poses[i].has_value(), truth_file, ": a pose is missing");
      input.truth.push_back(Eigen::Isometry3d(*poses[i]) * Eigen::Translation3d(input.scans[i].center));
    }
  }
  return input;
}

/// Writes what registration proposes, one line each: a, b and 16 numbers.
/// @return what it makes of them
inline registration::ScanGraph freezeProposals(EvidenceInput& input, const std::string& file)
{
  using namespace registration;
  const ScanCluster none;
  Exchange alone;
  const GlobalAlignment alignment = alignGlobally({input.scans, none, alone}, input.options, {});
  std::ostringstream text;
  text << std::setprecision(17);
  for (const PairAlignment& pair : alignment.pairs)
    for (const VerifiedHypothesis& hypothesis : pair.hypotheses) {
      text << pair.a << ' ' << pair.b;
      for (int k = 0; k < 16; ++k)
        text << ' ' << hypothesis.T_a_b.matrix()(k / 4, k % 4);
      text << '\n';
    }
  writeFile(file, text.str());
  return alignment.graph;
}

inline void readProposals(const std::string& file, EvidenceInput& input)
{
  std::istringstream text(readFile(file));
  registration::ProposedPlace proposal;
  while (text >> proposal.a >> proposal.b) {
    for (int k = 0; k < 16; ++k)
      text >> proposal.T_a_b.matrix()(k / 4, k % 4);
    const Index count = input.scans.size();
    require(!text.fail() && proposal.a >= 0 && proposal.b >= 0 && proposal.a < count && proposal.b < count, file,
            ": not proposals of these scans");
    input.proposals.push_back(proposal);
  }
  parallelFor(
      input.scans.size(), 0, [&](Index i) { registration::prepareManySearches(input.scans[i]); }, 1);
}
} // namespace fresco::benchmark
