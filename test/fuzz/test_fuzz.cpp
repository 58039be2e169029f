// SPDX-License-Identifier: BSD-3-Clause
// What the fuzzer starts from and what it once found, read again.
#include "seeds.h"
#include "targets.h"
#include "test_data.h"
#include <algorithm>
#include <chrono>
#include <fresco/io/file.h>
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
  const std::string findings = std::string(FRESCO_SOURCE_DIR) + "/test/fuzz/findings";
  for (const fuzz::Target& target : fuzz::targets())
    replay(target, findings + "/" + target.name, folder);
  for (const std::string& known : filesIn(findings))
    if (fs::is_directory(known)) {
      EXPECT_NO_THROW(fuzz::findTarget(fs::path(known).filename().string()));
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
