// SPDX-License-Identifier: BSD-3-Clause
#pragma once
namespace fresco::simulation {
// The files descriptions/*.json. Lengths are metres, angles degrees. Some decimals are those of a float that was computed.
extern const char* const materials_json;       ///< name: finish, color, accent, contrast, emission, seed, see Material
extern const char* const things_json;          ///< name: list of parts, see Furniture
extern const char* const conference_room_json; ///< shell and things, see makeScene()
extern const char* const apartment_json;       ///< likewise
} // namespace fresco::simulation
