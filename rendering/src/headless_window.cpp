// SPDX-License-Identifier: BSD-3-Clause
#include "headless_window.h"
#include "egl_context.h"
#include <GL/glew.h>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vtkAutoInit.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>
VTK_MODULE_INIT(vtkRenderingOpenGL2)

namespace fresco::rendering {
namespace {
// glewInit() of a GLEW made for GLX reports this after it has loaded every function of the core profile.
constexpr GLenum glew_no_glx_display = 4;

/// VTK draws into its own framebuffers; the window only has to supply a current context.
class EglRenderWindow : public vtkGenericOpenGLRenderWindow {
public:
  static EglRenderWindow* New()
  {
    auto* const made = new EglRenderWindow;
    made->InitializeObjectBase();
    return made;
  }

  void setContext(EglContext& context) { context_ = &context; }
  bool initialized() const { return Initialized; }
  void MakeCurrent() override { context_->makeCurrent(); }
  bool IsCurrent() override { return context_->isCurrent(); }
  int SupportsOpenGL() override { return 1; }

  void OpenGLInitContext() override
  {
    if (Initialized)
      return;
    ContextCreationTime.Modified();
    const GLenum status = glewInit();
    GlewInitValid = (status == GLEW_OK || status == glew_no_glx_display) && GLEW_VERSION_3_2;
    if (!GlewInitValid)
      return;
    Initialized = true;
    GLfloat widths[2] = {1.f, 1.f};
    glGetFloatv(GL_ALIASED_LINE_WIDTH_RANGE, widths);
    MaximumHardwareLineWidth = widths[1];
  }

protected:
  EglRenderWindow()
  {
    SetReadyForRendering(true);
    SetSupportsOpenGL(1);
    SetIsDirect(1);
    SetMapped(1);
    SetOwnContext(1);
    SetOffScreenRendering(1);
    SetFrameBlitModeToNoBlit();
  }

private:
  EglContext* context_ = nullptr;
};

/// One frame of a known colour: a context that VTK did not set up yields black pictures without any error.
void drawTestFrame(EglRenderWindow& window)
{
  const vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1.0, 0.4, 0.2);
  window.AddRenderer(renderer);
  window.Render();
  if (!window.initialized())
    throw std::runtime_error("pictures need OpenGL 3.2, which the graphics driver does not offer");
  const vtkNew<vtkUnsignedCharArray> pixel;
  window.GetRGBACharPixelData(0, 0, 0, 0, 0, pixel);
  const bool as_drawn = pixel->GetNumberOfValues() == 4 && pixel->GetValue(0) == 255 &&
                        std::abs(pixel->GetValue(1) - 102) <= 1 && std::abs(pixel->GetValue(2) - 51) <= 1;
  window.RemoveRenderer(renderer);
  if (!as_drawn)
    throw std::runtime_error("the graphics driver did not return the test frame as it was drawn");
}

int limit(GLenum name)
{
  GLint values[2] = {0, 0};
  glGetIntegerv(name, values);
  return values[0];
}
} // namespace

HeadlessWindow::HeadlessWindow()
{
  const auto window = vtkSmartPointer<EglRenderWindow>::Take(EglRenderWindow::New());
  window->setContext(context_);
  window->SetAlphaBitPlanes(1);
  window->SetMultiSamples(0);
  window->SetSize(8, 8);
  drawTestFrame(*window);
  largest_texture_ = limit(GL_MAX_TEXTURE_SIZE);
  largest_picture_ = std::min({limit(GL_MAX_RENDERBUFFER_SIZE), limit(GL_MAX_VIEWPORT_DIMS), largest_texture_});
  samples_ = std::min(8, limit(GL_MAX_SAMPLES));
  window->SetMultiSamples(samples_ > 1 ? samples_ : 0);
  window_ = window;
}

HeadlessWindow::~HeadlessWindow() { window_->Finalize(); }
} // namespace fresco::rendering
