// SPDX-License-Identifier: BSD-3-Clause
// Photographs and nothing else: in images/, or a folder of them.
#include "input/parts.h"
namespace fresco::model {
void readPhotographsAlone(const Survey& found, std::optional<Reading>, ModelInput& input)
{
  input.is_cloud = true;
  takeUnplaced(input, found, found.has("images/") ? "images" : "");
  input.warnings.push_back(roughOnly());
}
} // namespace fresco::model
