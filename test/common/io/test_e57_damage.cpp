// SPDX-License-Identifier: BSD-3-Clause
#include "common/io/e57_file.h"
#include "common/io/test_io_data.h"
#include "io/points/e57/paged_file.h"
#include <fresco/io/point_io.h>
#include <fresco/io/reading.h>
#include <fresco/io/scan_file.h>
#include <fresco/io/scan_images.h>
namespace {
using namespace fresco;

std::string smallFile()
{
  test::e57::Scan scan{"small", {}, 100};
  for (const char* name : {"cartesianX", "cartesianY", "cartesianZ"}) {
    test::e57::Field field{name, "ScaledInteger"};
    field.minimum = -5000;
    field.maximum = 5000;
    field.scale = 0.001;
    for (std::int64_t i = 0; i < 100; ++i)
      field.stored.push_back(i * 37 % 10001 - 5000);
    scan.fields.push_back(field);
  }
  return test::e57::fileOf({scan});
}

/// The error of reading, or what is remarked on.
std::string errorOf(const std::string& content)
{
  const std::string path = test::scratchFolder() + "/a.e57";
  test::writeText(path, content);
  std::string remarks;
  listenToReaders([&](const std::string& line) { remarks = line; });
  std::string error = test::errorOf([&] { readPoints(path); });
  listenToReaders({});
  if (error.empty())
    error = remarks;
  EXPECT_TRUE(error.empty() || error.find(path + ": ") == 0) << error;
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  return error;
}

bool says(const std::string& error, const std::string& words) { return error.find(words) != std::string::npos; }

TEST(E57Damage, ChecksumIsThatOfTheStandard)
{
  EXPECT_EQ(io::e57::crc32c("123456789", 9), 0xE3069283U); // RFC 3720
  std::mt19937 random(5);
  for (std::size_t size = 0; size < 70; ++size) {
    std::string bytes(size, '\0');
    for (char& c : bytes)
      c = static_cast<char>(random());
    EXPECT_EQ(io::e57::crc32c(bytes.data(), size), test::e57::checksum(bytes));
  }
}

TEST(E57Damage, NoByteCanBeChangedUnseen)
{
  const std::string good = smallFile();
  ASSERT_EQ(errorOf(good), "");
  for (std::size_t at = 0; at < good.size(); at += at < 64 ? 1 : 13) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 4);
    EXPECT_NE(errorOf(bad), "") << "byte " << at;
  }
}

TEST(E57Damage, NoEndCanBeMissing)
{
  const std::string good = smallFile();
  for (std::size_t size = 1; size < good.size(); size += 97)
    EXPECT_NE(errorOf(good.substr(0, size)), "") << size;
}

TEST(E57Damage, BrokenPageIsNamed)
{
  std::string bad = smallFile();
  bad[1500] = static_cast<char>(bad[1500] ^ 1);
  EXPECT_TRUE(says(errorOf(bad), "wrong checksum of page 2 of 2")) << errorOf(bad);
}

TEST(E57Damage, WhatTheXmlAsksForMustBeThere)
{
  const std::string good = smallFile();
  const auto error = [&](const std::string& what, const std::string& by) {
    const std::string bad = test::e57::edited(good, what, by);
    EXPECT_FALSE(bad.empty()) << what;
    return errorOf(bad);
  };
  // 65 bits: -5000 .. 2^64 - 1.
  const std::string wide = error("minimum=\"-5000\" maximum=\"5000\" scale=\"0.001\" offset=\"0\"",
                                 "minimum=\"-1\" maximum=\"18446744073709551615\"");
  EXPECT_TRUE(says(wide, "scan 1") && says(wide, "64 bits")) << wide;
  EXPECT_TRUE(says(error("fileOffset=\"48\"", "fileOffset=\"70\""), "no compressed vector"));
  EXPECT_TRUE(says(error("recordCount=\"100\"", "recordCount=\"101\""), "end early"));
  EXPECT_TRUE(says(error("recordCount=\"100\"", "recordCount=\"9e9\""), "whole number"));
  EXPECT_TRUE(says(error("cartesianX type=\"ScaledInteger\"", "cartesianX type=\"ScaledInteges\""), "is not known"));
  EXPECT_TRUE(says(error("<cartesianZ ", "<cartesianW "), "no field cartesianZ"));
  EXPECT_TRUE(says(error("minimum=\"-5000\"", "minimum=\"95000\""), "below minimum"));
  EXPECT_TRUE(says(error("</e57Root>", "</e57Roof>"), "XML"));
}

TEST(E57Damage, PointsMustFitAnXmlThatIsDamaged)
{
  const auto error = [](const std::string& what, const std::string& by) { // with the checksum as it was
    std::string bytes = smallFile();
    const std::size_t at = bytes.find(what);
    if (at == std::string::npos)
      return "no " + what;
    return errorOf(bytes.replace(at, by.size(), by));
  };
  EXPECT_TRUE(says(error("Vector\"></codecs", "Vectos\"></codecs"), "may be wrong")); // and read
  EXPECT_TRUE(says(error("recordCount=\"100\"", "recordCount=\"050\""), "than its 50 records"));
  EXPECT_TRUE(says(error("maximum=\"5000\"", "maximum=\"0000\""), "than its 100 records"));
}

TEST(E57Damage, SectionsEndWithTheFile)
{
  const std::string good = smallFile();
  using test::e57::raw;
  std::string logical;
  for (std::size_t at = 0; at < good.size(); at += 1024)
    logical += good.substr(at, 1020);
  const std::string length = logical.substr(48 + 8, 8);
  logical.replace(48 + 8, 8, raw(std::uint64_t{1} << 40));
  EXPECT_TRUE(says(errorOf(test::e57::File::withChecksums(logical)), "truncated: the section at offset 48"));
  logical.replace(48 + 8, 8, length);
  logical.replace(48 + 16, 8, raw(std::uint64_t{1} << 40)); // where its packets begin
  EXPECT_TRUE(says(errorOf(test::e57::File::withChecksums(logical)), "beyond the end of the file"));
}

TEST(E57Damage, PointsWithoutBitsAreNotTakenAtTheirWord)
{
  test::e57::Scan scan{"constant", {}, 1000000000};
  for (const char* name : {"cartesianX", "cartesianY", "cartesianZ"})
    scan.fields.push_back({name, "Integer"}); // 0..0: no bits are stored
  EXPECT_TRUE(says(errorOf(test::e57::fileOf({scan})), "do not fit")) << errorOf(test::e57::fileOf({scan}));
}

TEST(E57Damage, ManyFieldsWithoutBitsAreNotTakenAtTheirWord)
{
  test::e57::Scan scan{"constant", {}, 2000000};
  for (const char* name : {"cartesianX", "cartesianY", "cartesianZ"}) {
    test::e57::Field field{name, "Integer"};
    field.maximum = name[9] == 'X' ? 1 : 0;
    if (name[9] == 'X')
      field.stored.assign(scan.count, 1); // one bit a record is stored
    scan.fields.push_back(field);
  }
  for (int i = 0; i < 400; ++i)
    scan.fields.push_back({"constant_" + std::to_string(i), "ScaledInteger"});
  EXPECT_TRUE(says(errorOf(test::e57::fileOf({scan})), "do not fit"));
}

TEST(E57Damage, FilesOfOtherWritersAreReadOrRefused)
{
  FRESCO_NEED_DATA("e57");
  const std::string folder = test::dataFolder() + "/e57/";
  const auto error = [&](const std::string& name) { return test::errorOf([&] { readPoints(folder + name); }); };
  EXPECT_FALSE(error("self_bad-crc.e57").empty());
  for (const char* name :
       {"self_ZeroPoints.e57", "self_ZeroPointsInvalid.e57", "self_InvalidCVHeader.e57", "self_empty.e57"})
    EXPECT_TRUE(says(error(name), "no points")) << error(name);
  const PointSet doubles = readPoints(folder + "reference_bunnyDouble.e57");
  const PointSet integers = readPoints(folder + "reference_bunnyInt32.e57");
  ASSERT_EQ(doubles.size(), 30571);
  EXPECT_LT((doubles.points - integers.points).cwiseAbs().maxCoeff(), 1e-6f); // of which the integers are multiples
  const PointSet cube = readPoints(folder + "self_ColouredCubeFloat.e57");
  EXPECT_TRUE(test::sameValues(cube.colors, readPoints(folder + "self_ColouredCubeDouble.e57").colors));
  EXPECT_EQ(readPoints(folder + "3rdParty_las2e57_ColourRepresentation.e57").colors.maxCoeff(), 255);
  EXPECT_TRUE(readPoints(folder + "pye57_testWithNormals.e57").hasNormals());
  const CloudFile pump = readCloud(folder + "pye57_pumpAVisualReferenceImage.e57");
  EXPECT_EQ(pump.cloud.width, 345u);
  EXPECT_EQ(pump.cloud.height, 1074u);
  const std::string picture = readScanImageBytes(folder + "pye57_pumpAVisualReferenceImage.e57", 0);
  EXPECT_EQ(picture.substr(0, 3), "\xFF\xD8\xFF"); // a JPEG
  const PointSet moved = readPoints(folder + "pye57_translationWithoutRotation.e57");
  EXPECT_EQ(moved.points.col(0), Eigen::Vector3f(4, 5, 6));
}
} // namespace
