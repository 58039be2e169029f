// SPDX-License-Identifier: BSD-3-Clause
// Texture from calibrated photographs on a mesh, as a pcl::TextureMesh and its images.
#include <filesystem>
#include <fresco/io/colmap.h>
#include <fresco/texture/texture_reconstruction.h>
#include <iostream>
#include <pcl/io/obj_io.h>
#include <pcl/io/ply_io.h>
int main(int argc, char** argv)
try {
  if (argc != 5) {
    std::cerr << "usage: texture MESH.ply CAMERAS_DIR IMAGES_DIR OUT_DIR   (CAMERAS_DIR: a COLMAP model)\n";
    return 2;
  }
  const std::string images = argv[3], out = argv[4];
  const auto mesh = pcl::make_shared<pcl::PolygonMesh>();
  if (pcl::io::loadPLYFile(argv[1], *mesh) != 0)
    return 1;

  fresco::TextureReconstruction texture;
  texture.setInputMesh(mesh);
  const fresco::CameraSet cameras = fresco::readColmap(argv[2]);
  for (const fresco::View& view : cameras.views)
    texture.addView(cameras.cameras[view.camera], view.T_camera_world, images + "/" + view.image);
  texture.setProgress([](std::string_view step, double share) {
    std::cout << static_cast<int>(100 * share) << " % " << step << "\n";
    return true; // false would stop
  });

  pcl::TextureMesh model;
  texture.process(model);
  std::cout << texture.getResult().charts << " charts, " << 100 * texture.getResult().coverage
            << " % of the area seen\n";

  std::filesystem::create_directories(out);
  texture.saveAtlases(out);
  return pcl::io::saveOBJFile(out + "/model.obj", model, 9) == 0 ? 0 : 1;
} catch (const std::exception& error) {
  std::cerr << "texture: " << error.what() << "\n";
  return 1;
}
