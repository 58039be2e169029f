// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
namespace fresco::model {
/// Number, size and time of the last change of any kind, which nobody can set: another one as soon as a file is written to, renamed
/// or replaced. "" = no such file.
std::string stampOf(const std::string& file);

/// What a file is: size and hash of its content, and its stamp where it has been at rest for a while. "none" = no such file; null =
/// it cannot be read, or was changed since `since`, so that what was read of it is not what it is.
nlohmann::ordered_json
stateOf(const std::string& file,
        std::chrono::system_clock::time_point since = std::chrono::system_clock::time_point::max());

/// Whether a file still is what it was: not if its size is another, certainly with the same stamp; else its content tells.
bool isAs(const nlohmann::ordered_json& state, const std::string& file);
} // namespace fresco::model
