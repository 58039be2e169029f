// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.h"
#include "call.h"
namespace fresco::python {
namespace {
py::object mergeAll(const Call& call)
{
  const bool is_one = py::isinstance(call["a"], recordClass<PointSet>());
  if (is_one == call["b"].is_none())
    throw py::type_error("merge_points() wants two sets, or a sequence of sets");
  const Lent<std::vector<PointSet>> sets(is_one ? py::object(py::make_tuple(call["a"], call["b"])) : call["a"],
                                         is_one ? "points" : "a");
  if (sets->empty())
    throw py::value_error("a: no sets");
  for (const PointSet& set : *sets)
    validatePointSet(set);
  return call.run([&](const Progress&) {
    PointSet merged = sets->front();
    for (std::size_t i = 1; i < sets->size(); ++i)
      appendPoints(merged, (*sets)[i]);
    return merged;
  });
}
} // namespace

void addCore(const py::module_& module)
{
  addRecord<PointSet>(module);
  addRecord<TriangleMesh>(module);
  addRecord<TexturedMesh>(module);
  addRecord<CameraModel>(module);
  addRecord<View>(module);
  addRecord<CameraSet>(module);
  addRecord<MeshTopology>(module);
  addFunction(module,
              {"merge_points",
               "mergePoints",
               {{"a", "Union[PointSet, Sequence[PointSet]]"}, {"b", "Optional[PointSet]", "None"}},
               "PointSet",
               "`a` may be a sequence of sets, which are merged in its order.",
               false},
              mergeAll);
  addFunction(module,
              {"select_points",
               "selectPoints",
               {{"points", "PointSet"}, {"indices", "Indices"}},
               "PointSet",
               "`indices` may be a mask, an entry per point.",
               false},
              [](const Call& call) {
                const auto set = lendPoints(call);
                const auto indices = call.value<std::vector<Index>>("indices");
                return call.run([&](const Progress&) { return selectPoints(*set, indices); });
              });
  addFunction(module,
              {"transform_points",
               "transformPoints",
               {{"points", "PointSet"}, {"T_target_source", "ArrayLike"}},
               "PointSet",
               "",
               false},
              [](const Call& call) {
                const auto set = lendPoints(call);
                const auto T_target_source = call.value<Eigen::Matrix4d>("T_target_source");
                return call.run([&](const Progress&) { return transformPoints(*set, T_target_source); });
              });
  addFunction(module, {"mesh_topology", "meshTopology", {{"mesh", "TriangleMesh"}}, "MeshTopology", "", false},
              [](const Call& call) {
                const auto mesh = lendMesh(call);
                return call.run([&](const Progress&) { return meshTopology(*mesh); });
              });
  addFunction(
      module,
      {"vertex_normals", "vertexNormals", {{"mesh", "TriangleMesh"}, {"threads", "int", "0"}}, "Floats", "", false},
      [](const Call& call) {
        const auto mesh = lendMesh(call);
        const int threads = call.value<int>("threads");
        return call.run([&](const Progress&) { return vertexNormals(*mesh, threads); });
      });
}
} // namespace fresco::python
