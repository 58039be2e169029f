// SPDX-License-Identifier: BSD-3-Clause
// fresco_reconstruct_mpi: the same file as fresco_reconstruct, and how it ends when a rank cannot go on.
#include "mesh_parts.h"
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

// The parts of ranks make up the file of one process, to the byte.
TEST(ReconstructMpi, PartsMakeUpTheWhole)
{
  const std::string folder = scratchFolder();
  writeBall(folder);
  const std::string options = " -threads 1 -quiet -depth 10";
  const Outcome alone = run(folder, "reconstruct a.ply b.pcd one.ply" + options);
  ASSERT_EQ(alone.status, 0) << alone.err;
  const Outcome together = runJob(folder, ranks(3, "reconstruct_mpi a.ply b.pcd all.ply -parts" + options));
  ASSERT_EQ(together.status, 0) << together.err;
  EXPECT_EQ(listing(folder).size(), 7U); // a, b, one, the index, three parts
  writeMesh(folder + "/again.ply", joinedParts(folder, "all.json"));
  EXPECT_TRUE(get(folder + "/again.ply") == get(folder + "/one.ply"));
}

// Trimmed meshes are one part, as those of shallow octrees; no part takes the place of an input.
TEST(ReconstructMpi, OnePart)
{
  const std::string folder = scratchFolder();
  writeBall(folder);
  const Outcome done = runJob(folder, ranks(2, "reconstruct_mpi a.ply all.ply -parts -quiet -depth 7 -trim 5"));
  ASSERT_EQ(done.status, 0) << done.err;
  EXPECT_EQ(listing(folder).size(), 4U);
  EXPECT_GT(joinedParts(folder, "all.json").faceCount(), 0);
  fs::rename(folder + "/a.ply", folder + "/a_0001.ply");
  const std::string cloud = get(folder + "/a_0001.ply");
  EXPECT_EQ(runJob(folder, ranks(2, "reconstruct_mpi a_0001.ply a.ply -parts -quiet -depth 7")).status, 2);
  EXPECT_TRUE(get(folder + "/a_0001.ply") == cloud);
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
  for (const auto& [victim, parts] : {std::pair{0, ""}, {1, " -parts"}, {1, ""}, {0, " -parts"}}) {
    expectKilledRankEndsAll(folder,
                            std::string("reconstruct_mpi a.ply b.pcd old.ply -depth 11 -threads 1 -quiet") + parts,
                            victim, milliseconds);
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
