// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fresco/core/require.h>
#include <fresco/rendering/scale_bar.h>
#include <fresco/surface/core/error_colors.h>
#include <stdexcept>
#include <vtkAutoInit.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>
VTK_MODULE_INIT(vtkRenderingFreeType)

namespace fresco::rendering {
namespace {
using Rgb = std::array<std::uint8_t, 3>;

struct Tick {
  double value = 0;
  Image label;
};

/// Everything in pixels.
struct Layout {
  int font = 0, pad = 0, bar_width = 0, width = 0, bar_top = 0, bar_bottom = 0;
  std::vector<Image> title;
  std::vector<Tick> ticks;
};

/// One line of text, cut to its letters' box: coverage of each pixel, 0..255.
/// @param height of the font, pixels
/// @throws std::runtime_error if the text cannot be drawn
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
std::string label(double value, double step, bool at_least)
{
  const int exponent = value > 0 ? static_cast<int>(std::floor(std::log10(value) + 1e-9)) : 0;
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  char text[64];
  if (value > 0 && (exponent < -4 || exponent > 5))
    std::snprintf(text, sizeof text, "%.2g", value);
  else
    std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return (at_least ? "\u2265 " : "") + std::string(text);
}

std::vector<Tick> makeTicks(const ScaleBar& bar, int font)
{
  const std::vector<double> values = roundTicks(bar.largest);
  const double step = values[1];
  std::vector<Tick> ticks;
  for (const double value : values) {
    const bool last = value == values.back() && value > bar.largest * (1 - 1e-6);
    ticks.push_back({value, textCoverage(label(value, step, last && bar.open_ended), font)});
  }
  return ticks;
}

Layout makeLayout(const ScaleBar& bar, int height)
{
  Layout layout;
  layout.font = std::clamp(height / 48, 9, 40);
  layout.pad = layout.font / 2;
  layout.bar_width = std::max(8, layout.font * 5 / 4);
  int text_width = 0;
  for (const std::string& line : bar.title) {
    layout.title.push_back(textCoverage(line, layout.font));
    text_width = std::max(text_width, layout.title.back().width - layout.bar_width - layout.pad);
  }
  layout.ticks = makeTicks(bar, layout.font);
  for (const Tick& tick : layout.ticks)
    text_width = std::max(text_width, tick.label.width);
  layout.width = layout.bar_width + text_width + 4 * layout.pad;
  const int title_height = bar.title.size() * layout.font * 3 / 2;
  layout.bar_top = height / 12 + title_height + layout.pad;
  layout.bar_bottom = std::max(layout.bar_top + 1, height - height / 12);
  return layout;
}

void paint(Image& image, int x, int y, const Rgb& color, int coverage = 255)
{
  if (x < 0 || y < 0 || x >= image.width || y >= image.height || coverage == 0)
    return;
  std::uint8_t* const pixel = image.pixel(x, y);
  const int below = image.channels == 4 ? pixel[3] * (255 - coverage) / 255 : 255 - coverage;
  const int alpha = coverage + below;
  for (int c = 0; c < 3; ++c)
    pixel[c] = (color[c] * coverage + pixel[c] * below + alpha / 2) / alpha;
  if (image.channels == 4)
    pixel[3] = alpha;
}

void paintText(Image& image, const Image& text, const Eigen::Vector2i& corner, const Rgb& color)
{
  for (int y = 0; y < text.height; ++y)
    for (int x = 0; x < text.width; ++x)
      paint(image, corner.x() + x, corner.y() + y, color, *text.pixel(x, y));
}

void paintBar(Image& image, const Layout& layout, int left, const Rgb& rim)
{
  const int rows = layout.bar_bottom - layout.bar_top;
  const Eigen::VectorXf values = Eigen::VectorXf::LinSpaced(rows, 1.f, 0.f);
  const Colors colors = errorColors(values, 1.f);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < layout.bar_width; ++x) {
      const bool at_rim = x == 0 || y == 0 || x == layout.bar_width - 1 || y == rows - 1;
      paint(image, left + x, layout.bar_top + y, at_rim ? rim : Rgb{colors(0, y), colors(1, y), colors(2, y)});
    }
}
} // namespace

std::vector<double> roundTicks(double largest)
{
  require(largest > 0 && std::isfinite(largest), "scale bar: largest value ", largest, " is not above 0");
  const double power = std::pow(10.0, std::floor(std::log10(largest)));
  const double lead = largest / power; // 1 <= lead < 10
  const double step = power * (lead < 2 ? 0.2 : lead < 5 ? 0.5 : 1.0);
  std::vector<double> ticks;
  for (int i = 0; i * step <= largest * (1 + 1e-6); ++i)
    ticks.push_back(i * step);
  return ticks;
}

int scaleBarWidth(const ScaleBar& bar, int height) { return makeLayout(bar, height).width; }

void drawScaleBar(Image& image, const ScaleBar& bar)
{
  require(image.channels >= 3, "scale bar: the picture has ", image.channels, " channels, not 3 or 4");
  const Layout layout = makeLayout(bar, image.height);
  const int left = image.width - layout.width + layout.pad;
  const int line = layout.font * 3 / 2;
  for (std::size_t i = 0; i < layout.title.size(); ++i)
    paintText(image, layout.title[i], {left, image.height / 12 + static_cast<int>(i) * line}, bar.text_color);
  paintBar(image, layout, left, bar.text_color);
  for (const Tick& tick : layout.ticks) {
    const double share = std::min(1.0, tick.value / bar.largest);
    const int y = std::lround(layout.bar_bottom - 1 - share * (layout.bar_bottom - 1 - layout.bar_top));
    for (int x = 0; x < layout.pad; ++x)
      paint(image, left + layout.bar_width + x, y, bar.text_color);
    const int text_left = left + layout.bar_width + layout.pad * 3 / 2;
    paintText(image, tick.label, {text_left, y - tick.label.height / 2}, bar.text_color);
  }
}
} // namespace fresco::rendering
