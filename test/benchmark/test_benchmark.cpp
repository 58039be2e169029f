// SPDX-License-Identifier: BSD-3-Clause
#include "cases/cases.h"
#include "cases/process.h"
#include "cases/table.h"
#include "test_data.h"
#include <fresco/io/file.h>
#include <fstream>
namespace fresco::benchmark {
namespace {
ProcessResult shell(const std::string& script, double timeout = 0.0)
{
  return runProcess({"/bin/sh", "-c", script}, test::scratchFolder() + "/log.txt", {timeout});
}

TEST(BenchmarkProcess, WallTimeIsNotProcessorTime)
{
  const ProcessResult result = shell("sleep 0.3");
  EXPECT_TRUE(result.ok) << result.failure;
  EXPECT_GE(result.wall, 0.3);
  EXPECT_LT(result.cpu, 0.2);
  EXPECT_GT(result.peak_memory, 1e5);
}

TEST(BenchmarkProcess, ProcessorTimeIsCounted)
{
  const ProcessResult result = shell("i=0; while [ $i -lt 200000 ]; do i=$((i+1)); done");
  EXPECT_TRUE(result.ok) << result.failure;
  EXPECT_GT(result.cpu, 0.01);
  EXPECT_LE(result.cpu, result.wall + 0.05); // one thread
}

TEST(BenchmarkProcess, FailuresAreSaid)
{
  EXPECT_NE(shell("exit 3").failure.find("exit status 3"), std::string::npos);
  EXPECT_NE(shell("kill -SEGV $$").failure.find("signal"), std::string::npos);
  const ProcessResult slow = shell("exec sleep 20", 0.2);
  EXPECT_EQ(slow.failure, "time limit");
  EXPECT_FALSE(slow.ok);
  EXPECT_LT(slow.wall, 10.0);
  EXPECT_FALSE(runProcess({"no_such_program_here"}, test::scratchFolder() + "/log.txt").ok);
}

TEST(BenchmarkProcess, OutputGoesToTheLog)
{
  const std::string log = test::scratchFolder() + "/log.txt";
  ASSERT_TRUE(runProcess({"/bin/sh", "-c", "echo out; echo err >&2"}, log).ok);
  EXPECT_EQ(readFile(log), "out\nerr\n");
}

TEST(BenchmarkProcess, ReportsAreReadBack)
{
  const std::string path = test::scratchFolder() + "/report.txt";
  for (const ProcessResult& written :
       {ProcessResult{true, "", 1.25, 0.5, 1e6}, {false, "exit status 3, see x", 2, 1, 5}}) {
    std::FILE* file = std::fopen(path.c_str(), "w");
    writeReport(file, written);
    std::fclose(file);
    const ProcessResult read = readReport(path);
    EXPECT_EQ(read.ok, written.ok);
    EXPECT_EQ(read.failure, written.failure);
    EXPECT_EQ(read.wall, written.wall);
    EXPECT_EQ(read.peak_memory, written.peak_memory);
  }
  EXPECT_FALSE(readReport(path + ".missing").ok);
}

TEST(BenchmarkCases, TheTableOfTheProjectIsValid)
{
  const CaseTable table = readCases(test::projectFolder() + "/benchmark/cases/cases.json");
  EXPECT_GE(table.cases.size(), 4U);
  for (const Case& c : table.cases) {
    EXPECT_EQ(c.runs.size(), 3U) << c.name;
    EXPECT_FALSE(c.reference.empty()) << c.name;
  }
}

TEST(BenchmarkCases, PlaceholdersAreReplaced)
{
  EXPECT_EQ(substitute("{a}/{b}/{c}", {{"a", "{b}x"}, {"b", "y"}}), "yx/y/{c}");
  EXPECT_EQ(substitute("{a}{a}", {{"a", "{a}1"}}), "{a}1{a}1"); // ends
}

TEST(BenchmarkCases, MalformedTablesNameTheFile)
{
  const std::string path = test::scratchFolder() + "/cases.json";
  for (const char* text :
       {"nonsense", "{}",
        R"({"inputs":{},"peers":{},"cases":[{"name":"a","description":"","input":"x","runs":[]}]})"}) {
    std::ofstream(path) << text;
    try {
      readCases(path);
      ADD_FAILURE() << text;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos);
    }
  }
}

TEST(BenchmarkTable, MedianAndAbsentRows)
{
  EXPECT_EQ(median({3, 1, 2}), 2.0);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
  EXPECT_EQ(median({}), 0.0);
  Measurement measured{"case", "program", "", {2.0, 1.0, 4.0}, 3.0, 1 << 20, {}};
  Measurement absent{"case", "peer", "absent: not installed", {}, 0, 0, {}};
  const std::string text = markdownTable({measured, absent});
  EXPECT_NE(text.find("| case | program | 1.00 / 2.00 | 3.00 | 1 |"), std::string::npos) << text;
  EXPECT_NE(text.find("| case | peer | absent: not installed |"), std::string::npos) << text;
  EXPECT_EQ(measurementsJson({measured, absent}).size(), 2U);
}
} // namespace
} // namespace fresco::benchmark
