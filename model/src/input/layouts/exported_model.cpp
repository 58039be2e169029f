// SPDX-License-Identifier: BSD-3-Clause
// A model that another program made: OBJ with its textures, with or without the cloud that it was made of, as in the MatterPak of
// Matterport (cloud.xyz, pictures of the plan).
#include "input/parts.h"
#include <fresco/core/require.h>
namespace fresco::model {
void readExportedModel(const Survey& found, std::optional<Reading>, ModelInput& input)
{
  takeScans(input, found, cloudsIn(found));
  takeAsCloud(input, found);
  takePhotographs(input, found);
  if (const std::size_t pictures = found.match("<pictures>").size(); pictures > 0)
    input.found.push_back(concat(counted(pictures, "picture"), ": textures and plans of the exported model, not used"));
}
} // namespace fresco::model
