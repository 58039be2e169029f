// SPDX-License-Identifier: BSD-3-Clause
// fresco_model with every layout that docs/inputs.md lists, sound and with one thing wrong.
#include "common/float_files.h"
#include "common/io/e57_file.h"
#include "test_data.h"
#include "tools/layout_source.h"
#include <fresco/core/require.h>
#include <fresco/io/camera_files.h>
#include <fresco/simulation/sensors/layouts.h>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
namespace fresco::test {
namespace {
/// What the first line says of a layout; each of those that can be written has a line here.
const std::map<std::string, std::string>& expected()
{
  static const std::map<std::string, std::string> lines = {
      {"flat_pcd", "input: 2 scans, no pictures"},
      {"flat_ply", "input: 2 scans, no pictures"},
      {"flat_las", "input: 2 scans, no pictures"},
      {"flat_xyz", "input: 2 scans, no pictures"},
      {"one_scan", "input: 1 scan, no pictures"},
      {"one_cloud", "input: 1 file of one cloud, no pictures"},
      {"cloud_normals", "input: 1 file of one cloud, no pictures"},
      {"cloud_utm", "input: 2 files of one cloud, no pictures"},
      {"cloud_trajectory", "input: 1 file of one cloud, no pictures"},
      {"cloud_times", "input: 1 file of one cloud, no pictures"},
      {"matterpak", "input: 1 file of one cloud, no pictures"},
      {"e57", "input: 2 scans, 2 panoramas"},
      {"photographs", "input: 4 photographs and no scans"},
      {"images", "input: 4 photographs and no scans"},
      {"colmap", "input: 1 file of one cloud, 4 photographs"},
      {"colmap_sparse", "input: 4 photographs and no scans"},
      {"metashape", "input: 1 file of one cloud, 4 photographs\n"},
      {"bundler", "input: 1 file of one cloud, 4 photographs\n"},
      {"nvm", "input: 1 file of one cloud, 4 photographs\n"},
      {"transforms", "input: 1 file of one cloud, 4 photographs\n"},
      {"openmvg", "input: 1 file of one cloud, 4 photographs\n"},
      {"scanner_export", "input: 1 file of one cloud, 2 photographs"},
      {"seven_scenes", "input: 12 RGB-D frames\n"},
      {"tum", "input: 12 RGB-D frames (TUM RGB-D)"},
      {"open3d", "input: 12 RGB-D frames (Open3D RGB-D)"},
      {"redwood", "input: 12 RGB-D frames (Redwood RGB-D)"},
      {"scannet", "input: 12 RGB-D frames (ScanNet)"},
      {"stray", "input: 12 RGB-D frames (Stray Scanner)"},
      {"polycam", "input: 12 RGB-D frames (Polycam raw data)"},
      {"matterport", "input: 12 RGB-D frames (Matterport3D)"},
  };
  return lines;
}

class EachLayout : public Inputs, public testing::WithParamInterface<std::string> {};

TEST_P(EachLayout, IsRecognisedBeforeAnyWork)
{
  const std::string folder = laidOut(GetParam());
  const Outcome outcome = run(folder, "model x out -dry_run");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  ASSERT_EQ(expected().count(GetParam()), 1u) << "no line is expected of this layout";
  EXPECT_EQ(outcome.out.rfind(expected().at(GetParam()), 0), 0u) << outcome.out;
  EXPECT_NE(outcome.out.find("\nwould do: "), std::string::npos) << outcome.out;
  EXPECT_FALSE(fs::exists(folder + "/out"));
}

/// A cloud cut in four: told without being asked, and a damaged tile costs no other.
TEST_F(Inputs, TilesAreOneCloud)
{
  const std::string folder = laidOut("one_cloud");
  const PointSet cloud = readPoints(folder + "/x/cloud.pcd");
  const Eigen::Vector3f middle = cloud.points.rowwise().mean();
  for (int tile = 0; tile < 4; ++tile) {
    std::vector<Index> inside;
    for (Index i = 0; i < cloud.size(); ++i)
      if ((cloud.points(0, i) < middle.x()) + 2 * (cloud.points(1, i) < middle.y()) == tile)
        inside.push_back(i);
    PointSet part = selectPoints(cloud, inside);
    part.viewpoints.resize(3, 0);
    writePoints(concat(folder, "/x/tile_", tile, ".ply"), part);
  }
  fs::remove(folder + "/x/cloud.pcd");
  const Outcome whole = run(folder, "model x out -until points");
  EXPECT_NE((whole.out + whole.err).find("input: 4 files of one cloud"), std::string::npos) << whole.err;
  const std::string tile = get(folder + "/x/tile_1.ply");
  put(folder + "/x/tile_1.ply", tile.substr(0, tile.size() - 100));
  const Outcome damaged = run(folder, "model x out2 -until points");
  EXPECT_EQ(damaged.status, 0) << damaged.err;
  EXPECT_NE((damaged.out + damaged.err).find("input: 4 files of one cloud"), std::string::npos) << damaged.err;
  EXPECT_NE((damaged.out + damaged.err).find("left out: x/tile_1.ply: truncated"), std::string::npos) << damaged.err;
  EXPECT_LT(readPoints(folder + "/out2/points.ply").size(), readPoints(folder + "/out/points.ply").size());
}

/// Whatever program wrote them.
TEST_F(Inputs, CamerasOfEachProgramShowTheSame)
{
  const CameraFile given = readCameraFile(sourceFolder() + "/cameras", sourceFolder() + "/images");
  for (const char* layout : {"metashape", "bundler", "nvm", "transforms", "openmvg"}) {
    const std::string folder = laidOut(layout) + "/x";
    const auto [set, points] = readCameraFile(folder, folder + "/images");
    ASSERT_EQ(set.views.size(), given.set.views.size()) << layout;
    for (std::size_t v = 0; v < set.views.size(); ++v) {
      const View &view = set.views[v], &wanted = given.set.views[v];
      EXPECT_EQ(view.image, wanted.image) << layout;
      for (const SparsePoint& point : given.points)
        if (point.track[0].view == int(v)) {
          EXPECT_LT((project(set.cameras[view.camera], view.T_camera_world * point.position) -
                     project(given.set.cameras[wanted.camera], wanted.T_camera_world * point.position))
                        .norm(),
                    1e-6)
              << layout;
        }
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_LT((points[i].position - given.points[i].position).norm(), 1e-9) << layout;
      EXPECT_LT((points[i].track[0].pixel - given.points[i].track[0].pixel).norm(), 1e-6) << layout;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, EachLayout, testing::ValuesIn(simulation::layoutNames()),
                         [](const auto& test) { return test.param; });

/// Mean distance of the mesh's vertices from the walls of the room, and of these from the mesh's box.
void expectRoom(const std::string& file, const Eigen::Vector3d& corner, double tolerance)
{
  const TriangleMesh mesh = readMesh(file);
  ASSERT_GT(mesh.faceCount(), 100) << file;
  double sum = 0;
  Eigen::AlignedBox3d box;
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    const Eigen::Vector3d p = mesh.origin + mesh.vertices.col(v).cast<double>() - corner;
    box.extend(p);
    sum += std::min(p.cwiseAbs().minCoeff(), (roomSize() - p).cwiseAbs().minCoeff());
  }
  EXPECT_LT(sum / mesh.vertexCount(), tolerance) << file;
  EXPECT_LT((box.sizes() - roomSize()).cwiseAbs().maxCoeff(), 10 * tolerance)
      << file << ": " << box.sizes().transpose();
}

/// Share of the faces that look into the room.
double facingInside(const std::string& file, const Eigen::Vector3d& corner)
{
  const TriangleMesh mesh = readMesh(file);
  const Eigen::Vector3d middle = corner + 0.5 * roomSize() - mesh.origin;
  const Points normals = faceNormals(mesh);
  double inside = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
    inside += normals.col(f).dot(middle.cast<float>() - mesh.vertices.col(mesh.faces(0, f))) > 0;
  return inside / mesh.faceCount();
}

class WholeChain : public Inputs, public testing::WithParamInterface<std::string> {};

TEST_P(WholeChain, MakesTheRoom)
{
  const std::string folder = laidOut(GetParam());
  const Outcome outcome = run(folder, "model x out -cell 0.1 -size 160x120");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Eigen::Vector3d corner =
      GetParam() == "cloud_utm" ? Eigen::Vector3d(691000, 5334000, 520) : Eigen::Vector3d(0, 0, 0);
  expectRoom(folder + "/out/mesh.ply", corner, 0.03);
  EXPECT_GT(facingInside(folder + "/out/mesh.ply", corner), 0.98);
  EXPECT_TRUE(fs::exists(folder + "/out/model.glb"));
}

INSTANTIATE_TEST_SUITE_P(Some, WholeChain,
                         testing::Values("one_cloud", "cloud_utm", "cloud_normals", "cloud_trajectory", "cloud_times",
                                         "matterpak", "colmap", "metashape", "bundler", "scanner_export"),
                         [](const auto& test) { return test.param; });

/// Frames show the walls to some height only.
class FramesChain : public Inputs, public testing::WithParamInterface<std::string> {};

TEST_P(FramesChain, GivesTheSameSurfaceWhateverTheLayout)
{
  const std::string folder = laidOut(GetParam());
  const Outcome outcome = run(folder, "model x out -use_poses -cell 0.1 -size 160x120");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const TriangleMesh mesh = readMesh(folder + "/out/mesh.ply");
  ASSERT_GT(mesh.faceCount(), 100);
  const bool turned = GetParam() == "polycam"; // its world has another x and y, but z is up
  double sum = 0;
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    const Eigen::Vector3d p = mesh.origin + mesh.vertices.col(v).cast<double>();
    sum += std::min(p.cwiseAbs().minCoeff(), (roomSize() - p).cwiseAbs().minCoeff());
  }
  EXPECT_LT(sum / mesh.vertexCount(), 0.03) << turned;
}

INSTANTIATE_TEST_SUITE_P(Some, FramesChain, testing::Values("tum", "scannet", "stray", "polycam", "matterport"),
                         [](const auto& test) { return test.param; });

/// Points of structure from motion are few: a rough room.
TEST_F(Inputs, PhotographsOfAModelGiveARoughRoom)
{
  const std::string folder = laidOut("colmap_sparse"), model = folder + "/x/sparse/0";
  const CameraSet set = readColmap(model);
  SparsePoints found;
  for (SparsePoint& point : readColmapPoints(model)) {
    for (int more = 1; more < 3; ++more) // as if others had seen it, too
      point.track.push_back({(point.track[0].view + more) % int(set.views.size()), {1, 1}});
    if (std::min(point.position.cwiseAbs().minCoeff(), (roomSize() - point.position).cwiseAbs().minCoeff()) < 0.01)
      found.push_back(point);
  }
  writeColmap(model, set, found);
  const Outcome outcome = run(folder, "model x out -size 160x120");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expectRoom(folder + "/out/mesh.ply", {0, 0, 0}, 0.3);
  EXPECT_NE(outcome.err.find("\nwarning: sparse: "), std::string::npos) << outcome.err;
  EXPECT_TRUE(fs::exists(folder + "/out/model.glb"));
}

TEST_F(Inputs, TheViewpointThatPclAlwaysWritesTellsNothing)
{
  const std::string folder = laidOut("one_cloud");
  PointSet cloud = readPoints(folder + "/x/cloud.pcd");
  cloud.viewpoints = Points::Zero(3, 1);
  writePoints(folder + "/x/cloud.pcd", cloud);
  ASSERT_NE(get(folder + "/x/cloud.pcd").find("VIEWPOINT 0 0 0 1 0 0 0"), std::string::npos);
  const Outcome outcome = run(folder, "model x out -cell 0.1 -until mesh");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err.rfind(expected().at("one_cloud"), 0), 0u) << outcome.err;
  EXPECT_GT(facingInside(folder + "/out/mesh.ply", {0, 0, 0}), 0.98);
}

TEST_F(Inputs, AHandfulOfPointsIsNoModel)
{
  const std::string folder = scratchFolder();
  PointSet few;
  few.points = Points::Random(3, 11);
  writePoints(folder + "/few.ply", few);
  const Outcome outcome = run(folder, "model few.ply out -as cloud -quiet");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("few.ply: only "), std::string::npos) << outcome.err;
}

TEST_F(Inputs, TimesOfPointsTellFromWhereTheyWereSeen)
{
  const std::string folder = laidOut("cloud_times"), command = "model x out -until points";
  const auto normals = [&] {
    const auto report = nlohmann::json::parse(get(folder + "/out/report.json"));
    return report["stages"][0]["figures"]["normals"].get<std::string>();
  };
  ASSERT_EQ(run(folder, command).status, 0);
  EXPECT_EQ(normals(), "to where each point was seen from");
  std::string lines = get(folder + "/x/trajectory.txt");
  put(folder + "/x/trajectory.txt",
      "1" + lines.substr(0, lines.find('\n')) + "\n1" + lines.substr(lines.find('\n') + 1));
  const Outcome other_clock = run(folder, command);
  ASSERT_EQ(other_clock.status, 0);
  EXPECT_NE(other_clock.err.find("is it the same clock?"), std::string::npos) << other_clock.err;
  EXPECT_EQ(normals(), "to the places of the sensor in sight");
}

/// Depths in metres, as floats, in each kind of file.
TEST_F(Inputs, DepthsMayBeFloats)
{
  const std::string folder = laidOut("open3d"), command = "model x out -use_poses -until surface -cell 0.1";
  ASSERT_EQ(run(folder, command).status, 0);
  const double area = surfaceArea(readMesh(folder + "/out/surface.ply"));
  for (const char* extension : {".pfm", ".npy", ".tif"}) {
    for (const std::string& file : listing(folder + "/x/depth")) {
      const DepthFile depth = readDepthFile(file);
      Floats metres{depth.image.width, depth.image.height, {}};
      for (const std::uint16_t value : depth.image.data)
        metres.values.push_back(float(value * (depth.in_metres ? metres_unit : 1e-3)));
      fs::remove(file);
      put(fs::path(file).replace_extension(extension), extension == std::string(".pfm")   ? pfmBytes(metres)
                                                       : extension == std::string(".npy") ? npyBytes(metres)
                                                                                          : tiffBytes(metres));
    }
    EXPECT_NE(run(folder, "model x out -dry_run").out.find("12 depth images, 80x60, metres"), std::string::npos);
    ASSERT_EQ(run(folder, command).status, 0) << extension;
    EXPECT_NEAR(surfaceArea(readMesh(folder + "/out/surface.ply")), area, 0.01 * area) << extension;
  }
  const std::string last = listing(folder + "/x/depth").back();
  writeImage(fs::path(last).replace_extension(".png"), Image16{80, 60, std::vector<std::uint16_t>(4800, 1000)});
  fs::remove(last);
  EXPECT_NE(run(folder, command).err.find("whole numbers, but the first frame's depths are floats"), std::string::npos);
}

TEST_F(Inputs, OneFileStandsForItsFolder)
{
  const std::string folder = laidOut("one_cloud");
  EXPECT_EQ(run(folder, "model x/cloud.pcd out -dry_run").out, run(folder, "model x out -dry_run").out);
  EXPECT_EQ(run(folder, "model x/cloud.pcd out -as scans -dry_run").out.rfind("input: 1 scan,", 0), 0u);
  EXPECT_EQ(run(folder, "model x/cloud.pcd out -as rgbd -dry_run").status, 1);
  EXPECT_EQ(run(folder, "model x/cloud.pcd out -as nothing -dry_run").status, 1);
}

/// A plane, seen from nowhere that is known: a facade, or a floor from above.
TEST_F(Inputs, APlaneIsAModel)
{
  const std::string folder = scratchFolder();
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::normal_distribution<float> noise(0, 0.003f);
  for (const int axis : {0, 2}) {
    PointSet plane;
    plane.points.resize(3, 20000);
    for (Index i = 0; i < plane.size(); ++i) {
      plane.points.col(i) << 4 * uniform(random), 4 * uniform(random), 4 * uniform(random);
      plane.points(axis, i) = 12 + noise(random);
    }
    writePoints(folder + "/plane.ply", plane);
    const Outcome outcome = run(folder, "model plane.ply out -as cloud -size 160x120");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const double area = surfaceArea(readMesh(folder + "/out/mesh.ply"));
    EXPECT_GT(area, 0.95 * 16);
    EXPECT_LT(area, 4.4 * 4.4) << "trimmed by density, more than 20 cm beyond the border";
  }
}

TEST_F(Inputs, AThingSeenFromAroundIsClosedAndFacesOutwards)
{
  const std::string folder = scratchFolder();
  PointSet ball;
  ball.points = 0.2f * test::sphere(1.f, 5).vertices;
  writePoints(folder + "/ball.ply", ball);
  const Outcome outcome = run(folder, "model ball.ply out -size 160x120");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const double volume = 4.0 / 3 * pi * 0.008;
  EXPECT_NEAR(signedVolume(readMesh(folder + "/out/mesh.ply")), volume, 0.05 * volume);
}

/// One of them has no place: the model is of the other, and the message says so.
TEST_F(Inputs, ScansWithoutOverlap)
{
  const std::string folder = scratchFolder();
  makeFolder(folder + "/scans");
  PointSet room = scanRoom({1.2, 1.1, 1.3}, 20000), front = room;
  std::vector<Index> wall;
  for (Index i = 0; i < front.size(); ++i)
    if (front.points.col(i).normalized().x() > 0.8f)
      wall.push_back(i);
  front = selectPoints(front, wall);
  front.points.row(0).array() += 40.f + (front.points.row(1).array() * 7).sin(); // another place, of another shape
  writePoints(folder + "/scans/room.pcd", room);
  writePoints(folder + "/scans/front.pcd", front);
  const Outcome outcome = run(folder, "model scans out -as scans -cell 0.1 -size 160x120");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("\nwarning: "), std::string::npos) << outcome.err;
  EXPECT_NE(get(folder + "/out/poses.txt").find("none"), std::string::npos);
}

/// An E57 of pictures alone, an empty and a truncated one among scans: the others are read, and a line tells of each.
TEST_F(Inputs, FilesWithoutAScanDoNotCostTheOthers)
{
  const std::string folder = laidOut("flat_pcd"), x = folder + "/x/";
  put(x + "pictures.e57", e57::fileOf({}));
  put(x + "station3.pcd", get(x + "station1.pcd").substr(0, 3000));
  put(x + "station4.e57", get(sourceFolder() + "/survey.e57").substr(0, 5000));
  const Outcome dry = run(folder, "model x out -dry_run");
  ASSERT_EQ(dry.status, 0) << dry.err;
  EXPECT_NE(dry.err.find("pictures.e57: no scan in it: left out"), std::string::npos) << dry.err;
  EXPECT_EQ(dry.out.find("input: 4 scans"), 0u) << dry.out;
  const Outcome outcome = run(folder, "model x out -until points -cell 0.1");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* name : {"station3.pcd", "station4.e57"})
    EXPECT_NE(outcome.err.find(name), std::string::npos) << outcome.err;
  const Outcome registered = run(folder, "register x/pictures.e57 x/station1.pcd x/station2.pcd -o reg");
  EXPECT_EQ(registered.status, 0) << registered.err;
  EXPECT_NE(registered.err.find("pictures.e57: no scan in it: left out"), std::string::npos) << registered.err;
  for (const char* name : {"station1.pcd", "station2.pcd", "station3.pcd", "station4.e57"})
    fs::remove(x + name);
  const Outcome none = run(folder, "model x out -dry_run");
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.err.find("pictures.e57: no scan in it"), std::string::npos) << none.err;
}

TEST_F(Inputs, StageOptionsAndSettingsReachTheStages)
{
  const std::string folder = laidOut("one_scan");
  const std::string command = "model x out -cell 0.1 -size 160x120 ";
  ASSERT_EQ(run(folder, command + "-reconstruct.depth 5 -texture.rounds 0").status, 0);
  const auto depthOf = [&] {
    return nlohmann::json::parse(get(folder + "/out/report.json"))["stages"][1]["figures"]["octree_depth"].get<int>();
  };
  EXPECT_EQ(depthOf(), 5);
  const std::string settings = get(folder + "/out/settings.txt");
  EXPECT_NE(settings.find("\nreconstruct.depth 5\n"), std::string::npos) << settings;
  fs::rename(folder + "/out/settings.txt", folder + "/mine.txt");
  ASSERT_EQ(run(folder, "model x out -settings mine.txt -reconstruct.depth 4").status, 0);
  EXPECT_EQ(depthOf(), 4);
  const Outcome unknown = run(folder, command + "-reconstruct.depht 5 -quiet");
  EXPECT_EQ(unknown.status, 1);
  EXPECT_NE(unknown.err.find("reconstruct.depth"), std::string::npos) << unknown.err;
  put(folder + "/bad.txt", "cell abc\n");
  EXPECT_EQ(run(folder, "model x out -settings bad.txt").status, 2);
}
} // namespace
} // namespace fresco::test
