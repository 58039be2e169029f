// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "headless_window.h"
#include "vtk_messages.h"
#include <fresco/rendering/picture.h>
#include <mutex>
#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkRenderer.h>
namespace fresco::rendering {
enum class Lighting {
  Studio,   ///< key light from above, fill and back lights; all move with the eye
  Headlight ///< from the eye
};

/// One picture being made. VTK and the graphics system are held for its whole life: one canvas at a time per process,
/// others wait.
class Canvas {
public:
  /// @param options in range; size, background and oversampling count
  /// @throws std::runtime_error as HeadlessWindow, and if the size is above what the graphics driver can do
  explicit Canvas(const PictureOptions& options, Lighting lighting = Lighting::Studio);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  int largestTexture() const { return window_.largestTexture(); } ///< side in texels
  int oversampling() const { return oversampling_; }              ///< at least 2 where there is no multisampling
  void add(vtkActor* actor) { renderer_->AddActor(actor); }

  /// @param origin of the frame that the actors' coordinates are in; the view is in world coordinates
  /// @return RGB; RGBA if it is to be transparent, alpha 0 where nothing was drawn, colours not multiplied by alpha
  /// @throws std::runtime_error if VTK reports an error
  Image draw(const Viewpoint& view, const Eigen::Vector3d& origin);

private:
  void addStudioLights();
  std::unique_lock<std::mutex> lock_;
  VtkMessages messages_;
  HeadlessWindow window_;
  vtkNew<vtkRenderer> renderer_;
  int width_, height_, oversampling_, channels_;
};
} // namespace fresco::rendering
