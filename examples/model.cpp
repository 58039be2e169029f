// SPDX-License-Identifier: BSD-3-Clause
// A folder of scans and photographs to a textured model, as fresco_model does it.
#include <fresco/model/build_model.h>
#include <iostream>
int main(int argc, char** argv)
try {
  if (argc != 3) {
    std::cerr << "usage: model INPUT_DIR OUT_DIR   (INPUT_DIR: as fresco_scan writes it)\n";
    return 2;
  }
  fresco::ModelOptions options;
  options.cell = 0.1; // metres; the default of 0.02 shows more and takes longer
  options.use_poses = true;
  options.width = 320;
  options.height = 240;
  const fresco::ModelReport report =
      fresco::buildModel(argv[1], argv[2], options, [](std::string_view step, double share) {
        std::cout << static_cast<int>(100 * share) << " % " << step << "\n";
        return true; // false would stop
      });
  for (const fresco::ModelStage& stage : report.stages)
    std::cout << fresco::stageSummary(stage) << "\n";
  return 0;
} catch (const std::exception& error) {
  std::cerr << "model: " << error.what() << "\n";
  return 1;
}
