// SPDX-License-Identifier: BSD-3-Clause
#include "test_data.h"
#include <fresco/core/statistics.h>
#include <fresco/io/colmap.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <fresco/io/pose_file.h>
#include <fresco/io/scan_file.h>
#include <fresco/io/scan_images.h>
#include <fresco/simulation/scene/scene_builder.h>
#include <fresco/simulation/sensors/dataset.h>
#include <map>
using namespace fresco;
using namespace fresco::simulation;
namespace fs = std::filesystem;

namespace {
/// A box with a column, seen from inside, as a mesh file: quick to scan.
std::string boxFile(const std::string& folder)
{
  SceneBuilder builder("box", 0.5f);
  const int paint = builder.add({});
  builder.beginObject("box");
  builder.boxes({{{-2, -2, 0}, {2, 2, 2.5f}, allSides(paint), false},
                 {{-0.3f, -0.3f, 0}, {0.3f, 0.3f, 2.5f}, allSides(paint), true}},
                true);
  writeMesh(folder + "/box.ply", builder.finish().mesh);
  return folder + "/box.ply";
}

DatasetOptions small()
{
  DatasetOptions options;
  options.stations = 2;
  options.laser.points = 3000;
  options.views = 4;
  options.width = 96, options.height = 64;
  return options;
}

std::map<std::string, std::string> contents(const std::string& folder)
{
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[fs::relative(entry.path(), folder).string()] = readFile(entry.path().string());
  return files;
}

void writeFile(const std::string& path)
{
  OutputFile file(path);
  file.write("mine");
  file.commit();
}

int runScan(const std::string& arguments)
{
  const int status = std::system((test::buildFolder() + "/bin/fresco_scan " + arguments + " > /dev/null 2>&1").c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}
} // namespace

TEST(VirtualDataset, SameSeedSameBytesForAnyNumberOfThreads)
{
  const std::string folder = test::scratchFolder(), box = boxFile(folder);
  DatasetOptions options = small();
  options.threads = 1;
  writeDataset(box, folder + "/a", options);
  options.threads = 4;
  writeDataset(box, folder + "/b", options);
  options.seed = 2;
  writeDataset(box, folder + "/c", options);
  const auto a = contents(folder + "/a"), b = contents(folder + "/b"), c = contents(folder + "/c");
  EXPECT_EQ(a.size(), b.size());
  for (const auto& [name, bytes] : a)
    EXPECT_EQ(bytes, b.at(name)) << name;
  EXPECT_NE(a.at("poses.txt"), c.at("poses.txt"));
  EXPECT_NE(a.at("images/view_000.jpg"), c.at("images/view_000.jpg"));
}

TEST(VirtualDataset, TurnedScansShowTheSameWorld)
{
  const std::string folder = test::scratchFolder(), box = boxFile(folder);
  DatasetOptions options = small();
  options.views = 0;
  writeDataset(box, folder + "/upright", options);
  options.turned = true;
  writeDataset(box, folder + "/turned", options);
  EXPECT_EQ(contents(folder + "/upright").at("truth.ply"), contents(folder + "/turned").at("truth.ply"));
  const auto upright = readPoses(folder + "/upright/poses.txt"), turned = readPoses(folder + "/turned/poses.txt");
  for (std::size_t k = 0; k < upright.size(); ++k) {
    const std::string scan = "/scans/scan_0" + std::to_string(k) + ".pcd";
    const auto world = [&](const std::string& name, const Eigen::Matrix4d& pose) -> Eigen::Matrix4Xd {
      return pose * readPoints(folder + name + scan).points.cast<double>().colwise().homogeneous();
    };
    EXPECT_LT((world("/upright", *upright[k]) - world("/turned", *turned[k])).cwiseAbs().maxCoeff(), 1e-5);
    EXPECT_LT((*turned[k])(2, 2), 0.99) << "not upright";
  }
}

TEST(VirtualDataset, ReplacesAnEarlierRun)
{
  const std::string folder = test::scratchFolder(), box = boxFile(folder);
  DatasetOptions options = small();
  options.views = 2;
  options.stations = 3;
  writeDataset(box, folder + "/out", options);
  writeFile(folder + "/out/notes.txt");
  options.stations = 1;
  options.views = 1;
  writeDataset(box, folder + "/out", options);
  EXPECT_FALSE(fs::exists(folder + "/out/scans/scan_01.pcd"));
  EXPECT_FALSE(fs::exists(folder + "/out/images/view_001.jpg"));
  EXPECT_EQ(readPoses(folder + "/out/poses.txt").size(), 1u);
  EXPECT_TRUE(fs::exists(folder + "/out/notes.txt")) << "files of others stay";
}

TEST(VirtualDataset, IsCompleteAndConsistent)
{
  const std::string folder = test::scratchFolder(), out = folder + "/out";
  DatasetOptions options = small();
  options.laser.noise = 0.f;
  options.laser.veil = false;
  options.truth_images = true;
  writeDataset(boxFile(folder), out, options);
  const auto poses = readPoses(out + "/poses.txt");
  ASSERT_EQ(poses.size(), 2u);
  for (int k = 0; k < 2; ++k) {
    const PointSet scan = readPoints(out + "/scans/scan_0" + std::to_string(k) + ".pcd");
    EXPECT_NEAR(static_cast<double>(scan.size()), 3000.0, 900.0);
    EXPECT_EQ(scan.colors.cols(), scan.size());
    ASSERT_EQ(scan.viewpoints.cols(), 1);
    EXPECT_EQ(scan.viewpoints.norm(), 0.f);
    const Eigen::Matrix4d T = *poses[k];
    for (Index i = 0; i < scan.size(); ++i) { // each point lies on a wall of the box or of the column
      const Eigen::Vector3d p = (T * scan.points.col(i).cast<double>().homogeneous()).head<3>();
      const double wide = std::max(std::fabs(p.x()), std::fabs(p.y()));
      const double off =
          std::min({std::fabs(wide - 2), std::fabs(wide - 0.3), std::fabs(p.z()), std::fabs(p.z() - 2.5)});
      ASSERT_LT(off, 1e-4) << p.transpose();
    }
  }
  const CameraSet set = readColmap(out + "/cameras");
  ASSERT_EQ(set.views.size(), 4u);
  EXPECT_NEAR(set.cameras.at(0).fx, 0.9 * 96, 1e-9);
  for (const View& view : set.views) {
    const Image image = readImage(out + "/images/" + view.image);
    EXPECT_EQ(image.width, 96);
    EXPECT_EQ(image.height, 64);
    EXPECT_EQ(readImage(out + "/truth_images/" + fs::path(view.image).stem().string() + ".png").width, 96);
    EXPECT_LT(view.center().head<2>().cwiseAbs().maxCoeff(), 2.0);
  }
  const TriangleMesh truth = readMesh(out + "/truth.ply");
  EXPECT_EQ(truth.colors.cols(), truth.vertexCount());
  EXPECT_GT(truth.fields.at("returns").sum(), 3000.f);
  EXPECT_TRUE(fs::exists(out + "/exposures.txt"));
}

TEST(VirtualDataset, SurveyHoldsWhatTheFolderHolds)
{
  const std::string folder = test::scratchFolder(), out = folder + "/out", survey = out + "/survey.e57";
  DatasetOptions options = small();
  options.panoramas = options.survey = true;
  options.panorama_height = 32;
  writeDataset(boxFile(folder), out, options);
  const auto infos = readScanInfos(survey);
  const auto poses = readPoses(out + "/poses.txt");
  const auto images = readScanImages(survey);
  const CameraSet set = readColmap(out + "/cameras");
  ASSERT_EQ(infos.size(), 2u);
  ASSERT_EQ(images.size(), 2u + set.views.size());
  for (int k = 0; k < 2; ++k) {
    const PointSet scan = readPoints(out + "/scans/scan_0" + std::to_string(k) + ".pcd");
    const PointSet packed = readPoints(ScanPath{survey, k});
    EXPECT_EQ(packed.points, scan.points);
    EXPECT_EQ(packed.colors, scan.colors);
    EXPECT_TRUE(infos[k].T_file_scan.matrix().isApprox(*poses[k], 1e-9));
    EXPECT_EQ(images[k].scan, k);
    EXPECT_EQ(readScanImageBytes(survey, k), readFile(out + "/panoramas/scan_0" + std::to_string(k) + ".jpg"));
  }
  for (std::size_t v = 0; v < set.views.size(); ++v) {
    const auto [camera, T_camera_file] = cameraOf(images[2 + v]);
    EXPECT_NEAR(camera.fx, set.cameras[0].fx, 1e-9);
    EXPECT_TRUE(T_camera_file.matrix().isApprox(set.views[v].T_camera_world.matrix(), 1e-9));
    EXPECT_EQ(readScanImageBytes(survey, 2 + v), readFile(out + "/images/" + set.views[v].image));
  }
}

TEST(VirtualDataset, PanoramasShowWhatTheLaserMet)
{
  const std::string folder = test::scratchFolder(), out = folder + "/out";
  DatasetOptions options = small();
  options.views = 0;
  options.panoramas = true;
  options.panorama_height = 128;
  options.exposure_spread = 0.f;
  writeDataset(boxFile(folder), out, options);
  const CameraModel camera = sphericalCamera(256, 128);
  Eigen::Matrix3d R_camera_scan; // the middle looks along x, z is up
  R_camera_scan << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  for (int k = 0; k < 2; ++k) {
    const Image image = readImage(out + "/panoramas/scan_0" + std::to_string(k) + ".jpg");
    ASSERT_EQ(image.width, 256);
    ASSERT_EQ(image.height, 128);
    const PointSet scan = readPoints(out + "/scans/scan_0" + std::to_string(k) + ".pcd");
    std::vector<int> differences;
    for (Index i = 0; i < scan.size(); ++i) {
      const Eigen::Vector2i at = project(camera, R_camera_scan * scan.points.col(i).cast<double>()).cast<int>();
      differences.push_back(std::abs(image.pixel(std::min(at.x(), 255), std::min(at.y(), 127))[1] - scan.colors(1, i)));
    }
    std::nth_element(differences.begin(), differences.begin() + differences.size() / 2, differences.end());
    EXPECT_LT(differences[differences.size() / 2], 20); // scans are up to 8 % brighter or darker
  }
}

TEST(VirtualDataset, IntensitiesFallWithTheSquareOfTheRange)
{
  const std::string folder = test::scratchFolder(), out = folder + "/out";
  DatasetOptions options = small();
  options.views = 0;
  options.laser.intensity = true;
  writeDataset(boxFile(folder), out, options);
  const PointSet scan = readPoints(out + "/scans/scan_00.pcd");
  EXPECT_EQ(scan.colors.cols(), 0);
  ASSERT_EQ(scan.intensities.size(), scan.size());
  EXPECT_GT(scan.intensities.minCoeff(), 0.f);
  const Eigen::ArrayXf range = scan.points.colwise().norm().transpose();
  const Eigen::ArrayXf at_one_metre = scan.intensities.array() * range.square();
  EXPECT_LT(at_one_metre.maxCoeff(), 1.3f); // no surface sends more back than a white one
  const Eigen::Isometry3f T_world_scan(readPoses(out + "/poses.txt").at(0).value().cast<float>());
  std::vector<std::pair<float, float>> floor; // range; what it would send back frontally from a metre
  for (Index i = 0; i < scan.size(); ++i)
    if (std::abs((T_world_scan * scan.points.col(i)).z()) < 0.03f)
      floor.push_back({range[i], at_one_metre[i] * range[i] / T_world_scan.translation().z()});
  ASSERT_GT(floor.size(), 200u);
  std::sort(floor.begin(), floor.end());
  const auto middleOf = [&](std::size_t first, std::size_t last) {
    std::vector<float> values;
    for (std::size_t i = first; i < last; ++i)
      values.push_back(floor[i].second);
    return median(values);
  };
  const float near = middleOf(0, floor.size() / 4), far = middleOf(3 * floor.size() / 4, floor.size());
  EXPECT_GT(floor[7 * floor.size() / 8].first, 1.2f * floor[floor.size() / 8].first);
  EXPECT_NEAR(near, far, 0.1f * far); // of another power it would be more than 20 % off
}

TEST(VirtualDataset, MeshFromOutsideIsSeenFromAllAround)
{
  const std::string folder = test::scratchFolder();
  SceneBuilder builder("ball", 1.f);
  const int paint = builder.add({});
  builder.beginObject("ball");
  builder.cushion({40.f, 40.f, 40.f}, paint); // millimetres, say
  writeMesh(folder + "/ball.ply", builder.finish().mesh);
  DatasetOptions options = small();
  options.stations = 4;
  writeDataset(folder + "/ball.ply", folder + "/out", options);
  const TriangleMesh truth = readMesh(folder + "/out/truth.ply");
  EXPECT_GT((truth.fields.at("returns").array() > 0.f).cast<double>().mean(), 0.8);
}

TEST(VirtualDataset, RefusesBadOptionsAndFiles)
{
  const std::string folder = test::scratchFolder(), box = boxFile(folder);
  const auto refused = [&](auto change) {
    DatasetOptions options = small();
    change(options);
    EXPECT_THROW(writeDataset(box, folder + "/out", options), std::invalid_argument);
  };
  refused([](DatasetOptions& o) { o.stations = 0; });
  refused([](DatasetOptions& o) { o.views = -1; });
  refused([](DatasetOptions& o) { o.width = 3; });
  refused([](DatasetOptions& o) { o.focal = 0.f; });
  refused([](DatasetOptions& o) { o.exposure_spread = 1.f; });
  refused([](DatasetOptions& o) { o.response = 1.1f; });
  refused([](DatasetOptions& o) { o.sensor_noise = -1.f; });
  refused([](DatasetOptions& o) { o.jpeg_quality = 0; });
  EXPECT_FALSE(fs::exists(folder + "/out"));
  EXPECT_THROW(writeDataset(folder + "/none.ply", folder + "/out", small()), std::runtime_error);
  EXPECT_THROW(writeDataset(box, "/proc/none/out", small()), std::runtime_error);
}

TEST(VirtualTool, ExitsAsStated)
{
  const std::string folder = test::scratchFolder(), box = boxFile(folder), out = " " + folder + "/out";
  if (!fs::exists(test::buildFolder() + "/bin/fresco_scan"))
    GTEST_SKIP() << "fresco_scan is not built";
  EXPECT_EQ(runScan("-h"), 0);
  EXPECT_EQ(runScan(""), 2);
  EXPECT_EQ(runScan(box), 2);
  EXPECT_EQ(runScan(box + out + " -nonsense"), 2);
  EXPECT_EQ(runScan(box + out + " -images 12"), 2);
  EXPECT_EQ(runScan(box + out + " -images 0x0"), 2);
  EXPECT_EQ(runScan(box + out + " -seed -4"), 2);
  EXPECT_EQ(runScan(folder + "/none.ply" + out), 1);
  EXPECT_EQ(runScan("kitchen" + out), 1);
  EXPECT_EQ(runScan(box + " /proc/none/out"), 1);
  EXPECT_FALSE(fs::exists(folder + "/out"));
  EXPECT_EQ(runScan(box + out + " -stations 1 -points 500 -no_images -quiet"), 0);
  EXPECT_TRUE(fs::exists(folder + "/out/poses.txt"));
  EXPECT_FALSE(fs::exists(folder + "/out/images"));
}
