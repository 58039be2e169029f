// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.h"
#include "call.h"
#include <fresco/deliverables/core/model_file.h>
namespace fresco::python {
namespace {
/// A function that reads a file or folder: read(path) gives what is in it.
template <typename Read>
void addReader(const py::module_& module, const char* name, const char* core, const char* result, const Read& read)
{
  addFunction(module, {name, core, {{"path", "Path"}}, result, "", false}, [read](const Call& call) {
    const auto path = call.value<std::string>("path");
    return toPython(Call::access([&] { return read(path); }));
  });
}

/// One that writes: write(path, value).
template <typename Value, typename Write>
void addWriter(const py::module_& module, const char* name, const char* core, const char* argument, const Write& write)
{
  const Function function{name, core, {{"path", "Path"}, {argument, Convert<Value>::annotation()}}, "None", "", false};
  addFunction(module, function, [argument, write](const Call& call) {
    const auto path = call.value<std::string>("path");
    const Lent<Value> value = call.lend<Value>(argument);
    Call::access([&] { write(path, *value); });
    return py::none();
  });
}

void addPoints(const py::module_& module)
{
  addRecord<ScanInfo>(module);
  addReader(module, "read_scan_infos", "readScanInfos", "list[ScanInfo]",
            [](const std::string& path) { return readScanInfos(path); });
  addFunction(module,
              {"read_points",
               "readPoints",
               {{"path", "Path"}, {"scan", "Optional[int]", "None"}},
               "PointSet",
               "`scan` is one of read_scan_infos(), from 0; None = all of them as one cloud.",
               false},
              [](const Call& call) {
                const auto path = call.value<std::string>("path");
                const auto scan = call.value<std::optional<int>>("scan");
                if (scan && *scan < 0)
                  throw py::value_error(concat("scan: ", *scan, " is negative"));
                return toPython(Call::access([&] { return readPoints(ScanPath{path, scan ? *scan : -1}); }));
              });
  addFunction(module, {"write_points", "writePoints", {{"path", "Path"}, {"points", "PointSet"}}, "None", "", false},
              [](const Call& call) {
                const auto path = call.value<std::string>("path");
                const auto set = lendPoints(call);
                Call::access([&] { writePoints(path, *set); });
                return py::none();
              });
}

void addMeshes(const py::module_& module)
{
  addReader(module, "read_mesh", "readMesh", "TriangleMesh", [](const std::string& path) { return readMesh(path); });
  addFunction(module,
              {"write_mesh", "writeMesh", {{"path", "Path"}, {"mesh", "TriangleMesh"}}, "None", "Also .glb.", false},
              [](const Call& call) {
                const auto path = call.value<std::string>("path");
                const auto mesh = lendMesh(call);
                Call::access([&] { writeModel(path, {{*mesh, {}, {}, {}, {}}, {}}); });
                return py::none();
              });
  addReader(module, "read_textured_mesh", "readTexturedMesh", "TexturedMesh",
            [](const std::string& path) { return readTexturedMesh(path); });
  addFunction(module,
              {"write_textured_mesh",
               "writeTexturedMesh",
               {{"path", "Path"}, {"model", "TexturedMesh"}, {"jpeg_quality", "int", "0"}},
               "None",
               "",
               false},
              [](const Call& call) {
                const auto path = call.value<std::string>("path");
                const auto model = call.lend<TexturedMesh>("model");
                require(model->mesh.vertexCount() > 0, "model: no vertices");
                const int quality = call.value<int>("jpeg_quality");
                Call::access([&] { writeTexturedMesh(path, *model, quality); });
                return py::none();
              });
}
} // namespace

void addIo(const py::module_& module)
{
  addPoints(module);
  addMeshes(module);
  addReader(module, "read_poses", "readPoses", "list[Optional[Doubles]]",
            [](const std::string& path) { return readPoses(path); });
  addWriter<std::vector<Pose>>(module, "write_poses", "writePoses", "poses",
                               [](const auto& path, const auto& poses) { writePoses(path, poses); });
  addReader(module, "read_cameras", "readColmap", "CameraSet",
            [](const std::string& folder) { return readColmap(folder); });
  addWriter<CameraSet>(module, "write_cameras", "writeColmap", "cameras",
                       [](const auto& folder, const auto& cameras) { writeColmap(folder, cameras); });
  addReader(module, "read_image", "readImage", "Bytes", [](const std::string& path) { return readImage(path); });
  addFunction(module,
              {"write_image",
               "writeImage",
               {{"path", "Path"}, {"image", "Bytes"}, {"quality", "int", "95"}},
               "None",
               "",
               false},
              [](const Call& call) {
                const auto path = call.value<std::string>("path");
                const Image image = call.value<Image>("image");
                if (image.empty())
                  throw py::value_error("image: no pixels");
                const int quality = call.value<int>("quality");
                Call::access([&] { writeImage(path, image, quality); });
                return py::none();
              });
}
} // namespace fresco::python
