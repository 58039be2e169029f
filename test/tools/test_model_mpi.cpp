// SPDX-License-Identifier: BSD-3-Clause
// fresco_model_mpi: the same files as fresco_model, and how it ends when a rank cannot go on.
#include "tools/tool_runs.h"
#include <csignal>
#include <fcntl.h>
#include <fstream>
#include <thread>
#include <unistd.h>
namespace {
using namespace fresco;
using namespace fresco::test;
using Clock = std::chrono::steady_clock;

std::string binary(const std::string& name) { return std::string(FRESCO_BINARY_DIR) + "/bin/fresco_" + name; }

/// A command, such as mpirun with what it starts, in a group of processes of its own.
class Job {
public:
  Job(const std::string& folder, const std::string& command) : log_(folder + "/.log.err")
  {
    process_ = fork();
    if (process_ != 0)
      return;
    dup2(open(log_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666), STDERR_FILENO);
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    if (chdir(folder.c_str()) == 0)
      execl("/bin/sh", "sh", "-c", ("exec " + command).c_str(), nullptr);
    _exit(127);
  }

  /// Processes that it has started, rank 0 first.
  std::vector<pid_t> children() const
  {
    const std::string id = std::to_string(process_);
    std::ifstream list("/proc/" + id + "/task/" + id + "/children");
    std::vector<pid_t> found;
    for (pid_t child = 0; list >> child;)
      found.push_back(child);
    return found;
  }

  int wait() const
  {
    int status = 0;
    waitpid(process_, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  std::string said() const { return get(log_); }

private:
  std::string log_;
  pid_t process_ = 0;
};

Outcome runJob(const std::string& folder, const std::string& command)
{
  const Job job(folder, command);
  const int status = job.wait();
  return {status, "", job.said()};
}

std::string ranks(int count, const std::string& arguments)
{
  return "mpirun -np " + std::to_string(count) + " " + binary("model_mpi") + " " + arguments;
}

/// Lines in which the program speaks.
std::vector<std::string> linesOf(const std::string& said)
{
  std::vector<std::string> lines;
  std::istringstream stream(said);
  for (std::string line; std::getline(stream, line);)
    if (line.rfind("fresco_", 0) == 0)
      lines.push_back(line);
  return lines;
}

const std::string coarse = " -no_optimize -cell 0.1 -texel 0.1 -size 160x120 -threads 1 -quiet";

/// Three scans of the conference room, without photographs.
void scannedRoom(const std::string& folder)
{
  static const std::string made = [] {
    std::string all = std::string(FRESCO_BINARY_DIR) + "/scratch/ModelMpi";
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
    const Outcome together = runJob(folder, ranks(count, "room " + out + coarse));
    ASSERT_EQ(together.status, 0) << together.err;
    EXPECT_EQ(together.err, "");
    const auto found = contents(folder + "/" + out);
    EXPECT_EQ(found.size(), wanted.size());
    for (const auto& [name, bytes] : wanted)
      EXPECT_TRUE(found.count(name) > 0 && found.at(name) == bytes) << count << " ranks: " << name << " differs";
  }
  const std::string written = get(folder + "/out2/mesh.ply");
  fs::remove(folder + "/out2/mesh.ply");
  const Outcome resumed = runJob(folder, ranks(2, "room out2 -resume" + coarse));
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  EXPECT_TRUE(get(folder + "/out2/mesh.ply") == written);
}

TEST(ModelMpi, OneLineForWhatNoRankCanDo)
{
  const std::string folder = scratchFolder();
  for (const auto& [arguments, status, text] :
       {std::tuple{"room out", 1, "no such folder"}, {"room out -nonsense", 2, "nonsense"}, {"room", 2, "OUT_DIR"}}) {
    const Outcome outcome = runJob(folder, ranks(3, arguments));
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
  const Outcome outcome = runJob(folder, ranks(2, "room out -use_poses" + coarse));
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
  fs::create_directory_symlink(std::string(FRESCO_BINARY_DIR) + "/lib", folder + "/lib");
  put(folder + "/bin/fresco_model_mpi", get(binary("model_mpi")) + "x");
  fs::permissions(folder + "/bin/fresco_model_mpi", fs::perms::owner_all);
  const Outcome outcome =
      runJob(folder, ranks(1, "room out") + " : -np 1 " + folder + "/bin/fresco_model_mpi room out");
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  ASSERT_EQ(linesOf(outcome.err).size(), 1U) << outcome.err;
  EXPECT_NE(linesOf(outcome.err)[0].find("the version of fresco_model_mpi differs between rank 0 on "),
            std::string::npos)
      << outcome.err;
}

bool lives(pid_t process)
{
  std::ifstream stat("/proc/" + std::to_string(process) + "/stat");
  std::string id, name, state;
  return stat >> id >> name >> state && state != "Z";
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
    const Job job(folder, ranks(2, "room out" + coarse)); // registration takes its time
    std::vector<pid_t> processes;
    for (int i = 0; i < 500 && processes.size() < 2; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      processes = job.children();
    }
    ASSERT_EQ(processes.size(), 2U) << job.said();
    std::this_thread::sleep_for(std::chrono::milliseconds(700 + 400 * victim));
    kill(processes[victim], SIGKILL);
    EXPECT_NE(job.wait(), 0);
    for (int i = 0; i < 100 && lives(processes[1 - victim]); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_FALSE(lives(processes[1 - victim]));
    EXPECT_TRUE(linesOf(job.said()).empty()) << job.said();
    EXPECT_NE(job.said().find("rank " + std::to_string(victim)), std::string::npos) << job.said();
    for (const char* name : {"/out/poses.txt", "/out/mesh.ply"})
      EXPECT_EQ(get(folder + name), "older");
    EXPECT_EQ(listing(folder + "/out").size(), 2U);
  }
}
} // namespace
