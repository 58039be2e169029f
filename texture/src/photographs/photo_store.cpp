// SPDX-License-Identifier: BSD-3-Clause
#include "photographs/photo_store.h"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fresco/core/require.h>
#include <fresco/core/simd.h>
#include <fresco/io/image_io.h>
#include <opencv2/imgproc.hpp>
namespace fresco::texture {
namespace {
Image asRgb(const Image& in)
{
  Image out(in.width, in.height, 3);
  for (int y = 0; y < in.height; ++y)
    for (int x = 0; x < in.width; ++x)
      for (int c = 0; c < 3; ++c)
        out.pixel(x, y)[c] = in.pixel(x, y)[in.channels >= 3 ? c : 0];
  return out;
}

/// Weights of the pixels at -1, 0, 1, 2 for a place t = 0..1 between the middle two (Catmull & Rom 1974).
Eigen::Vector4f cubicWeights(float t)
{
  const float t2 = t * t, t3 = t2 * t;
  return {-0.5f * t + t2 - 0.5f * t3, 1 - 2.5f * t2 + 1.5f * t3, 0.5f * t + 2 * t2 - 1.5f * t3, -0.5f * t2 + 0.5f * t3};
}

/// For images that were given, not read.
void requireSize(const Image& image, const CameraModel& camera, const std::string& name)
try {
  requireImageSize({image.width, image.height}, camera);
} catch (const std::runtime_error& error) {
  throw std::runtime_error(name + ": " + error.what());
}

std::shared_ptr<const Image> loadGiven(const TextureView& v, Index view)
{
  if (v.image.empty())
    return std::make_shared<const Image>(readImage(v.path, v.camera));
  const std::shared_ptr<const Image> image(std::shared_ptr<void>(), &v.image);
  requireSize(*image, v.camera, v.path.empty() ? concat("photograph ", view) : v.path);
  return image->channels == 3 ? image : std::make_shared<const Image>(asRgb(*image));
}
} // namespace

PhotoStore::PhotoStore(const std::vector<ViewPart>& views, std::size_t most_bytes)
    : views_(views), most_bytes_(most_bytes), slots_(views.size())
{}

std::shared_ptr<const Image> PhotoStore::get(Index view)
{
  {
    const std::lock_guard lock(mutex_);
    Slot& slot = slots_[view];
    if (slot.image) {
      recent_.splice(recent_.begin(), recent_, slot.recent);
      return slot.image;
    }
  }
  auto image = load(view);
  keep(view, image);
  return image;
}

std::shared_ptr<const Image> PhotoStore::load(Index view)
{
  return views_[view].ofPanorama() ? std::make_shared<const Image>(cutPanorama(*panoramaOf(view), views_[view]))
                                   : loadGiven(*views_[view].given, views_[view].view);
}

std::shared_ptr<const Image> PhotoStore::panoramaOf(Index view)
{
  const int number = views_[view].view;
  {
    const std::lock_guard lock(mutex_);
    if (panorama_view_ == number)
      return panorama_;
  }
  auto image = std::make_shared<const Image>(wrapPanorama(*loadGiven(*views_[view].given, views_[view].view)));
  const std::lock_guard lock(mutex_);
  panorama_ = image;
  panorama_view_ = number;
  return image;
}

Image PhotoStore::mask(Index view)
{
  const ViewPart& part = views_[view];
  const TextureView& v = *part.given;
  Image rgb;
  if (!v.mask.empty() || !v.mask_path.empty()) {
    rgb = v.mask.empty() ? readImage(v.mask_path, v.camera) : asRgb(v.mask);
    requireSize(rgb, v.camera, v.mask_path.empty() ? concat("mask of photograph ", part.view) : v.mask_path);
  }
  if (part.ofPanorama()) {
    const Image ends = blackEnds(*panoramaOf(view));
    rgb = rgb.empty() ? ends : wrapPanorama(rgb);
    for (std::size_t i = 0; i < ends.data.size(); ++i)
      rgb.data[i] = std::min(rgb.data[i], ends.data[i]);
    if (!rgb.empty())
      rgb = cutPanorama(rgb, part);
  }
  if (rgb.empty())
    return {};
  constexpr int used = 128, reach = 2; // grey level; pixels, of cubic interpolation
  Image out(rgb.width, rgb.height, 1);
  for (std::size_t i = 0; i < out.data.size(); ++i)
    out.data[i] = rgb.data[3 * i + 1] >= used ? 255 : 0;
  cv::Mat grey(out.height, out.width, CV_8U, out.data.data());
  cv::erode(grey, grey, cv::Mat::ones(2 * reach + 1, 2 * reach + 1, CV_8U));
  return out;
}

void PhotoStore::keep(Index view, std::shared_ptr<const Image> image)
{
  const std::lock_guard lock(mutex_);
  if (slots_[view].image)
    return;
  bytes_ += image->data.size();
  recent_.push_front(view);
  slots_[view] = {std::move(image), recent_.begin()};
  drop();
}

void PhotoStore::setAside(std::size_t bytes)
{
  const std::lock_guard lock(mutex_);
  aside_ = bytes;
  drop();
}

void PhotoStore::drop()
{
  while (bytes_ + aside_ > most_bytes_ && recent_.size() > 1)
    dropOldest();
}

void PhotoStore::dropOldest()
{
  Slot& oldest = slots_[recent_.back()];
  bytes_ -= oldest.image->data.size();
  oldest.image.reset();
  recent_.pop_back();
}

void PhotoStore::dropUnlessAll()
{
  const std::lock_guard lock(mutex_);
  while (recent_.size() < slots_.size() && !recent_.empty())
    dropOldest();
}

namespace {
constexpr int taps = 4; // of the cubic

/// Rows weighted and added first: number 3 * a + c of tap a and channel c.
void addRow(const std::uint8_t* row, float weight, simd::Float4 (&sum)[3])
{
  for (int i = 0; i < 3; ++i)
    sum[i] += weight * simd::floatsOf(row + 4 * i);
}
} // namespace

Eigen::Vector3f samplePhoto(const Image& photo, float x, float y)
{
  const float u = std::clamp(x - 0.5f, 0.f, photo.width - 1.f), v = std::clamp(y - 0.5f, 0.f, photo.height - 1.f);
  const int i = u, j = v;
  const Eigen::Vector4f wx = cubicWeights(u - i), wy = cubicWeights(v - j);
  simd::Float4 rows[3] = {};
  const bool inside = i >= 1 && i + 2 < photo.width;
  for (int b = 0; b < taps; ++b) {
    const int row = std::clamp(j + b - 1, 0, photo.height - 1);
    if (inside) {
      addRow(photo.pixel(i - 1, row), wy[b], rows);
      continue;
    }
    std::uint8_t pixels[3 * taps];
    for (int a = 0; a < taps; ++a)
      std::copy_n(photo.pixel(std::clamp(i + a - 1, 0, photo.width - 1), row), 3, pixels + 3 * a);
    addRow(pixels, wy[b], rows);
  }
  float sum[3 * taps];
  std::memcpy(sum, rows, sizeof sum);
  Eigen::Vector3f out;
  for (int c = 0; c < 3; ++c)
    out[c] = wx[0] * sum[c] + wx[1] * sum[3 + c] + wx[2] * sum[6 + c] + wx[3] * sum[9 + c];
  return out.cwiseMax(0.f).cwiseMin(255.f);
}

Eigen::Vector3f samplePhotoQuickly(const Image& photo, float x, float y)
{
  const float u = std::clamp(x - 0.5f, 0.f, photo.width - 1.f), v = std::clamp(y - 0.5f, 0.f, photo.height - 1.f);
  const int i = std::min<int>(u, photo.width - 2), j = std::min<int>(v, photo.height - 2);
  const float a = u - i, b = v - j;
  const std::uint8_t *p = photo.pixel(i, j), *q = photo.pixel(i, j + 1);
  return ((1 - a) * (1 - b)) * Eigen::Vector3f(p[0], p[1], p[2]) + (a * (1 - b)) * Eigen::Vector3f(p[3], p[4], p[5]) +
         ((1 - a) * b) * Eigen::Vector3f(q[0], q[1], q[2]) + (a * b) * Eigen::Vector3f(q[3], q[4], q[5]);
}
} // namespace fresco::texture
