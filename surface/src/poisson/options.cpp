// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/surface/core/volumetric_reconstruction.h>
namespace fresco {
void validateVolumetricOptions(const VolumetricOptions& options)
{
  require(options.depth >= 2 && options.depth <= 16, "volumetric reconstruction: depth ", options.depth,
          " is not in 2..16");
  require(options.cell_size >= 0 && std::isfinite(options.cell_size), "volumetric reconstruction: cell size ",
          options.cell_size, " is negative or not finite");
  require(options.min_depth >= 2 && options.min_depth <= 8, "volumetric reconstruction: minimum depth ",
          options.min_depth, " is not in 2..8");
  require(options.point_weight >= 0 && std::isfinite(options.point_weight), "volumetric reconstruction: point weight ",
          options.point_weight, " is negative or not finite");
  require(options.scale >= 1 && options.scale <= 100, "volumetric reconstruction: scale ", options.scale,
          " is not in 1..100");
  require(options.samples_per_node > 0 && std::isfinite(options.samples_per_node),
          "volumetric reconstruction: samples per node ", options.samples_per_node, " is not positive");
  require(options.trim >= 0 && std::isfinite(options.trim), "volumetric reconstruction: trimming depth ", options.trim,
          " is negative or not finite");
  require(options.trim_levels >= 0 && std::isfinite(options.trim_levels),
          "volumetric reconstruction: ", options.trim_levels, " levels of trimming are negative or not finite");
  require(options.iterations >= 1 && options.iterations <= 1000, "volumetric reconstruction: ", options.iterations,
          " iterations are not in 1..1000");
  threadCount(options.threads);
}
} // namespace fresco
