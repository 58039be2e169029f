// SPDX-License-Identifier: BSD-3-Clause
// Photographs and nothing else: in images/, or a folder of them.
#include "input/parts.h"
namespace fresco::model {
void readPhotographsAlone(const Survey& found, std::optional<Reading>, ModelInput& input)
{
  input.is_cloud = true;
  const std::string images = found.has("images/") ? "images" : "";
  takeUnplaced(input, found, images);
  if (input.unplaced.empty())
    throw std::runtime_error(found.at(images) + ": no photograph in it; docs/inputs.md lists what is understood");
  input.warnings.push_back(roughOnly());
}
} // namespace fresco::model
