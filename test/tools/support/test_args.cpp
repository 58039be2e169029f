// SPDX-License-Identifier: BSD-3-Clause
#include "support/args.h"
#include "support/tool.h"
#include "test_data.h"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fresco/io/file.h>
#include <thread>
#include <unistd.h>
namespace {
using namespace fresco;

struct Line {
  explicit Line(std::vector<std::string> given) : words(std::move(given))
  {
    words.insert(words.begin(), "tool");
    for (std::string& word : words)
      pointers.push_back(word.data());
  }
  std::vector<std::string> words;
  std::vector<char*> pointers;
};

struct Values {
  int depth = 8;
  double eye_x = 0, eye_z = 0;
  float weight = 4.f;
  std::string name = "none";
  bool flip = false;
  std::vector<std::string> files;
};

Values parse(const std::vector<std::string>& words, std::size_t least = 2, std::size_t most = 2)
{
  Values v;
  Args args("tool IN OUT", "For tests.");
  args.option("depth", v.depth, Range::within(2, 16), "depth");
  args.option("weight", v.weight, Range::above(0).atMost(100).zero("none"), "weight");
  args.option("name", v.name, "name");
  args.flag("flip", v.flip, "flip");
  args.numbers("eye", "X Y Z", Range::any(), "eye", [&](const auto& given) {
    v.eye_x = given[0];
    v.eye_z = given[2];
  });
  Line line(words);
  v.files = args.parse(static_cast<int>(line.pointers.size()), line.pointers.data(), least, most);
  return v;
}

TEST(Args, FilesAndOptionsInAnyOrder)
{
  const Values v =
      parse({"-depth", "10", "in.ply", "-eye", "1", "-2.5", "-.5", "--flip", "out.ply", "-weight", "1e-3"});
  EXPECT_EQ(v.files, (std::vector<std::string>{"in.ply", "out.ply"}));
  EXPECT_EQ(v.depth, 10);
  EXPECT_EQ(v.eye_x, 1);
  EXPECT_EQ(v.eye_z, -0.5);
  EXPECT_FLOAT_EQ(v.weight, 1e-3f);
  EXPECT_TRUE(v.flip);
  EXPECT_EQ(parse({"a", "b"}).depth, 8);
}

TEST(Args, WrongUsageIsNamed)
{
  const std::vector<std::vector<std::string>> lines = {{"a"},
                                                       {"a", "b", "c"},
                                                       {"a", "b", "-depht", "9"},
                                                       {"a", "b", "-depth"},
                                                       {"a", "b", "-depth", "nine"},
                                                       {"a", "b", "-depth", "9.5"},
                                                       {"a", "b", "-depth", "17"},
                                                       {"a", "b", "-weight", "-1"},
                                                       {"a", "b", "-eye", "1", "2", "1e13"},
                                                       {"a", "b", "-depth", "99999999999"},
                                                       {"a", "b", "-weight", "nan"},
                                                       {"a", "b", "-weight", ""},
                                                       {"a", "b", "-eye", "1", "2"},
                                                       {"a", "b", "-eye", "1", "-flip", "3"}};
  for (const auto& line : lines)
    EXPECT_THROW(parse(line), UsageError) << line.back();
}

TEST(Args, RangesHoldWhatTheySay)
{
  struct Case {
    Range range;
    std::string text;
    std::vector<double> held, refused;
  };
  const double tiny = 1e-9;
  for (const Case& c : {Case{Range::any(), "any number", {-1e12, 0, 7}, {}},
                        {Range::within(-2, 0.5), "-2..0.5", {-2, 0, 0.5}, {-2 - tiny, 0.5 + tiny}},
                        {Range::within(100, 1e8), "100..100000000", {100, 1e8}, {0, 99}},
                        {Range::atLeast(1), "at least 1", {1, 1e12}, {1 - tiny, 0, -1}},
                        {Range::above(0), "above 0", {tiny, 1e12}, {0, -tiny}},
                        {Range::above(0).atMost(1), "above 0 and at most 1", {tiny, 1}, {0, 1 + tiny}},
                        {Range::above(0).below(90), "above 0 and below 90", {tiny, 90 - tiny}, {0, 90}},
                        {Range::within(3, 9).zero("all"), "3..9; 0 = all", {0, 3, 9}, {tiny, 1, -3}}}) {
    EXPECT_EQ(c.range.text(), c.text);
    for (const double value : c.held)
      EXPECT_TRUE(c.range.holds(value)) << c.text << ": " << value;
    for (const double value : c.refused)
      EXPECT_FALSE(c.range.holds(value)) << c.text << ": " << value;
    EXPECT_FALSE(c.range.text() != "any number" && c.range.holds(NAN)) << c.text;
  }
}

TEST(Args, HelpAndRefusalSayTheRange)
{
  float voxel = 0, share = 0.1f;
  Args args("tool", "");
  args.option("voxel", voxel, Range::above(0), "side");
  args.option("share", share, Range::above(0).atMost(0.1), "part");
  EXPECT_NE(args.usage().find("side (above 0)\n"), std::string::npos) << "a default that may not be given is shown";
  EXPECT_NE(args.usage().find("part (above 0 and at most 0.1; default 0.1)\n"), std::string::npos) << args.usage();
  Line good({"-share", "0.1"}), bad({"-voxel", "0"});
  args.parse(3, good.pointers.data(), 0); // as written, not as rounded to a float
  try {
    args.parse(3, bad.pointers.data(), 0);
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(), "option -voxel: 0 is out of range: above 0");
  }
}

TEST(Args, HelpShowsEveryOptionWithItsDefault)
{
  testing::internal::CaptureStdout();
  EXPECT_THROW(parse({"a", "-h"}), HelpShown);
  const std::string help = testing::internal::GetCapturedStdout();
  for (const char* part :
       {"usage: tool IN OUT", "-depth N", "(2..16; default 8)", "-eye X Y Z", "-flip", "default none", "-h"})
    EXPECT_NE(help.find(part), std::string::npos) << part << "\n" << help;
}

/// What is said of an option that a tool with -voxel, -outliers and -depth does not have.
std::string saidOf(const std::string& option)
{
  float voxel = 0;
  int depth = 8;
  Args args("tool IN OUT", "");
  args.option("voxel", voxel, Range::above(0), "length");
  args.option("depth", depth, Range::within(2, 16), "depth");
  args.values("outliers", "K SIGMA", "", [](const auto&) {});
  std::vector<std::string> words{"tool", "a", "b", option, "1"};
  std::vector<char*> argv;
  for (std::string& word : words)
    argv.push_back(word.data());
  try {
    args.parse(static_cast<int>(argv.size()), argv.data(), 2);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "nothing";
}

TEST(Tool, UnknownOptionIsAnsweredByWhatIsMeant)
{
  EXPECT_EQ(saidOf("-depht"), "unknown option -depht; did you mean -depth?");
  EXPECT_EQ(saidOf("-Voxel"), "unknown option -Voxel; did you mean -voxel?");
  EXPECT_EQ(saidOf("-leaf"), "unknown option -leaf; here it is called -voxel"); // pcl_voxel_grid
  EXPECT_EQ(saidOf("-mean_k"), "unknown option -mean_k; here it is called -outliers");
  EXPECT_EQ(saidOf("-negative"), "unknown option -negative"); // this tool has no -removed
  EXPECT_EQ(saidOf("-zzzzzz"), "unknown option -zzzzzz");
}

TEST(Tool, ExitStatusAndOneLine)
{
  const auto status = [](const std::function<void()>& body, std::string& said) {
    testing::internal::CaptureStderr();
    const int result = runTool("tool", body);
    said = testing::internal::GetCapturedStderr();
    return result;
  };
  std::string said;
  EXPECT_EQ(status([] {}, said), 0);
  EXPECT_EQ(said, "");
  EXPECT_EQ(status([] { throw std::runtime_error("in.ply: the file\nis empty"); }, said), 1);
  EXPECT_EQ(said, "tool: in.ply: the file is empty\n");
  EXPECT_EQ(status([] { throw UsageError("unknown option -x"); }, said), 2);
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1);
  EXPECT_EQ(status([] { throw std::bad_alloc(); }, said), 1);
}

/// Ends the process by the way that a tool ends when `body` is at work.
void runAndExit(const std::function<void()>& body) { _exit(runTool("tool", body)); }

TEST(Tool, ExceptionOfAnotherThreadIsOneLine)
{
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const std::string folder = test::scratchFolder();
  EXPECT_EXIT(runAndExit([&] {
                OutputFile file(folder + "/half");
                std::thread([] { throw std::bad_alloc(); }).join();
              }),
              testing::ExitedWithCode(1), "^tool: not enough memory\n$");
  EXPECT_EXIT(runAndExit([] { std::thread([] { throw std::runtime_error("a\nb"); }).join(); }),
              testing::ExitedWithCode(1), "^tool: a b\n$");
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST(Tool, StopsWhileAStepGoesOn)
{
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto start = std::chrono::steady_clock::now();
  const std::string folder = test::scratchFolder();
  for (const int stop : {SIGINT, SIGTERM, SIGHUP})
    EXPECT_EXIT((std::signal(stop, SIG_DFL), // not as whoever runs the tests has it
                 runAndExit([&] {
                   OutputFile file(folder + "/half");
                   file.write("half");
                   std::raise(stop);
                   std::this_thread::sleep_for(std::chrono::minutes(5)); // a step that asks nobody
                 })),
                testing::ExitedWithCode(1), "^tool: cancelled\n$");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST(Tool, HangUpThatIsIgnoredStopsNothing) // nohup
{
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT((std::signal(SIGHUP, SIG_IGN), runAndExit([] {
                 std::raise(SIGHUP);
                 report(printProgress(true), "step", 0.5); // throws if it is to stop
               })),
              testing::ExitedWithCode(0), "^$");
}

TEST(Tool, ProgressTellsEachStepOfAJobOnce)
{
  testing::internal::CaptureStderr();
  EXPECT_TRUE(printProgress(true)("step", 0.5));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  testing::internal::CaptureStderr();
  const Progress progress = printProgress(false);
  progress("solve", 0.25);
  progress("solve", 0.5);
  progress("solve", 0.0); // of the next job
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "solve (25 %)\nsolve (0 %)\n");
}
} // namespace
