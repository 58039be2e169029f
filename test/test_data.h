// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "test_folders.h"
#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <iostream>
#include <string>
namespace fresco::test {
/// Folder of the real data: the environment variable FRESCO_DATA, else ../shared/data beside the project.
inline std::string dataFolder()
{
  const char* given = std::getenv("FRESCO_DATA");
  return given ? given : projectFolder() + "/../shared/data";
}

/// A fresh, empty folder for the output of the running test.
inline std::string scratchFolder()
{
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  const auto folder =
      std::filesystem::path(buildFolder()) / "scratch" / (std::string(info->test_suite_name()) + "." + info->name());
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder.string();
}
} // namespace fresco::test

/// Skips the running test, loudly, where `name` of the real data is absent.
#define FRESCO_NEED_DATA(name)                                                                                         \
  if (!std::filesystem::exists(fresco::test::dataFolder() + "/" + (name))) {                                           \
    std::cout << "*** SKIPPED: no real data " << (name) << " in " << fresco::test::dataFolder() << " ***\n";           \
    GTEST_SKIP();                                                                                                      \
  }
