// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
namespace fresco::test {
// Functions, so that the objects of the tests are the same in every folder and a compiler's cache serves them all.
std::string projectFolder();
std::string buildFolder();
} // namespace fresco::test
