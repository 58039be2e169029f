// SPDX-License-Identifier: BSD-3-Clause
// What the fuzzer starts from and what it once found, read again.
#include "generator.h"
#include "input/model_input.h"
#include "layouts.h"
#include "seeds.h"
#include "targets.h"
#include "test_data.h"
#include <algorithm>
#include <chrono>
#include <fresco/core/parallel.h>
#include <fresco/io/camera_files.h>
#include <fresco/io/file.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <set>
namespace {
using namespace fresco;
namespace fs = std::filesystem;

std::vector<std::string> filesIn(const std::string& folder)
{
  std::vector<std::string> files;
  if (fs::is_directory(folder))
    for (const auto& entry : fs::directory_iterator(folder))
      files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

/// Every input is read in time and neither crashes nor breaks what the readers promise.
void replay(const fuzz::Target& target, const std::string& inputs, const std::string& scratch)
{
  fs::create_directories(scratch);
  for (const std::string& file : filesIn(inputs)) {
    SCOPED_TRACE(file);
    const auto start = std::chrono::steady_clock::now();
    EXPECT_NO_THROW(target.run(readFile(file), scratch));
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_LT(seconds, 10.0);
  }
}

TEST(Fuzz, SeedsAreRead)
{
  const std::string folder = test::scratchFolder();
  fuzz::writeSeeds(folder + "/seeds");
  for (const fuzz::Target& target : fuzz::targets()) {
    EXPECT_FALSE(filesIn(folder + "/seeds/" + target.name).empty()) << target.name;
    replay(target, folder + "/seeds/" + target.name, folder + "/scratch");
  }
}

TEST(Fuzz, FindingsStayFixed)
{
  const std::string folder = test::scratchFolder();
  const std::string findings = test::projectFolder() + "/test/fuzz/findings";
  for (const fuzz::Target& target : fuzz::targets())
    replay(target, findings + "/" + target.name, folder);
  for (const std::string& known : filesIn(findings))
    if (fs::is_directory(known)) {
      EXPECT_NO_THROW(fuzz::findTarget(fs::path(known).filename().string()));
    }
}

/// Files of the generator are read; with one thing broken they are read or refused.
TEST(Fuzz, GeneratedFilesAreReadOrRefused)
{
  const std::string folder = test::scratchFolder();
  setDefaultThreads(1);
  for (const fuzz::Target& target : fuzz::targets()) {
    fs::create_directories(folder + "/seeds/" + target.name);
    for (std::uint32_t seed = 0; seed < 100; ++seed) {
      SCOPED_TRACE(target.name + " " + std::to_string(seed));
      const fuzz::GeneratedFile file = fuzz::generated(target.name, seed);
      if (file.parts.empty())
        break;
      const std::string bytes = file.packed();
      EXPECT_NO_THROW(target.run(bytes, folder));
      EXPECT_NO_THROW(target.run(fuzz::broken(file, seed), folder));
      EXPECT_NO_THROW(target.run(fuzz::broken(bytes, seed), folder));
    }
  }
  setDefaultThreads(0);
}

TEST(Fuzz, GeneratedFilesAreValid)
{
  const std::string folder = test::scratchFolder();
  for (const std::string format : {"ply", "vtk", "stl", "obj"})
    for (std::uint32_t seed = 0; seed < 50; ++seed) {
      const std::string path = folder + "/a." + format;
      writeFile(path, fuzz::generated(format, seed).packed());
      EXPECT_NO_THROW(readMesh(path)) << format << ' ' << seed;
    }
  for (const std::string format : {"pcd", "xyz", "ptx", "pts", "las"})
    for (std::uint32_t seed = 0; seed < 50; ++seed) {
      const std::string path = folder + "/a." + format;
      writeFile(path, fuzz::generated(format, seed).packed());
      EXPECT_NO_THROW(readPoints(path)) << format << ' ' << seed;
    }
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    writeFile(folder + "/a.glb", fuzz::generated("glb", seed).packed());
    EXPECT_NO_THROW(readTexturedMesh(folder + "/a.glb")) << seed;
  }
}

TEST(Fuzz, GeneratedCamerasAreValid)
{
  const std::string folder = test::scratchFolder();
  std::set<std::string> programs;
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    const std::string bytes = fuzz::generated("cameras", seed).packed();
    std::string_view content = bytes;
    const std::string path = folder + "/cameras" + std::string(fuzz::takePart(content));
    programs.insert(std::string(content.substr(0, 12)));
    fuzz::findTarget("cameras").run(bytes, folder); // which writes the photographs
    EXPECT_NO_THROW(EXPECT_EQ(readCameraFile(path, folder + "/images").set.views.size(), 2u)) << content;
  }
  EXPECT_GE(programs.size(), 5u);
}

TEST(Fuzz, LayoutsAreUnderstood)
{
  const std::string folder = test::scratchFolder();
  for (const auto& [name, input] : fuzz::layouts()) {
    fuzz::writeFolder(input, folder + "/" + name);
    EXPECT_NO_THROW(model::readModelInput(folder + "/" + name)) << name;
  }
}

TEST(Fuzz, EmptyInputIsNoProblem)
{
  const std::string folder = test::scratchFolder();
  for (const fuzz::Target& target : fuzz::targets())
    EXPECT_NO_THROW(target.run("", folder)) << target.name;
  EXPECT_THROW(fuzz::findTarget("nothing"), std::invalid_argument);
}
} // namespace
