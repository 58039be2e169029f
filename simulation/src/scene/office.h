// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/simulation/scene/scene.h>
#include <nlohmann/json.hpp>
namespace fresco::simulation {
/// A floor of an office as a description like descriptions/*.json: up to 10 rooms on both sides of a corridor, more
/// around two corridors that are joined at both ends. Rooms have different sizes and furniture, but some are equal.
/// Doors stand open or are closed, or a glass partition is beside them. Walls between rooms are 12 cm thick.
/// Two storeys have different rooms and furniture, and a stairwell at the beginning of their corridors. "floors" and,
/// with a stairwell, "stations" (its foot and landing) are those of Scene.
/// @throws std::invalid_argument if the number of rooms or storeys is out of range
nlohmann::json officeFloor(const OfficeOptions& options);
} // namespace fresco::simulation
