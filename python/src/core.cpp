// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.h"
#include "call.h"
namespace fresco::python {
void addCore(const py::module_& module)
{
  addRecord<PointSet>(module);
  addRecord<TriangleMesh>(module);
  addRecord<TexturedMesh>(module);
  addRecord<CameraModel>(module);
  addRecord<View>(module);
  addRecord<CameraSet>(module);
  addRecord<MeshTopology>(module);
  addFunction(module, {"merge_points", "mergePoints", {{"a", "PointSet"}, {"b", "PointSet"}}, "PointSet", "", false},
              [](const Call& call) {
                const auto a = lendPoints(call, "a"), b = lendPoints(call, "b");
                return call.run([&](const Progress&) { return mergePoints(*a, *b); });
              });
  addFunction(module,
              {"select_points",
               "selectPoints",
               {{"points", "PointSet"}, {"indices", "Indices"}},
               "PointSet",
               "`indices` are int64.",
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
