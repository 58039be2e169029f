// SPDX-License-Identifier: BSD-3-Clause
#include "test_data.h"
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fresco/core/array.h>
#include <fresco/core/scratch_space.h>
#include <fresco/core/types.h>
#include <gtest/gtest.h>
#include <thread>
#include <unistd.h>
namespace {
using namespace fresco;
constexpr std::size_t memory = ScratchSpace::least_memory;
constexpr std::size_t numbers = 2'500'000; // 20 MB

std::size_t residentBytes()
{
  unsigned long size = 0, resident = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    EXPECT_EQ(std::fscanf(file, "%lu %lu", &size, &resident), 2);
    std::fclose(file);
  }
  return resident * sysconf(_SC_PAGESIZE);
}

std::uint64_t valueAt(std::size_t array, std::size_t i) { return array * 0x9e3779b97f4a7c15u ^ i * i; }

std::vector<Array<std::uint64_t>> filledArrays(std::size_t count)
{
  std::vector<Array<std::uint64_t>> arrays(count);
  for (std::size_t a = 0; a < count; ++a) {
    arrays[a].resize(numbers);
    for (std::size_t i = 0; i < numbers; ++i)
      arrays[a][i] = valueAt(a, i);
  }
  return arrays;
}

bool holdTheirValues(const std::vector<Array<std::uint64_t>>& arrays)
{
  for (std::size_t a = 0; a < arrays.size(); ++a)
    for (std::size_t i = 0; i < numbers; ++i)
      if (arrays[a][i] != valueAt(a, i))
        return false;
  return true;
}

TEST(ScratchSpace, ArraysBeyondTheMemoryKeepTheirValues)
{
  const std::string folder = test::scratchFolder();
  const std::size_t before = residentBytes();
  std::vector<Array<std::uint64_t>> arrays;
  {
    const ScratchSpace space(memory, folder);
    arrays = filledArrays(20); // 400 MB
    EXPECT_GE(space.mostBytes(), 400'000'000 - ScratchSpace::keptInMemory(memory));
    EXPECT_TRUE(holdTheirValues(arrays));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    if (before < memory / 2) { // else the program alone takes what is allowed
      EXPECT_LT(residentBytes(), memory);
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder));
  }
  EXPECT_TRUE(holdTheirValues(arrays)); // they may outlive it
  arrays.clear();
  EXPECT_TRUE(holdTheirValues(filledArrays(1)));
}

TEST(ScratchSpace, AMatrixKeepsItsValuesInAFileAndAfterwards)
{
  const ScratchSpace space(memory, test::scratchFolder());
  const std::size_t before = space.mostBytes();
  Points points = Points::Zero(3, 8'000'000); // 96 MB
  for (Index i = 0; i < points.cols(); ++i)
    points.col(i).setConstant(static_cast<float>(i));
  const auto sound = [](const Points& all) {
    for (Index i = 0; i < all.cols(); ++i)
      if (all(0, i) != static_cast<float>(i) || all(2, i) != static_cast<float>(i))
        return false;
    return true;
  };
  Points moved;
  {
    FileBacking backing(points);
    EXPECT_GT(space.mostBytes(), before + 90'000'000);
    FileBacking other = std::move(backing);
    moved = std::move(points);
    EXPECT_TRUE(sound(moved));
  }
  EXPECT_TRUE(sound(moved));
  moved.conservativeResize(3, 8'000'001);
  EXPECT_TRUE(sound(moved.leftCols(8'000'000)));
}

TEST(ScratchSpace, BadSpacesAreErrors)
{
  const std::string folder = test::scratchFolder();
  EXPECT_THROW(ScratchSpace(memory, folder + "/none"), std::runtime_error);
  EXPECT_THROW(ScratchSpace(memory - 1, folder), std::invalid_argument);
  const ScratchSpace space(memory, folder);
  EXPECT_THROW(ScratchSpace(memory, folder), std::invalid_argument);
  EXPECT_THROW(Array<char>(std::size_t{1} << 46), std::runtime_error); // more than any disk has
  EXPECT_TRUE(holdTheirValues(filledArrays(3)));
}
} // namespace
