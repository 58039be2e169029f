// SPDX-License-Identifier: BSD-3-Clause
#include "common/io/e57_file.h"
#include "common/io/las_writer.h"
#include "common/io/test_io_data.h"
#include <filesystem>
#include <fresco/io/point_io.h>
#include <fresco/io/reading.h>
#include <fresco/io/scan_file.h>
#include <fresco/io/scan_writer.h>
#include <fstream>
#include <sstream>
namespace {
using namespace fresco;
using test::stored;
using test::e57::exact;

Eigen::Isometry3d somePose(double angle, const Eigen::Vector3d& place)
{
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = place;
  return T;
}

/// A station with what its scanner saw, in its own frame.
struct Station {
  Eigen::Isometry3d T_file_scan;
  Points points; ///< columns beams, `rows` to a column of the scan
  Index rows = 1;
};

/// Two stations that saw random points, in the middle of Europe in metres.
std::vector<Station> farStations()
{
  std::vector<Station> stations;
  for (unsigned i = 0; i < 2; ++i)
    stations.push_back(
        {somePose(0.7 + i, {431000.25 + 3 * i, 5410000.5, 512.125}), test::randomPoints(12, 5 + i, 9.f), 4});
  return stations;
}

std::string headerOf(const Station& station, Index columns)
{
  std::ostringstream text;
  text.precision(17);
  const Eigen::Matrix4d T = station.T_file_scan.matrix();
  text << columns << "\n" << station.rows << "\n";
  for (int column : {3, 0, 1, 2})
    text << T.col(column).head<3>().transpose() << "\n";
  text << T.transpose() << "\n";
  return text.str();
}

std::string ptxOf(const std::vector<Station>& stations, const std::string& line_end = "\n")
{
  std::ostringstream text;
  text.precision(9);
  for (const Station& station : stations) {
    text << headerOf(station, station.points.cols() / station.rows);
    for (Index i = 0; i < station.points.cols(); ++i)
      text << station.points.col(i).transpose() << " " << 0.01 * static_cast<double>(i) << " " << i << " 20 255\n";
  }
  return test::e57::replaced(text.str(), "\n", line_end);
}

std::string e57Of(const std::vector<Station>& stations)
{
  std::vector<test::e57::Scan> scans;
  for (const Station& station : stations) {
    test::e57::Scan scan{
        "station " + std::to_string(scans.size() + 1), {}, static_cast<std::size_t>(station.points.cols())};
    for (int axis = 0; axis < 3; ++axis) {
      test::e57::Field field{std::string("cartesian") + "XYZ"[axis]};
      field.single = true;
      for (Index i = 0; i < station.points.cols(); ++i)
        field.reals.push_back(station.points(axis, i));
      scan.fields.push_back(field);
    }
    const Eigen::Quaterniond q(station.T_file_scan.linear());
    const Eigen::Vector3d t = station.T_file_scan.translation();
    scan.more = test::e57::poseXml(q.w(), q.z(), t.x(), t.y(), t.z());
    scans.push_back(scan);
  }
  return test::e57::fileOf(scans);
}

/// Points of all stations in the frame of the file, metres.
Eigen::Matrix3Xd worldOf(const std::vector<Station>& stations)
{
  Eigen::Matrix3Xd all(3, 0);
  for (const Station& station : stations) {
    const Index before = all.cols();
    all.conservativeResize(3, before + station.points.cols());
    all.rightCols(station.points.cols()) = station.T_file_scan * station.points.cast<double>();
  }
  return all;
}

TEST(ScanFiles, StationsAreScansWithPosesAndTogetherOneCloud)
{
  const std::vector<Station> stations = farStations();
  for (const auto& [name, content] : {std::pair<std::string, std::string>{"a.ptx", ptxOf(stations)},
                                      {"b.ptx", ptxOf(stations, "\r\n")},
                                      {"a.e57", e57Of(stations)}}) {
    const std::string path = stored(name, content);
    SCOPED_TRACE(path);
    const std::vector<ScanPath> scans = scansOf({path});
    ASSERT_EQ(scans.size(), 2u);
    EXPECT_EQ(scans[1].name(), path + " scan 2");
    const std::vector<Pose> poses = posesOf(scans);
    for (std::size_t s = 0; s < 2; ++s) {
      EXPECT_LT((*poses[s] - stations[s].T_file_scan.matrix()).cwiseAbs().maxCoeff(), 1e-9);
      const PointSet own = readPoints(scans[s]);
      EXPECT_TRUE(own.origin.isZero(0));
      EXPECT_LT((own.viewpoints.col(0)).norm(), 1e-6f);
      EXPECT_EQ(own.size(), 12);
    }
    EXPECT_EQ(readCloud(scans[0]).cloud.height, extension(path) == ".ptx" ? 4u : 1u);
    const PointSet whole = readPoints(path);
    const Eigen::Matrix3Xd world = worldOf(stations);
    ASSERT_EQ(whole.size(), world.cols());
    const Eigen::Matrix3Xd read = whole.points.cast<double>().colwise() + whole.origin;
    EXPECT_LT((read - world).colwise().norm().maxCoeff(), 1e-5); // a float 10 m from the origin resolves a micrometre
    ASSERT_EQ(whole.viewpoints.cols(), 24);
    const Eigen::Vector3d eye = whole.origin + whole.viewpoints.col(20).cast<double>();
    EXPECT_LT((eye - stations[1].T_file_scan.translation()).norm(), 1e-5);
    EXPECT_THROW(readPoints(ScanPath{path, 2}), std::runtime_error);
  }
}

/// Points in the order of the file, from windows of 5.
Points streamed(const ScanPath& scan)
{
  Points all(3, 0);
  streamPoints(scan, 5, [&](const PointSet& window) {
    EXPECT_LE(window.size(), 5);
    const Index before = all.cols();
    all.conservativeResize(3, before + window.size());
    all.rightCols(window.size()) = window.points;
    return true;
  });
  return all;
}

TEST(ScanFiles, WindowsTogetherAreTheScan)
{
  for (const auto& [name, content] :
       {std::pair<std::string, std::string>{"a.ptx", ptxOf(farStations())}, {"a.e57", e57Of(farStations())}}) {
    const std::string path = stored(name, content);
    for (const Index station : {0, 1}) // the first does not read on into the second
      EXPECT_TRUE(test::sameValues(streamed({path, station}), farStations()[station].points)) << name << ' ' << station;
    int calls = 0;
    streamPoints(ScanPath{path, 1}, 5, [&](const PointSet&) { return ++calls < 2; });
    EXPECT_EQ(calls, 2);
    EXPECT_THROW(streamPoints(ScanPath{path, 1}, 0, [](const PointSet&) { return true; }), std::invalid_argument);
  }
}

TEST(ScanFiles, FilesOfOneCloudAreOneScan)
{
  const std::string path = stored("a.xyz", "1 2 3\n4 5 6\n");
  EXPECT_FALSE(holdsScans(path));
  ASSERT_EQ(scansOf({path}).size(), 1u);
  EXPECT_EQ(readPoints(scansOf({path})[0]).size(), 2);
  EXPECT_FALSE(posesOf(scansOf({path}))[0]);
  EXPECT_NE(test::errorOf([&] { readPoints(ScanPath{path, 0}); }).find(path + ": holds one cloud"), std::string::npos);
}

TEST(ScanFiles, AStationWithoutPointsKeepsItsPlace)
{
  std::vector<Station> stations = farStations();
  stations[0].points.resize(3, 0);
  for (const auto& [name, content] :
       {std::pair<std::string, std::string>{"a.ptx", ptxOf(stations)}, {"a.e57", e57Of(stations)}}) {
    const std::string path = stored(name, content);
    ASSERT_EQ(scansOf({path}).size(), 2u) << name;
    EXPECT_EQ(readPoints(ScanPath{path, 0}).size(), 0) << name;
    EXPECT_EQ(readPoints(ScanPath{path, 1}).size(), 12) << name;
    EXPECT_EQ(readPoints(path).size(), 12) << name;
  }
  stations.pop_back();
  EXPECT_NE(test::errorOf([&] { readPoints(stored("b.e57", e57Of(stations))); }).find("no points"), std::string::npos);
}

/// Bytes that this process has read from files; nothing where the system does not count them.
std::optional<double> bytesRead()
{
  std::ifstream counts("/proc/self/io");
  std::string name;
  double bytes = 0;
  return counts >> name >> bytes ? std::optional(bytes) : std::nullopt;
}

TEST(Ptx, AllStationsTogetherCostTwoPasses)
{
  if (!bytesRead())
    GTEST_SKIP() << "no /proc/self/io";
  const Station station{somePose(0, {0, 0, 0}), test::randomPoints(500, 5, 9.f), 20};
  const std::string path = stored("a.ptx", ptxOf(std::vector<Station>(24, station)));
  const auto size = double(std::filesystem::file_size(path));
  const double before = *bytesRead();
  const std::vector<ScanPath> scans = scansOf({path});
  EXPECT_EQ(posesOf(scans).size(), 24u);
  const double listed = *bytesRead();
  for (const ScanPath& scan : scans)
    EXPECT_EQ(readPoints(scan).size(), 500);
  const double read = *bytesRead();
  for (const ScanPath& scan : scans)
    streamPoints(scan, 100, [](const PointSet&) { return true; });
  const double streamed = *bytesRead();
  for (const double pass : {listed - before, read - listed, streamed - read})
    EXPECT_LT(pass, 1.1 * size);
  EXPECT_EQ(readPlacedClouds(path).size(), 24u);
  EXPECT_LT(*bytesRead() - streamed, 2.2 * size);
}

TEST(Ptx, AFileThatChangedIsSearchedAgain)
{
  const std::vector<Station> stations = farStations();
  const std::string path = stored("a.ptx", ptxOf(stations));
  const std::vector<ScanPath> scans = scansOf({path});
  const auto time = std::filesystem::last_write_time(path);
  const auto second = [&](const std::vector<Station>& now) {
    stored("a.ptx", ptxOf(now));
    std::filesystem::last_write_time(path, time + std::chrono::seconds(1)); // even if it is as long as before
    return streamed(scans[1]);
  };
  EXPECT_TRUE(test::sameValues(second({stations[1], stations[0]}), stations[0].points));
  EXPECT_TRUE(test::sameValues(second({stations[0], stations[0], stations[1]}), stations[0].points));
  EXPECT_THROW(second({stations[0]}), std::runtime_error);
}

TEST(Ptx, DamageIsToldAtEachReading)
{
  const std::vector<Station> stations = farStations();
  const std::string good = ptxOf(stations);
  const std::string path = stored("a.ptx", "1\nx" + good.substr(good.find('\n') + 1) + good);
  std::vector<std::string> told;
  listenToReaders([&](const std::string& line) { told.push_back(line); });
  const std::vector<ScanPath> scans = scansOf({path});
  ASSERT_EQ(scans.size(), 4u);
  for (Index i = 0; i < 2; ++i)
    EXPECT_TRUE(test::sameValues(streamed(scans[2 + i]), stations[i].points));
  listenToReaders({});
  ASSERT_EQ(told.size(), 3u);
  EXPECT_NE(told[0].find("a.ptx: could not be read: station 1: header, line 2"), std::string::npos) << told[0];
  EXPECT_EQ(told[2], told[0]);
}

TEST(Ptx, BeamsWithoutAPointAreNotFinite)
{
  Station station{somePose(0, {0, 0, 0}), Points::Ones(3, 6), 3};
  const std::string path =
      stored("a.ptx", headerOf(station, 2) + "1 0 0 0.5\n0 0 0 0.5\n2 0 0 1\n3 0 0 0\n4 0 0 0\n5 0 0 0\n");
  const CloudFile cloud = readCloud(path);
  EXPECT_EQ(cloud.cloud.width, 2u);
  EXPECT_EQ(cloud.cloud.height, 3u);
  const PointSet points = readPoints(path); // row by row
  EXPECT_EQ(points.points(0, 0), 1.f);
  EXPECT_EQ(points.points(0, 1), 3.f);
  EXPECT_TRUE(std::isnan(points.points(0, 2)));
  EXPECT_EQ(points.intensities[4], 1.f);
}

TEST(Ptx, WrongCountsAndNumbersAreNamed)
{
  const std::vector<Station> stations = farStations();
  const std::string good = ptxOf(stations), header = headerOf(stations[0], 3);
  const auto error = [&](const std::string& content) {
    const std::string path = stored("a.ptx", content);
    return test::errorOf([&] { readPoints(path); });
  };
  const std::string last_line = good.substr(good.rfind('\n', good.size() - 2) + 1);
  const std::string alone = ptxOf({stations[0]});
  EXPECT_NE(error(alone + last_line).find("station 1: 12 points announced, 13 there"), std::string::npos);
  EXPECT_NE(
      error(alone.substr(0, alone.rfind('\n', alone.size() - 2) + 1)).find("station 1: 12 points announced, 11 there"),
      std::string::npos);
  EXPECT_NE(error("1000000\n1000000" + alone.substr(alone.find('\n', 2))).find("points announced"), std::string::npos);
  EXPECT_NE(error(test::e57::replaced(good, " 20 255\n", " 20 twenty\n")).find("line 11"), std::string::npos);
  EXPECT_NE(error(test::e57::replaced(header, exact(stations[0].T_file_scan(0, 0)), "7")).find("no rotation"),
            std::string::npos);
  EXPECT_NE(error("three\n").find("station 1: header, line 1"), std::string::npos);
}

TEST(Pts, BlocksAreReadWithWhatTheirLinesHold)
{
  const std::string path =
      stored("a.pts", "2\n1 2 3 -7 10 20 30\n4 5 6 100 1 2 3\n1\n431000.123 5410000.456 7 8 9 10 11\n");
  ASSERT_EQ(scansOf({path}).size(), 2u);
  const PointSet all = readPoints(path);
  ASSERT_EQ(all.size(), 3);
  EXPECT_EQ(all.intensities[0], -7.f);
  EXPECT_EQ(all.colors.col(1), (Colors(3, 1) << 1, 2, 3).finished());
  const PointSet second = readPoints(ScanPath{path, 1});
  EXPECT_NEAR(second.origin.x() + double(second.points(0, 0)), 431000.123, 1e-6);
  const PointSet plain = readPoints(stored("b.pts", "1 2 3\n4 5 6\n"));
  EXPECT_EQ(plain.size(), 2);
  EXPECT_EQ(plain.intensities.size() + plain.colors.cols(), 0);
  EXPECT_NE(test::errorOf([] {
              readPoints(stored("c.pts", "3\n1.5 2.5 3.5\n4.5 5.5 6.5\n"));
            }).find("3 points announced, 2 there"),
            std::string::npos);
  EXPECT_NE(test::errorOf([] { readPoints(stored("c.pts", "1\n1 2 3 4 5\n")); }).find("or 10 numbers, not 5"),
            std::string::npos);
}

test::las::File someLas(int minor, int format)
{
  test::las::File file;
  file.minor = minor;
  file.format = format;
  file.offset = {431000, 5410000, 0};
  file.extra_bytes = format % 3;
  std::mt19937 random(11);
  for (int i = 0; i < 50; ++i) {
    test::las::Point point;
    for (std::int32_t& stored : point.stored)
      stored = static_cast<std::int32_t>(random() % 2000001) - 1000000;
    point.intensity = static_cast<std::uint16_t>(random());
    point.return_number = 2;
    point.number_of_returns = 3;
    point.classification = 6;
    point.time = 0.125 * i;
    for (std::uint16_t& channel : point.color)
      channel = static_cast<std::uint16_t>(random() | 1024U);
    file.points.push_back(point);
  }
  return file;
}

TEST(Las, EveryVersionAndFormatIsReadAsWritten)
{
  for (int minor = 0; minor <= 4; ++minor)
    for (int format = 0; format <= (minor == 4 ? 10 : minor == 3 ? 5 : minor == 2 ? 3 : 1); ++format) {
      const test::las::File file = someLas(minor, format);
      const std::string path = stored("a.las", test::las::fileOf(file));
      SCOPED_TRACE(path + " 1." + std::to_string(minor) + " format " + std::to_string(format));
      const PointSet points = readPoints(path);
      ASSERT_EQ(points.size(), 50);
      const bool colored = format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
      EXPECT_EQ(points.colors.cols(), colored ? 50 : 0);
      for (Index i = 0; i < 50; ++i) {
        const test::las::Point& truth = file.points[i];
        for (Index axis = 0; axis < 3; ++axis)
          EXPECT_NEAR(points.origin[axis] + double(points.points(axis, i)),
                      truth.stored[axis] * 0.001 + file.offset[axis], 2e-4);
        EXPECT_EQ(points.intensities[i], float(truth.intensity));
        for (Index channel = 0; colored && channel < 3; ++channel)
          EXPECT_EQ(points.colors(channel, i), truth.color[channel] >> 8);
      }
      const CloudFile cloud = readCloud(path);
      const auto has = [&](const std::string& name) {
        return std::any_of(cloud.cloud.fields.begin(), cloud.cloud.fields.end(),
                           [&](const auto& f) { return f.name == name; });
      };
      EXPECT_TRUE(has("classification") && has("return_number"));
      EXPECT_EQ(has("gps_time"), format != 0 && format != 2);
    }
}

TEST(Las, ColoursOfEightBitsStayAsTheyAre)
{
  test::las::File file = someLas(2, 2);
  for (test::las::Point& point : file.points)
    point.color = {200, 100, 50};
  const PointSet points = readPoints(stored("a.las", test::las::fileOf(file)));
  EXPECT_EQ(points.colors(0, 7), 200);
  EXPECT_EQ(points.colors(2, 7), 50);
}

TEST(Las, WhatCannotBeReadIsNamed)
{
  const std::string good = test::las::fileOf(someLas(2, 3));
  const auto error = [](const std::string& content) {
    const std::string path = stored("a.las", content);
    return test::errorOf([&] { readPoints(path); });
  };
  std::string compressed = good;
  compressed[104] = static_cast<char>(0x83);
  EXPECT_NE(error(compressed).find(".laz"), std::string::npos);
  EXPECT_NE(test::errorOf([] { readPoints(stored("a.laz", "x")); }).find("laszip"), std::string::npos);
  EXPECT_NE(error(good.substr(0, good.size() - 1)).find("truncated"), std::string::npos);
  EXPECT_NE(error("LASF").find("too short"), std::string::npos);
  test::las::File empty = someLas(1, 1);
  empty.points.clear();
  EXPECT_NE(error(test::las::fileOf(empty)).find("no points"), std::string::npos);
  std::string version = good;
  version[25] = 9;
  EXPECT_NE(error(version).find("1.9"), std::string::npos);
}
} // namespace
