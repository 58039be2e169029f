// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>
/// What reads bytes that somebody else wrote, as functions of those bytes: for the fuzzer, and for the test that reads
/// the seeds and the findings of the fuzzer again.
namespace fresco::fuzz {
/// Stands between the files of an input that consists of several.
inline constexpr std::string_view separator = "\n=====\n";

/// The first part of `bytes`; they then begin behind its separator.
std::string_view takePart(std::string_view& bytes);

struct Target {
  std::string name; ///< also the folder of its seeds and findings
  /// Feeds the reader. @throws std::logic_error if it does what no reader may: another error than std::runtime_error
  /// naming a file of `folder`, an error of several lines, or a result that is not sound
  std::function<void(std::string_view bytes, const std::string& folder)> run;
};

const std::vector<Target>& targets();

/// @throws std::invalid_argument if there is no such target
const Target& findTarget(const std::string& name);
} // namespace fresco::fuzz
