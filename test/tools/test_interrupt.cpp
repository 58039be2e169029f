// SPDX-License-Identifier: BSD-3-Clause
// Every tool that works for long, asked to stop at several moments: it ends soon, with 1 and one line, and leaves
// neither half nor temporary files.
#include "common/shapes.h"
#include "test_data.h"
#include "tools/small_room.h"
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fresco/io/mesh_io.h>
#include <fstream>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
namespace {
using namespace fresco;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

struct Command {
  std::string tool; ///< without fresco_
  std::vector<std::string> words;
};

/// A tool in a process of its own, with `folder` as working folder.
class ToolRun {
public:
  ToolRun(const Command& command, const std::string& folder) : log_(folder + ".err")
  {
    const std::string name = "fresco_" + command.tool, program = test::buildFolder() + "/bin/" + name;
    std::vector<std::string> words = command.words;
    words.insert(words.begin(), name);
    std::vector<char*> pointers;
    for (std::string& word : words)
      pointers.push_back(word.data());
    pointers.push_back(nullptr);
    process_ = fork();
    if (process_ != 0)
      return;
    for (const int stop : {SIGINT, SIGTERM, SIGHUP}) // not as whoever runs the tests has them
      std::signal(stop, SIG_DFL);
    const int log = open(log_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    dup2(log, STDERR_FILENO);
    dup2(open("/dev/null", O_WRONLY), STDOUT_FILENO);
    if (chdir(folder.c_str()) == 0)
      execv(program.c_str(), pointers.data());
    _exit(127);
  }

  /// Whether the process ended within `seconds`.
  bool endsWithin(double seconds)
  {
    const auto start = Clock::now();
    while (!ended_ && secondsSince(start) < seconds) {
      ended_ = waitpid(process_, &status_, WNOHANG) != 0;
      std::this_thread::sleep_for(std::chrono::milliseconds(ended_ ? 0 : 2));
    }
    return ended_;
  }

  void signal(int number) const { kill(process_, number); }
  int status() const { return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_); }

  std::string said() const
  {
    std::ifstream log(log_);
    return {std::istreambuf_iterator<char>(log), {}};
  }

private:
  std::string log_;
  pid_t process_ = 0;
  int status_ = 0;
  bool ended_ = false;
};

/// What a stopped tool may leave in its folder.
enum class Remains { Nothing, WholeFiles };

std::size_t filesBelow(const std::string& folder, Remains allowed)
{
  std::size_t count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    count += entry.is_regular_file() && (allowed == Remains::Nothing || entry.path().filename().string()[0] == '.');
  return count;
}

/// What all tools work on, large enough for seconds of work.
class Interrupt : public testing::Test {
protected:
  static void SetUpTestSuite()
  {
    folder_ = test::buildFolder() + "/scratch/Interrupt";
    fs::remove_all(folder_);
    test::writeSmallRoom(folder_ + "/room", 150000);
    const TriangleMesh ball = test::sphere(1.f, 6);
    writeMesh(folder_ + "/ball.ply", ball);
    writeMesh(folder_ + "/small.ply", test::sphere(1.f, 4));
    PointSet points;
    points.points = test::sphere(1.001f, 8).vertices;
    points.normals = points.points;
    points.viewpoints = Points::Zero(3, 1);
    writePoints(folder_ + "/points.ply", points);
  }

  /// Asks the tool to stop after 0.1, 0.2, 0.4 ... s until it ends of its own accord.
  static void expectStops(const Command& command, int stop = SIGINT, Remains allowed = Remains::Nothing)
  {
    int stopped = 0;
    for (double moment = 0.1; moment < 60; moment *= 2) {
      SCOPED_TRACE(command.tool + " after " + std::to_string(moment) + " s");
      const std::string work = folder_ + "/work_" + command.tool;
      fs::remove_all(work);
      fs::create_directory(work);
      ToolRun run(command, work);
      if (run.endsWithin(moment)) {
        EXPECT_EQ(run.status(), 0) << run.said();
        break;
      }
      run.signal(stop);
      ASSERT_TRUE(run.endsWithin(10)) << run.said(); // a fraction of a second on a machine that has nothing else to do
      if (run.status() == 0 || run.status() == 128 + stop)
        continue; // it was ready, or had not yet begun
      ++stopped;
      EXPECT_EQ(run.status(), 1);
      EXPECT_EQ(run.said(), "fresco_" + command.tool + ": cancelled\n");
      EXPECT_EQ(filesBelow(work, allowed), 0U);
    }
    EXPECT_GT(stopped, 0) << command.tool << " was always ready";
  }

  static inline std::string folder_;
};

TEST_F(Interrupt, Reconstruct)
{
  expectStops({"reconstruct", {folder_ + "/points.ply", "out.ply", "-depth", "9", "-quiet"}});
}

TEST_F(Interrupt, Optimize)
{
  expectStops({"optimize", {folder_ + "/ball.ply", folder_ + "/points.ply", "out.ply", "-quiet"}});
}

TEST_F(Interrupt, Normals)
{
  expectStops({"normals", {folder_ + "/points.ply", "out.ply", "-bilateral", "3", "-quiet"}}, SIGTERM);
}

TEST_F(Interrupt, Filter)
{
  expectStops({"filter", {folder_ + "/points.ply", "out.ply", "-outliers", "600", "3", "-quiet"}}, SIGHUP);
}

TEST_F(Interrupt, Register)
{
  expectStops(
      {"register", {folder_ + "/room/scans/scan_00.pcd", folder_ + "/room/scans/scan_01.pcd", "-o", ".", "-quiet"}});
}

TEST_F(Interrupt, Compare)
{
  expectStops({"compare",
               {folder_ + "/ball.ply", folder_ + "/ball.ply", "-samples", "3000000", "-colored", "out.ply", "-quiet"}});
}

TEST_F(Interrupt, Texture)
{
  expectStops({"texture",
               {folder_ + "/ball.ply", folder_ + "/room/cameras", folder_ + "/room/images", "out.obj", "-texel",
                "0.001", "-quiet"}});
}

TEST_F(Interrupt, Scan) // what it has finished stays, poses.txt comes last
{
  expectStops({"scan", {folder_ + "/small.ply", ".", "-no_images", "-stations", "2", "-quiet"}}, SIGINT,
              Remains::WholeFiles);
}

TEST_F(Interrupt, Snapshot)
{
  expectStops({"snapshot", {folder_ + "/ball.ply", "out.png", "-size", "3000x2000", "-quiet"}});
}
} // namespace
