// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/drawing.h"
#include <cmath>
#include <fresco/core/require.h>
#include <fresco/deliverables/core/model_file.h>
#include <iomanip>
#include <opencv2/imgproc.hpp>
#include <sstream>
namespace fresco {
using namespace drawing;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {
/// A white sheet.
ScaledPicture sheet(const Vector2d& low, const Vector2d& high, double pixel)
{
  require(pixel > 0 && std::isfinite(pixel), "picture: pixel ", pixel, " m is not above 0");
  const Eigen::Array2d size = ((high - low) / pixel).array().ceil().max(1.0);
  require(size.prod() < double(1 << 28), "picture: ", size.x(), " x ", size.y(),
          " pixels are too many; a larger pixel than ", pixel, " m helps");
  ScaledPicture picture;
  picture.image = Image(static_cast<int>(size.x()), static_cast<int>(size.y()), 3, 255);
  picture.pixel = pixel;
  picture.first_pixel = {low.x() + pixel / 2, high.y() - pixel / 2};
  return picture;
}

cv::Mat matOf(Image& image) { return {image.height, image.width, CV_8UC3, image.data.data()}; }

cv::Scalar penOf(std::uint32_t color) { return cv::Scalar(color >> 16 & 255u, color >> 8 & 255u, color & 255u); }

/// Draws surfaces from above; of those below the cut the highest stays.
class DownwardView {
public:
  DownwardView(const FloorPlan& plan, double pixel) : plan_(plan), picture_(sheet(plan.low, plan.high, pixel))
  {
    heights_.assign(static_cast<std::size_t>(picture_.image.width) * picture_.image.height, -INFINITY);
  }

  Vector3d place(const Vector3d& model) const
  {
    const Vector3d p = plan_.T_plan_model * model;
    return {(p.x() - picture_.first_pixel.x()) / picture_.pixel, (picture_.first_pixel.y() - p.y()) / picture_.pixel,
            p.z()};
  }

  /// @param color of three barycentric weights
  template <typename Color>
  void triangle(const Vector3d (&p)[3], const Color& color)
  {
    const auto side = [](const Vector3d& a, const Vector3d& b, double x, double y) {
      return (b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x());
    };
    const double area = side(p[0], p[1], p[2].x(), p[2].y());
    if (!(std::abs(area) > 1e-12))
      return;
    const Eigen::Array3d low = p[0].cwiseMin(p[1]).cwiseMin(p[2]), high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
    const int x1 = static_cast<int>(std::min<double>(picture_.image.width - 1, std::floor(high.x())));
    const int y1 = static_cast<int>(std::min<double>(picture_.image.height - 1, std::floor(high.y())));
    for (int y = static_cast<int>(std::max(0.0, std::ceil(low.y()))); y <= y1; ++y)
      for (int x = static_cast<int>(std::max(0.0, std::ceil(low.x()))); x <= x1; ++x) {
        const Vector3d w(side(p[1], p[2], x, y) / area, side(p[2], p[0], x, y) / area, side(p[0], p[1], x, y) / area);
        if (w.minCoeff() >= 0)
          dot(x, y, w.x() * p[0].z() + w.y() * p[1].z() + w.z() * p[2].z(), [&] { return color(w); });
      }
  }

  template <typename Color>
  void dot(int x, int y, double height, const Color& color)
  {
    float& highest = heights_[static_cast<std::size_t>(y) * picture_.image.width + x];
    if (height > plan_.height || !(height > highest))
      return;
    highest = static_cast<float>(height);
    const Vector3d rgb = color();
    for (int c = 0; c < 3; ++c)
      picture_.image.pixel(x, y)[c] = static_cast<std::uint8_t>(std::clamp(std::round(rgb[c]), 0.0, 255.0));
  }

  /// Pixels that nothing fell on get the mean of their neighbours. @return whether there were any
  void closeGaps()
  {
    const std::vector<float> before = heights_;
    const Image old = picture_.image;
    for (int y = 1; y + 1 < old.height; ++y)
      for (int x = 1; x + 1 < old.width; ++x) {
        const std::size_t at = static_cast<std::size_t>(y) * old.width + x;
        if (before[at] > -INFINITY)
          continue;
        Vector3d sum = Vector3d::Zero();
        int count = 0;
        for (int k = 0; k < 9; ++k) {
          const int nx = x + k % 3 - 1, ny = y + k / 3 - 1;
          if (const float height = before[static_cast<std::size_t>(ny) * old.width + nx]; height > -INFINITY) {
            for (int c = 0; c < 3; ++c)
              sum[c] += old.pixel(nx, ny)[c];
            heights_[at] = height;
            ++count;
          }
        }
        for (int c = 0; c < 3 && count > 0; ++c)
          picture_.image.pixel(x, y)[c] = static_cast<std::uint8_t>(sum[c] / count);
      }
  }

  ScaledPicture finish() { return std::move(picture_); }
  int width() const { return picture_.image.width; }
  int height() const { return picture_.image.height; }

private:
  const FloorPlan& plan_;
  ScaledPicture picture_;
  std::vector<float> heights_;
};

/// @param at texture coordinates, v upwards
Vector3d texel(const Image& atlas, const Vector2d& at)
{
  const double x = std::clamp(at.x() * atlas.width - 0.5, 0.0, atlas.width - 1.0);
  const double y = std::clamp((1 - at.y()) * atlas.height - 0.5, 0.0, atlas.height - 1.0);
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, atlas.width - 1), y1 = std::min(y0 + 1, atlas.height - 1);
  const auto color = [&](int i, int j) {
    const std::uint8_t* p = atlas.pixel(i, j);
    return Vector3d(p[0], p[1], p[2]);
  };
  const double u = x - x0, v = y - y0;
  return (1 - v) * ((1 - u) * color(x0, y0) + u * color(x1, y0)) + v * ((1 - u) * color(x0, y1) + u * color(x1, y1));
}
} // namespace

ScaledPicture planPicture(const FloorPlan& plan, double pixel)
{
  constexpr int fraction = 4; // bits of a coordinate after the point
  const Drawing drawing = drawingOf(plan, {});
  ScaledPicture picture = sheet(drawing.low, drawing.high, pixel);
  cv::Mat canvas = matOf(picture.image);
  const auto pixelOf = [&](const Vector2d& p) {
    const Vector2d at = (p - picture.first_pixel) / pixel * (1 << fraction);
    return cv::Point(static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(-at.y())));
  };
  const auto thickness = [&](double width) { return std::max(1, static_cast<int>(std::lround(width / pixel))); };
  for (const Line& line : drawing.lines) {
    const Style& style = styleOf(line.layer);
    std::vector<cv::Point> points;
    for (Index k = 0; k < line.points.cols(); ++k)
      points.push_back(pixelOf(line.points.col(k)));
    if (style.width > 0)
      cv::polylines(canvas, points, false, penOf(style.color), thickness(style.width), cv::LINE_AA, fraction);
    else
      cv::fillPoly(canvas, points, penOf(style.color), cv::LINE_AA, fraction);
  }
  for (Index k = 0; k < drawing.points.cols(); ++k)
    cv::circle(canvas, pixelOf(drawing.points.col(k)), 1 << fraction, penOf(styleOf(Layer::section).color), cv::FILLED,
               cv::LINE_AA, fraction);
  for (const Text& text : drawing.texts) {
    constexpr double height_of_font = 22; // pixels of a capital at scale 1
    const double scale = text.height / pixel / height_of_font;
    const cv::Size size = cv::getTextSize(text.words, cv::FONT_HERSHEY_SIMPLEX, scale, 1, nullptr);
    const cv::Point at = pixelOf(text.at);
    cv::putText(canvas, text.words, {at.x / (1 << fraction) - size.width / 2, at.y / (1 << fraction)},
                cv::FONT_HERSHEY_SIMPLEX, scale, penOf(0x333333), thickness(text.height / 12), cv::LINE_AA);
  }
  return picture;
}

ScaledPicture orthophoto(const TexturedMesh& model, const FloorPlan& plan, double pixel)
{
  const TriangleMesh& mesh = model.mesh;
  const bool textured = isTextured(model);
  textured ? validateTexturedMesh(model) : validateMesh(mesh);
  require(isColored(model), "orthophoto: the model has neither texture nor colours");
  DownwardView view(plan, pixel);
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    Vector3d corners[3];
    for (int k = 0; k < 3; ++k)
      corners[k] = view.place(faceCorner(mesh, f, k) + mesh.origin);
    if (const int atlas = textured ? model.face_atlas[f] : -1; atlas >= 0) {
      Eigen::Matrix<double, 2, 3> at;
      for (int k = 0; k < 3; ++k)
        at.col(k) = model.texcoords.col(model.texcoord_faces(k, f)).cast<double>();
      view.triangle(corners, [&](const Vector3d& w) { return texel(model.atlases[atlas], at * w); });
    } else if (mesh.colors.cols() > 0) {
      view.triangle(corners, [&](const Vector3d& w) {
        Vector3d color = Vector3d::Zero();
        for (int k = 0; k < 3; ++k)
          color += w[k] * mesh.colors.col(mesh.faces(k, f)).cast<double>();
        return color;
      });
    }
  }
  return view.finish();
}

ScaledPicture orthophoto(const PointSet& cloud, const FloorPlan& plan, double pixel)
{
  validatePointSet(cloud);
  require(cloud.colors.cols() > 0, "orthophoto: the cloud has no colours");
  DownwardView view(plan, pixel);
  for (Index i = 0; i < cloud.size(); ++i) {
    const Vector3d p = view.place(cloud.points.col(i).cast<double>() + cloud.origin);
    if (p.x() > -0.5 && p.y() > -0.5 && p.x() < view.width() - 0.5 && p.y() < view.height() - 0.5)
      view.dot(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())), p.z(),
               [&] { return Vector3d(cloud.colors.col(i).cast<double>()); });
  }
  view.closeGaps();
  view.closeGaps();
  return view.finish();
}

std::string worldFile(const ScaledPicture& picture)
{
  std::ostringstream text;
  text << std::setprecision(12) << picture.pixel << "\n0\n0\n"
       << -picture.pixel << '\n'
       << picture.first_pixel.x() << '\n'
       << picture.first_pixel.y() << '\n';
  return text.str();
}
} // namespace fresco
