// SPDX-License-Identifier: BSD-3-Clause
#include "common/io/e57_file.h"
#include "input/model_input.h"
#include "input/scan_pictures.h"
#include "test_data.h"
#include <fresco/core/constants.h>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
namespace fresco::model {
namespace {
namespace e57 = test::e57;
using e57::element;
using Eigen::Isometry3d;
using Eigen::Vector3d;

/// A picture whose colour tells the pixel: red the column, green the row.
Image numbered(int width, int height)
{
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.pixel(x, y)[0] = x, image.pixel(x, y)[1] = y, image.pixel(x, y)[2] = 128;
  return image;
}

std::string png(const Image& image)
{
  const auto bytes = encodeImage(image, ".png");
  return {bytes.begin(), bytes.end()};
}

e57::Image stored(const char* kind, const Image& image, const std::string& more)
{
  return {concat("<", kind, "Representation type=\"Structure\"><pngImage type=\"Blob\" PICTURE/>",
                 element("imageWidth", image.width), element("imageHeight", image.height), more, "</", kind,
                 "Representation>"),
          png(image), ""};
}

const Isometry3d T_file_image =
    Eigen::Translation3d(10, 1, 2) * Isometry3d(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()));

/// Two stations at x = 0 and 10 with a point each, and pictures.
std::string survey(const std::vector<e57::Image>& images)
{
  const auto scan = [](const std::string& name, double x) {
    e57::Scan out{name, {}, 1, e57::poseXml(Isometry3d(Eigen::Translation3d(x, 0, 0)))};
    for (const char* field : {"cartesianX", "cartesianY", "cartesianZ"}) {
      out.fields.push_back({field});
      out.fields.back().reals = {1.0};
    }
    return out;
  };
  const std::string path = test::scratchFolder() + "/survey.e57";
  writeFile(path, e57::fileOf({scan("a", 0), scan("b", 10)}, images));
  return path;
}

/// Pixel of `taken` that shows a direction of the picture's own frame (see ScanImage).
const std::uint8_t* shown(const ScanPicture& picture, const CameraPicture& taken, const Vector3d& in_image)
{
  const Isometry3d T_file_scan(Eigen::Translation3d(picture.scan == 1 ? 10 : 0, 0, 0));
  const Eigen::Vector2d at =
      project(taken.camera, picture.T_camera_scan * (T_file_scan.inverse() * (T_file_image * in_image)));
  return taken.image.pixel(int(at.x()), int(at.y()));
}

Vector3d towards(double longitude, double latitude) // to the left, upwards
{
  return {std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude), std::sin(latitude)};
}

TEST(ScanPictures, ShowWhereTheirFileSaysThatTheyLook)
{
  const double focal = 0.02, pixel = 0.0005, angle = 2 * pi / 200;
  const std::string pose = e57::poseXml(T_file_image);
  e57::Image pinhole =
      stored("pinhole", numbered(60, 40),
             element("focalLength", focal) + element("pixelWidth", pixel) + element("pixelHeight", pixel) +
                 element("principalPointX", 30.0) + element("principalPointY", 20.0));
  e57::Image whole =
      stored("spherical", numbered(200, 100), element("pixelWidth", angle) + element("pixelHeight", angle));
  e57::Image part =
      stored("spherical", numbered(100, 50), element("pixelWidth", angle) + element("pixelHeight", angle));
  e57::Image cylinder = stored("cylindrical", numbered(200, 60),
                               element("pixelWidth", angle) + element("pixelHeight", 0.05) + element("radius", 2.0) +
                                   element("principalPointY", 25.0));
  pinhole.more = whole.more = part.more = cylinder.more = pose;
  whole.more += "<associatedData3DGuid type=\"String\">guid of a</associatedData3DGuid>";
  const ModelInput input = readModelInput(survey({pinhole, whole, part, cylinder}));
  EXPECT_EQ(describe(input), "2 scans, 3 panoramas, 1 photograph");
  const auto& pictures = input.inside.pictures;
  ASSERT_EQ(pictures.size(), 4u);
  EXPECT_EQ(pictures[0].scan, 1) << "the nearest, where the file names none";
  EXPECT_EQ(pictures[1].scan, 0);
  const CameraPicture photograph = readPicture(pictures[0]);
  const std::uint8_t* color = shown(pictures[0], photograph, Vector3d(0.1125, 0.1875, -1));
  EXPECT_EQ(color[0], 30 + 4);
  EXPECT_EQ(color[1], 20 - 8);
  const double left = 0.5 * angle + 0.3, up = 0.2;
  for (int k : {1, 2, 3}) {
    const CameraPicture taken = readPicture(pictures[k]);
    ASSERT_EQ(taken.camera.projection, CameraProjection::spherical);
    EXPECT_EQ(taken.as_stored, k == 1);
    const std::uint8_t* seen = shown(pictures[k], taken, towards(left, up));
    EXPECT_NEAR(seen[0], (k == 2 ? 50 : 100) - left / angle, 1.5) << k;
    EXPECT_NEAR(seen[1], k == 3 ? 25 - 2 * std::tan(up) / 0.05 : (k == 2 ? 25 : 50) - up / angle, 1.5) << k;
    EXPECT_EQ(taken.mask.empty(), k == 1);
    if (k > 1) { // what they do not show is not known
      EXPECT_EQ(*taken.mask.pixel(taken.image.width / 2, 0), 0);
      EXPECT_EQ(*taken.mask.pixel(taken.image.width / 2, taken.image.height / 2), 255);
      EXPECT_EQ(*taken.mask.pixel(2, taken.image.height / 2), k == 2 ? 0 : 255);
    }
  }
}

TEST(ScanPictures, OfNoUseAreNamedAndDamagedOnesRefused)
{
  const e57::Image lost = stored("spherical", numbered(20, 10), "");
  e57::Image oblong = stored("spherical", numbered(20, 11), ""), broken = lost, wide = lost, masked = lost;
  oblong.more = broken.more = wide.more = masked.more = e57::poseXml(T_file_image);
  broken.picture.resize(40);
  wide.representation = stored("spherical", numbered(20, 10), element("pixelWidth", 1.0)).representation;
  masked.representation = stored("spherical", numbered(20, 10), "<imageMask type=\"Blob\" MASK/>").representation;
  masked.mask = png(Image(20, 11, 1, 255));
  const ModelInput input = readModelInput(survey({lost, oblong, broken, wide, masked}));
  ASSERT_EQ(input.inside.pictures.size(), 4u);
  ASSERT_EQ(input.inside.warnings.size(), 1u);
  EXPECT_NE(input.inside.warnings[0].find("1 of 5 pictures"), std::string::npos);
  const char* reasons[] = {"picture 2: covers 0 radians", "picture 3: the image is damaged",
                           "picture 4: covers 20 radians", "picture 5: its mask is 20x11"};
  for (int k = 0; k < 4; ++k)
    try {
      readPicture(input.inside.pictures[k]);
      FAIL() << reasons[k];
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(reasons[k]), std::string::npos) << error.what();
    }
  EXPECT_THROW(checkPhotographs(input, 2), std::runtime_error);
}
} // namespace
} // namespace fresco::model
