// SPDX-License-Identifier: BSD-3-Clause
#include "answer/report.h"
#include <fresco/core/constants.h>
#include <fresco/io/json_text.h>
namespace fresco {
namespace registration {
namespace {
Json toJson(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

// By rows.
Json rowsJson(const Eigen::MatrixXd& matrix)
{
  Json rows = Json::array();
  for (Index r = 0; r < matrix.rows(); ++r) {
    Json& row = rows.emplace_back(Json::array());
    for (Index c = 0; c < matrix.cols(); ++c)
      row.push_back(matrix(r, c));
  }
  return rows;
}

Json pairJson(const PairResult& pair)
{
  Json json = {{"a", pair.a},
               {"b", pair.b},
               {"overlap", pair.overlap},
               {"violation", pair.violation},
               {"rms", pair.rms},
               {"matches", pair.matches},
               {"accepted", pair.accepted},
               {"pose", rowsJson(pair.T_a_b)},
               {"information", pair.information.isZero() ? Json() : rowsJson(pair.information)},
               {"information_point", toJson(pair.information_point)}};
  json["alternatives"] = Json::array();
  for (const AlternativePose& pose : pair.alternatives)
    json["alternatives"].push_back(
        {{"pose", rowsJson(pose.T_a_b)}, {"overlap", pose.overlap}, {"violation", pose.violation}});
  return json;
}

// By RefusalReason.
constexpr const char* reason_names[] = {"none",         "unusable",     "nothing_found", "too_little",
                                        "contradicted", "second_place", "repeats",       "claimed",
                                        "loose",        "apart",        "unsure"};
static_assert(std::size(reason_names) == static_cast<std::size_t>(RefusalReason::unsure) + 1);

Json refusalJson(const Refusal& refusal)
{
  return {{"reason", reason_names[static_cast<int>(refusal.reason)]},
          {"scan", refusal.scan},
          {"agree", refusal.agree},
          {"contradict", refusal.contradict}};
}

double oddsOfProbability(double p) { return p / (1.0 - p); }

Json scanJson(const std::string& file, const ScanResult& scan, const Pose& pose,
              const std::vector<CandidatePlace>& candidates)
{
  Json json = {{"file", file}, {"placed", scan.placed}, {"group", scan.group}};
  json["pose"] = pose ? rowsJson(*pose) : Json();
  json["pose_in_group"] = scan.group >= 0 ? rowsJson(scan.T_group_scan) : Json();
  json["problem"] = scan.problem;
  json["refusal"] = scan.placed ? Json() : refusalJson(scan.refusal);
  json["hint"] = scan.hint;
  json["probability"] = scan.probability;
  json["odds"] = oddsOfProbability(scan.probability);
  json["alternatives"] = Json::array();
  for (std::size_t k = 0; k < candidates.size(); ++k)
    if (scan.group >= 0 && candidates[k].group == scan.group)
      json["alternatives"].push_back(k);
  json["duplicate_of"] = scan.duplicate_of;
  json["viewpoint_problem"] = scan.viewpoint_problem;
  if (scan.found_viewpoint)
    json["found_viewpoint"] = toJson(*scan.found_viewpoint);
  json["rms"] = scan.rms;
  json["translation_deviation"] = scan.translation_deviation;
  json["rotation_deviation_deg"] = scan.rotation_deviation * 180.0 / pi;
  if (scan.free_motion)
    json["free_motion"] = {{"translation", toJson(scan.free_motion->translation)},
                           {"rotation", toJson(scan.free_motion->rotation)}};
  return json;
}
} // namespace

Json candidateJson(const CandidatePlace& place, const ScanRegistrationOptions& options)
{
  return {{"group", place.group},
          {"scan", place.scan},
          {"beside", place.beside},
          {"number", place.number},
          {"pose", rowsJson(place.T_beside_scan)},
          {"group_pose", rowsJson(place.T_larger_group)},
          {"overlap", place.overlap},
          {"violation", place.violation},
          {"agree", place.agree},
          {"contradict", place.contradict},
          {"contradicted", place.contradicted},
          {"probability", place.probability},
          {"odds", oddsOfProbability(place.probability)},
          {"hint", hintLine(place, options)}};
}
} // namespace registration

std::string registrationJson(const ScanRegistrationResult& result, const ScanRegistrationOptions& options)
{
  using namespace registration;
  Json json;
  for (const char* list : {"scans", "unplaced", "pairs", "candidates", "links"})
    json[list] = Json::array();
  for (std::size_t i = 0; i < result.scans.size(); ++i) {
    json["scans"].push_back(scanJson(scanName(options, i), result.scans[i], result.poses[i], result.candidates));
    if (!result.scans[i].placed)
      json["unplaced"].push_back(scanName(options, i));
  }
  for (const PairResult& pair : result.pairs)
    json["pairs"].push_back(pairJson(pair));
  for (const CandidatePlace& place : result.candidates)
    json["candidates"].push_back(candidateJson(place, options));
  for (const CandidatePlace& link : result.links) {
    Json& place = json["links"].emplace_back(candidateJson(link, options));
    place["part"] = link.part;
    place.erase("hint");
  }
  json["hints"] = result.hints;
  json["warnings"] = registrationWarnings(result, options);
  json["groups"] = result.groups;
  json["rms"] = result.rms;
  json["voxel"] = result.voxel;
  json["iterations"] = result.iterations;
  json["converged"] = result.converged;
  return jsonText(json, 1);
}
} // namespace fresco
