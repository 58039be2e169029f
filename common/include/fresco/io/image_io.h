// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <fresco/core/export.h>
#include <fresco/core/image.h>
#include <string>
#include <string_view>
#include <vector>
namespace fresco {
struct CameraModel;

/// In pixels.
struct ImageSize {
  int width = 0, height = 0;
};

/// PNG, JPEG, TIFF, BMP or WebP; 16 bit and alpha are reduced to 8-bit RGB; EXIF orientation is not applied.
/// @throws std::runtime_error naming the file if it is missing, empty, truncated or no image
FRESCO_EXPORT Image readImage(const std::string& path);

/// The same for a camera's photograph or its mask. @throws std::runtime_error naming the file and both sizes before
/// anything is decoded if it has not the camera's size
FRESCO_EXPORT Image readImage(const std::string& path, const CameraModel& camera);

/// The same with alpha as a fourth channel where a PNG file has it: photographs of which only parts are to be used.
FRESCO_EXPORT Image readPhotograph(const std::string& path, const CameraModel& camera);

/// What the header tells; nothing is decoded. @throws std::runtime_error as readImage
FRESCO_EXPORT ImageSize readImageSize(const std::string& path);

/// @throws std::runtime_error with both sizes if that of an image is not the camera's
FRESCO_EXPORT void requireImageSize(const ImageSize& size, const CameraModel& camera);

/// The same from the bytes of such a file.
/// @throws std::runtime_error if they are damaged, truncated, fewer than the size asks for or none of these
FRESCO_EXPORT Image decodeImage(std::string_view bytes);

/// @throws std::runtime_error as readImage, and if the image is not 16 bit with one channel
FRESCO_EXPORT Image16 readImage16(const std::string& path);

inline constexpr double metres_unit = 1e-4; ///< of depths in metres where they are made whole numbers: up to 6.5 m

struct DepthFile {
  Image16 image; ///< 0 = none
  bool in_metres =
      false; ///< the file has metres as floats, which became units of `metres_unit`; else the camera's units
};

/// Depths as readImage16() has them, or 32-bit floats: TIFF, PFM, NPY (64 bits, too). What is not finite or farther than 16 bits hold is none.
/// @throws std::runtime_error as readImage, and if it is another image
FRESCO_EXPORT DepthFile readDepthFile(const std::string& path);

/// PNG or JPEG by extension; whole or not at all.
/// @param quality of JPEG, 0..100
FRESCO_EXPORT void writeImage(const std::string& path, const Image& image, int quality = 95);

/// PNG of 16 bits. @throws std::invalid_argument if `path` has another extension or the image is empty
FRESCO_EXPORT void writeImage(const std::string& path, const Image16& image);

/// File of the mask of a photograph (white = use): NAME.png or NAME.EXT.png of `folder`/masks, else of masks beside
/// `folder`, where NAME.EXT is the photograph. "" if there is none.
/// @param name of the photograph, below `folder`
FRESCO_EXPORT std::string maskFileOf(const std::string& folder, const std::string& name);

/// The bytes that writeImage() would put into a file with extension ".png" or ".jpg".
FRESCO_EXPORT std::vector<std::uint8_t> encodeImage(const Image& image, const std::string& extension, int quality = 95);
} // namespace fresco
