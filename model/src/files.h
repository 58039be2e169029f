// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
namespace fresco::model {
/// Files that the chain writes into its folder; the ones in `work` are kept for resuming.
struct ModelFiles {
  explicit ModelFiles(const std::string& folder);
  std::string folder, work, snapshots, points, surface, poses, mesh, model_obj, model_glb, viewer_glb, report_json,
      report_html;

  /// Mask `index` of `count`: white where no photograph saw the surface.
  std::string mask(std::size_t index, std::size_t count) const;
};
} // namespace fresco::model
