// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.h"
#include "call.h"
namespace fresco::python {
namespace {
std::vector<TextureView> readViews(const std::string& cameras, const std::string& images)
{
  const CameraSet set = readCameraFile(cameras, images).set;
  std::vector<TextureView> views;
  for (const View& view : set.views) {
    TextureView& out = views.emplace_back();
    out.camera = set.cameras[view.camera];
    out.T_camera_world = view.T_camera_world;
    out.path = images + "/" + view.image;
    out.mask_path = maskFileOf(images, view.image);
  }
  return views;
}
} // namespace

void addTexture(const py::module_& module)
{
  addRecord<TextureView>(module);
  addRecord<TextureResult>(module);
  addRecord<PlacedCamera>(module);
  addRecord<PhotographFit>(module);
  addRecord<PointTextureResult>(module);
  addFunction(module,
              {"read_views",
               "readCameraFile",
               {{"cameras", "Path"}, {"images", "Path"}},
               "list[TextureView]",
               "The photographs are in the folder `images`; they are read when they are needed. Masks are found as "
               "`masks/NAME.png` in it or beside it, white where the photograph is used.",
               false},
              [](const Call& call) {
                const auto cameras = call.value<std::string>("cameras"), images = call.value<std::string>("images");
                return toPython(Call::access([&] { return readViews(cameras, images); }));
              });
  addFunction<TextureOptions>(
      module,
      {"reconstruct_texture",
       "reconstructTexture",
       {{"mesh", "Union[TriangleMesh, TexturedMesh]"}, {"views", "Sequence[TextureView]"}},
       "TextureResult",
       "A TexturedMesh is painted in the layout that it has: its texture coordinates stay."},
      [](const Call& call) {
        const auto views = call.lend<std::vector<TextureView>>("views");
        const auto options = call.options<TextureOptions>();
        if (py::isinstance(call["mesh"], recordClass<TexturedMesh>())) {
          const auto model = call.lend<TexturedMesh>("mesh");
          return call.run(
              [&](const Progress& progress) { return reconstructTexture(*model, *views, options, progress); });
        }
        const auto mesh = lendMesh(call);
        return call.run([&](const Progress& progress) { return reconstructTexture(*mesh, *views, options, progress); });
      });
  addFunction<PointTextureOptions>(module,
                                   {"reconstruct_point_texture",
                                    "reconstructPointTexture",
                                    {{"mesh", "TriangleMesh"}, {"points", "PointSet"}},
                                    "PointTextureResult"},
                                   [](const Call& call) {
                                     const auto mesh = lendMesh(call);
                                     const auto set = lendPoints(call);
                                     const auto options = call.options<PointTextureOptions>();
                                     return call.run([&](const Progress& progress) {
                                       return reconstructPointTexture(*mesh, *set, options, progress);
                                     });
                                   });
}
} // namespace fresco::python
