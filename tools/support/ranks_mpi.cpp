// SPDX-License-Identifier: BSD-3-Clause
#include "support/ranks.h"
#include "support/tool.h"
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fresco/core/require.h>
#include <fresco/distributed/mpi_session.h>
#include <fresco/io/byte_hash.h>
#include <fresco/io/file.h>
#include <fresco/io/packing.h>
#include <link.h>
#include <memory>
#include <unistd.h>
namespace fresco {
namespace {
bool asksForHelp(const char* word)
{
  const std::string text(word);
  return text == "-h" || text == "-help" || text == "--help";
}

/// Whether the environment says that this is another process than the first of a job.
bool isFollower()
{
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK", "SLURM_PROCID"})
    if (const char* rank = std::getenv(name))
      return std::strcmp(rank, "0") != 0;
  return false;
}

void mute(int descriptor)
{
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere < 0)
    return;
  ::dup2(nowhere, descriptor);
  ::close(nowhere);
}

/// A hash of what this program and the project's libraries consist of.
std::string programVersion()
{
  std::uint64_t hash = 0;
  const auto add = [](dl_phdr_info* object, std::size_t, void* sum) {
    const std::string path = *object->dlpi_name ? object->dlpi_name : "/proc/self/exe";
    if (path == "/proc/self/exe" || path.find("libfresco_") != std::string::npos) {
      const std::string content = readFile(path);
      auto& so_far = *static_cast<std::uint64_t*>(sum);
      so_far = hashBytes(content.data(), content.size(), so_far);
    }
    return 0;
  };
  dl_iterate_phdr(add, &hash);
  return std::to_string(hash);
}

/// What the mathematical library and this project choose their code by.
std::string processorKind()
{
#if defined(__x86_64__)
  return concat("x86 ", __builtin_cpu_supports("avx2") != 0, __builtin_cpu_supports("fma") != 0,
                __builtin_cpu_supports("avx512f") != 0);
#else
  return "other";
#endif
}
} // namespace

int runRanks(const std::string& name, int argc, char** argv,
             const std::function<void(const std::string& program, Exchange& ranks)>& body)
{
  const std::string program = name + "_mpi";
  if (std::any_of(argv, argv + argc, asksForHelp)) {
    if (isFollower())
      mute(STDOUT_FILENO);
    Exchange alone;
    return runTool(program, [&] { body(program, alone); });
  }
  std::unique_ptr<MpiSession> session; // outlives the body: its errors end all ranks through it
  const auto end_all = [&](int status, const std::function<void()>& say) {
    if (session)
      session->endJob(status, say);
    say();
    ::_exit(status);
  };
  return runTool(program, [&] {
    joinJob({"", end_all}); // what started the ranks may ask them to stop while they look for each other
    session = std::make_unique<MpiSession>();
    joinJob({session->place(), end_all});
    if (session->exchange().rank() > 0)
      mute(STDOUT_FILENO);
    session->requireSame("the version of " + program, programVersion());
    session->requireSame("the kind of processor", processorKind());
    body(program, session->exchange());
    awaitAll(session->exchange());
  });
}
} // namespace fresco
