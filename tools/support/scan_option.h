// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "support/args.h"
#include <fresco/io/scan_file.h>
namespace fresco {
/// Option -columns of tools that read clouds.
void declareColumns(Args& args);

/// Options -scan N and -columns of tools that read one cloud.
struct ScanOption {
  int number = 0; ///< from 1; 0 = all scans of the file as one cloud
  void declare(Args& args);
  ScanPath of(const std::string& file) const;
};
} // namespace fresco
