// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/alignment_state.h"
#include "scan/scan_survey.h"
namespace fresco::registration {
/// What an alignment depends on: scans, start poses and options, but neither hints nor threads.
std::string memoryKey(const ScanSurvey& survey, const std::vector<Pose>& start, const ScanRegistrationOptions& options);

/// Bytes with version, key and check sum.
std::string packAlignment(GlobalAlignment alignment, const std::string& key);

/// @return nothing unless the bytes are whole and of this version and key
std::optional<GlobalAlignment> unpackAlignment(const std::string& bytes, const std::string& key);
} // namespace fresco::registration
