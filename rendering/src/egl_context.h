// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <EGL/egl.h>
namespace fresco::rendering {
/// OpenGL 3.2 core context of its own, not tied to any display. The connection to EGL is opened once per process and
/// stays open; contexts come and go.
class EglContext {
public:
  /// @throws std::runtime_error naming what is missing
  EglContext();
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  /// For the calling thread. @throws std::runtime_error if the driver refuses
  void makeCurrent();
  bool isCurrent() const { return eglGetCurrentContext() == context_; }

private:
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLSurface surface_ = EGL_NO_SURFACE;
  EGLContext context_ = EGL_NO_CONTEXT;
};
} // namespace fresco::rendering
