// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/simulation/sensors/photograph.h>
#include <fresco/simulation/sensors/random.h>
#include <opencv2/imgproc.hpp>
namespace fresco::simulation {
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {
constexpr int block = 2; // pixels along the side of a ray packet's square
constexpr float corners[4][2] = {{0.25f, 0.25f}, {0.75f, 0.25f}, {0.25f, 0.75f}, {0.75f, 0.75f}}; // rays within a pixel
constexpr int pixel_rays = 4 * block * block; // rays traced together
const Vector3f background(0.7f, 0.75f, 0.8f);

/// Noise of a pixel, deviation 1: twelve random bits of a hash each, four a channel (Irwin-Hall).
Vector3f pixelNoise(const Exposure& exposure, std::uint64_t pixel)
{
  Vector3f noise;
  for (int channel = 0; channel < 3; ++channel) {
    std::uint64_t bits =
        scramble(scramble(exposure.seed * 0x9e3779b97f4a7c15ull + exposure.number) + 3 * pixel + channel);
    float sum = 0.f;
    for (int k = 0; k < 4; ++k, bits >>= 16)
      sum += (bits & 0xffffu) / 65536.f;
    noise[channel] = (sum - 2.f) * 1.7320508f;
  }
  return noise;
}

/// @param value grey levels
float throughCurve(float value, float response)
{
  const float v = std::min(value / 255.f, 1.f);
  return 255.f * ((1 - response) * v + response * v * v * (3 - 2 * v));
}

/// What the sensor makes of the light, display values as fractions of white, row by row.
Image develop(const std::vector<Vector3f>& light, const Shot& shot, int threads)
{
  const auto& [gain, noise, corner, blur, response, seed, number] = shot.exposure;
  const CameraModel& camera = shot.camera;
  Image image(camera.width, camera.height);
  const double half = 0.5 * std::hypot(camera.width, camera.height);
  parallelFor(image.height, threads, [&, gain = gain, noise = noise, corner = corner, response = response](Index y) {
    for (int x = 0; x < image.width; ++x) {
      const Index at = y * image.width + x;
      Vector3f value = 255.f * light[at].cwiseProduct(gain);
      if (corner < 1.f) {
        const double r = std::hypot(x + 0.5 - camera.cx, y + 0.5 - camera.cy) / half;
        value *= 1 - (1 - corner) * r * r;
      }
      if (response > 0.f)
        value = value.unaryExpr([&](float v) { return throughCurve(v, response); });
      if (noise > 0.f)
        value += noise * pixelNoise(shot.exposure, at);
      for (int channel = 0; channel < 3; ++channel)
        image.pixel(x, y)[channel] = static_cast<std::uint8_t>(std::clamp(value[channel] + 0.5f, 0.f, 255.f));
    }
  });
  return image;
}

/// Rays of the pixels at (x, y) .. (x + 1, y + 1), four a pixel.
RayPacket<pixel_rays> pixelRays(const Shot& shot, const Vector3f& center, const Eigen::Vector2i& at)
{
  const Eigen::Matrix3d R_world_camera = shot.view.T_camera_world.linear().transpose();
  RayPacket<pixel_rays> packet;
  for (int i = 0; i < pixel_rays; ++i) {
    const int pixel = i / 4;
    const Vector2d where(at.x() + pixel % block + corners[i % 4][0], at.y() + pixel / block + corners[i % 4][1]);
    const bool around = shot.camera.projection == CameraProjection::spherical;
    const Vector3d beam = R_world_camera * (around ? direction(shot.camera, where) : unproject(shot.camera, where));
    packet[i] = {center, beam.cast<float>()};
  }
  return packet;
}

Vector3f rayColor(const LitScene& lit, const Shot& shot, const Ray& ray, const RayHit& hit)
{
  if (shot.intruder)
    if (const auto seen = shot.intruder->hit(ray); seen && (hit.face < 0 || seen->first < hit.distance))
      return seen->second;
  if (hit.face < 0)
    return background;
  const float cosine = std::fabs(faceNormal(lit.scene.mesh, hit.face).dot(ray.direction.normalized()));
  // distance is a depth, for directions have z = 1 (panoramas: length 1); of the four rays of a pixel each stands for half its width
  const float footprint = 0.7f * hit.distance / static_cast<float>(shot.camera.fx) / std::sqrt(std::max(cosine, 0.1f));
  return surfaceColor(lit, hit, footprint);
}
} // namespace

Exposure randomExposure(std::uint64_t seed, std::uint64_t number, float spread)
{
  require(spread >= 0.f && spread <= 0.9f, "exposure: spread ", spread, " is not in 0..0.9");
  CounterRandom random(seed, 61, number);
  const double brightness = 1.0 + random.uniform(-spread, spread);
  const double red = 1.0 + random.uniform(-0.25, 0.25) * spread, blue = 1.0 + random.uniform(-0.25, 0.25) * spread;
  Exposure exposure;
  exposure.gain = Eigen::Vector3d(brightness * red, brightness, brightness * blue).cast<float>();
  exposure.seed = seed;
  exposure.number = number;
  return exposure;
}

std::optional<std::pair<float, Vector3f>> Intruder::hit(const Ray& ray) const
{
  const Vector3f from = (ray.origin - center).cwiseQuotient(radii), along = ray.direction.cwiseQuotient(radii);
  const float a = along.squaredNorm(), b = from.dot(along), c = from.squaredNorm() - 1;
  const float root = b * b - a * c;
  if (!(root > 0) || !(c > 0)) // passes by, or the camera is inside
    return {};
  const float distance = (-b - std::sqrt(root)) / a;
  if (!(distance > 0))
    return {};
  const Vector3f at = from + distance * along; // on the unit sphere
  constexpr float stripes = 7;                 // over the height
  const Vector3f color =
      std::fmod(stripes * (at.z() + 1), 2.f) < 1 ? Vector3f(0.75f, 0.2f, 0.15f) : Vector3f(0.15f, 0.25f, 0.6f);
  return std::pair{distance, Vector3f((0.6f + 0.4f * at.z()) * color)};
}

std::optional<Intruder> intruderBefore(const LitScene& lit, const View& view)
{
  const Vector3f radii(0.28f, 0.28f, 0.85f);  // of a person, metres
  constexpr float least = 0.9f, share = 0.6f; // metres from the camera; of the way to what stands there
  const Vector3f eye = (view.center() - lit.scene.mesh.origin).cast<float>();
  const Vector3f ahead = view.T_camera_world.linear().transpose().col(2).cast<float>();
  const RayHit wall = lit.rays.intersect(Ray{eye, ahead});
  if (wall.face < 0 || share * wall.distance < least)
    return {};
  Vector3f center = eye + share * wall.distance * ahead;
  center.z() = lit.scene.mesh.vertices.row(2).minCoeff() + radii.z();
  return Intruder{center, radii};
}

Image takePhotograph(const LitScene& lit, const Shot& shot, int threads)
{
  const CameraModel& camera = shot.camera;
  require(camera.width > 0 && camera.height > 0 && camera.fx > 0 && camera.fy > 0, "photograph: not a camera");
  require(shot.exposure.corner >= 0.1f && shot.exposure.corner <= 1.f && shot.exposure.blur >= 0.f &&
              shot.exposure.blur <= 20.f && shot.exposure.response >= 0.f && shot.exposure.response <= 1.f,
          "photograph: vignetting, blur or response out of range");
  std::vector<Vector3f> light(static_cast<std::size_t>(camera.width) * camera.height);
  const Vector3f center = (shot.view.center() - lit.scene.mesh.origin).cast<float>();
  const Index rows = (camera.height + block - 1) / block;
  parallelFor(
      rows, threads,
      [&](Index row) {
        for (int x = 0; x < camera.width; x += block) {
          const Eigen::Vector2i at(x, row * block);
          const RayPacket<pixel_rays> packet = pixelRays(shot, center, at);
          const HitPacket<pixel_rays> hits = lit.rays.intersect(packet, RayOrder::coherent);
          for (int pixel = 0; pixel < block * block; ++pixel) {
            const Eigen::Vector2i own = at + Eigen::Vector2i(pixel % block, pixel / block);
            if (own.x() >= camera.width || own.y() >= camera.height)
              continue;
            Vector3f sum = Vector3f::Zero();
            for (std::size_t k = 0; k < 4; ++k) {
              const std::size_t i = 4 * pixel + k;
              sum += rayColor(lit, shot, packet[i], hits[i]);
            }
            light[static_cast<std::size_t>(own.y()) * camera.width + own.x()] = 0.25f * sum;
          }
        }
      },
      4);
  if (const float blur = shot.exposure.blur; blur > 0.f) {
    cv::Mat pixels(camera.height, camera.width, CV_32FC3, light.data());
    cv::GaussianBlur(pixels, pixels, {}, blur, blur, cv::BORDER_REPLICATE);
  }
  return develop(light, shot, threads);
}
} // namespace fresco::simulation
