// SPDX-License-Identifier: BSD-3-Clause
// fresco_reconstruct_mpi: the same file as fresco_reconstruct, and how it ends when a rank cannot go on.
#include "tools/mpi_job.h"
namespace {
using namespace fresco;
using namespace fresco::test;

/// A bumpy ball with colours and intensities in two files, dense enough for depths that are divided among ranks.
void writeBall(const std::string& folder)
{
  const Points directions = sphere(1.f, 6).vertices;
  PointSet ball;
  ball.points = directions;
  for (Index i = 0; i < ball.points.cols(); ++i)
    ball.points.col(i) *= 1.f + 0.05f * std::sin(9.f * directions(0, i)) * std::sin(7.f * directions(1, i));
  ball.normals = directions;
  ball.colors = (100.f * (directions.array() + 1.f)).cast<std::uint8_t>();
  ball.intensities = directions.row(2).transpose();
  std::vector<Index> some, others;
  for (Index i = 0; i < ball.size(); ++i)
    (directions(0, i) < 0.3f ? some : others).push_back(i);
  writePoints(folder + "/a.ply", selectPoints(ball, some));
  writePoints(folder + "/b.pcd", selectPoints(ball, others));
}

TEST(ReconstructMpi, SameFileAsOneProcess)
{
  const std::string folder = scratchFolder();
  writeBall(folder);
  for (const char* depth : {"7", "10"}) {
    const std::string options = std::string(" -threads 1 -quiet -depth ") + depth;
    const Outcome alone = run(folder, "reconstruct a.ply b.pcd one.ply" + options);
    ASSERT_EQ(alone.status, 0) << alone.err;
    const std::string wanted = get(folder + "/one.ply");
    for (const int count : {1, 2, 3}) {
      const Outcome together = runJob(folder, ranks(count, "reconstruct_mpi b.pcd a.ply all.ply" + options));
      ASSERT_EQ(together.status, 0) << together.err;
      EXPECT_EQ(together.err, "");
      EXPECT_TRUE(get(folder + "/all.ply") == wanted) << count << " ranks, depth " << depth;
      fs::remove(folder + "/all.ply");
    }
  }
  EXPECT_EQ(listing(folder).size(), 3U);
}

// One of the ball's two files is an open surface.
TEST(ReconstructMpi, TrimsAsOneProcess)
{
  const std::string folder = scratchFolder();
  writeBall(folder);
  std::string closed;
  for (const char* trimming : {"", " -trim_levels 2", " -trim 6.5", " -trim 40"}) {
    const std::string options = std::string(" -threads 1 -quiet -depth 10") + trimming;
    const Outcome alone = run(folder, "reconstruct a.ply one.ply" + options);
    ASSERT_EQ(alone.status, 0) << alone.err;
    const Outcome together = runJob(folder, ranks(2, "reconstruct_mpi a.ply all.ply" + options));
    ASSERT_EQ(together.status, 0) << together.err;
    EXPECT_TRUE(get(folder + "/all.ply") == get(folder + "/one.ply")) << trimming;
    if (closed.empty())
      closed = get(folder + "/one.ply");
    else
      EXPECT_LT(get(folder + "/one.ply").size(), closed.size()) << trimming;
  }
}

TEST(ReconstructMpi, OneLineForWhatCannotBeDone)
{
  const std::string folder = scratchFolder();
  writeBall(folder);
  const std::string cloud = get(folder + "/a.ply");
  put(folder + "/cut.ply", cloud.substr(0, cloud.size() / 2));
  put(folder + "/old.ply", "older");
  const auto before = listing(folder);
  for (const auto& [arguments, status, text] :
       {std::tuple{"nothing.ply old.ply", 1, "nothing.ply: no such file"},
        {"cut.ply b.pcd old.ply -depth 10", 1, "cut.ply"},
        {"a.ply b.pcd missing/old.ply -depth 10", 1, "missing/old.ply: cannot be written"},
        {"a.ply old.obj", 2, ".ply"},
        {"a.ply old.ply -depth 99", 2, "depth"}}) {
    const Outcome outcome = runJob(folder, ranks(2, std::string("reconstruct_mpi -quiet -threads 1 ") + arguments));
    EXPECT_EQ(outcome.status, status) << arguments << outcome.err;
    ASSERT_EQ(linesOf(outcome.err).size(), 1U) << arguments << outcome.err;
    EXPECT_NE(linesOf(outcome.err)[0].find(text), std::string::npos) << outcome.err;
    EXPECT_EQ(listing(folder), before) << arguments;
  }
  EXPECT_EQ(get(folder + "/old.ply"), "older");
}

// While reading, solving and writing.
TEST(ReconstructMpi, KilledRank)
{
  const std::string folder = scratchFolder();
  writeBall(folder);
  put(folder + "/old.ply", "older");
  const auto before = listing(folder);
  int milliseconds = 400;
  for (const int victim : {0, 1, 1, 0}) {
    expectKilledRankEndsAll(folder, "reconstruct_mpi a.ply b.pcd old.ply -depth 11 -threads 1 -quiet", victim,
                            milliseconds);
    EXPECT_EQ(get(folder + "/old.ply"), "older");
    EXPECT_EQ(listing(folder), before);
    milliseconds += 400;
  }
}

// A rank that stands still for a while holds the others up, and changes nothing.
TEST(ReconstructMpi, StoppedRank)
{
  const std::string folder = scratchFolder();
  writeBall(folder);
  const std::string options = " -depth 10 -threads 1 -quiet";
  const Outcome alone = run(folder, "reconstruct a.ply b.pcd one.ply" + options);
  ASSERT_EQ(alone.status, 0) << alone.err;
  const Job job(folder, ranks(2, "reconstruct_mpi a.ply b.pcd all.ply" + options));
  const std::vector<pid_t> processes = job.children(2);
  ASSERT_EQ(processes.size(), 2U) << job.said();
  std::this_thread::sleep_for(std::chrono::milliseconds(600));
  kill(processes[1], SIGSTOP);
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  EXPECT_TRUE(lives(processes[0]));
  kill(processes[1], SIGCONT);
  EXPECT_EQ(job.wait(), 0) << job.said();
  EXPECT_TRUE(get(folder + "/all.ply") == get(folder + "/one.ply"));
}
} // namespace
