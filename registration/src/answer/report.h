// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/registration/core/scan_registration.h>
#include <nlohmann/json.hpp>
namespace fresco::registration {
using Json = nlohmann::ordered_json;

Json candidateJson(const CandidatePlace& place, const ScanRegistrationOptions& options);
} // namespace fresco::registration
