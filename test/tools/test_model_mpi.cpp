// SPDX-License-Identifier: BSD-3-Clause
// fresco_model_mpi: the same files as fresco_model, and how it ends when a rank cannot go on.
#include "tools/mpi_job.h"
namespace {
using namespace fresco;
using namespace fresco::test;

const std::string coarse = " -no_optimize -cell 0.1 -texel 0.1 -size 160x120 -threads 1 -quiet";

/// Three scans of the conference room, without photographs.
void scannedRoom(const std::string& folder)
{
  static const std::string made = [] {
    std::string all = buildFolder() + "/scratch/ModelMpi";
    fs::remove_all(all);
    fs::create_directories(all);
    const Outcome outcome = run(all, "scan conference_room room -stations 3 -points 10000 -no_images -quiet");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return all + "/room";
  }();
  fs::copy(made, folder + "/room", fs::copy_options::recursive);
}

/// Names below a folder with the bytes of the files, without what tells of times.
std::map<std::string, std::string> contents(const std::string& folder)
{
  std::map<std::string, std::string> files;
  for (const std::string& file : listing(folder))
    if (const fs::path path(file); path.extension() != ".json" && path.extension() != ".html")
      files[fs::relative(path, folder).string()] = get(file);
  return files;
}

TEST(ModelMpi, SameFilesAsOneProcess)
{
  const std::string folder = scratchFolder();
  scannedRoom(folder);
  const Outcome alone = run(folder, "model room alone" + coarse);
  ASSERT_EQ(alone.status, 0) << alone.err;
  const auto wanted = contents(folder + "/alone");
  EXPECT_TRUE(wanted.count("poses.txt") && wanted.count("mesh.ply") && wanted.count("work/points/scan_000002.pcd"));
  for (const int count : {2, 4}) { // of four ranks, one has no scan
    const std::string out = "out" + std::to_string(count);
    const Outcome together = runJob(folder, ranks(count, "model_mpi room " + out + coarse));
    ASSERT_EQ(together.status, 0) << together.err;
    EXPECT_EQ(together.err, "");
    const auto found = contents(folder + "/" + out);
    EXPECT_EQ(found.size(), wanted.size());
    for (const auto& [name, bytes] : wanted)
      EXPECT_TRUE(found.count(name) > 0 && found.at(name) == bytes) << count << " ranks: " << name << " differs";
  }
  const std::string written = get(folder + "/out2/mesh.ply");
  fs::remove(folder + "/out2/mesh.ply");
  const Outcome resumed = runJob(folder, ranks(2, "model_mpi room out2 -resume" + coarse));
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  EXPECT_TRUE(get(folder + "/out2/mesh.ply") == written);
}

TEST(ModelMpi, OneLineForWhatNoRankCanDo)
{
  const std::string folder = scratchFolder();
  for (const auto& [arguments, status, text] : {std::tuple{"room out", 1, "no such file or folder"},
                                                {"room out -nonsense", 2, "nonsense"},
                                                {"room", 2, "OUT_DIR"}}) {
    const Outcome outcome = runJob(folder, ranks(3, std::string("model_mpi ") + arguments));
    EXPECT_EQ(outcome.status, status) << outcome.err;
    ASSERT_EQ(linesOf(outcome.err).size(), 1U) << outcome.err;
    EXPECT_NE(linesOf(outcome.err)[0].find(text), std::string::npos) << outcome.err;
  }
  EXPECT_TRUE(listing(folder).empty());
}

TEST(ModelMpi, OneLineNamesTheRankThatFailed)
{
  const std::string folder = scratchFolder();
  scannedRoom(folder);
  const std::string scan = get(folder + "/room/scans/scan_01.pcd");
  put(folder + "/room/scans/scan_01.pcd", scan.substr(0, scan.size() / 2));
  const Outcome outcome = runJob(folder, ranks(2, "model_mpi room out -use_poses" + coarse));
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  ASSERT_EQ(linesOf(outcome.err).size(), 1U) << outcome.err;
  for (const char* part : {"scan_01.pcd", "(rank 1 on "})
    EXPECT_NE(linesOf(outcome.err)[0].find(part), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(folder + "/out/poses.txt"));
}

TEST(ModelMpi, OtherVersionIsRefused)
{
  const std::string folder = scratchFolder();
  fs::create_directory(folder + "/bin");
  fs::create_directory_symlink(buildFolder() + "/lib", folder + "/lib");
  put(folder + "/bin/fresco_model_mpi", get(binary("model_mpi")) + "x");
  put(folder + "/by_rank", // mpirun of Open MPI 5.0.7 crashes when it is given two programs
      "#!/bin/sh\n[ \"$OMPI_COMM_WORLD_RANK\" = 0 ] && exec " + binary("model_mpi") + " room out\nexec " + folder +
          "/bin/fresco_model_mpi room out\n");
  for (const char* program : {"/bin/fresco_model_mpi", "/by_rank"})
    fs::permissions(folder + program, fs::perms::owner_all);
  const Outcome outcome = runJob(folder, "mpirun -np 2 " + folder + "/by_rank");
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  ASSERT_EQ(linesOf(outcome.err).size(), 1U) << outcome.err;
  EXPECT_NE(linesOf(outcome.err)[0].find("the version of fresco_model_mpi differs between rank 0 on "),
            std::string::npos)
      << outcome.err;
}

// Whichever rank is killed: all end, and what an earlier run wrote stays.
TEST(ModelMpi, KilledRank)
{
  const std::string folder = scratchFolder();
  scannedRoom(folder);
  fs::create_directory(folder + "/out");
  for (const char* name : {"/out/poses.txt", "/out/mesh.ply"})
    put(folder + name, "older");
  for (const int victim : {0, 1}) {
    expectKilledRankEndsAll(folder, "model_mpi room out" + coarse, victim, 700 + 400 * victim);
    for (const char* name : {"/out/poses.txt", "/out/mesh.ply"})
      EXPECT_EQ(get(folder + name), "older");
    EXPECT_EQ(listing(folder + "/out").size(), 2U);
  }
}
} // namespace
