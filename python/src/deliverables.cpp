// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.h"
#include "call.h"
namespace fresco::python {
namespace {
const char* const any_model = "Union[TriangleMesh, TexturedMesh]";

/// The model that a call is given, as what it is: onMesh(TriangleMesh) or onModel(TexturedMesh).
template <typename OnMesh, typename OnModel>
py::object visitModel(const Call& call, const OnMesh& onMesh, const OnModel& onModel)
{
  if (py::isinstance(call["model"], recordClass<TexturedMesh>())) {
    const auto model = call.lend<TexturedMesh>("model");
    return onModel(*model);
  }
  const auto mesh = lendMesh(call, "model");
  return onMesh(*mesh);
}

CropRegion regionOf(const Call& call)
{
  using Rows = py::array_t<double, py::array::c_style | py::array::forcecast>;
  CropRegion region;
  if (!call["outlines"].is_none())
    for (const py::object& entry : toEntries(call["outlines"], "outlines", "ArrayLike")) {
      const Rows rows = Rows::ensure(entry);
      if (!rows || rows.ndim() != 2 || rows.shape(1) != 2)
        throw py::value_error("outlines: an outline is no array of shape (K, 2)");
      region.outlines.emplace_back(Eigen::Map<const Eigen::Matrix2Xd>(rows.data(), 2, rows.shape(0)));
    }
  region.low = call.value<std::optional<double>>("low").value_or(region.low);
  region.high = call.value<std::optional<double>>("high").value_or(region.high);
  return region;
}
} // namespace

void addDeliverables(const py::module_& module)
{
  addRecord<GltfModel>(module);
  addFunction<SimplificationOptions>(
      module, {"simplify", "simplifyModel", {{"model", any_model}}, any_model, "A mesh gives a mesh."},
      [](const Call& call) {
        const auto options = call.options<SimplificationOptions>();
        const auto run = [&](const auto& simplify) {
          return [&](const auto& model) {
            return call.run([&](const Progress& progress) { return simplify(model, options, nullptr, progress); });
          };
        };
        return visitModel(call, run(simplifyMesh), run(simplifyModel));
      });
  addFunction<LightModelOptions>(
      module, {"make_light_model", "makeLightModel", {{"full", "TexturedMesh"}}, "GltfModel"}, [](const Call& call) {
        const auto full = call.lend<TexturedMesh>("full");
        const auto options = call.options<LightModelOptions>();
        return call.run([&](const Progress& progress) { return makeLightModel(*full, options, progress); });
      });
  addFunction(module,
              {"crop",
               "cropModel",
               {{"model", any_model},
                {"outlines", "Optional[Sequence[ArrayLike]]", "None"},
                {"low", "Optional[float]", "None"},
                {"high", "Optional[float]", "None"}},
               any_model,
               "A mesh gives a mesh. `outlines` are arrays of shape (K, 2), world x y, of which one in another is a "
               "hole; `low` "
               "and `high` are heights. None = no bound.",
               false},
              [](const Call& call) {
                const CropRegion region = regionOf(call);
                const auto run = [&](const auto& crop) {
                  return
                      [&](const auto& model) { return call.run([&](const Progress&) { return crop(model, region); }); };
                };
                return visitModel(call, run(cropMesh), run(cropModel));
              });
  addFunction<GltfOptions>(
      module,
      {"write_gltf",
       "writeGltf",
       {{"path", "Path"}, {"model", "GltfModel"}, {"T_world_model", "Optional[ArrayLike]", "None"}},
       "None",
       "",
       false},
      [](const Call& call) {
        const auto path = call.value<std::string>("path");
        const auto model = call.lend<GltfModel>("model");
        auto options = call.options<GltfOptions>();
        if (!call["T_world_model"].is_none())
          options.T_world_model = call.value<Eigen::Matrix4d>("T_world_model");
        Call::access([&] { writeGltf(path, *model, options); });
        return py::none();
      });
}
} // namespace fresco::python
