// SPDX-License-Identifier: BSD-3-Clause
#include "stages/stage_options.h"
#include <charconv>
#include <cmath>
#include <fresco/core/require.h>
#include <fresco/io/listed.h>
#include <fresco/io/range.h>
#include <functional>
#include <variant>
namespace fresco::model {
namespace {
using Value = std::variant<int*, float*, double*, bool*>;

struct Row {
  const char* name;
  Value value;
  Range range; ///< as the tool has it
};

/// Every option that reaches a stage, under the name of its tool.
std::vector<Row> rowsOf(StageOptions& o)
{
  const Range flag = Range::within(0, 1);
  return {{"register.voxel", &o.registration.voxel, Range::above(0).zero("from the data")},
          {"register.max_distance", &o.registration.max_distance, Range::above(0).zero("20 voxels")},
          {"register.min_overlap", &o.registration.min_overlap, Range::above(0).atMost(1)},
          {"register.max_violation", &o.registration.max_violation, Range::within(0, 1)},
          {"register.confidence", &o.registration.confidence, Range::within(0.5, 0.9999).zero("the joins decide")},
          {"register.max_iterations", &o.registration.max_iterations, Range::atLeast(1)},
          {"register.upright", &o.registration.upright, flag},
          {"filter.outlier_neighbors", &o.outliers.k, Range::atLeast(1)},
          {"filter.outlier_sigma", &o.outliers.sigma, Range::atLeast(0)},
          {"filter.veil_angle", &o.mixed_pixels.angle, Range::above(0).below(90)},
          {"filter.noise", &o.mixed_pixels.noise, Range::above(0).zero("measured from the scan")},
          {"normals.k", &o.normals.k, Range::within(3, 1000)},
          {"normals.radius", &o.normals.radius, Range::above(0).zero("k")},
          {"normals.edges", &o.normals.edges, flag},
          {"normals.sigma_d", &o.smoothing.sigma_d, Range::above(0).zero("from the local sampling")},
          {"normals.sigma_n", &o.smoothing.sigma_n, Range::above(0).atMost(180)},
          {"normals.move_rounds", &o.smoothing.move_rounds, Range::atLeast(0)},
          {"fuse.truncation", &o.fusion.truncation, Range::within(2, 16)},
          {"fuse.free_weight", &o.fusion.free_weight, Range::above(0)},
          {"track.nearest", &o.tracking.nearest, Range::above(0)},
          {"track.farthest", &o.tracking.farthest, Range::above(0)},
          {"track.refinement_rounds", &o.tracking.refinement_rounds, Range::within(0, 10)},
          {"track.calibrate_color", &o.tracking.calibrate_color, flag},
          {"reconstruct.depth", &o.reconstruction.depth, Range::within(2, 16).zero("from the cells")},
          {"reconstruct.point_weight", &o.reconstruction.point_weight, Range::above(0).zero("unscreened")},
          {"reconstruct.samples_per_node", &o.reconstruction.samples_per_node, Range::above(0)},
          {"reconstruct.scale", &o.reconstruction.scale, Range::within(1, 100)},
          {"reconstruct.trim", &o.reconstruction.trim, Range::above(0).zero("closed")},
          {"reconstruct.iterations", &o.reconstruction.iterations, Range::within(1, 1000)},
          {"optimize.iterations", &o.optimization.iterations, Range::within(1, 8)},
          {"optimize.smoothness_weight", &o.optimization.smoothness_weight, Range::atLeast(0)},
          {"optimize.tangential_weight", &o.optimization.tangential_weight, Range::atLeast(0)},
          {"optimize.flip", &o.optimization.flip, flag},
          {"align.min_support", &o.alignment.min_support, Range::above(0).atMost(1)},
          {"align.max_alias", &o.alignment.max_alias, Range::above(0).atMost(1)},
          {"texture.border", &o.texture.border, Range::within(1, 16)},
          {"texture.smoothness", &o.texture.smoothness, Range::above(0).zero("best view of each face")},
          {"texture.margin", &o.texture.margin, Range::within(0, 100)},
          {"texture.depth_tolerance", &o.texture.depth_tolerance, Range::within(0, 0.5)},
          {"texture.refine", &o.texture.refine, flag},
          {"texture.exposure", &o.texture.exposure, flag},
          {"texture.consistency", &o.texture.consistency, flag},
          {"texture.level", &o.texture.level, flag},
          {"texture.blend_width", &o.texture.blend_width, Range::within(0, 100)},
          {"texture.rounds", &o.texture.rounds, Range::within(0, 100)},
          {"texture.memory", &o.texture.memory, Range::atLeast(1)}};
}

void assign(const Row& row, const std::string& text)
{
  double number = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  require(read.ec == std::errc() && read.ptr == text.data() + text.size() && std::isfinite(number), "option ", row.name,
          " wants a number, not '", text, "'");
  require(row.range.holds(number), "option ", row.name, ": ", text, " is out of range: ", row.range.text());
  const auto store = [&](auto* value) {
    using T = std::decay_t<decltype(*value)>;
    require(!std::is_integral_v<T> || (number == std::floor(number) && std::abs(number) < 1e9), "option ", row.name,
            " wants a whole number, not ", text);
    *value = T(number);
  };
  std::visit(store, row.value);
}
} // namespace

StageOptions::StageOptions(int threads, const std::vector<std::pair<std::string, std::string>>& asked)
{
  for (int* each : {&registration.threads, &mixed_pixels.threads, &outliers.threads, &normals.threads,
                    &smoothing.threads, &fusion.threads, &tracking.threads, &reconstruction.threads,
                    &optimization.threads, &alignment.threads, &texture.threads})
    *each = threads;
  outliers.relative = true; // density falls with the distance from the scanner
  outliers.sigma = 3;
  optimization.flip = true;
  reconstruction.depth = 0; // the cells of the chain set it
  const std::vector<Row> rows = rowsOf(*this);
  for (const auto& [name, text] : asked) {
    const std::string stage = name.substr(0, name.find('.') + 1);
    std::vector<std::string> others;
    const Row* row = nullptr;
    for (const Row& each : rows) {
      if (name == each.name)
        row = &each;
      if (std::string(each.name).rfind(stage, 0) == 0)
        others.emplace_back(each.name);
    }
    require(row, "model: no option ", name,
            others.empty() ? "; stages are register, filter, normals, fuse, track, reconstruct, "
                             "optimize, align, texture"
                           : "; there are " + listed(others, 20));
    assign(*row, text);
  }
}
} // namespace fresco::model
