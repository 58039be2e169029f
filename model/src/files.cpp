// SPDX-License-Identifier: BSD-3-Clause
#include "files.h"
#include <fresco/core/require.h>
namespace fresco::model {
ModelFiles::ModelFiles(const std::string& out)
    : folder(out), work(out + "/work"), snapshots(out + "/snapshots"), points(work + "/registered.ply"),
      surface(work + "/surface.ply"), poses(out + "/poses.txt"), mesh(out + "/mesh.ply"), model_obj(out + "/model.obj"),
      model_glb(out + "/model.glb"), viewer_glb(work + "/viewer.glb"), report_json(out + "/report.json"),
      report_html(out + "/report.html")
{}

std::string ModelFiles::mask(std::size_t index, std::size_t count) const
{
  return folder + (count > 1 ? concat("/model_mask_", index, ".png") : "/model_mask.png");
}
} // namespace fresco::model
