// SPDX-License-Identifier: BSD-3-Clause
// fresco_model -resume with every kind of input and output touched, damaged, emptied and lost; -until.
#include "test_data.h"
#include "tools/layout_source.h"
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
namespace fresco::test {
namespace {
const std::string small = " -cell 0.1 -size 160x120 -quiet";

/// Stages of the last run that were not taken over from an earlier one.
std::vector<std::string> made(const std::string& out)
{
  std::vector<std::string> names;
  const nlohmann::json report = nlohmann::json::parse(get(out + "/report.json"));
  for (const auto& stage : report["stages"])
    if (!stage["resumed"].get<bool>())
      names.push_back(stage["name"]);
  return names;
}

/// The same bytes in a file of another number and time.
void touch(const std::string& file)
{
  const std::string bytes = get(file);
  fs::remove(file);
  put(file, bytes);
}

/// Another byte in its middle; its size and the time that can be set stay.
void damage(const std::string& file)
{
  const auto time = fs::last_write_time(file);
  std::string bytes = get(file);
  char& middle = bytes.at(bytes.size() / 2);
  middle = static_cast<char>(middle == '1' ? '2' : middle >= '0' && middle <= '9' ? '1' : middle ^ 1);
  put(file, bytes);
  fs::last_write_time(file, time);
}

/// The first file of each folder and extension, and each text file.
std::vector<std::string> kindsIn(const std::string& folder)
{
  std::map<std::string, std::string> kinds;
  for (const std::string& file : listing(folder)) {
    const fs::path path(file);
    kinds.emplace(path.parent_path().string() + (path.extension() == ".txt" || path.extension() == ".csv" ||
                                                         path.filename().string().find(".pose.") != std::string::npos
                                                     ? path.filename().string()
                                                     : path.stem().extension().string() + path.extension().string()),
                  file);
  }
  std::vector<std::string> files;
  for (const auto& [kind, file] : kinds)
    files.push_back(file);
  return files;
}

class ResumeOf : public Inputs, public testing::WithParamInterface<std::string> {};

TEST_P(ResumeOf, BelievesNoInputThatChangedAndEachThatDidNot)
{
  const std::set<std::string> not_read = {"rigs.txt",     "frames.txt",   "intrinsic_color.txt",
                                          "0f37bd07.obj", "0f37bd07.mtl", "0f37bd07_000.jpg"};
  const std::string folder = laidOut(GetParam()), command = std::string("model x out -until points") +
                                                            (GetParam() == "flat_pcd" ? "" : " -use_poses") + small;
  ASSERT_EQ(run(folder, command).status, 0);
  fs::copy(folder + "/out", folder + "/good", fs::copy_options::recursive);
  ASSERT_EQ(run(folder, command + " -resume").status, 0);
  EXPECT_TRUE(made(folder + "/out").empty());
  for (const std::string& file : kindsIn(folder + "/x")) {
    if (not_read.count(fs::path(file).filename()) > 0)
      continue;
    const std::string before = get(file);
    touch(file);
    EXPECT_EQ(run(folder, command + " -resume").status, 0) << file;
    EXPECT_TRUE(made(folder + "/out").empty()) << file << " was touched";
    damage(file);
    const Outcome outcome = run(folder, command + " -resume");
    EXPECT_TRUE(outcome.status == 1 || !made(folder + "/out").empty()) << file << " was damaged";
    put(file, before);
    fs::remove_all(folder + "/out");
    fs::copy(folder + "/good", folder + "/out", fs::copy_options::recursive);
  }
}

INSTANTIATE_TEST_SUITE_P(All, ResumeOf,
                         testing::Values("flat_pcd", "cloud_times", "cloud_utm", "e57", "matterpak", "scanner_export",
                                         "colmap", "seven_scenes", "tum", "open3d", "scannet", "stray", "polycam",
                                         "matterport"),
                         [](const auto& test) { return test.param; });

class Resume : public Inputs {};

TEST_F(Resume, AddedInputsAreSeen)
{
  const std::string folder = laidOut("flat_pcd"), command = "model x out -until points -as scans" + small;
  fs::copy(folder + "/x/station1.pcd", folder + "/x/station3.pcd");
  fs::remove(folder + "/x/station2.pcd");
  ASSERT_EQ(run(folder, command).status, 0);
  put(folder + "/x/notes.md", "of nobody's interest");
  ASSERT_EQ(run(folder, command + " -resume").status, 0);
  EXPECT_TRUE(made(folder + "/out").empty());
  put(folder + "/x/poses.txt", "1 0 0 9  0 1 0 0  0 0 1 0  0 0 0 1\n1 0 0 9  0 1 0 0  0 0 1 0  0 0 0 1\n");
  ASSERT_EQ(run(folder, command + " -resume").status, 0);
  EXPECT_EQ(made(folder + "/out"), std::vector<std::string>{"points"});
  EXPECT_EQ(get(folder + "/out/poses.txt").substr(0, 7), "1 0 0 9");
}

/// Of a whole run, photographs included: what is damaged, emptied or lost comes back as it was, and nothing before it is made anew.
TEST_F(Resume, EveryOutputComesBack)
{
  const std::string folder = scratchFolder(),
                    command = "model '" + sourceFolder() + "' out -use_poses -texture.refine 0" + small;
  ASSERT_EQ(run(folder, command).status, 0);
  const std::function<void(const std::string&)> harms[] = {damage,
                                                           [](const std::string& file) { fs::resize_file(file, 0); },
                                                           [](const std::string& file) { fs::remove(file); }};
  int count = 0;
  for (const std::string& file : listing(folder + "/out")) {
    const std::string extension = fs::path(file).extension().string();
    if (extension == ".json" || extension == ".html" || fs::path(file).filename() == "settings.txt" ||
        fs::path(file).filename() == ".lock")
      continue; // of times; or written by every run
    const std::string before = get(file);
    harms[count++ % 3](file);
    ASSERT_EQ(run(folder, command + " -resume").status, 0) << file;
    EXPECT_TRUE(get(file) == before) << file << " did not come back";
    const bool by_every_run = fs::path(file).stem() == "plan";
    EXPECT_EQ(made(folder + "/out").empty(), by_every_run) << file;
  }
  EXPECT_GT(count, 15);
  EXPECT_EQ(run(folder, command + " -resume").status, 0);
  EXPECT_TRUE(made(folder + "/out").empty());
}

/// It ends there, says so, leaves the file that was asked for, and a later run takes over all that is done.
TEST_F(Resume, UntilEndsThereAndALaterRunGoesOn)
{
  const std::string folder = scratchFolder(),
                    command = "model '" + sourceFolder() + "' out -use_poses -texture.refine 0" + small;
  std::vector<std::string> expected;
  for (const auto& [until, file, stage] : {std::tuple{"points", "points.ply", "points"},
                                           {"surface", "surface.ply", "surface"},
                                           {"mesh", "mesh.ply", "optimization"}}) {
    const std::string asked = command + " -resume -until " + until;
    EXPECT_NE(run(folder, asked + " -dry_run").out.find(std::string(stage) + ";"), std::string::npos) << until;
    ASSERT_EQ(run(folder, asked).status, 0) << until;
    EXPECT_EQ(made(folder + "/out"), std::vector<std::string>{stage}); // those before were there
    EXPECT_TRUE(fs::exists(folder + "/out/" + file)) << file;
    EXPECT_FALSE(fs::exists(folder + "/out/model.glb"));
    EXPECT_NE(get(folder + "/out/report.html").find(file), std::string::npos) << file;
  }
  const PointSet points = readPoints(folder + "/out/points.ply");
  EXPECT_TRUE(points.hasNormals());
  EXPECT_GT(points.size(), 1000);
  EXPECT_EQ(get(folder + "/out/surface.ply"), get(folder + "/out/work/surface.ply"));
  ASSERT_EQ(run(folder, command + " -resume").status, 0);
  EXPECT_EQ(made(folder + "/out"), (std::vector<std::string>{"alignment", "texture", "light", "pictures"}));
  EXPECT_TRUE(fs::exists(folder + "/out/model.glb"));
  const Outcome wrong = run(folder, command + " -until nothing");
  EXPECT_EQ(wrong.status, 1);
  EXPECT_NE(wrong.err.find("points, surface, mesh"), std::string::npos) << wrong.err;
}
} // namespace
} // namespace fresco::test
