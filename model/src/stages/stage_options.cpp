// SPDX-License-Identifier: BSD-3-Clause
#include "stages/stage_options.h"
#include <charconv>
#include <cmath>
#include <fresco/core/require.h>
#include <fresco/io/listed.h>
#include <functional>
#include <variant>
namespace fresco::model {
namespace {
using Value = std::variant<int*, float*, double*, bool*>;

struct Row {
  const char* name;
  Value value;
};

/// Every option that reaches a stage, under the name of its tool.
std::vector<Row> rowsOf(StageOptions& o)
{
  return {{"register.voxel", &o.registration.voxel},
          {"register.max_distance", &o.registration.max_distance},
          {"register.min_overlap", &o.registration.min_overlap},
          {"register.max_violation", &o.registration.max_violation},
          {"register.max_iterations", &o.registration.max_iterations},
          {"register.upright", &o.registration.upright},
          {"filter.outlier_neighbors", &o.outliers.k},
          {"filter.outlier_sigma", &o.outliers.sigma},
          {"filter.veil_angle", &o.mixed_pixels.angle},
          {"filter.noise", &o.mixed_pixels.noise},
          {"normals.k", &o.normals.k},
          {"normals.radius", &o.normals.radius},
          {"normals.edges", &o.normals.edges},
          {"normals.sigma_d", &o.smoothing.sigma_d},
          {"normals.sigma_n", &o.smoothing.sigma_n},
          {"normals.move_rounds", &o.smoothing.move_rounds},
          {"fuse.truncation", &o.fusion.truncation},
          {"fuse.free_weight", &o.fusion.free_weight},
          {"track.nearest", &o.tracking.nearest},
          {"track.farthest", &o.tracking.farthest},
          {"track.refinement_rounds", &o.tracking.refinement_rounds},
          {"track.calibrate_color", &o.tracking.calibrate_color},
          {"reconstruct.depth", &o.reconstruction.depth},
          {"reconstruct.point_weight", &o.reconstruction.point_weight},
          {"reconstruct.samples_per_node", &o.reconstruction.samples_per_node},
          {"reconstruct.scale", &o.reconstruction.scale},
          {"reconstruct.trim", &o.reconstruction.trim},
          {"reconstruct.iterations", &o.reconstruction.iterations},
          {"optimize.iterations", &o.optimization.iterations},
          {"optimize.smoothness_weight", &o.optimization.smoothness_weight},
          {"optimize.tangential_weight", &o.optimization.tangential_weight},
          {"optimize.flip", &o.optimization.flip},
          {"align.min_support", &o.alignment.min_support},
          {"align.max_alias", &o.alignment.max_alias},
          {"texture.border", &o.texture.border},
          {"texture.smoothness", &o.texture.smoothness},
          {"texture.margin", &o.texture.margin},
          {"texture.depth_tolerance", &o.texture.depth_tolerance},
          {"texture.refine", &o.texture.refine},
          {"texture.exposure", &o.texture.exposure},
          {"texture.consistency", &o.texture.consistency},
          {"texture.level", &o.texture.level},
          {"texture.blend_width", &o.texture.blend_width},
          {"texture.rounds", &o.texture.rounds},
          {"texture.memory", &o.texture.memory}};
}

void assign(const Row& row, const std::string& text)
{
  double number = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  require(read.ec == std::errc() && read.ptr == text.data() + text.size() && std::isfinite(number), "option ", row.name,
          " wants a number, not '", text, "'");
  const auto store = [&](auto* value) {
    using T = std::decay_t<decltype(*value)>;
    if constexpr (std::is_same_v<T, bool>)
      require(number == 0 || number == 1, "option ", row.name, " wants 0 or 1, not ", text);
    if constexpr (std::is_integral_v<T>)
      require(number == std::floor(number) && std::abs(number) < 1e9, "option ", row.name,
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
