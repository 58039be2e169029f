// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/e57/content.h"
#include "io/points/scan_reader.h"
#include <fresco/io/file.h>
#include <fresco/io/scan_images.h>
namespace fresco {
namespace io::e57 {
namespace {
/// A section begins with its kind, its length and 0 for a blob.
std::string readBlob(PagedFile& file, const Blob& blob)
{
  constexpr std::size_t header_bytes = 16;
  const std::uint64_t begin = file.logical(blob.physical_offset);
  char header[header_bytes];
  file.read(begin, header, header_bytes);
  expect(header[0] == 0, "damaged: no picture at offset ", blob.physical_offset);
  const std::uint64_t left = file.size() - begin - header_bytes;
  expect(blob.length != 0 && blob.length <= left, "truncated: a picture of ", blob.length, " bytes, ", left,
         " are left in the file");
  std::string bytes(blob.length, '\0');
  file.read(begin + header_bytes, bytes.data(), bytes.size());
  return bytes;
}

/// The picture, or its mask.
std::string imageBytes(const std::string& path, Index image, bool mask)
{
  return namingFile(path, [&] {
    PagedFile file(path);
    const Content content = parseContent(file);
    expect(image >= 0 && image < Index(content.images.size()), "no picture ", image, ", the file has ",
           content.images.size());
    const Image& asked = content.images[image];
    expect(!mask || asked.mask, "picture ", image, " has no mask");
    return readBlob(file, mask ? *asked.mask : asked.picture);
  });
}
} // namespace
} // namespace io::e57

std::vector<ScanImage> readScanImages(const std::string& path)
{
  std::vector<ScanImage> images;
  if (extension(path) == ".e57")
    io::namingFile(path, [&] {
      io::e57::PagedFile file(path);
      for (const io::e57::Image& image : parseContent(file).images)
        images.push_back(image.description);
    });
  return images;
}

std::string readScanImageBytes(const std::string& path, Index image) { return io::e57::imageBytes(path, image, false); }
std::string readScanImageMask(const std::string& path, Index image) { return io::e57::imageBytes(path, image, true); }

Eigen::Isometry3d cameraAxes(ScanImage::Projection projection)
{
  Eigen::Isometry3d T_camera_image = Eigen::Isometry3d::Identity();
  if (projection == ScanImage::Projection::pinhole)
    T_camera_image.linear().diagonal() << 1, -1, -1;
  else
    T_camera_image.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return T_camera_image;
}

ScanCamera cameraOf(const ScanImage& image)
{
  require(image.projection == ScanImage::Projection::pinhole && image.T_file_image, "picture '", image.name,
          "': not pinhole, or without a pose");
  require(image.width > 0 && image.height > 0 && image.focal_length > 0 && image.pixel_width > 0 &&
              image.pixel_height > 0,
          "picture '", image.name, "': no size or no focal length");
  ScanCamera result;
  CameraModel& camera = result.camera;
  camera.width = image.width;
  camera.height = image.height;
  camera.fx = image.focal_length / image.pixel_width;
  camera.fy = image.focal_length / image.pixel_height;
  camera.cx = image.principal_x;
  camera.cy = image.principal_y;
  result.T_camera_file = cameraAxes(image.projection) * image.T_file_image->inverse();
  return result;
}
} // namespace fresco
