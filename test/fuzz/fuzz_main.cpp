// SPDX-License-Identifier: BSD-3-Clause
// libFuzzer program for one target, named by the environment variable FRESCO_FUZZ_TARGET:
//   FRESCO_FUZZ_TARGET=ply fresco_fuzz CORPUS_DIR -max_total_time=600 -close_fd_mask=1
#include "generator.h"
#include "targets.h"
#include <algorithm>
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

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

/// Of eight inputs, three are bytes that libFuzzer has changed, three a valid file with one thing broken, and two the
/// input with one of its lines broken.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed)
{
  using namespace fresco::fuzz;
  const unsigned choice = seed % 8;
  if (choice < 3)
    return LLVMFuzzerMutate(data, size, most);
  const GeneratedFile file = generated(target->name, seed);
  const std::string bytes = choice < 6 && !file.parts.empty()
                                ? broken(file, seed / 8)
                                : broken(std::string_view(reinterpret_cast<const char*>(data), size), seed / 8);
  if (bytes.empty())
    return LLVMFuzzerMutate(data, size, most);
  return std::size_t(std::copy_n(bytes.begin(), std::min(most, bytes.size()), data) - data);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  target->run({reinterpret_cast<const char*>(data), size}, folder);
  return 0;
}
