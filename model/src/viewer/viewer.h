// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>
namespace fresco::model {
/// A place from which a visitor looks at the model; world coordinates, unit of the model.
struct ViewerPlace {
  std::string name;
  Eigen::Vector3d eye = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d look = Eigen::Vector3d::Zero(); ///< point in the middle of the picture
  double angle = 60;                              ///< vertical opening angle, degrees, 1..170
  std::string group = "Views";                    ///< of the menu; places of a group follow each other
  /// Bytes of a JPEG that is laid over the model: taken from here, with that opening angle, upright; empty = none.
  std::string photograph;
  double aspect = 0; ///< of the photograph, width / height
};

/// An upright wall, its room on the left; points of the model.
struct ViewerWall {
  Eigen::Vector3d from, to;
};

struct ViewerOptions {
  std::string title = "fresco model";
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ(); ///< any length above 0
  std::vector<ViewerPlace>
      places;                  ///< the first one is shown first; none: the whole model from above, near walls left out
  std::optional<double> floor; ///< its height along `up`; nothing: the lowest point of the model
  std::vector<ViewerWall>
      walls; ///< from above, what hangs on those that turn their back to the eye is left out; 48 count
};

/// A page that shows a binary glTF model with WebGL 2, the model and all code inside: it works from a file, offline.
/// @param glb bytes of the .glb
/// @throws std::invalid_argument if `glb` is no binary glTF or an option is out of range
std::string viewerHtml(const std::string& glb, const ViewerOptions& options = {});

/// The same as an element to be put into another page: style, <div class="fresco-viewer"> as large as its parent,
/// which must have a height, and script. One element per page.
std::string viewerElement(const std::string& glb, const ViewerOptions& options = {});

/// `text` as it is written between and inside of the tags of a page.
std::string escapedHtml(const std::string& text);

/// RFC 4648, section 4.
std::string base64(const std::string& bytes);
} // namespace fresco::model
