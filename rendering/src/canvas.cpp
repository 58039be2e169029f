// SPDX-License-Identifier: BSD-3-Clause
#include "canvas.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/require.h>
#include <stdexcept>
#include <vtkCamera.h>
#include <vtkLight.h>
#include <vtkUnsignedCharArray.h>
namespace fresco::rendering {
namespace {
/// Distant white light; where it comes from in camera axes (x right, y up, z to the eye).
struct StudioLight {
  double from[3];
  double intensity;
};

// The key light makes shapes readable, the others keep its shadow side and ceilings from going black, and a lamp at the
// eye lights every face that is seen, also those of a room around the eye. A face seen and lit head-on has about its
// full colour.
constexpr StudioLight studio[] = {{{-0.45, 0.75, 0.85}, 0.6}, {{0.9, 0.05, 0.5}, 0.34}, {{0.15, -0.9, 0.35}, 0.28}};
constexpr double eye_lamp = 0.32;

std::mutex& graphicsMutex()
{
  static std::mutex mutex;
  return mutex;
}

/// Fills `image` (RGB or RGBA) with means of blocks of `factor` x `factor` pixels of `rgba`: rows from below, colours
/// multiplied by alpha. Rows of the image are from the top, colours divided by alpha.
void resolve(const unsigned char* rgba, int factor, Image& image)
{
  const Index row = Index(image.width) * factor * 4;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      int sum[4] = {0, 0, 0, 0};
      for (int j = 0; j < factor; ++j)
        for (int i = 0; i < factor; ++i)
          for (int c = 0; c < 4; ++c)
            sum[c] += rgba[((image.height - 1 - y) * factor + j) * row + (x * factor + i) * 4 + c];
      const int samples = factor * factor, alpha = sum[3];
      for (int c = 0; c < 3; ++c)
        image.pixel(x, y)[c] = alpha > 0 ? std::min(255, (sum[c] * 255 + alpha / 2) / alpha) : 0;
      if (image.channels == 4)
        image.pixel(x, y)[3] = (alpha + samples / 2) / samples;
    }
}

void setCamera(vtkCamera& camera, const Viewpoint& view, const Eigen::Vector3d& origin)
{
  const Eigen::Vector3d eye = view.eye - origin, look = view.look - origin;
  const Eigen::Vector3d up = cameraAxes(view.eye - view.look, view.up).col(1);
  camera.SetPosition(eye.data());
  camera.SetFocalPoint(look.data());
  camera.SetViewUp(up.data());
  camera.SetViewAngle(view.angle);
}
} // namespace

Canvas::Canvas(const PictureOptions& options, Lighting lighting)
    : lock_(graphicsMutex()), width_(options.width), height_(options.height), oversampling_(options.oversampling),
      channels_(options.transparent ? 4 : 3)
{
  if (window_.samples() < 2)
    oversampling_ = std::max(oversampling_, 2);
  else if (oversampling_ > 1)
    window_.window().SetMultiSamples(0); // samples of every pixel drawn would take most of the time
  const int largest = window_.largestPicture() / oversampling_;
  if (std::max(width_, height_) > largest)
    throw std::runtime_error(
        concat("picture of ", width_, "x", height_, " pixels: the graphics driver can do ", largest));
  window_.window().SetSize(width_ * oversampling_, height_ * oversampling_);
  window_.window().AddRenderer(renderer_);
  if (!options.transparent) { // else black, so that colours at the rim come back multiplied by alpha
    const auto& [red, green, blue] = options.background;
    renderer_->SetBackground(red / 255.0, green / 255.0, blue / 255.0);
    renderer_->SetBackgroundAlpha(1.0);
  }
  renderer_->AutomaticLightCreationOff();
  const vtkNew<vtkLight> lamp;
  lamp->SetLightTypeToHeadlight();
  if (lighting == Lighting::Studio) {
    addStudioLights();
    lamp->PositionalOn();
    lamp->SetConeAngle(180); // to all sides
    lamp->SetIntensity(eye_lamp);
  }
  renderer_->AddLight(lamp);
}

Canvas::~Canvas() { window_.window().RemoveRenderer(renderer_); }

void Canvas::addStudioLights()
{
  for (const StudioLight& lamp : studio) {
    const vtkNew<vtkLight> light;
    light->SetLightTypeToCameraLight();
    light->SetPosition(lamp.from[0], lamp.from[1], lamp.from[2]);
    light->SetIntensity(lamp.intensity);
    renderer_->AddLight(light);
  }
}

Image Canvas::draw(const Viewpoint& view, const Eigen::Vector3d& origin)
{
  validateViewpoint(view);
  setCamera(*renderer_->GetActiveCamera(), view, origin);
  renderer_->ResetCameraClippingRange();
  vtkRenderWindow& window = window_.window();
  window.Render();
  const vtkNew<vtkUnsignedCharArray> pixels;
  const int width = width_ * oversampling_, height = height_ * oversampling_;
  window.GetRGBACharPixelData(0, 0, width - 1, height - 1, 0, pixels);
  messages_.check();
  if (pixels->GetNumberOfValues() != static_cast<vtkIdType>(width) * height * 4)
    throw std::runtime_error("the graphics driver returned no picture");
  Image image(width_, height_, channels_);
  resolve(pixels->GetPointer(0), oversampling_, image);
  return image;
}
} // namespace fresco::rendering
