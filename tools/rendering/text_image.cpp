// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/text_image.h"
#include <stdexcept>
#include <vtkAutoInit.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>
VTK_MODULE_INIT(vtkRenderingFreeType)

namespace fresco::rendering {
Image textCoverage(const std::string& text, int height)
{
  if (text.empty())
    return Image(0, 0, 1);
  const vtkNew<vtkTextProperty> font;
  font->SetFontFamilyToArial();
  font->SetFontSize(height);
  font->SetColor(1.0, 1.0, 1.0);
  const vtkNew<vtkImageData> drawn;
  int size[2] = {0, 0};
  vtkTextRenderer* const renderer = vtkTextRenderer::GetInstance();
  constexpr int pixels_per_inch = 72; // one point of font size is one pixel
  if (!renderer || !renderer->RenderString(font, text, drawn, size, pixels_per_inch, vtkTextRenderer::FreeType) ||
      size[0] < 1 || size[1] < 1)
    throw std::runtime_error("picture: the text '" + text + "' cannot be drawn");
  Image image(size[0], size[1], 1);
  const int* extent = drawn->GetExtent();
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const auto* rgba = static_cast<const unsigned char*>(
          drawn->GetScalarPointer(extent[0] + x, extent[2] + image.height - 1 - y, extent[4]));
      *image.pixel(x, y) = rgba[3];
    }
  return image;
}
} // namespace fresco::rendering
