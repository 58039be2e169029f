// SPDX-License-Identifier: BSD-3-Clause
#include "input/model_input.h"
#include "input/rgbd.h"
#include "report/report.h"
#include "stages/fusion.h"
#include "stages/placed_points.h"
#include "test_data.h"
#include "viewer/viewer.h"
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <fstream>
namespace {
using namespace fresco;
using namespace fresco::model;
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

TEST(Fusion, SamplesOfOneSurfaceBecomeOneAndBothSidesOfASheetStayTwo)
{
  PointSet set;
  set.points = 0.3f * (Points::Random(3, 20000).array() + 1.f).matrix();
  set.points.row(2) = 0.0015f * Eigen::RowVectorXf::Random(20000).array() + 0.005f;
  set.normals = Points::Zero(3, 20000);
  set.normals.row(2).setOnes();
  PointFusion fusion(0.01);
  fusion.add(set);
  const PointSet one = fusion.result();
  EXPECT_LE(one.size(), 61 * 61);
  EXPECT_NEAR(one.confidences.sum(), 20000.f, 1.f);
  EXPECT_LT((one.points.row(2).array() - 0.005f).abs().maxCoeff(), 0.0015f);
  set.normals *= -1.f;
  fusion.add(set);
  EXPECT_EQ(fusion.result().size(), 2 * one.size());
  EXPECT_THROW(PointFusion(0.0), std::invalid_argument);
}

TEST(Fusion, OptimisationGetsNoMorePointsThanVerticesCanUse)
{
  PointSet set; // a square of 0.6 m, cells of 2 cm: about 900 vertices
  set.points = 0.3f * Points::Random(3, 50000);
  set.points.row(2) = 0.001f * Eigen::RowVectorXf::Random(50000);
  set.normals = Points::Zero(3, 50000);
  set.normals.row(2).setOnes();
  set.viewpoints = set.points;
  set.origin = {1000, 2000, 3000};
  const PlacedPoints placed(test::scratchFolder() + "/points");
  placed.clear();
  placed.write(0, set);
  const PointSet same = pointsForVertices(*placed.stream(), 4000, 0.02);
  EXPECT_LT(((same.points - set.points).cast<double>().colwise() + (same.origin - set.origin)).norm(), 1e-2);
  EXPECT_EQ(same.size(), set.size());
  const PointSet thinned = pointsForVertices(*placed.stream(), 900, 0.02);
  EXPECT_LE(thinned.size(), 2 * 92 * 92); // two layers of cells meet at z = 0
  EXPECT_GT(thinned.size(), 90 * 90);
  EXPECT_EQ(thinned.origin, same.origin);
  EXPECT_NEAR(thinned.confidences.sum(), 50000.f, 1.f);
  EXPECT_NEAR(thinned.points.row(2).mean() + thinned.origin.z(), set.origin.z(), 1e-4);
}

TEST(PlacedPoints, AreTheSameInWindowsAndAsFiles)
{
  PointSet a, b;
  a.points = Points::Random(3, 1000);
  b.points = Points::Random(3, 500);
  a.normals = a.points.colwise().normalized();
  b.normals = b.points.colwise().normalized();
  a.viewpoints = Eigen::Vector3f(1, 2, 3);
  b.viewpoints = Eigen::Vector3f(3, 2, 1);
  a.colors = Colors::Constant(3, 1000, 7);
  const PlacedPoints placed(test::scratchFolder() + "/points");
  placed.clear();
  EXPECT_THROW(placed.stream(), std::runtime_error);
  placed.write(11, b); // the order is that of the scans
  placed.write(2, a);
  const PointSet both = mergePoints(a, b);
  const PointSet all = placed.sample(1500);
  EXPECT_EQ(all.points, both.points);
  EXPECT_EQ(all.normals, both.normals);
  EXPECT_EQ(all.viewpoints, both.viewpoints);
  EXPECT_EQ(all.colors.cols(), 0);
  PointSet streamed;
  placed.stream()->read([&](const PointSet& window) { appendPoints(streamed, window); });
  EXPECT_EQ(streamed.points, both.points);
  EXPECT_EQ(countPoints(*placed.stream()), 1500);
  placed.clear();
  EXPECT_THROW(placed.forEach([](const PointSet&) {}), std::runtime_error);
}

TEST(PlacedPoints, SamplesAreEven)
{
  PointSet near, far; // 20,000 points on one side of a square, 2,000 on the other
  near.points = Points::Random(3, 20000).cwiseProduct(Eigen::Vector3f(0.5f, 1, 0).replicate(1, 20000));
  near.points.row(0).array() -= 0.5f;
  far.points = Points::Random(3, 2000).cwiseProduct(Eigen::Vector3f(0.5f, 1, 0).replicate(1, 2000));
  far.points.row(0).array() += 0.5f;
  const PlacedPoints placed(test::scratchFolder() + "/even");
  placed.clear();
  placed.write(0, near);
  placed.write(1, far);
  const PointSet sample = placed.sample(6000);
  EXPECT_LE(sample.size(), 6000);
  EXPECT_GT(sample.size(), 5500);
  EXPECT_GT((sample.points.row(0).array() > 0).count(), 1900); // almost all; every fourth were 500
  EXPECT_LE(placed.sample(3).size(), 3);
  EXPECT_EQ(placed.sample(22000).size(), 22000);
}

struct TwoStages {
  std::string folder;
  int runs_a = 0, runs_b = 0;

  std::vector<StageRecord> run(const std::string& key, const std::string& option, bool resume)
  {
    StageLog log(folder + "/work", {key}, resume, {});
    const auto write = [](const std::string& path, int& count) {
      ++count;
      OutputFile file(path);
      file.write("result");
      file.commit();
      return Json{{"answer", 42}};
    };
    log.run({"a", option, {folder + "/a"}, [&](const Progress&) { return write(folder + "/a", runs_a); }});
    log.run({"b", "", {folder + "/b"}, [&](const Progress&) { return write(folder + "/b", runs_b); }});
    return log.records();
  }
};

TEST(Stages, ProgramFilesAreTheProgramAndItsLibraries)
{
  const std::vector<std::string> files = programFiles();
  EXPECT_EQ(fs::path(files.at(0)).filename(), "test_model");
  for (const std::string& file : files)
    EXPECT_TRUE(fs::is_regular_file(file)) << file;
}

TEST(Stages, ResumeTakesOverOnlyWhatIsStillValid)
{
  TwoStages job{test::scratchFolder()};
  job.run("input", "x", false);
  EXPECT_EQ(job.runs_a + job.runs_b, 2);
  const auto records = job.run("input", "x", true);
  EXPECT_EQ(job.runs_a + job.runs_b, 2);
  EXPECT_TRUE(records[0].resumed && records[1].resumed);
  EXPECT_EQ(records[0].figures["answer"], 42);
  job.run("input", "x", false); // not asked to resume
  EXPECT_EQ(job.runs_a + job.runs_b, 4);
  fs::remove(job.folder + "/b");
  job.run("input", "x", true);
  EXPECT_EQ(job.runs_a, 2);
  EXPECT_EQ(job.runs_b, 3);
  job.run("input", "y", true); // another option of a: b depends on it
  EXPECT_EQ(job.runs_a, 3);
  EXPECT_EQ(job.runs_b, 4);
  job.run("other input", "y", true);
  EXPECT_EQ(job.runs_a, 4);
  std::ofstream(job.folder + "/work/a.json") << "{ broken";
  job.run("other input", "y", true);
  EXPECT_EQ(job.runs_a, 5);
}

TEST(Stages, AStageThatLostAFileOfItsFolderIsMadeAnew)
{
  const std::string folder = test::scratchFolder(), points = folder + "/points";
  const auto isResumed = [&] {
    StageLog log(folder + "/work", {"input"}, true, {});
    log.run({"a", "", {points}, [&](const Progress&) {
               fs::create_directories(points);
               std::ofstream(points + "/1") << "one";
               std::ofstream(points + "/2") << "two";
               return Json();
             }});
    return log.records().at(0).resumed;
  };
  EXPECT_FALSE(isResumed());
  EXPECT_TRUE(isResumed());
  fs::remove(points + "/1");
  EXPECT_FALSE(isResumed());
  EXPECT_TRUE(fs::exists(points + "/1"));
}

TEST(Report, SummaryOfAStageIsOneLineForPeople)
{
  StageRecord stage;
  stage.name = "surface";
  stage.seconds = 1.25;
  stage.cpu_seconds = 2.5;
  stage.peak_megabytes = 300.2;
  stage.resumed = true;
  stage.figures = {{"vertices", 85709}, {"cell", 0.0200004}, {"seconds", {{"solve", 1.0}}}, {"up", {0, 0, 1}}};
  const ModelReport report = publicReport({"", "", {stage}, {}, Eigen::Vector3d::UnitZ(), 0});
  EXPECT_EQ(stageSummary(report.stages.at(0)),
            "surface (earlier run): 1.2 s, 2.5 s of CPU, 300 MB, vertices 85709, cell 0.02");
}

TEST(Report, IsWholeAndEscaped)
{
  const ModelFiles files{test::scratchFolder()};
  makeFolder(files.snapshots);
  writeImage(files.snapshots + "/p.png", Image(8, 8));
  StageRecord stage;
  stage.name = "pictures";
  stage.figures = {{"coverage", 0.5}, {"note", "<b>"}};
  makeFolder(files.work);
  TexturedMesh model;
  model.mesh.vertices = Points::Identity(3, 3);
  model.mesh.faces = Faces(3, 1);
  model.mesh.faces << 0, 1, 2;
  model.texcoord_faces = Faces::Constant(3, 1, -1);
  model.face_atlas = Eigen::VectorXi::Constant(1, -1);
  writeTexturedMesh(files.viewer_glb, model);
  writeMesh(files.mesh, model.mesh);
  writeFile(files.poses, "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n");
  Report content;
  content.input = "a<b>";
  content.stages = {stage};
  content.pictures = {{"snapshots/p.png", "title"}};
  content.seconds = 1.5;
  writeReport(content, files);
  const std::string html = readFile(files.report_html);
  EXPECT_NE(html.find("data:image/jpeg;base64,/9j/"), std::string::npos);
  EXPECT_NE(html.find("name=\"viewport\""), std::string::npos);
  EXPECT_NE(html.find("<a href=\"mesh.ply\">"), std::string::npos);
  EXPECT_NE(html.find("a&lt;b&gt;"), std::string::npos);
  EXPECT_EQ(html.find("<b>\""), std::string::npos);
  EXPECT_NE(html.find("fresco-viewer"), std::string::npos);
  const Json json = Json::parse(readFile(files.report_json));
  EXPECT_EQ(json["stages"][0]["figures"]["coverage"], 0.5);
  EXPECT_EQ(json["pictures"][0]["file"], "snapshots/p.png");
  content.stages[0].name = "surface"; // asked to end there
  content.pictures.clear();
  writeReport(content, files);
  const std::string part = readFile(files.report_html);
  EXPECT_EQ(part.find("fresco-viewer"), std::string::npos);
  EXPECT_NE(part.find("surface.ply"), std::string::npos);
}

TEST(RgbdFolder, RealRoomIsRead)
{
  FRESCO_NEED_DATA("room7");
  const RgbdFolder room = *readModelInput(test::dataFolder() + "/room7").rgbd;
  EXPECT_EQ(room.frames.size(), 100U);
  EXPECT_EQ(room.camera.width, 640);
  EXPECT_EQ(room.camera.fx, 585.0);
  const DepthImage depth = readDepth(room, 50);
  EXPECT_EQ(depth.cols(), 640);
  EXPECT_GT((depth > 0.f).count(), depth.size() / 2);
  EXPECT_TRUE((depth == 0.f || (depth >= 0.3f && depth <= 4.f)).all());
  const double footprint = pixelFootprint(room); // a room is seen from 1 to 3 m
  EXPECT_GT(footprint, 1.0 / 585);
  EXPECT_LT(footprint, 3.0 / 585);
}

TEST(StageLog, NamesOfAnyBytes)
{
  const std::string folder = test::scratchFolder(), name = "scan\xff\xfe.pcd";
  StageLog log(folder + "/work", {name}, false, {});
  log.run({"stage", name, {}, [&](const Progress&) { return Json{{"warnings", {name + ": dark"}}}; }});
  EXPECT_TRUE(Json::parse(readFile(folder + "/work/stage.json"), nullptr, false).contains("figures"));
  const std::string html = escapedHtml(name + "<&\"");
  EXPECT_EQ(html, "scan\xef\xbf\xbd\xef\xbf\xbd.pcd&lt;&amp;&quot;");
}

TEST(ModelInput, PhotographsAreLookedAtBeforeTheWork)
{
  const std::string folder = test::scratchFolder();
  fs::create_directory(folder + "/images");
  ModelInput input;
  input.images = folder + "/images";
  input.cameras.cameras = {{64, 48, 60, 60, 32, 24, 0, 0, 0, 0}};
  for (const char* name : {"a.png", "b.png"}) {
    writeImage(input.images + "/" + name, Image(64, 48));
    View view;
    view.image = name;
    input.cameras.views.push_back(view);
  }
  EXPECT_NO_THROW(checkPhotographs(input, 2));
  writeImage(input.images + "/b.png", Image(48, 64));
  EXPECT_THROW(checkPhotographs(input, 2), std::runtime_error);
  std::ofstream(input.images + "/b.png") << "damaged";
  EXPECT_THROW(checkPhotographs(input, 2), std::runtime_error);
}
} // namespace
