// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.h"
#include "call.h"
namespace fresco::python {
void addRegistration(const py::module_& module)
{
  addRecord<ScanRegistrationResult>(module);
  addRecord<ScanResult>(module);
  addRecord<PairResult>(module);
  addRecord<AlternativePose>(module);
  addRecord<FreeMotion>(module);
  addRecord<RegistrationHint>(module);
  addRecord<Refusal>(module);
  addRecord<CandidatePlace>(module);
  addFunction<ScanRegistrationOptions>(
      module,
      {"register_scans",
       "registerScans",
       {{"scans", "Sequence[PointSet]"}, {"start", "Sequence[Optional[ArrayLike]]", "()"}},
       "ScanRegistrationResult",
       "Poses are (4, 4) float64, None for a scan without one."},
      [](const Call& call) {
        const auto scans = call.lend<std::vector<PointSet>>("scans");
        const auto start = call.value<std::vector<Pose>>("start");
        const auto options = call.options<ScanRegistrationOptions>();
        return call.run([&](const Progress& progress) { return registerScans(*scans, start, options, progress); });
      });
  addFunction<ScanRegistrationOptions>(module,
                                       {"registration_warnings",
                                        "registrationWarnings",
                                        {{"result", "ScanRegistrationResult"}},
                                        "list[str]",
                                        "The options are those of the registration.",
                                        false},
                                       [](const Call& call) {
                                         const auto result = call.value<ScanRegistrationResult>("result");
                                         return toPython(
                                             registrationWarnings(result, call.options<ScanRegistrationOptions>()));
                                       });
  addFunction(module,
              {"merge_scans",
               "mergeScans",
               {{"scans", "Sequence[PointSet]"}, {"poses", "Sequence[Optional[ArrayLike]]"}, {"threads", "int", "0"}},
               "PointSet",
               "",
               false},
              [](const Call& call) {
                const auto scans = call.lend<std::vector<PointSet>>("scans");
                const auto poses = call.value<std::vector<Pose>>("poses");
                const int threads = call.value<int>("threads");
                return call.run([&](const Progress&) { return mergeScans(*scans, poses, threads); });
              });
}
} // namespace fresco::python
