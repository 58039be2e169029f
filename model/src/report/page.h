// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "report/facts.h"
#include <optional>
namespace fresco::model {
/// The page for the owner of the room: readable offline, on a phone and on paper; figures of the stages are folded away.
/// @param facts nothing if no plan could be drawn
std::string reportPage(const Report& report, const ModelFiles& files, const std::optional<RoomFacts>& facts);
} // namespace fresco::model
