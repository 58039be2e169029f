// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.h"
#include "call.h"
namespace fresco::python {
/// What a filter leaves of a set of points.
struct FilterResult {
  PointSet points;
  std::vector<Index> kept;
};

template <>
struct Fields<FilterResult> {
  static constexpr const char* name = "FilterResult";
  static constexpr const char* text = "What a filter leaves of a set of points.";
  template <typename Visitor>
  static void visit(Visitor&& visit)
  {
    visit("points", &FilterResult::points, "those that stay, with all attributes");
    visit("kept", &FilterResult::kept, "(M,), where they were in the input, ascending");
  }
};

namespace {
FilterResult keep(const PointSet& set, std::vector<Index> kept)
{
  PointSet points = selectPoints(set, kept);
  return {std::move(points), std::move(kept)};
}

void addNormals(const py::module_& module)
{
  addRecord<NormalField>(module);
  addRecord<BilateralResult>(module);
  addFunction<NormalOptions>(
      module, {"estimate_normals", "estimateNormals", {{"points", "PointSet"}}, "NormalField"}, [](const Call& call) {
        const auto set = lendPoints(call);
        const auto options = call.options<NormalOptions>();
        return call.run([&](const Progress& progress) { return estimateNormals(*set, options, progress); });
      });
  addFunction<BilateralOptions>(
      module,
      {"smooth_normals",
       "smoothNormals",
       {{"points", "PointSet"}, {"normals", "Optional[Floats]", "None"}},
       "BilateralResult",
       "Without `normals` those of the points are smoothed. Where `points.viewpoints` are known, after each of the "
       "first two rounds normals beside creases are compared with the directions that are frequent around (`edges`)."},
      [](const Call& call) {
        const auto set = lendPoints(call);
        const bool own = call["normals"].is_none();
        const Lent<Points> given = call.lend<Points>("normals");
        const Points& normals = own ? set->normals : *given;
        require(normals.cols() > 0, own ? "points: no normals" : "normals: none");
        const auto options = call.options<BilateralOptions>();
        return call.run([&](const Progress& progress) { return smoothNormals(*set, normals, options, progress); });
      });
}
} // namespace

void addFilters(const py::module_& module)
{
  addRecord<FilterResult>(module);
  addNormals(module);
  addFunction<MixedPixelOptions>(module,
                                 {"remove_mixed_pixels",
                                  "withoutMixedPixels",
                                  {{"points", "PointSet"}},
                                  "FilterResult",
                                  "The viewpoints are `points.viewpoints`, which must be known."},
                                 [](const Call& call) {
                                   const auto set = lendPoints(call);
                                   require(set->viewpoints.cols() > 0, "points: no viewpoints");
                                   const auto options = call.options<MixedPixelOptions>();
                                   return call.run([&](const Progress& progress) {
                                     return keep(*set,
                                                 withoutMixedPixels(set->points, set->viewpoints, options, progress));
                                   });
                                 });
  addFunction<OutlierOptions>(
      module, {"remove_outliers", "withoutOutliers", {{"points", "PointSet"}}, "FilterResult", "", false},
      [](const Call& call) {
        const auto set = lendPoints(call);
        const auto options = call.options<OutlierOptions>();
        return call.run([&](const Progress&) { return keep(*set, withoutOutliers(set->points, options)); });
      });
  addFunction(module,
              {"thin",
               "thinByVoxel",
               {{"points", "PointSet"}, {"cell", "float"}, {"centroids", "bool", "False"}, {"threads", "int", "0"}},
               "FilterResult",
               "Keeps one point for each occupied cell of a grid: the one nearest to the centroid of its cell, moved "
               "to it with `centroids`.",
               false},
              [](const Call& call) {
                const auto set = lendPoints(call);
                const auto cell = call.value<float>("cell");
                const bool centroids = call.value<bool>("centroids");
                const int threads = call.value<int>("threads");
                return call.run([&](const Progress&) {
                  VoxelThinning thinning = thinByVoxel(set->points, cell, threads);
                  FilterResult result = keep(*set, std::move(thinning.kept));
                  if (centroids)
                    result.points.points.swap(thinning.centroids);
                  return result;
                });
              });
}
} // namespace fresco::python
