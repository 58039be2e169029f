// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <string>
namespace fresco {
/// Removes what every OutputFile of this process has written and not committed, and folders that are empty then: for a program that ends at once, without
/// unwinding. No OutputFile can be made or committed afterwards (the caller blocks for ever).
FRESCO_EXPORT void abandonUnfinishedFiles() noexcept;

/// A temporary file that another process has made and this one writes to goes with those of this process, from here on.
FRESCO_EXPORT void addUnfinishedFile(const std::string& path);

/// It has its name, or is removed here.
FRESCO_EXPORT void dropUnfinishedFile(const std::string& path) noexcept;

/// Removes the folders that makeFolder() has made in this process and that are empty: for a program that has failed.
FRESCO_EXPORT void removeEmptyFolders() noexcept;
} // namespace fresco
