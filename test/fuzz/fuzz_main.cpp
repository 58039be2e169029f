// SPDX-License-Identifier: BSD-3-Clause
// libFuzzer program for one target, named by the environment variable FRESCO_FUZZ_TARGET:
//   FRESCO_FUZZ_TARGET=ply fresco_fuzz CORPUS_DIR -max_total_time=600 -close_fd_mask=1
#include "targets.h"
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fresco/core/parallel.h>
#include <iostream>
#include <unistd.h>
namespace {
const fresco::fuzz::Target* target = nullptr;
std::string folder;
} // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***)
{
  const char* name = std::getenv("FRESCO_FUZZ_TARGET");
  try {
    target = &fresco::fuzz::findTarget(name ? name : "");
  } catch (const std::exception& error) {
    std::cerr << error.what() << "; FRESCO_FUZZ_TARGET must be one of:";
    for (const auto& known : fresco::fuzz::targets())
      std::cerr << " " << known.name;
    std::cerr << "\n";
    std::exit(2);
  }
  fresco::setDefaultThreads(1);                    // handing small inputs to threads would cost more than reading them
  const std::filesystem::path memory = "/dev/shm"; // no disk is needed
  const auto parent = std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
  folder = (parent / ("fresco_fuzz." + std::to_string(getpid()))).string();
  std::filesystem::create_directories(folder);
  std::atexit([] { std::filesystem::remove_all(folder); });
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  target->run({reinterpret_cast<const char*>(data), size}, folder);
  return 0;
}
