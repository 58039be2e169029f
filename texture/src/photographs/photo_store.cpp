// SPDX-License-Identifier: BSD-3-Clause
#include "photographs/photo_store.h"
#include "photographs/blank_pixels.h"
#include "photographs/color_fringe.h"
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
  if (in.channels == 3)
    return in;
  Image out(in.width, in.height, 3);
  for (std::size_t i = 0; i < out.data.size(); ++i)
    out.data[i] = in.data[i / 3 * in.channels + (in.channels >= 3 ? i % 3 : 0)];
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

PhotoStore::Photo loadGiven(const TextureView& v, Index view)
{
  std::shared_ptr<const Image> image(std::shared_ptr<void>(), &v.image);
  if (v.image.empty())
    image = std::make_shared<const Image>(readPhotograph(v.path, v.camera));
  else
    requireSize(*image, v.camera, v.path.empty() ? concat("photograph ", view) : v.path);
  if (image->channels == 1)
    image = std::make_shared<const Image>(asRgb(*image));
  auto unblank = std::make_shared<const Image>(blankPixels(*image));
  if (image->channels == 4)
    image = std::make_shared<const Image>(asRgb(*image));
  const int fringe = fringeWidth(*image);
  if (fringe > 0)
    image = std::make_shared<const Image>(withoutFringe(*image, fringe));
  return {std::move(image), std::move(unblank), fringe};
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
  Photo photo = load(view);
  auto image = photo.image;
  keep(view, std::move(photo));
  return image;
}

PhotoStore::Photo PhotoStore::load(Index view)
{
  if (!views_[view].ofPanorama())
    return loadGiven(*views_[view].given, views_[view].view);
  Photo photo = panoramaOf(view);
  photo.image = std::make_shared<const Image>(cutPanorama(*photo.image, views_[view]));
  return photo;
}

PhotoStore::Photo PhotoStore::panoramaOf(Index view)
{
  const int number = views_[view].view;
  {
    const std::lock_guard lock(mutex_);
    if (panorama_view_ == number)
      return panorama_;
  }
  Photo photo = loadGiven(*views_[view].given, number);
  photo.image = std::make_shared<const Image>(wrapPanorama(*photo.image));
  const std::lock_guard lock(mutex_);
  panorama_ = photo;
  panorama_view_ = number;
  return photo;
}

std::shared_ptr<const Image> PhotoStore::unblank(Index view)
{
  for (;; get(view)) {
    const std::lock_guard lock(mutex_);
    if (slots_[view].unblank)
      return slots_[view].unblank;
  }
}

int PhotoStore::fringe(Index view)
{
  unblank(view);
  const std::lock_guard lock(mutex_);
  return slots_[view].fringe;
}

Image PhotoStore::mask(Index view)
{
  const ViewPart& part = views_[view];
  const TextureView& v = *part.given;
  Image used = *unblank(view);
  if (!v.mask.empty() || !v.mask_path.empty()) {
    const Image given = asRgb(v.mask.empty() ? readImage(v.mask_path, v.camera) : v.mask);
    requireSize(given, v.camera, v.mask_path.empty() ? concat("mask of photograph ", part.view) : v.mask_path);
    if (used.empty())
      used = Image(given.width, given.height, 1, 255);
    for (std::size_t i = 0; i < used.data.size(); ++i)
      used.data[i] = given.data[3 * i + 1] >= mid_grey ? used.data[i] : 0;
  }
  if (!part.ofPanorama() || used.empty())
    return used;
  const Image cut = cutPanorama(wrapPanorama(asRgb(used)), part);
  used = Image(cut.width, cut.height, 1);
  for (std::size_t i = 0; i < used.data.size(); ++i)
    used.data[i] = cut.data[3 * i] >= mid_grey ? 255 : 0;
  return used;
}

void PhotoStore::keep(Index view, Photo photo)
{
  const std::lock_guard lock(mutex_);
  Slot& slot = slots_[view];
  if (slot.image)
    return;
  bytes_ += photo.image->data.size() + photo.unblank->data.size();
  recent_.push_front(view);
  slot = {std::move(photo), recent_.begin()};
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
  bytes_ -= oldest.image->data.size() + oldest.unblank->data.size();
  oldest.image.reset();
  if (!oldest.unblank->empty())
    oldest.unblank.reset();
  recent_.pop_back();
}

void PhotoStore::dropUnlessAll()
{
  const std::lock_guard lock(mutex_);
  while (recent_.size() < slots_.size() && !recent_.empty())
    dropOldest();
}

Image withinReach(Image mask)
{
  cv::Mat grey(mask.height, mask.width, CV_8U, mask.data.data());
  if (!mask.empty())
    cv::erode(grey, grey, cv::Mat::ones(2 * interpolation_reach + 1, 2 * interpolation_reach + 1, CV_8U));
  return mask;
}

Eigen::Vector3f samplePhoto(const Image& photo, float x, float y)
{
  const float u = std::clamp(x - 0.5f, 0.f, photo.width - 1.f), v = std::clamp(y - 0.5f, 0.f, photo.height - 1.f);
  const int i = u, j = v;
  const Eigen::Vector4f wx = cubicWeights(u - i), wy = cubicWeights(v - j);
  constexpr int taps = 4;    // of the cubic
  simd::Float4 rows[3] = {}; // weighted and added first: number 3 * a + c of tap a and channel c
  const auto addRow = [&](const std::uint8_t* row, float weight) {
    for (int k = 0; k < 3; ++k)
      rows[k] += weight * simd::floatsOf(row + 4 * k);
  };
  const bool inside = i >= 1 && i + 2 < photo.width;
  for (int b = 0; b < taps; ++b) {
    const int row = std::clamp(j + b - 1, 0, photo.height - 1);
    if (inside) {
      addRow(photo.pixel(i - 1, row), wy[b]);
      continue;
    }
    std::uint8_t pixels[3 * taps];
    for (int a = 0; a < taps; ++a)
      std::copy_n(photo.pixel(std::clamp(i + a - 1, 0, photo.width - 1), row), 3, pixels + 3 * a);
    addRow(pixels, wy[b]);
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
