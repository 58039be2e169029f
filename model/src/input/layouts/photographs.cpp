// SPDX-License-Identifier: BSD-3-Clause
// Photographs in images/, or a folder of them, alone or with a file of their cameras and its points.
#include "input/parts.h"
#include <stdexcept>
namespace fresco::model {
void readPhotographsAlone(const Survey& found, std::optional<Reading>, ModelInput& input)
{
  input.is_cloud = true;
  takePhotographs(input, found);
  if (input.cameras.views.empty() && input.unplaced.empty())
    takeUnplaced(input, found, "");
  if (!input.cameras.views.empty() && input.sparse.empty())
    throw std::runtime_error(input.camera_folder + ": cameras, but no points of a surface: put the cloud or mesh that "
                                                   "was exported with them (.ply, .las, .obj) beside it");
  input.warnings.push_back(roughOnly());
}
} // namespace fresco::model
