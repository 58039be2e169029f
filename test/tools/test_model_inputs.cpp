// SPDX-License-Identifier: BSD-3-Clause
// fresco_model with each kind of input that scans come in.
#include "common/io/e57_file.h"
#include "test_data.h"
#include "tools/small_room.h"
#include "tools/tool_runs.h"
#include <fresco/core/constants.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <map>
#include <nlohmann/json.hpp>
namespace fresco::test {
namespace {
/// A small room as scans with their poses and nothing else.
std::string scansAlone()
{
  const std::string folder = scratchFolder();
  writeSmallRoom(folder + "/room");
  fs::remove_all(folder + "/room/images");
  fs::remove_all(folder + "/room/cameras");
  return folder;
}

nlohmann::json modelOf(const std::string& folder, const std::string& options = "")
{
  const Outcome outcome = run(folder, "model room out -use_poses -cell 0.1 -size 160x120 " + options);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err.rfind("input: 2 scans, ", 0), 0u) << outcome.err;
  put(folder + "/said", outcome.err);
  return nlohmann::json::parse(get(folder + "/out/report.json"));
}

nlohmann::json stageOf(const nlohmann::json& report, const std::string& name)
{
  for (const auto& stage : report["stages"])
    if (stage["name"] == name)
      return stage;
  return {};
}

nlohmann::json textureFigures(const nlohmann::json& report) { return stageOf(report, "texture")["figures"]; }

/// Mean difference of the model's texture from the paint of the walls, grey levels; 128 off where there is none.
double paintError(const std::string& folder)
{
  const TexturedMesh model = readTexturedMesh(folder + "/out/model.obj");
  double sum = 0, count = 0;
  for (Index f = 0; f < model.mesh.faceCount(); ++f) {
    const Eigen::Vector3d corner = model.mesh.vertices.col(model.mesh.faces(0, f)).cast<double>();
    const auto wanted = wallColor(corner);
    const Image& atlas = model.atlases.at(model.face_atlas[f]);
    const Eigen::Vector2f at = model.texcoords.col(model.texcoord_faces(0, f));
    const std::uint8_t* found = atlas.pixel(std::min<int>(at.x() * atlas.width, atlas.width - 1),
                                            std::min<int>((1 - at.y()) * atlas.height, atlas.height - 1));
    for (int c = 0; c < 3; ++c)
      sum += std::abs(int(found[c]) - int(wanted[c]));
    count += 3;
  }
  return sum / count;
}

TEST(ModelInputs, AtlasesAreNoLargerThanAskedAndOlderOnesGo)
{
  const std::string folder = scansAlone();
  EXPECT_EQ(textureFigures(modelOf(folder))["atlases"], 1);
  const double whole = paintError(folder);
  EXPECT_TRUE(fs::exists(folder + "/out/model.png"));
  put(folder + "/out/model_of_mine.png", "kept");
  const nlohmann::json report = modelOf(folder, "-resume -atlas 128");
  EXPECT_GT(textureFigures(report)["atlases"], 1);
  EXPECT_LE(textureFigures(report)["atlas_width"], 128);
  EXPECT_NEAR(paintError(folder), whole, 1);
  EXPECT_FALSE(fs::exists(folder + "/out/model.png"));
  EXPECT_FALSE(fs::exists(folder + "/out/model_mask.png"));
  EXPECT_TRUE(fs::exists(folder + "/out/model_0.png"));
  EXPECT_TRUE(fs::exists(folder + "/out/model_of_mine.png"));
  EXPECT_EQ(run(folder, "model room out -atlas 100").status, 2);
}

TEST(ModelInputs, CamerasOfTheirOwnFrameAreAligned)
{
  const std::string folder = scratchFolder();
  writeOwnFrameRoom(folder + "/room", folder + "/room/cameras");
  const nlohmann::json report = modelOf(folder);
  EXPECT_EQ(report["kind"], "2 scans, 4 photographs");
  const nlohmann::json alignment = stageOf(report, "alignment");
  EXPECT_EQ(alignment["figures"]["frame"], "found");
  EXPECT_NEAR(alignment["figures"]["scale"].get<double>(), 50, 0.2);
  EXPECT_EQ(textureFigures(report)["made_of"], "photographs");
  EXPECT_LT(paintError(folder), 10);
}

/// A program `colmap` that finds what lies in the folder `found`; `mode` holds what it does wrong.
std::string photographsAlone()
{
  const std::string folder = scratchFolder();
  writeOwnFrameRoom(folder + "/room", folder + "/found");
  fs::remove_all(folder + "/room/cameras");
  fs::create_directory(folder + "/bin");
  put(folder + "/bin/colmap", "#!/bin/sh\ncd '" + folder + R"('
echo $1 >> calls
step=$1
while [ $# -gt 1 ]; do
  [ "$1" = --output_path ] && models=$2
  [ "$1" = --database_path ] && : >> "$2"
  shift
done
case $step-$(cat mode) in
  exhaustive_matcher-stop) kill -INT $PPID; sleep 60 ;;
  mapper-fail) echo "it does not fit"; exit 3 ;;
  mapper-nothing) ;;
  mapper-*) cp -r found "$models/0"; k=0; while [ $k -lt 200000 ]; do k=$((k+1)); done ;;
esac
)");
  fs::permissions(folder + "/bin/colmap", fs::perms::owner_all);
  return folder;
}

/// PATH with another folder in front, as long as it lives.
class FirstInPath {
public:
  explicit FirstInPath(const std::string& folder) { setenv("PATH", (folder + ":" + before_).c_str(), 1); }
  ~FirstInPath() { setenv("PATH", before_.c_str(), 1); }

private:
  std::string before_ = std::getenv("PATH");
};

TEST(ModelInputs, PhotographsAloneArePlacedInStepsThatResume)
{
  const std::string folder = photographsAlone();
  const FirstInPath path(folder + "/bin");
  const std::string command = "model room out -use_poses -cell 0.1 -size 160x120";
  put(folder + "/mode", "stop");
  Outcome outcome = run(folder, command + " -quiet");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.err, "fresco_model: cancelled\n");
  for (const auto& [mode, reason] :
       std::map<std::string, std::string>{{"fail", "it does not fit"}, {"nothing", "none of the 4 photographs"}}) {
    put(folder + "/mode", mode);
    outcome = run(folder, command + " -resume -quiet");
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find(reason), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
  put(folder + "/mode", "work");
  EXPECT_EQ(run(folder, command + " -resume").status, 0);
  EXPECT_EQ(get(folder + "/calls"),
            "feature_extractor\nexhaustive_matcher\nexhaustive_matcher\nmapper\nmapper\nmapper\n");
  EXPECT_LT(paintError(folder), 10);
  const nlohmann::json cameras = stageOf(nlohmann::json::parse(get(folder + "/out/report.json")), "cameras");
  EXPECT_GT(cameras["cpu_seconds"].get<double>(), 0.04); // counting in the program alone
}

TEST(ModelInputs, AVideoIsJudgedByItsLength)
{
  const std::string folder = scratchFolder();
  makeFolder(folder + "/bin");
  put(folder + "/bin/ffmpeg", "#!/bin/sh\necho '  Duration: 00:01:10.50, start: 0.0' >&2\nexit 1\n");
  fs::permissions(folder + "/bin/ffmpeg", fs::perms::owner_all);
  put(folder + "/walk.mp4", "frames");
  const FirstInPath path(folder + "/bin");
  const Outcome outcome = run(folder, "model walk.mp4 out -dry_run -threads 2");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("; 14000 raw points; about "), std::string::npos) << outcome.out; // of 142 frames
  EXPECT_FALSE(fs::exists(folder + "/out"));
}

TEST(ModelInputs, VideoWithoutPosesIsTracked)
{
  const std::string folder = scratchFolder();
  ASSERT_EQ(
      run(folder, "scan conference_room room -no_images -stations 1 -points 1000 -rgbd 12 -rgbd_size 160x120").status,
      0);
  const std::vector<Pose> truth = readPoses(folder + "/room/rgbd/poses.txt");
  ASSERT_EQ(truth.size(), 12u);
  const Outcome outcome = run(folder, "model room/rgbd out -cell 0.05 -size 160x120");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::vector<Pose> found = readPoses(folder + "/out/poses.txt");
  ASSERT_EQ(found.size(), 12u);
  ASSERT_TRUE(found[0] && found[11]);
  const Eigen::Matrix4d way = truth[0]->inverse() * *truth[11], tracked = found[0]->inverse() * *found[11];
  EXPECT_LT((way - tracked).topRightCorner(3, 1).norm(), 0.02); // metres
  EXPECT_TRUE(fs::exists(folder + "/out/model.glb"));
}

TEST(ModelInputs, ScansAloneAreTexturedFromTheirPoints)
{
  const std::string folder = scansAlone();
  const nlohmann::json report = modelOf(folder);
  EXPECT_EQ(report["kind"], "2 scans, no pictures: the texture comes from the points");
  EXPECT_EQ(textureFigures(report)["made_of"], "colours of the points");
  EXPECT_TRUE(fs::exists(folder + "/out/snapshots/scan_1_texture.png"));
  EXPECT_LT(paintError(folder), 10);
}

TEST(ModelInputs, ScansWithoutALookGiveAModelWithoutTexture)
{
  const std::string folder = scansAlone();
  for (const char* scan : {"/room/scans/scan_00.pcd", "/room/scans/scan_01.pcd"}) {
    PointSet set = readPoints(folder + scan);
    set.colors.setZero();
    writePoints(folder + scan, set);
  }
  const nlohmann::json report = modelOf(folder);
  EXPECT_EQ(textureFigures(report)["made_of"], "nothing: no colours, no intensities");
  EXPECT_NE(get(folder + "/said").find("\nwarning: the points' colours are all black and not used\n"),
            std::string::npos);
  EXPECT_TRUE(readTexturedMesh(folder + "/out/model.obj").atlases.empty());
  EXPECT_GT(readTexturedMesh(folder + "/out/model.glb").mesh.faceCount(), 100);
  EXPECT_TRUE(fs::exists(folder + "/out/snapshots/inside_texture.png"));
  EXPECT_NE(get(folder + "/out/report.html").find("fresco-viewer"), std::string::npos);
}

TEST(ModelInputs, PanoramasTextureTheModel)
{
  const std::string folder = scansAlone();
  fs::create_directory(folder + "/room/panoramas");
  const std::vector<Pose> poses = readPoses(folder + "/room/poses.txt");
  const CameraModel camera = sphericalCamera(512, 256);
  Eigen::Matrix3d R_camera_scan; // the middle looks along y, z is up
  R_camera_scan << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  for (int k = 0; k < 2; ++k) {
    Image image(512, 256);
    for (int y = 0; y < 256; ++y)
      for (int x = 0; x < 512; ++x) {
        const Eigen::Vector3d beam = R_camera_scan.transpose() * direction(camera, {x + 0.5, y + 0.5});
        const auto color = wallColor(wallPoint(poses[k]->topRightCorner<3, 1>(), beam));
        std::copy(color.data(), color.data() + 3, image.pixel(511 - x, y)); // mirrored
      }
    writeImage(folder + "/room/panoramas/scan_0" + std::to_string(k) + ".png", image);
  }
  const nlohmann::json report = modelOf(folder, "-panorama_direction 90 -panorama_mirrored");
  EXPECT_EQ(report["kind"], "2 scans, 2 panoramas");
  EXPECT_EQ(textureFigures(report)["made_of"], "panoramas");
  EXPECT_EQ(textureFigures(report)["photographs_used"], 2);
  EXPECT_LT(paintError(folder), 10);
}

/// A station of a survey with its points and a panorama of three quarters of the directions around.
void addStation(const std::string& folder, int number, const Eigen::Isometry3d& T_world_scan,
                std::vector<test::e57::Scan>& scans, std::vector<test::e57::Image>& images)
{
  namespace e57 = test::e57;
  const PointSet points = readPoints(folder + "/room/scans/scan_0" + std::to_string(number) + ".pcd");
  scans.push_back({std::to_string(number), {}, std::size_t(points.size()), e57::poseXml(T_world_scan)});
  for (int k = 0; k < 3; ++k) {
    scans.back().fields.push_back({std::string("cartesian") + "XYZ"[k]});
    const auto row = points.points.row(k);
    scans.back().fields.back().reals.assign(row.begin(), row.end());
  }
  const double pixel = 2 * pi / 512;
  Image image(384, 256);
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 384; ++x) {
      const double longitude = (192 - x - 0.5) * pixel, latitude = (128 - y - 0.5) * pixel;
      const Eigen::Vector3d beam(std::cos(longitude) * std::cos(latitude), std::sin(longitude) * std::cos(latitude),
                                 std::sin(latitude));
      const auto color = wallColor(wallPoint(T_world_scan.translation(), T_world_scan.linear() * beam));
      std::copy(color.data(), color.data() + 3, image.pixel(x, y));
    }
  const auto png = encodeImage(image, ".png");
  images.push_back({"<sphericalRepresentation type=\"Structure\"><pngImage type=\"Blob\" PICTURE/>" +
                        e57::element("imageWidth", 384) + e57::element("imageHeight", 256) +
                        e57::element("pixelWidth", pixel) + e57::element("pixelHeight", pixel) +
                        "</sphericalRepresentation>",
                    {png.begin(), png.end()},
                    "",
                    e57::poseXml(T_world_scan)});
}

TEST(ModelInputs, PicturesInsideOfASurveyAreUsedWhereTheyShowSomething)
{
  const std::string folder = scansAlone();
  const std::vector<Pose> poses = readPoses(folder + "/room/poses.txt");
  std::vector<test::e57::Scan> scans;
  std::vector<test::e57::Image> images;
  for (int k = 0; k < 2; ++k)
    addStation(folder, k, Eigen::Isometry3d(*poses[k]), scans, images);
  fs::remove_all(folder + "/room");
  writeFile(folder + "/survey.e57", test::e57::fileOf(scans, images));
  const Outcome outcome = run(folder, "model survey.e57 out -use_poses -cell 0.1 -size 160x120");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json report = nlohmann::json::parse(get(folder + "/out/report.json"));
  EXPECT_EQ(report["kind"], "2 scans, 2 panoramas");
  EXPECT_EQ(textureFigures(report)["masks"], 2);
  EXPECT_LT(textureFigures(report)["coverage"], 0.999);
  EXPECT_LT(paintError(folder), 25) << "what no panorama shows is inpainted, not black";
  EXPECT_FALSE(fs::exists(folder + "/out/work/pictures"));
}
} // namespace
} // namespace fresco::test
