// SPDX-License-Identifier: BSD-3-Clause
#include "stages/photograph_places.h"
#include "stages/standpoints.h"
#include <cmath>
#include <filesystem>
#include <fresco/core/constants.h>
#include <fresco/core/parallel.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
namespace fresco::model {
using rendering::Viewpoint;
namespace {
/// Bilinear; nothing outside of the picture.
Eigen::Vector3f colorAt(const Image& photograph, const Eigen::Vector2d& pixel)
{
  const Eigen::Vector2d at = pixel.array() - 0.5;
  const int x = std::floor(at.x()), y = std::floor(at.y());
  if (!(at.minCoeff() > -1 && x < photograph.width && y < photograph.height))
    return Eigen::Vector3f::Zero();
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int k = 0; k < 4; ++k) {
    const std::uint8_t* color = photograph.pixel(std::clamp(x + k % 2, 0, photograph.width - 1),
                                                 std::clamp(y + k / 2, 0, photograph.height - 1));
    const double weight = (k % 2 == 0 ? x + 1 - at.x() : at.x() - x) * (k / 2 == 0 ? y + 1 - at.y() : at.y() - y);
    sum += float(weight) * Eigen::Vector3f(color[0], color[1], color[2]);
  }
  return sum;
}

/// What a pinhole camera without roll takes at the place of the photograph. Each pixel is the mean of four places.
Image levelPicture(const TextureView& view, const Viewpoint& from, const Eigen::Vector3d& up, int width, int height)
{
  const Image photograph = readImage(view.path, view.camera);
  const Eigen::Vector3d ahead = (from.look - from.eye).normalized(), right = ahead.cross(up).normalized();
  const Eigen::Vector3d down = ahead.cross(right);
  const double tangent = std::tan(0.5 * from.angle / degrees_per_radian);
  Image picture(width, height);
  parallelFor(height, 0, [&](Index row) {
    for (int column = 0; column < width; ++column) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (int k = 0; k < 4; ++k) {
        const double x = 2 * (column + 0.25 + 0.5 * (k % 2)) - width, y = 2 * (row + 0.25 + 0.5 * (k / 2)) - height;
        const Eigen::Vector3d seen =
            view.T_camera_world.linear() * (ahead + tangent / height * (x * right + y * down)).eval();
        if (seen.z() > 0 || view.camera.projection != CameraProjection::perspective)
          sum += 0.25f * colorAt(photograph, project(view.camera, seen));
      }
      for (int c = 0; c < 3; ++c)
        picture.pixel(column, row)[c] = std::lround(sum[c]);
    }
  });
  return picture;
}
} // namespace

Figures writePhotographPlaces(const Job& job, const std::vector<TextureView>& views)
{
  constexpr std::size_t most = 8; // that a menu shows at a glance, and a page holds
  constexpr int widest = 800, quality = 75;
  const Eigen::Vector3d up = uprightOf(job).value_or(Eigen::Vector3d::UnitZ());
  std::vector<Viewpoint> from;
  std::vector<const TextureView*> of;
  for (const TextureView& view : views)
    if (const Viewpoint place = viewOf(view.camera, view.T_camera_world.inverse()); isLevel(place, up)) {
      from.push_back(place);
      of.push_back(&view);
    }
  Figures places = Figures::array();
  if (from.empty())
    return places;
  makeFolder(job.files.places);
  for (const std::size_t v : variedViews(from, std::min(most, from.size()))) {
    const CameraModel& camera = of[v]->camera;
    const bool panorama = camera.projection == CameraProjection::spherical;
    const int width = panorama ? widest : std::min(widest, camera.width);
    const double aspect = panorama ? 4.0 / 3 : double(camera.width) / camera.fx * camera.fy / camera.height;
    const std::string file = concat("places/", places.size() + 1, ".jpg");
    writeImage(job.files.work + "/" + file,
               levelPicture(*of[v], from[v], up, width, std::max(1L, std::lround(width / aspect))), quality);
    const auto list = [](const Eigen::Vector3d& p) { return Figures{p.x(), p.y(), p.z()}; };
    places.push_back({{"name", std::filesystem::path(of[v]->path).stem().string()},
                      {"eye", list(from[v].eye)},
                      {"look", list(from[v].look)},
                      {"angle", from[v].angle},
                      {"aspect", aspect},
                      {"file", "work/" + file}});
  }
  return places;
}
} // namespace fresco::model
