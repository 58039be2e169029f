// SPDX-License-Identifier: BSD-3-Clause
// Writes small sound inputs for every fuzz target: fresco_fuzz_seeds OUT_DIR
#include "seeds.h"
#include <iostream>
int main(int argc, char** argv)
try {
  if (argc != 2) {
    std::cerr << "usage: fresco_fuzz_seeds OUT_DIR\n";
    return 2;
  }
  fresco::fuzz::writeSeeds(argv[1]);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "fresco_fuzz_seeds: " << error.what() << "\n";
  return 1;
}
