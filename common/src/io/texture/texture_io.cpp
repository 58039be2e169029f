// SPDX-License-Identifier: BSD-3-Clause
#include "io/texture/texture_io.h"
#include "io/format_table.h"
#include "io/points/parse_file.h"
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/io/mesh_io.h>
namespace fresco {
namespace {
bool isGlb(const io::Format& format) { return format.extensions[0] == std::string(".glb"); }
} // namespace

void validateTexturedMesh(const TexturedMesh& model)
{
  validateMesh(model.mesh);
  const Index faces = model.mesh.faceCount(), texcoords = model.texcoords.cols();
  const Index atlases = model.atlases.size();
  require(model.texcoord_faces.cols() == faces && model.face_atlas.size() == faces, "textured mesh: ", faces,
          " faces, ", model.texcoord_faces.cols(), " with texture coordinates, ", model.face_atlas.size(),
          " with an atlas");
  require(model.texcoords.allFinite(), "textured mesh: a texture coordinate is not finite");
  for (Index f = 0; f < faces; ++f) {
    const int atlas = model.face_atlas[f];
    require(atlas >= -1 && atlas < atlases, "textured mesh: face ", f, " names atlas ", atlas, ", there are ", atlases);
    for (int k = 0; k < 3; ++k) {
      const int texcoord = model.texcoord_faces(k, f);
      require(atlas < 0 ? texcoord == -1 : texcoord >= 0 && texcoord < texcoords, "textured mesh: face ", f,
              " of atlas ", atlas, " names texture coordinate ", texcoord, ", there are ", texcoords);
    }
  }
  for (const Image& image : model.atlases)
    require(image.width > 0 && image.height > 0 && image.channels == 3 &&
                image.data.size() == std::size_t{3} * image.width * image.height,
            "textured mesh: an atlas is no RGB image");
}

void writeTexturedMesh(const std::string& path, const TexturedMesh& model, int jpeg_quality)
{
  validateTexturedMesh(model);
  require(jpeg_quality >= 0 && jpeg_quality <= 100, "textured mesh: JPEG quality ", jpeg_quality, " is not in 0..100");
  if (isGlb(io::formatToWrite(path, FileKind::textured_mesh)))
    io::writeGlb(path, model, jpeg_quality);
  else
    io::writeTexturedObj(path, model, jpeg_quality);
}

TexturedMesh readTexturedMesh(const std::string& path)
{
  if (isGlb(io::formatToRead(path, FileKind::textured_mesh)))
    return io::parseFile(path, [&](std::string_view content) {
      return io::parseGlb(content, std::filesystem::path(path).parent_path().string());
    });
  return io::readTexturedObj(path);
}

TexturedMesh readTextureLayout(const std::string& path)
{
  return isGlb(io::formatToRead(path, FileKind::textured_mesh)) ? readTexturedMesh(path)
                                                                : io::readTexturedObj(path, true);
}
} // namespace fresco
