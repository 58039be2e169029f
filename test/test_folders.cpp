// SPDX-License-Identifier: BSD-3-Clause
#include "test_folders.h"
namespace fresco::test {
std::string projectFolder() { return FRESCO_SOURCE_DIR; }
std::string buildFolder() { return FRESCO_BINARY_DIR; }
} // namespace fresco::test
