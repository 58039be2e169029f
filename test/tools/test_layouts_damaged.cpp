// SPDX-License-Identifier: BSD-3-Clause
// fresco_model with every layout that docs/inputs.md lists, with one thing wrong.
#include "test_data.h"
#include "tools/layout_source.h"
#include <functional>
#include <numeric>
#include <unistd.h>
namespace fresco::test {
namespace {
/// One thing wrong with a layout.
struct Damage {
  const char* name;
  const char* layout;
  std::function<void(const std::string& x)> harm;
  std::vector<std::string> said; ///< all in the one line
};

void replaceIn(const std::string& file, const std::string& what, const std::string& by)
{
  std::string text = get(file);
  const std::size_t at = text.find(what);
  ASSERT_NE(at, std::string::npos) << file << " has no " << what;
  put(file, text.replace(at, what.size(), by));
}

/// The first file of a folder in the order of names.
std::string firstIn(const std::string& folder) { return listing(folder).at(0); }

void keepLines(const std::string& file, int count)
{
  std::istringstream lines(get(file));
  std::string text, line;
  for (int k = 0; k < count && std::getline(lines, line); ++k)
    text += line + "\n";
  put(file, text);
}

void scaleDepths(const std::string& folder, double factor)
{
  for (const std::string& file : listing(folder))
    if (file.find("depth") != std::string::npos || folder.find("depth") != std::string::npos) {
      Image16 image = readImage16(file);
      for (auto& value : image.data)
        value = std::uint16_t(std::min(65534.0, value * factor));
      writeImage(file, image);
    }
}

const std::vector<Damage> damages_of_points = {
    {"EmptyFolder",
     "flat_pcd",
     [](const auto& x) {
       fs::remove_all(x);
       fs::create_directory(x);
     },
     {"x: an empty folder", "docs/inputs.md"}},
    {"Unknown",
     "flat_pcd",
     [](const auto& x) {
       fs::remove_all(x);
       fs::create_directory(x);
       put(x + "/a.dwg", "1");
       put(x + "/b.dwg", "1");
       put(x + "/c.rcp", "1");
     },
     {"2 .dwg, 1 .rcp", "docs/inputs.md"}},
    {"Gone", "flat_pcd", [](const auto& x) { fs::remove_all(x); }, {"x: no such file or folder"}},
    {"WrapperFolder",
     "tum",
     [](const auto& x) {
       fs::rename(x, x + "_");
       fs::create_directory(x);
       fs::rename(x + "_", x + "/freiburg");
     },
     {"x/freiburg would be understood"}},
    {"TwoReadings",
     "tum",
     [](const auto& x) { simulation::writeLayout("flat_pcd", sourceFolder(), x + "/scans"); },
     {"-as scans", "-as rgbd"}},
    {"Laz",
     "flat_las",
     [](const auto& x) {
       put(x + "/a.laz", "LASF");
       put(x + "/b.laz", "LASF");
     },
     {"a.laz and 1 more", "laszip"}},
    {"ScanAndCloud",
     "flat_las",
     [](const auto& x) { simulation::writeLayout("cloud_utm", sourceFolder(), x); },
     {"-as scans", "-as cloud"}},
    {"PosesForFewer",
     "flat_pcd",
     [](const auto& x) { put(x + "/poses.txt", "none\n"); },
     {"poses.txt: 1 poses for 2 scans"}},
    {"ColmapWithoutModel",
     "colmap",
     [](const auto& x) {
       for (const auto& file : listing(x + "/sparse/0"))
         fs::remove(file);
       put(x + "/sparse/0/readme.md", "1");
     },
     {"sparse", "colmap mapper"}},
    {"ColmapPhotographGone",
     "colmap",
     [](const auto& x) { fs::remove(x + "/images/view_2.png"); },
     {"view_2.png: no such photograph"}},
    {"NotAPoint", "one_cloud", [](const auto& x) { put(x + "/cloud.pcd", "nonsense"); }, {"cloud.pcd"}},
    {"TrajectoryShort",
     "cloud_trajectory",
     [](const auto& x) { put(x + "/trajectory.txt", "1 2\n"); },
     {"trajectory.txt: wants lines of x y z"}},
    {"TimesInAnotherOrder",
     "cloud_times",
     [](const auto& x) { put(x + "/trajectory.txt", "2 0 0 0\n1 1 1 1\n"); },
     {"trajectory.txt: its lines are not in the order of time", "sort them"}},
    {"ExportPanoramaGone",
     "scanner_export",
     [](const auto& x) { fs::remove(x + "/pano/00001-pano.jpg"); },
     {"00001-pano.jpg: no such panorama"}},
    {"ExportColumnGone",
     "scanner_export",
     [](const auto& x) { replaceIn(x + "/pano-poses.csv", "pano_ori_w", "angle"); },
     {"pano-poses.csv", "pano_ori_w"}},
};

const std::vector<Damage> damages_of_frames = {
    {"SevenScenesIntrinsics",
     "seven_scenes",
     [](const auto& x) { fs::remove(x + "/camera-intrinsics.txt"); },
     {"camera-intrinsics.txt: no such file", "585 0 320"}},
    {"SevenScenesColorGone",
     "seven_scenes",
     [](const auto& x) { fs::remove(x + "/frame-100003.color.jpg"); },
     {"frame-100003.color.jpg: no such file"}},
    {"TumListGone", "tum", [](const auto& x) { fs::remove(x + "/rgb.txt"); }, {"rgb.txt", "TUM"}},
    {"TumOtherClock",
     "tum",
     [](const auto& x) {
       replaceIn(x + "/depth.txt", "1305031102.16", "1305099102.16");
       keepLines(x + "/depth.txt", 2);
     },
     {"no colour and depth image within 0.02 s"}},
    {"TumFileGone",
     "tum",
     [](const auto& x) { fs::remove(firstIn(x + "/depth")); },
     {"depth/1305031102.160000.png: no such file"}},
    {"TumPosesOfAnotherTime",
     "tum",
     [](const auto& x) { put(x + "/groundtruth.txt", "1 0 0 0 0 0 0 1\n"); },
     {"groundtruth.txt: no pose within 0.02 s"}},
    {"TumDepthTimesThousand",
     "tum",
     [](const auto& x) { scaleDepths(x + "/depth", 0.001); },
     {"depth/1305031102.160000.png: a median depth of", "units of 0.2 mm"}},
    {"Open3dHalfThePoses",
     "open3d",
     [](const auto& x) { keepLines(x + "/trajectory.log", 30); },
     {"trajectory.log: 6 poses for 12 frames"}},
    {"Open3dOddLines",
     "open3d",
     [](const auto& x) { keepLines(x + "/trajectory.log", 29); },
     {"trajectory.log: 29 lines"}},
    {"Open3dIntrinsicsBroken",
     "open3d",
     [](const auto& x) { put(x + "/camera_intrinsic.json", "{}"); },
     {"camera_intrinsic.json: wants width"}},
    {"Open3dIntrinsicsGone",
     "open3d",
     [](const auto& x) {
       fs::remove(x + "/camera_intrinsic.json");
       fs::remove(x + "/trajectory.log");
     },
     {"camera_intrinsic.json", "missing"}},
    {"Open3dSizesDisagree",
     "open3d",
     [](const auto& x) { replaceIn(x + "/camera_intrinsic.json", "\"height\": 60", "\"height\": 80"); },
     {"camera_intrinsic.json: does not fit"}},
    {"Open3dDepthTimesThousandth",
     "open3d",
     [](const auto& x) { scaleDepths(x + "/depth", 0.001); },
     {"depth/000000.png: a median depth of", "units of 1 mm"}},
    {"DepthsAsOpenExr",
     "open3d",
     [](const auto& x) {
       for (const auto& file : listing(x + "/depth")) {
         fs::remove(file);
         put(fs::path(file).replace_extension(".exr"), std::string("v/1\x01\2\0\0\0", 8));
       }
     },
     {"depth/000000.exr: OpenEXR is not read", "oiiotool"}},
    {"SevenScenesDepthTimesThousandth",
     "seven_scenes",
     [](const auto& x) { scaleDepths(x, 0.001); },
     {"frame-100000.depth.png: a median depth of", "units of 1 mm"}},
    {"PolycamSizesDisagree",
     "polycam",
     [](const auto& x) {
       writeImage(firstIn(x + "/keyframes/depth"), Image16{50, 50, std::vector<std::uint16_t>(2500, 1000)});
     },
     {"keyframes/cameras: does not fit"}},
    {"RedwoodOtherSize",
     "redwood",
     [](const auto& x) {
       for (const auto& file : listing(x + "/depth"))
         writeImage(file, simulation::enlarged(readImage16(file), 320, 240));
     },
     {"camera_intrinsic.json: no such file", "320x240"}},
    {"ScanNetIntrinsicsGone",
     "scannet",
     [](const auto& x) {
       for (const auto& file : listing(x + "/intrinsic"))
         fs::remove(file);
       put(x + "/intrinsic/extrinsic_depth.txt", "1");
     },
     {"intrinsic_color.txt: no such file"}},
    {"ScanNetHalfThePoses",
     "scannet",
     [](const auto& x) {
       for (int f = 0; f < 6; ++f)
         fs::remove(x + "/pose/" + std::to_string(f) + ".txt");
     },
     {"pose: poses of 6 of 12 frames"}},
    {"ScanNetPoseBroken",
     "scannet",
     [](const auto& x) { put(x + "/pose/3.txt", "1 0 0\n"); },
     {"pose/3.txt: wants 4x4 numbers"}},
    {"ScanNetNamesDisagree",
     "scannet",
     [](const auto& x) {
       for (int f = 0; f < 12; ++f)
         fs::rename(x + "/color/" + std::to_string(f) + ".jpg", x + "/color/" + std::to_string(f + 100) + ".jpg");
     },
     {"only 0 of the same name or number"}},
    {"StrayMatrixGone",
     "stray",
     [](const auto& x) { fs::remove(x + "/camera_matrix.csv"); },
     {"camera_matrix.csv", "Stray Scanner"}},
    {"StrayMatrixShort",
     "stray",
     [](const auto& x) { put(x + "/camera_matrix.csv", "1, 2, 3\n"); },
     {"camera_matrix.csv: wants 3x3 numbers, has 3"}},
    {"StrayHalfThePoses",
     "stray",
     [](const auto& x) { keepLines(x + "/odometry.csv", 5); },
     {"odometry.csv: poses of 4 of 12 frames"}},
    {"StrayNoQuaternion",
     "stray",
     [](const auto& x) { put(x + "/odometry.csv", "timestamp, frame, x, y, z\n1, 000000, 1, 2, 3\n"); },
     {"odometry.csv: line 2 has 5 values"}},
    {"PolycamCameraGone",
     "polycam",
     [](const auto& x) { fs::remove(firstIn(x + "/keyframes/cameras")); },
     {".json: no such file"}},
    {"PolycamCameraBroken",
     "polycam",
     [](const auto& x) { put(firstIn(x + "/keyframes/cameras"), "{\"fx\": \"a\"}"); },
     {".json: wants width, height, fx"}},
    {"MatterportFileGone",
     "matterport",
     [](const auto& x) { fs::remove(firstIn(x + "/undistorted_depth_images")); },
     {"no such file, but", "house.conf names it"}},
    {"MatterportShortLine",
     "matterport",
     [](const auto& x) {
       put(x + "/undistorted_camera_parameters/house.conf", "intrinsics_matrix 1 0 1 0 1 1 0 0 1\nscan a b 1 2\n");
     },
     {"house.conf: a line 'scan' wants"}},
};

const std::vector<Damage>& damages()
{
  static const std::vector<Damage> all = [] {
    std::vector<Damage> both = damages_of_points;
    both.insert(both.end(), damages_of_frames.begin(), damages_of_frames.end());
    return both;
  }();
  return all;
}

class OneThingWrong : public Inputs, public testing::WithParamInterface<std::size_t> {};

TEST_P(OneThingWrong, IsOneLineWithFileAndCure)
{
  const Damage& damage = damages()[GetParam()];
  const std::string folder = laidOut(damage.layout);
  damage.harm(folder + "/x");
  const Outcome outcome = run(folder, "model x out -dry_run");
  EXPECT_EQ(outcome.status, 1) << outcome.out;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  for (const std::string& part : damage.said)
    EXPECT_NE(outcome.err.find(part), std::string::npos) << part << "\n" << outcome.err;
  EXPECT_FALSE(fs::exists(folder + "/out"));
}

INSTANTIATE_TEST_SUITE_P(All, OneThingWrong, testing::Range(std::size_t{0}, damages().size()),
                         [](const auto& test) { return damages()[test.param].name; });

/// Lists whose rows lie in another order say the same.
TEST_F(Inputs, FramesInAnotherOrder)
{
  struct List {
    const char *layout, *file;
    std::size_t header, rows; ///< lines of the head, of an entry
  };
  for (const List& list : {List{"open3d", "trajectory.log", 0, 5}, List{"stray", "odometry.csv", 1, 1},
                           List{"tum", "groundtruth.txt", 0, 1}, List{"tum", "rgb.txt", 0, 1}}) {
    const std::string folder = laidOut(list.layout), file = folder + "/x/" + list.file;
    ASSERT_EQ(run(folder, "model x out -use_poses -until points -cell 0.1").status, 0);
    const std::string before = get(folder + "/out/poses.txt");
    std::vector<std::string> lines;
    std::istringstream text(get(file));
    for (std::string line; std::getline(text, line);)
      lines.push_back(line + "\n");
    std::rotate(lines.begin() + list.header, lines.begin() + list.header + 3 * list.rows, lines.end());
    put(file, std::accumulate(lines.begin(), lines.end(), std::string()));
    ASSERT_EQ(run(folder, "model x out -use_poses -until points -cell 0.1").status, 0);
    EXPECT_EQ(get(folder + "/out/poses.txt"), before) << list.file;
  }
}

/// As another user than root, who may read everything.
TEST_F(Inputs, PermissionIsMissing)
{
  const std::string folder = laidOut("open3d");
  const std::string another = ::geteuid() == 0 ? "setpriv --reuid=65534 --clear-groups " : "";
  if (run(folder, "model x out -dry_run", another).status != 0)
    GTEST_SKIP() << "no user who may run the tools, but not read everything";
  for (const char* name : {"/x/depth", "/x/camera_intrinsic.json", "/x"}) {
    const fs::perms usual = fs::status(folder + name).permissions();
    fs::permissions(folder + name, fs::perms::none);
    const Outcome outcome = run(folder, "model x out -dry_run", another);
    fs::permissions(folder + name, usual);
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find(std::string(name).substr(1) + ": "), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("Permission denied"), std::string::npos) << outcome.err;
  }
}
} // namespace
} // namespace fresco::test
