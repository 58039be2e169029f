// SPDX-License-Identifier: BSD-3-Clause
#include "common/io/e57_file.h"
#include "common/io/test_io_data.h"
#include "io/points/point_formats.h"
#include <fresco/core/constants.h>
#include <fresco/io/point_io.h>
#include <fresco/io/scan_images.h>
namespace {
using namespace fresco;
using test::e57::Field;
using test::e57::Scan;

std::vector<double> randomReals(std::size_t count, unsigned seed)
{
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(-20, 20);
  std::vector<double> values(count);
  std::generate(values.begin(), values.end(), [&] { return uniform(generator); });
  return values;
}

std::vector<Field> cartesian(std::size_t count, bool single = false)
{
  std::vector<Field> fields;
  for (const char* name : {"cartesianX", "cartesianY", "cartesianZ"}) {
    Field field{name};
    field.single = single;
    field.reals = randomReals(count, 10 + static_cast<unsigned>(fields.size()));
    if (single)
      for (double& value : field.reals)
        value = static_cast<float>(value);
    fields.push_back(field);
  }
  return fields;
}

Field whole(const std::string& name, std::int64_t minimum, std::int64_t maximum, std::vector<std::int64_t> stored)
{
  Field field{name, "Integer"};
  field.minimum = minimum;
  field.maximum = maximum;
  field.stored = std::move(stored);
  return field;
}

std::string stored(const std::string& bytes) { return test::stored("scan.e57", bytes); }

/// All rows of a scan as the reader gives them, `window` at a time.
io::PointTable rowsOf(const std::string& path, Index window, Index scan = 0)
{
  const auto reader = io::openE57({path});
  io::PointTable all = reader->open(scan);
  all.allocate(reader->scans()[scan].points);
  Index done = 0;
  while (const Index more = reader->read(all, done, std::min(all.rows, done + window)))
    done += more;
  EXPECT_EQ(done, all.rows);
  return all;
}

template <typename T>
std::vector<T> valuesOf(const io::PointTable& table, const std::string& name)
{
  std::vector<T> values(table.rows);
  const io::Column* column = table.find(name);
  EXPECT_NE(column, nullptr) << name;
  if (column)
    io::forEachValue(table, *column, 0, [&](Index row, auto value) { values[row] = static_cast<T>(value); });
  return values;
}

TEST(E57, IntegersOfEveryWidthAreReadAsWritten)
{
  constexpr std::size_t count = 300;
  std::mt19937_64 random(3);
  for (int bits = 0; bits <= 64; ++bits)
    for (const std::int64_t minimum : {std::int64_t{0}, std::int64_t{-3}, std::numeric_limits<std::int64_t>::min()}) {
      const std::uint64_t range = bits == 0 ? 0 : ~std::uint64_t{0} >> (64 - bits);
      const auto maximum = static_cast<std::int64_t>(static_cast<std::uint64_t>(minimum) + range);
      if (maximum < minimum)
        continue; // beyond 64 bits with a sign
      Field field = whole("value", minimum, maximum, {});
      for (std::size_t i = 0; i < count; ++i)
        field.stored.push_back(static_cast<std::int64_t>(static_cast<std::uint64_t>(minimum) + (random() & range)));
      field.stored[0] = minimum;
      field.stored[1] = maximum;
      Scan scan{"widths", cartesian(count), count};
      scan.fields.push_back(field);
      const std::string path = stored(test::e57::fileOf({scan}));
      for (const Index window : {Index{7}, Index{1000}})
        EXPECT_EQ(valuesOf<std::int64_t>(rowsOf(path, window), "value"), field.stored) << bits << " bits, " << minimum;
    }
}

TEST(E57, FloatsAndScaledIntegersAreReadAsWritten)
{
  constexpr std::size_t count = 2000;
  for (const bool single : {false, true}) {
    const Scan scan{"floats", cartesian(count, single), count};
    const io::PointTable rows = rowsOf(stored(test::e57::fileOf({scan})), 333);
    EXPECT_EQ(rows.columns[0].type, single ? io::Scalar::float32 : io::Scalar::float64);
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_EQ(valuesOf<double>(rows, io::xyz_names[axis]), scan.fields[axis].reals);
  }
  Scan scan{"scaled", cartesian(count), count};
  Field& x = scan.fields[0];
  x = whole("cartesianX", -8000000, 8000000, {});
  x.type = "ScaledInteger";
  x.scale = 1e-4;
  x.offset = 431234.5;
  std::vector<double> expected;
  for (std::size_t i = 0; i < count; ++i) {
    x.stored.push_back(static_cast<std::int64_t>(i * 7919 % 16000001) - 8000000);
    expected.push_back(static_cast<double>(x.stored.back()) * x.scale + x.offset);
  }
  EXPECT_EQ(valuesOf<double>(rowsOf(stored(test::e57::fileOf({scan})), 333), "x"), expected);
}

TEST(E57, EveryFieldOfAPointIsKept)
{
  constexpr std::size_t count = 4;
  Scan scan{"fields", cartesian(count), count};
  scan.more = "<colorLimits type=\"Structure\"><colorRedMinimum type=\"Integer\"/><colorRedMaximum "
              "type=\"Integer\">65535</colorRedMaximum></colorLimits><intensityLimits type=\"Structure\">"
              "<intensityMinimum type=\"Float\">-1</intensityMinimum><intensityMaximum type=\"Float\">3"
              "</intensityMaximum></intensityLimits>";
  scan.fields.push_back(whole("cartesianInvalidState", 0, 2, {0, 1, 2, 0}));
  scan.fields.push_back(whole("colorRed", 0, 65535, {0, 65535, 256, 511}));
  scan.fields.push_back(whole("colorGreen", 0, 255, {0, 1, 128, 255}));
  Field blue{"colorBlue"};
  blue.reals = {0, 0.5, 1, std::numeric_limits<double>::quiet_NaN()};
  scan.fields.push_back(blue);
  Field intensity{"intensity"};
  intensity.reals = {-1, 0, 1, 3};
  scan.fields.push_back(intensity);
  scan.fields.push_back(whole("isIntensityInvalid", 0, 1, {0, 0, 1, 0}));
  scan.fields.push_back(whole("returnIndex", 0, 3, {0, 1, 2, 3}));
  Field label{"label", "String"};
  label.texts = {"", std::string(200, 'a'), "b", "c"};
  scan.fields.insert(scan.fields.begin(), label);
  for (const char* name : {"nor:normalX", "nor:normalY", "nor:normalZ"}) {
    Field normal{name};
    normal.reals = {1, 0, 0.5, -1};
    scan.fields.push_back(normal);
  }
  const std::string path = stored(test::e57::fileOf({scan}));
  const io::PointTable rows = rowsOf(path, 100);
  EXPECT_EQ(valuesOf<int>(rows, "red"), (std::vector<int>{0, 255, 1, 1}));
  EXPECT_EQ(valuesOf<int>(rows, "green"), (std::vector<int>{0, 1, 128, 255}));
  EXPECT_EQ(valuesOf<int>(rows, "blue"), (std::vector<int>{0, 128, 255, 0}));
  EXPECT_EQ(valuesOf<int>(rows, "returnIndex"), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(valuesOf<float>(rows, "normal_y"), (std::vector<float>{1, 0, 0.5, -1}));
  const PointSet points = readPoints(path);
  EXPECT_TRUE(points.points.col(0).allFinite() && points.points.col(3).allFinite());
  EXPECT_TRUE(points.points.col(1).array().isNaN().all() && points.points.col(2).array().isNaN().all());
  EXPECT_EQ(points.intensities[1], 0.f);
  EXPECT_TRUE(std::isnan(points.intensities[2]));
  const ScanInfo info = readScanInfos(path)[0];
  EXPECT_EQ(info.name, "fields");
  EXPECT_EQ((*info.intensity_limits)[0], -1);
  EXPECT_EQ((*info.intensity_limits)[1], 3);
  EXPECT_FALSE(info.has_pose || info.sensor);
}

TEST(E57, FieldsWithNamesOfOursAreNotTakenForThem)
{
  Scan scan{"names", cartesian(3), 3, test::e57::poseXml(1, 0, 5, 0, 0)};
  for (const char* name : {"vp_x", "vp_y", "vp_z", "rgb", "row", "x", "normal_x", "normal_y", "normal_z"})
    scan.fields.push_back(whole(name, 0, 1, {0, 1, 0}));
  const std::string path = stored(test::e57::fileOf({scan, scan}));
  const PointSet points = readPoints(path);
  EXPECT_EQ(points.size(), 6);
  EXPECT_EQ(points.colors.cols() + points.normals.cols(), 0);
  EXPECT_EQ(points.viewpoints.col(4), Eigen::Vector3f(5, 0, 0));
  EXPECT_EQ(valuesOf<int>(rowsOf(path, 3), "e57_vp_x"), (std::vector<int>{0, 1, 0}));
}

TEST(E57, SphericalPointsLieWhereTheirAnglesSay)
{
  constexpr std::size_t count = 500;
  Scan scan{"spherical", cartesian(count), count};
  const std::vector<Field> truth = scan.fields;
  Field &range = scan.fields[0], &azimuth = scan.fields[1], &elevation = scan.fields[2];
  range.name = "sphericalRange", azimuth.name = "sphericalAzimuth", elevation.name = "sphericalElevation";
  for (std::size_t i = 0; i < count; ++i) {
    const double x = truth[0].reals[i], y = truth[1].reals[i], z = truth[2].reals[i];
    range.reals[i] = std::sqrt(x * x + y * y + z * z);
    azimuth.reals[i] = std::atan2(y, x);
    elevation.reals[i] = std::asin(z / range.reals[i]);
  }
  const std::string path = stored(test::e57::fileOf({scan}));
  const io::PointTable rows = rowsOf(path, 64);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::vector<double> values = valuesOf<double>(rows, io::xyz_names[axis]);
    for (std::size_t i = 0; i < count; ++i)
      EXPECT_NEAR(values[i], truth[axis].reals[i], 1e-12);
  }
  EXPECT_TRUE(readScanInfos(path)[0].sensor.has_value()); // angles are seen from somewhere
}

TEST(E57, RowsAndColumnsMakeAnOrganisedCloud)
{
  constexpr std::int64_t width = 5, height = 4;
  Scan scan{"organised", {}, 0};
  std::vector<std::int64_t> rows, columns;
  for (std::int64_t column = 0; column < width; ++column) // as scanners turn: column by column
    for (std::int64_t row = 0; row < height; ++row)
      if (row != 2 || column != 3) {
        rows.push_back(row + 10);
        columns.push_back(column);
      }
  scan.count = rows.size();
  scan.fields = cartesian(scan.count);
  scan.fields[0].reals.assign(columns.begin(), columns.end());
  scan.fields[1].reals.assign(rows.begin(), rows.end());
  scan.fields.push_back(whole("rowIndex", 0, 100, rows));
  scan.fields.push_back(whole("columnIndex", 0, 100, columns));
  const std::string path = stored(test::e57::fileOf({scan}));
  const CloudFile cloud = readCloud(path);
  EXPECT_EQ(cloud.cloud.width, 5u);
  EXPECT_EQ(cloud.cloud.height, 4u);
  const PointSet points = readPoints(path);
  for (Index i = 0; i < points.size(); ++i)
    if (i == 2 * width + 3)
      EXPECT_TRUE(points.points.col(i).array().isNaN().all());
    else
      EXPECT_EQ(points.points.col(i).head<2>(), Eigen::Vector2f(float(i % width), float(i / width + 10)));
  scan.fields[4].stored[1] = scan.fields[4].stored[0] = 0; // two returns of one beam
  scan.fields[3].stored[1] = scan.fields[3].stored[0];
  const CloudFile list = readCloud(stored(test::e57::fileOf({scan})));
  EXPECT_EQ(list.cloud.height, 1u);
  EXPECT_EQ(list.cloud.width, scan.count);
}

TEST(E57, PicturesAreTheBytesThatWereStored)
{
  const std::string picture(3000, 'p'), mask(70, 'm');
  const std::string sizes = "<imageWidth type=\"Integer\">640</imageWidth><imageHeight type=\"Integer\">480"
                            "</imageHeight>";
  test::e57::Image pinhole{"<pinholeRepresentation type=\"Structure\"><pngImage type=\"Blob\" PICTURE/><imageMask "
                           "type=\"Blob\" MASK/>" +
                               sizes +
                               "<focalLength type=\"Float\">0.01</focalLength><pixelWidth type=\"Float\">0.00002"
                               "</pixelWidth><pixelHeight type=\"Float\">0.00001</pixelHeight><principalPointX "
                               "type=\"Float\">320</principalPointX><principalPointY type=\"Float\">240"
                               "</principalPointY></pinholeRepresentation>",
                           picture, mask};
  pinhole.more = test::e57::poseXml(std::sqrt(0.5), std::sqrt(0.5), 1, 2, 3) +
                 "<associatedData3DGuid type=\"String\">guid of a</associatedData3DGuid>";
  const test::e57::Image spherical{"<sphericalRepresentation type=\"Structure\"><jpegImage type=\"Blob\" PICTURE/>" +
                                       sizes + "</sphericalRepresentation>",
                                   "jpeg", ""};
  const std::string path = stored(test::e57::fileOf({Scan{"a", cartesian(3), 3}}, {pinhole, spherical}));
  const std::vector<ScanImage> images = readScanImages(path);
  ASSERT_EQ(images.size(), 2u);
  EXPECT_EQ(images[0].projection, ScanImage::Projection::pinhole);
  EXPECT_EQ(images[0].encoding, ScanImage::Encoding::png);
  EXPECT_EQ(images[0].scan, 0);
  EXPECT_EQ(readScanImageBytes(path, 0), picture);
  EXPECT_EQ(readScanImageMask(path, 0), mask);
  EXPECT_EQ(images[1].projection, ScanImage::Projection::spherical);
  EXPECT_EQ(images[1].scan, -1);
  EXPECT_FALSE(images[1].has_mask || images[1].T_file_image);
  EXPECT_EQ(readScanImageBytes(path, 1), "jpeg");
  EXPECT_THROW(readScanImageMask(path, 1), std::runtime_error);
  EXPECT_THROW(readScanImageBytes(path, 2), std::runtime_error);
  EXPECT_THROW(cameraOf(images[1]), std::invalid_argument);
  // The picture looks along its -z; what lies to its right (+x) and up (+y) is right of the middle and above it.
  const auto [camera, T_camera_file] = cameraOf(images[0]);
  const Eigen::Vector3d seen = *images[0].T_file_image * Eigen::Vector3d(0.1, 0.2, -2);
  const Eigen::Vector2d pixel = project(camera, T_camera_file * seen);
  EXPECT_NEAR(pixel.x(), 320 + 0.1 / 2 * 0.01 / 0.00002, 1e-9);
  EXPECT_NEAR(pixel.y(), 240 - 0.2 / 2 * 0.01 / 0.00001, 1e-9);
}
} // namespace
