// SPDX-License-Identifier: BSD-3-Clause
// What every tool promises about its command line and its outputs: ranges, collisions, devices and pipes, names of any
// bytes, two processes at once.
#include "tools/tool_runs.h"
#include <chrono>
#include <csignal>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>
namespace {
using namespace fresco;
using namespace fresco::test;

/// Exit status of a command, with what it says at hand.
void expectStatus(const std::string& folder, const std::string& command, int status)
{
  const Outcome outcome = run(folder, command);
  EXPECT_EQ(outcome.status, status) << command << "\n" << outcome.err;
}

/// An option that takes numbers, as the help of its tool shows it.
struct NumberOption {
  std::string name, range;         ///< range: none where the help says none
  std::vector<std::string> beyond; ///< values next to the range, as they stand on a command line
};

/// What `bound` moved outwards by the least that matters is on a command line.
std::string beyond(const std::string& placeholders, double bound, int direction)
{
  const bool whole = std::regex_match(placeholders, std::regex("N|WxH|R G B|K SIGMA"));
  const std::string value =
      concat(std::setprecision(12), bound + direction * (whole ? 1 : 0.001 + 0.001 * std::abs(bound)));
  if (placeholders == "WxH")
    return value + "x" + value;
  std::istringstream words(placeholders);
  std::string line;
  for (std::string word; words >> word;)
    line += " " + (word == "AXIS" ? "x" : word == "SIGMA" ? "1" : value);
  return line;
}

NumberOption numberOption(const std::string& name, const std::string& placeholders, const std::string& text)
{
  static const std::string number = "(-?[0-9.]+)";
  static const std::regex range("\\((?:[A-Z]+ )?(any number|" + number + "\\.\\." + number + "|(at least|above) " +
                                number + "(?: and (below|at most) " + number + ")?)([^()]*)\\)$");
  NumberOption option{name, "", {}};
  std::smatch found;
  if (!std::regex_search(text, found, range))
    return option;
  option.range = found[1];
  const std::string low = found[2].str() + found[5].str(), high = found[3].str() + found[7].str();
  const bool or_zero = found[8].str().rfind("; 0 = ", 0) == 0;
  if (!low.empty())
    option.beyond.push_back(beyond(placeholders, or_zero ? std::min(0., std::stod(low)) : std::stod(low), -1));
  if (!high.empty())
    option.beyond.push_back(beyond(placeholders, std::stod(high), 1));
  return option;
}

/// Options of a tool that take numbers, from its help.
std::vector<NumberOption> numberOptions(const std::string& help)
{
  const std::regex others("|TEXT|FILE|NAMES?(\\[.*)?");
  std::vector<NumberOption> options;
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("  -", 0) != 0)
      continue;
    std::istringstream left(line.substr(0, 28));
    std::string name, placeholders, word;
    for (left >> name; left >> word;)
      placeholders += (placeholders.empty() ? "" : " ") + word;
    if (line.size() <= 28) // names that are too long have their text below
      std::getline(lines, line);
    if (!std::regex_match(placeholders, others))
      options.push_back(numberOption(name, placeholders, line));
  }
  return options;
}

TEST(Usage, EveryNumberHasARangeThatHoldsOrIsSaidToBeFree)
{
  const std::string folder = soundFolder();
  for (const std::string& tool : tools()) {
    const std::vector<NumberOption> options = numberOptions(run(folder, tool + " -h").out);
    EXPECT_FALSE(options.empty()) << tool;
    for (const NumberOption& option : options) {
      EXPECT_FALSE(option.range.empty()) << tool << " " << option.name;
      EXPECT_EQ(option.beyond.empty(), option.range == "any number") << tool << " " << option.name;
      for (const std::string& value : option.beyond) {
        const Outcome outcome = run(folder, tool + " " + option.name + " " + value);
        EXPECT_EQ(outcome.status, 2) << tool << " " << option.name << " " << value;
        EXPECT_NE(outcome.err.find("out of range: " + option.range), std::string::npos) << outcome.err;
      }
    }
  }
}

/// fresco_model -STAGE.OPTION takes what the tool of the stage takes, and says so before anything is read.
TEST(Usage, OptionsOfStagesHaveTheRangesOfTheirTools)
{
  const std::string folder = soundFolder();
  int same = 0;
  for (const std::string tool :
       {"register", "filter", "normals", "track", "reconstruct", "optimize", "align", "texture"}) {
    const std::string known = run(folder, "model missing out -" + tool + ".none 1").err;
    for (const NumberOption& option : numberOptions(run(folder, tool + " -h").out)) {
      const std::string name = tool + "." + option.name.substr(1);
      if (!std::regex_search(known, std::regex(" " + name + "[,\\n]")))
        continue;
      ++same;
      for (const std::string& value : option.beyond) {
        const Outcome outcome = run(folder, "model missing out -" + name + " " + value);
        EXPECT_EQ(outcome.status, 1) << name << " " << value;
        EXPECT_NE(outcome.err.find("out of range: " + option.range), std::string::npos) << outcome.err;
      }
    }
  }
  EXPECT_GT(same, 20);
}

TEST(Usage, NumbersOutOfRangeAreWrongBeforeAnythingIsRead)
{
  const std::string folder = soundFolder();
  expectStatus(folder, "filter missing.pcd out.pcd -voxel 0", 2);
  expectStatus(folder, "normals missing.pcd out.pcd -sigma_n 0", 2);
  expectStatus(folder, "register missing.pcd -o out -min_overlap 0", 2);
  expectStatus(folder, "model missing out -size 100x100", 2);
  expectStatus(folder, "model missing out -size 130x130", 2);
  expectStatus(folder, "scan missing.ply out -images 10x1000", 2);
}

TEST(Usage, EveryToolTellsItsVersion)
{
  const std::string folder = soundFolder();
  for (const std::string& tool : tools()) {
    const Outcome outcome = run(folder, tool + " --version");
    EXPECT_EQ(outcome.status, 0) << tool;
    EXPECT_TRUE(std::regex_match(outcome.out, std::regex("fresco [0-9]+\\.[0-9]+\\.[0-9]+( with .*[0-9])?\n")))
        << outcome.out;
  }
  const auto expectNamed = [&](const std::string& tool, const std::string& library) {
    const std::string line = run(folder, tool + " --version").out;
    EXPECT_TRUE(std::regex_search(line, std::regex(library + " [0-9]+\\.[0-9]+"))) << line;
  };
  expectNamed("filter", "PCL");
  for (const char* library : {"Embree", "OpenCV", "VTK"})
    expectNamed("model", library);
}

TEST(Usage, OutputsCollideNeitherWithEachOtherNorWithInputs)
{
  const std::string folder = soundFolder();
  fs::create_directories(folder + "/in/scans");
  fs::create_symlink(folder, folder + "/same");
  const auto before = listing(folder);
  for (const char* command :
       {"filter cloud.pcd cloud.pcd", "filter cloud.pcd ./images/../cloud.pcd", "filter cloud.pcd same/cloud.pcd",
        "normals cloud.pcd cloud.pcd", "reconstruct mesh.ply mesh.ply",
        "optimize mesh.ply cloud.pcd out.ply -report out.ply", "optimize mesh.ply cloud.pcd out.ply -report cloud.pcd",
        "compare mesh.ply mesh.ply -json mesh.ply", "compare mesh.ply mesh.ply -colored a.ply -json a.ply",
        "snapshot mesh.ply out.png -shading flat,flat", "register cloud.pcd -o . -poses poses.txt",
        "texture mesh.ply cameras images images/a.obj", "model in in", "model in in/scans"})
    expectStatus(folder, command, 2);
  EXPECT_EQ(listing(folder), before);
  // The picture would replace the texture of the model that it shows.
  put(folder + "/model.obj",
      "mtllib model.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n");
  put(folder + "/model.mtl", "newmtl m\nmap_Kd model.png\n");
  writeImage(folder + "/model.png", Image(4, 4, 3, 200));
  const std::string texture = get(folder + "/model.png");
  expectStatus(folder, "snapshot model.obj model.png -shading texture -size 64x48", 2);
  EXPECT_EQ(get(folder + "/model.png"), texture);
}

TEST(Usage, WhatFollowsTwoDashesAreFiles)
{
  const std::string folder = soundFolder();
  fs::copy(folder + "/cloud.pcd", folder + "/-h.pcd");
  expectStatus(folder, "filter -quiet -- -h.pcd -out.pcd", 0);
  EXPECT_TRUE(fs::exists(folder + "/-out.pcd"));
}

TEST(Usage, StandardOutputThatIsFull)
{
  const std::string folder = soundFolder(), bin = buildFolder() + "/bin/fresco_";
  for (const std::string command :
       {"filter -h", "model -h", "compare mesh.ply mesh.ply -quiet", "reconstruct cloud.pcd out.ply -estimate"}) {
    const int status = std::system(("cd '" + folder + "' && '" + bin + command.substr(0, command.find(' ')) + "'" +
                                    command.substr(command.find(' ')) + " >/dev/full 2>.log.err")
                                       .c_str());
    EXPECT_EQ(WEXITSTATUS(status), 1) << command;
    EXPECT_NE(get(folder + "/.log.err").find("standard output"), std::string::npos) << command;
  }
}

TEST(Usage, OnlyFilesAreReplaced)
{
  const std::string folder = soundFolder();
  ASSERT_EQ(mkfifo((folder + "/pipe.ply").c_str(), 0600), 0);
  fs::create_symlink("/dev/null", folder + "/null.ply"); // never the device itself: a test may run as root
  fs::create_symlink(folder + "/mesh.ply", folder + "/link.ply");
  const std::string mesh = get(folder + "/mesh.ply");
  for (const std::string name : {"pipe.ply", "null.ply", "link.ply"}) {
    expectRefused(folder, "reconstruct cloud.pcd " + name + " -depth 4", name);
  }
  EXPECT_TRUE(fs::is_fifo(folder + "/pipe.ply") && fs::is_symlink(folder + "/null.ply"));
  EXPECT_EQ(get(folder + "/mesh.ply"), mesh);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(Usage, PipesAsInputAreRefusedAtOnce)
{
  const std::string folder = soundFolder();
  for (const char* name : {"pipe.ply", "pipe.pcd", "pipe.stl", "pipe.xyz", "pipe.e57", "pipe.ptx", "pipe.las"})
    ASSERT_EQ(mkfifo((folder + "/" + name).c_str(), 0600), 0);
  const auto start = std::chrono::steady_clock::now();
  for (const char* command : {"filter pipe.pcd out.pcd", "filter pipe.e57 out.pcd", "filter pipe.las out.pcd",
                              "compare pipe.stl mesh.ply", "register pipe.xyz -o out", "register pipe.ptx -o out"})
    expectRefused(folder, command, "pipe");
  fs::remove(folder + "/images/a.png");
  ASSERT_EQ(mkfifo((folder + "/images/a.png").c_str(), 0600), 0);
  expectRefused(folder, "texture mesh.ply cameras images out.obj", "a.png");
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 10.0);
}

TEST(Usage, NoEmptyFolderAfterAnError)
{
  const std::string folder = soundFolder();
  expectRefused(folder, "register missing.pcd -o new/out", "missing.pcd");
  expectRefused(folder, "scan noise.ply new/out", "noise.ply");
  EXPECT_FALSE(fs::exists(folder + "/new"));
}

TEST(Usage, NamesOfAnyBytes)
{
  const std::string folder = soundFolder(), name = "scan\xff\xfe\x1b[31m.pcd";
  fs::copy(folder + "/cloud.pcd", folder + "/" + name);
  expectStatus(folder, "register '" + name + "' -o out -quiet", 0);
  EXPECT_FALSE(get(folder + "/out/poses.txt").empty());
  const std::string json = get(folder + "/out/registration.json");
  EXPECT_TRUE(nlohmann::json::parse(json, nullptr, false).contains("scans"));
  put(folder + "/" + name, "damaged");
  const Outcome outcome = run(folder, "filter '" + name + "' out.pcd");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.err.find('\x1b'), std::string::npos);
  EXPECT_NE(outcome.err.find("scan\xff\xfe?[31m.pcd"), std::string::npos) << outcome.err;
}

TEST(Usage, DamagedPhotographsAreNamedInOneLine)
{
  const std::string folder = soundFolder();
  writeImage(folder + "/images/a.jpg", Image(64, 48, 3, 90));
  put(folder + "/cameras/images.txt", "1 1 0 0 0 0 0 4 1 a.jpg\n\n");
  std::string bytes = get(folder + "/images/a.jpg");
  bytes.replace(bytes.size() - 20, 10, std::string(10, '\x55'));
  put(folder + "/images/a.jpg", bytes);
  expectRefused(folder, "texture mesh.ply cameras images out.obj", "a.jpg");
  fs::create_directories(folder + "/in/scans");
  fs::copy(folder + "/cloud.pcd", folder + "/in/scans");
  for (const char* part : {"cameras", "images", "poses.txt"})
    fs::copy(folder + "/" + part, folder + "/in/" + part);
  expectRefused(folder, "model in out", "a.jpg"); // before the first stage: no output is there
  EXPECT_FALSE(fs::exists(folder + "/out"));
}

TEST(Usage, TwoProcessesWithOneOutput)
{
  const std::string folder = soundFolder();
  PointSet few = readPoints(folder + "/cloud.pcd");
  few.points *= 2.f;
  writePoints(folder + "/other.pcd", few);
  expectStatus(folder, "filter cloud.pcd one.ply -quiet", 0);
  expectStatus(folder, "filter other.pcd two.ply -quiet", 0);
  const std::string one = get(folder + "/one.ply"), two = get(folder + "/two.ply");
  for (int i = 0; i < 5; ++i) {
    std::thread other([&] { expectStatus(folder + "/images", "filter ../other.pcd ../out.ply -quiet", 0); });
    expectStatus(folder, "filter cloud.pcd out.ply -quiet", 0);
    other.join();
    const std::string out = get(folder + "/out.ply");
    EXPECT_TRUE(out == one || out == two);
  }
  const FolderLock lock(folder + "/images", "test"); // as another process would hold it
  expectRefused(folder, "register cloud.pcd -o images", "another fresco_register works in this folder");
}
} // namespace
