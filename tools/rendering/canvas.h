// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "rendering/headless_window.h"
#include "rendering/viewpoint.h"
#include "rendering/vtk_messages.h"
#include <array>
#include <fresco/core/image.h>
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
  /// @param width, height pixels, >= 1
  /// @param oversampling pixels drawn per pixel of the picture along each side, 1..4
  /// @throws std::runtime_error as HeadlessWindow, and if the size is above what the graphics driver can do
  Canvas(int width, int height, int oversampling);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  int largestTexture() const { return window_.largestTexture(); } ///< side in texels
  int oversampling() const { return oversampling_; }              ///< at least 2 where there is no multisampling
  void setLighting(Lighting lighting);
  void setBackground(const std::array<std::uint8_t, 3>& color);
  void setTransparentBackground();
  void add(vtkActor* actor) { renderer_->AddActor(actor); }

  /// @param origin of the frame that the actors' coordinates are in; the view is in world coordinates
  /// @return RGBA, alpha 0 where nothing was drawn on a transparent background; colours not multiplied by alpha
  /// @throws std::runtime_error if VTK reports an error
  Image draw(const Viewpoint& view, const Eigen::Vector3d& origin);

private:
  std::unique_lock<std::mutex> lock_;
  VtkMessages messages_;
  HeadlessWindow window_;
  vtkNew<vtkRenderer> renderer_;
  int width_, height_, oversampling_;
};
} // namespace fresco::rendering
