// SPDX-License-Identifier: BSD-3-Clause
// fresco_model when it is killed, stopped, out of disk or out of memory. FRESCO_KILLS = moments of SIGKILL (default 3).
#include "test_data.h"
#include "tools/small_room.h"
#include <csignal>
#include <fcntl.h>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
namespace {
using namespace fresco;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// What the operating system allows the program; 0 = as much as there is.
struct Limits {
  rlim_t file_bytes = 0;
  rlim_t memory_bytes = 0;
  bool foreign = false; ///< run by root: as a user who owns nothing
};

struct Outcome {
  int status = 0; ///< exit status, or 128 + signal
  std::string err;
};

/// fresco_model in a process of its own.
class ModelRun {
public:
  ModelRun(const std::string& input, const std::string& out, bool resume, Limits limits = {}) : log_(out + ".err")
  {
    const std::string program = test::buildFolder() + "/bin/fresco_model";
    process_ = fork();
    if (process_ == 0) {
      const int log = open(log_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
      dup2(log, STDERR_FILENO);
      apply(RLIMIT_FSIZE, limits.file_bytes);
      apply(RLIMIT_AS, limits.memory_bytes);
      if (limits.foreign && geteuid() == 0 && (setgid(nobody) != 0 || setuid(nobody) != 0))
        _exit(126);
      execl(program.c_str(), "fresco_model", input.c_str(), out.c_str(), "-use_poses", "-cell", "0.1", "-size",
            "160x120", "-quiet", resume ? "-resume" : nullptr, nullptr);
      _exit(127);
    }
  }

  void signal(int number) const { kill(process_, number); }

  Outcome wait()
  {
    int status = 0;
    const auto start = Clock::now();
    while (waitpid(process_, &status, WNOHANG) == 0) {
      if (secondsSince(start) > 500)
        signal(SIGKILL); // it hangs
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    std::ifstream log(log_);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
            {std::istreambuf_iterator<char>(log), {}}};
  }

private:
  static constexpr unsigned nobody = 65534;

  static void apply(int what, rlim_t most)
  {
    const rlimit limit{most, most};
    if (most > 0)
      setrlimit(static_cast<__rlimit_resource>(what), &limit);
  }

  std::string log_;
  pid_t process_ = 0;
};

/// A report or a record of a stage without what differs from run to run.
void dropCosts(nlohmann::ordered_json& json)
{
  if (json.is_object())
    for (const char* cost : {"seconds", "cpu_seconds", "peak_megabytes", "resumed", "stamp"})
      json.erase(cost);
  for (auto& part : json)
    if (part.is_structured())
      dropCosts(part);
}

/// Every file below the folder by name, with its bytes; costs are left out of .json, report.html (which shows them)
/// too.
std::map<std::string, std::string> contents(const std::string& folder)
{
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = fs::relative(entry.path(), folder).string();
    if (!entry.is_regular_file() || name == "report.html")
      continue;
    std::string bytes = readFile(entry.path().string());
    if (entry.path().extension() == ".json") {
      auto json = nlohmann::ordered_json::parse(bytes);
      dropCosts(json);
      bytes = json.dump();
    }
    files[name] = std::move(bytes);
  }
  return files;
}

/// Same names, same bytes.
void expectSame(const std::map<std::string, std::string>& found, const std::map<std::string, std::string>& wanted)
{
  for (const auto& [name, bytes] : wanted) {
    ASSERT_TRUE(found.count(name)) << name << " is missing";
    EXPECT_TRUE(found.at(name) == bytes) << name << " differs";
  }
  for (const auto& [name, bytes] : found)
    EXPECT_TRUE(wanted.count(name)) << name << " should not be there";
}

/// What stands under its final name is whole.
void expectNothingHalf(const std::string& folder, const std::map<std::string, std::string>& wanted)
{
  if (!fs::exists(folder))
    return;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().filename().string()[0] == '.') // an unfinished file of a killed run
      fs::remove(entry.path());
  for (const auto& [name, bytes] : contents(folder))
    EXPECT_TRUE(wanted.count(name) && wanted.at(name) == bytes) << name << " is half or wrong";
}

void expectOneLine(const Outcome& outcome)
{
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_EQ(outcome.err.rfind("fresco_model: ", 0), 0U) << outcome.err;
}

/// A small room, and what an undisturbed run makes of it.
class Faults : public testing::Test {
protected:
  static void SetUpTestSuite()
  {
    folder_ = test::buildFolder() + "/scratch/Faults";
    fs::remove_all(folder_);
    input_ = folder_ + "/room";
    test::writeSmallRoom(input_);
    const auto start = Clock::now();
    const Outcome outcome = ModelRun(input_, folder_ + "/whole", false).wait();
    seconds_ = secondsSince(start);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    whole_ = contents(folder_ + "/whole");
  }

  void SetUp() override
  {
    for (const char* name : {"model.obj", "model.glb", "mesh.ply", "report.json"})
      ASSERT_TRUE(whole_.count(name)) << name;
  }

  /// The run that `out` was left by is gone on with, and ends as if nothing had happened.
  static void expectResumeCompletes(const std::string& out)
  {
    const Outcome outcome = ModelRun(input_, out, true).wait();
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    expectSame(contents(out), whole_);
  }

  static inline std::string folder_, input_;
  static inline double seconds_ = 0; ///< of the undisturbed run
  static inline std::map<std::string, std::string> whole_;
};

TEST_F(Faults, KilledAtAnyMomentAndResumed)
{
  const char* wanted = std::getenv("FRESCO_KILLS");
  const int kills = wanted ? std::atoi(wanted) : 3;
  std::mt19937 generator(std::random_device{}());
  std::uniform_real_distribution<double> moment(0.02 * seconds_, 0.98 * seconds_);
  int killed = 0;
  for (int i = 0; i < kills; ++i) {
    const double seconds = moment(generator);
    SCOPED_TRACE("killed after " + std::to_string(seconds) + " of " + std::to_string(seconds_) + " s");
    const std::string out = folder_ + "/killed_" + std::to_string(i);
    ModelRun run(input_, out, false);
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    run.signal(SIGKILL);
    killed += run.wait().status == 128 + SIGKILL;
    if (fs::exists(out) && i % 2 == 0) // every other run resumes beside what the killed one left unfinished
      expectNothingHalf(out, whole_);
    expectResumeCompletes(out);
  }
  std::cout << killed << " of " << kills << " runs were killed before their end\n";
}

TEST_F(Faults, KilledAgainAndAgain)
{
  const std::string out = folder_ + "/again";
  for (const double share : {0.3, 0.5, 0.4}) {
    ModelRun run(input_, out, true);
    std::this_thread::sleep_for(std::chrono::duration<double>(share * seconds_));
    run.signal(SIGKILL);
    run.wait();
  }
  expectResumeCompletes(out);
}

TEST_F(Faults, ControlCEndsItSoonAndCleanly)
{
  for (const double share : {0.2, 0.5, 0.8}) {
    const std::string out = folder_ + "/stopped_" + std::to_string(share);
    ModelRun run(input_, out, false);
    std::this_thread::sleep_for(std::chrono::duration<double>(share * seconds_));
    const auto start = Clock::now();
    run.signal(SIGINT);
    const Outcome outcome = run.wait();
    EXPECT_LT(secondsSince(start), 10.0);                      // a second on a machine that is not busy otherwise
    if (outcome.status != 0 && outcome.status != 128 + SIGINT) // it may have ended, or not yet have begun
      expectOneLine(outcome);
    if (fs::exists(out)) {
      for (const auto& entry : fs::recursive_directory_iterator(out))
        EXPECT_TRUE(entry.is_directory() || entry.path().filename().string()[0] != '.') << entry.path();
    }
    expectNothingHalf(out, whole_);
    expectResumeCompletes(out);
  }
}

TEST_F(Faults, DiskFull)
{
  std::vector<std::size_t> sizes;
  for (const auto& [name, bytes] : whole_)
    sizes.push_back(bytes.size());
  std::sort(sizes.begin(), sizes.end());
  // The largest file no longer fits; half of the files do not; nothing does.
  for (const std::size_t room : {sizes.back() - 1, sizes[sizes.size() / 2], std::size_t{400}}) {
    SCOPED_TRACE("files of " + std::to_string(room) + " bytes");
    const std::string out = folder_ + "/full_" + std::to_string(room);
    const Outcome outcome = ModelRun(input_, out, false, {static_cast<rlim_t>(room), 0}).wait();
    expectOneLine(outcome);
    EXPECT_NE(outcome.err.find(out), std::string::npos) << outcome.err;
    expectNothingHalf(out, whole_);
    expectResumeCompletes(out);
  }
}

TEST_F(Faults, NotEnoughMemory)
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer needs more address space than any limit leaves";
#endif
  for (const rlim_t megabytes : {300, 304, 310, 400, 550}) {
    SCOPED_TRACE(std::to_string(megabytes) + " MB");
    const std::string out = folder_ + "/memory_" + std::to_string(megabytes);
    const Outcome outcome = ModelRun(input_, out, false, {0, megabytes << 20}).wait();
    if (outcome.status == 127 || outcome.status == 0)
      continue; // too little even for its libraries, or enough
    expectOneLine(outcome);
    expectNothingHalf(out, whole_);
    expectResumeCompletes(out);
  }
}

TEST_F(Faults, NoPermissionAndAFileInTheWay)
{
  std::ofstream(folder_ + "/file") << "in the way";
  const Outcome outcome = ModelRun(input_, folder_ + "/file", false).wait();
  expectOneLine(outcome);
  EXPECT_NE(outcome.err.find(folder_ + "/file"), std::string::npos) << outcome.err;
  const std::string out = folder_ + "/locked";
  fs::create_directory(out);
  fs::permissions(out, fs::perms::owner_read | fs::perms::owner_exec);
  Limits foreign;
  foreign.foreign = true;
  const Outcome locked = ModelRun(input_, out, false, foreign).wait();
  expectOneLine(locked);
  EXPECT_NE(locked.err.find(out), std::string::npos) << locked.err;
  EXPECT_TRUE(fs::is_empty(out));
  fs::permissions(out, fs::perms::owner_all);
  fs::create_directories(out + "/mesh.ply"); // a folder where a stage wants its file
  const Outcome blocked = ModelRun(input_, out, false).wait();
  expectOneLine(blocked);
  EXPECT_NE(blocked.err.find("mesh.ply"), std::string::npos) << blocked.err;
  fs::remove_all(out + "/mesh.ply");
  expectResumeCompletes(out);
}
} // namespace
