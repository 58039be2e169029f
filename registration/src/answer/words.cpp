// SPDX-License-Identifier: BSD-3-Clause
#include "answer/odds.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/io/listed.h>
#include <fresco/registration/core/scan_registration.h>
namespace fresco {
namespace {
double rounded(double value) { return std::round(100.0 * value) / 100.0; }

// As short as a hints file may call it.
std::string shortName(Index scan, const ScanRegistrationOptions& options)
{
  const auto file = [](const std::string& name) { return std::filesystem::path(name).filename().string(); };
  std::string name = scanName(options, scan);
  if (std::count_if(options.names.begin(), options.names.end(),
                    [&](const std::string& other) { return file(other) == file(name); }) == 1)
    name = file(name);
  return name.find(' ') == std::string::npos ? name : "\"" + name + "\"";
}

std::string namesOf(const std::vector<Index>& scans, const ScanRegistrationOptions& options)
{
  std::vector<std::string> names;
  for (const Index scan : scans)
    names.push_back(scanName(options, scan));
  return listed(names, 5);
}
} // namespace

std::string hintLine(const CandidatePlace& place, const ScanRegistrationOptions& options)
{
  const std::string scan = shortName(place.scan, options), beside = shortName(place.beside, options);
  if (place.number > 0)
    return concat("choose ", scan, " ", beside, " ", place.number);
  const Eigen::Matrix4d& T = place.T_beside_scan;
  const Eigen::Quaterniond q(T.topLeftCorner<3, 3>().eval());
  std::string line = concat("relative ", beside, " ", scan);
  for (const double value : {T(0, 3), T(1, 3), T(2, 3), q.x(), q.y(), q.z(), q.w()})
    line += concat(" ", std::round(1e6 * value) / 1e6);
  return line;
}

std::string refusalText(const Refusal& refusal, const ScanRegistrationOptions& options)
{
  const std::string other = refusal.scan < 0 ? std::string("another group") : scanName(options, refusal.scan);
  const std::string alike = "fits in several places that look alike, and nothing seen tells which is right: ";
  const std::string uncertain = "no place among the other scans is certain: ";
  const std::string agrees =
      refusal.agree > 0.0 ? concat(", where surfaces of ", rounded(refusal.agree), " scans agree") : std::string();
  switch (refusal.reason) {
  case RefusalReason::none:
    return "";
  case RefusalReason::unusable:
    return "it cannot be used";
  case RefusalReason::nothing_found:
    return uncertain + "no pair with a placed scan gave an acceptable pose";
  case RefusalReason::too_little:
    return concat(uncertain, "too little agrees at the best one, beside ", other, ": surfaces of ",
                  rounded(refusal.agree), " scans");
  case RefusalReason::contradicted:
    return concat(uncertain, "others saw through it at the best one, beside ", other, ": ",
                  rounded(100.0 * refusal.contradict), " % of a scan's points, while ", rounded(100.0 * refusal.agree),
                  " % agree");
  case RefusalReason::second_place:
    return concat(alike, "beside ", other, agrees, ", and at a second place there");
  case RefusalReason::repeats:
    return concat(alike, "beside ", other, agrees, "; but a scan looks the same elsewhere, as of equal rooms");
  case RefusalReason::claimed:
    return concat(alike, "beside ", other, agrees, ", and beside scans that cannot be there");
  case RefusalReason::loose:
    return "what holds its place leaves it free";
  case RefusalReason::apart:
    return "a hint keeps it apart from " + other;
  case RefusalReason::unsure:
    return concat("its place beside ", other, agrees, ", is less probable than asked for");
  }
  return "";
}

namespace {
// The first place of a group that a person may choose.
std::string firstPlace(const ScanRegistrationResult& result, Index group, const ScanRegistrationOptions& options)
{
  for (const bool placed : {true, false})
    for (const CandidatePlace& place : result.candidates)
      if (place.group == group && !place.contradicted && result.scans[place.beside].placed == placed)
        return concat("; a hint that takes a place", placed ? "" : " beside another scan that has none", ": ",
                      hintLine(place, options));
  return "";
}
} // namespace

std::vector<std::string> registrationWarnings(const ScanRegistrationResult& result,
                                              const ScanRegistrationOptions& options)
{
  std::vector<std::string> warnings;
  std::vector<std::vector<Index>> groups(result.groups);
  for (std::size_t i = 0; i < result.scans.size(); ++i)
    if (result.scans[i].group > 0)
      groups[result.scans[i].group].push_back(i);
  for (std::size_t i = 0; i < result.scans.size(); ++i) {
    const ScanResult& scan = result.scans[i];
    const bool is_told = !scan.placed && scan.group > 0 && groups[scan.group].size() > 1; // of the whole group
    if (!scan.problem.empty() && !is_told)
      warnings.push_back(scanName(options, i) + ": " + scan.problem +
                         (scan.placed || scan.group < 0 ? "" : firstPlace(result, scan.group, options)));
    if (!scan.viewpoint_problem.empty())
      warnings.push_back(scanName(options, i) + ": free space not used: " + scan.viewpoint_problem);
  }
  if (result.people_moved)
    warnings.push_back("people moved between the scans: what may be one speaks against no pose");
  for (const std::vector<Index>& group : groups)
    if (group.size() > 1)
      warnings.push_back(concat("another group: ", group.size(), " scans hang together, but not with the placed ones: ",
                                namesOf(group, options), ": ", result.scans[group[0]].problem,
                                firstPlace(result, result.scans[group[0]].group, options)));
  if (options.confidence > registration::largestClaim())
    warnings.push_back(concat("confidence ", options.confidence, ": no place is known to be surer than ",
                              registration::largestClaim(), ", which is asked for instead"));
  warnings.insert(warnings.end(), result.hints.begin(), result.hints.end());
  return warnings;
}
} // namespace fresco
