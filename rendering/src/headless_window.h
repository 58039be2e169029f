// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "egl_context.h"
#include <vtkRenderWindow.h>
#include <vtkSmartPointer.h>
namespace fresco::rendering {
/// Render window in memory: OpenGL 3.2 core over EGL without a surface, so neither a display nor an X server is needed.
/// It holds its own OpenGL context; it must be used and released on the thread that made it.
class HeadlessWindow {
public:
  /// @throws std::runtime_error naming what is missing if there is no EGL, no suitable platform or no OpenGL 3.2, or if
  ///         a first frame does not come back as drawn
  HeadlessWindow();
  ~HeadlessWindow();
  HeadlessWindow(const HeadlessWindow&) = delete;
  HeadlessWindow& operator=(const HeadlessWindow&) = delete;

  vtkRenderWindow& window() { return *window_; }
  int largestPicture() const { return largest_picture_; } ///< side in pixels
  int largestTexture() const { return largest_texture_; } ///< side in texels
  int samples() const { return samples_; }                ///< per pixel, up to 8; below 2: no multisampling

private:
  EglContext context_; // outlives the window, which frees its resources in it
  vtkSmartPointer<vtkRenderWindow> window_;
  int largest_picture_ = 0, largest_texture_ = 0, samples_ = 0;
};
} // namespace fresco::rendering
