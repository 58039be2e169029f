// SPDX-License-Identifier: BSD-3-Clause
#include "job/file_state.h"
#include "job/stage_log.h"
#include "test_data.h"
#include <algorithm>
#include <fresco/io/file.h>
#include <fstream>
#include <map>
namespace fresco::model {
namespace {
namespace fs = std::filesystem;

/// A job of three stages that read and write all kinds of files; counts how often each runs.
class SmallJob {
public:
  explicit SmallJob(std::string folder) : folder_(std::move(folder))
  {
    fs::create_directories(folder_ + "/in/sub");
    for (const char* name : {"listed.txt", "also_listed.bin", "found.txt", "sub/late.txt"})
      writeFile(folder_ + "/in/" + name, std::string("content of ") + name);
  }

  std::map<std::string, int> run(bool resume, const Progress& progress = {})
  {
    runs_.clear();
    const std::string in = folder_ + "/in/", out = folder_ + "/out/";
    StageLog log(out + "work", {in + "listed.txt", in + "also_listed.bin"}, resume, progress);
    const auto stage = [&](const std::string& name, std::vector<std::string> outputs,
                           const std::function<void()>& body) {
      log.run({name, "", std::move(outputs), [&](const Progress&) {
                 ++runs_[name];
                 body();
                 return nlohmann::ordered_json{{"name", name}};
               }});
    };
    stage("first", {out + "work/parts", out + "work/grows.db"}, [&] {
      makeFolder(out + "work/parts");
      writeFile(out + "work/parts/a", readFile(in + "found.txt"));
      writeFile(out + "work/parts/b", "b");
      writeFile(out + "work/grows.db", "1");
    });
    stage("second", {out + "model.obj"}, [&] {
      writeFile(out + "model.obj", readFile(out + "work/parts/a"));
      writeFile(out + "model.png", "not named by the stage");
      writeFile(out + "work/grows.db", readFile(out + "work/grows.db") + "2");
    });
    stage("third", {out + "last"},
          [&] { writeFile(out + "last", readFile(in + "sub/late.txt") + readFile(out + "model.obj")); });
    return runs_;
  }

private:
  std::string folder_;
  std::map<std::string, int> runs_;
};

std::vector<std::string> filesIn(const std::string& folder)
{
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

/// Another byte in a file of the same size and time of change, in place.
void damage(const std::string& file)
{
  const auto time = fs::last_write_time(file);
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  const char first = static_cast<char>(stream.get());
  stream.seekp(0);
  stream.put(static_cast<char>(first ^ 1));
  stream.close();
  fs::last_write_time(file, time);
}

using Runs = std::map<std::string, int>;

TEST(StageLog, TakesOverWhatIsAsItWas)
{
  SmallJob job(test::scratchFolder());
  EXPECT_EQ(job.run(false), (Runs{{"first", 1}, {"second", 1}, {"third", 1}}));
  EXPECT_EQ(job.run(true), Runs());
  EXPECT_EQ(job.run(true), Runs());
  EXPECT_EQ(job.run(false), (Runs{{"first", 1}, {"second", 1}, {"third", 1}}));
}

TEST(StageLog, ProgressOfEachStageRisesFromZeroToOne)
{
  SmallJob job(test::scratchFolder());
  for (const bool resume : {false, true}) {
    std::map<std::string, std::vector<double>> shares; // by stage
    job.run(resume, [&](std::string_view step, double share) {
      shares[std::string(step.substr(0, step.find(':')))].push_back(share);
      return true;
    });
    EXPECT_EQ(shares.size(), 3u);
    for (const auto& [stage, values] : shares) {
      EXPECT_TRUE(std::is_sorted(values.begin(), values.end())) << stage;
      EXPECT_EQ(values.front(), 0) << stage;
      EXPECT_EQ(values.back(), 1) << stage;
    }
  }
}

TEST(StageLog, BelievesNoFileThatWasDamagedEmptiedOrLost)
{
  const std::string folder = test::scratchFolder();
  SmallJob job(folder);
  job.run(false);
  const std::vector<std::string> inputs = filesIn(folder + "/in"), outputs = filesIn(folder + "/out");
  ASSERT_EQ(inputs.size(), 4u);
  ASSERT_EQ(outputs.size(), 9u); // six outputs, three records
  const std::map<std::string, std::function<void(const std::string&)>> harms = {
      {"damaged", damage},
      {"emptied", [](const std::string& file) { fs::resize_file(file, 0); }},
      {"lost", [](const std::string& file) { fs::remove(file); }}};
  for (const std::string& file : outputs)
    for (const auto& [how, harm] : harms) {
      const std::string before = readFile(file);
      harm(file);
      EXPECT_NE(job.run(true), Runs()) << file << " was " << how;
      EXPECT_EQ(job.run(true), Runs()) << file;
      if (fs::path(file).extension() != ".json") {
        EXPECT_EQ(readFile(file), before) << file << " was " << how;
      }
    }
  for (const std::string& file : inputs) {
    damage(file);
    EXPECT_NE(job.run(true), Runs()) << file;
    EXPECT_EQ(job.run(true), Runs()) << file;
  }
}

/// Copied, or written again as it was: neither number nor times tell, the content does.
TEST(StageLog, BelievesFilesThatOnlyWereTouched)
{
  const std::string folder = test::scratchFolder();
  SmallJob job(folder);
  job.run(false);
  for (const std::string& part : {folder + "/in", folder + "/out"})
    for (const std::string& file : filesIn(part)) {
      const std::string content = readFile(file);
      fs::remove(file);
      writeFile(file, content);
      EXPECT_EQ(job.run(true), Runs()) << file;
    }
}

/// Nobody knows which of both contents the stage has seen.
TEST(StageLog, AnInputThatChangesWhileItIsReadIsNotBelieved)
{
  const std::string folder = test::scratchFolder();
  writeFile(folder + "/input", "before");
  int runs = 0;
  for (const bool changes : {true, false, false}) {
    StageLog log(folder + "/out/work", {folder + "/input"}, true, {});
    log.run({"stage", "", {}, [&](const Progress&) {
               ++runs;
               readFile(folder + "/input");
               if (changes)
                 writeFile(folder + "/input", "after");
               return nlohmann::ordered_json::object();
             }});
  }
  EXPECT_EQ(runs, 2);
}

TEST(StageLog, StageOfAChangedInputAndThoseBehindItRunAgain)
{
  const std::string folder = test::scratchFolder();
  SmallJob job(folder);
  job.run(false);
  damage(folder + "/in/sub/late.txt");
  EXPECT_EQ(job.run(true), (Runs{{"third", 1}}));
  damage(folder + "/out/model.png");
  EXPECT_EQ(job.run(true), (Runs{{"second", 1}, {"third", 1}}));
  damage(folder + "/in/listed.txt");
  EXPECT_EQ(job.run(true).size(), 3u);
  writeFile(folder + "/out/work/parts/c", "of nobody");
  EXPECT_EQ(job.run(true).size(), 3u);
}
} // namespace
} // namespace fresco::model
