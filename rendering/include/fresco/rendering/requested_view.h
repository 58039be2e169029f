// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/rendering/picture.h>
namespace fresco::rendering {
/// Where to look from, in the words of a user.
struct ViewRequest {
  std::string view = "corner"; ///< one of viewNames(): the whole model; inside or above: see insideView(), aboveView()
  std::optional<Eigen::Vector3d> eye;  ///< world; replaces `view`
  std::optional<Eigen::Vector3d> look; ///< world, with `eye`; nothing: middle of the model
  std::optional<Eigen::Vector3d> up;   ///< nothing: z, or with inside and above found from the model
  std::optional<double> angle;         ///< vertical opening angle, degrees; nothing: 30, or as insideView() has it
};

/// What is looked at: one of the two is not null.
struct Subject {
  const TriangleMesh* mesh = nullptr;
  const PointSet* points = nullptr;
};

/// @param room    mesh that inside and above are chosen for; null: the subject's
/// @param options size of the picture and threads
/// @throws std::invalid_argument if the view is unknown, needs a mesh with faces, or none can be found
Viewpoint requestedView(const ViewRequest& request, const Subject& subject, const TriangleMesh* room,
                        const PictureOptions& options);
} // namespace fresco::rendering
