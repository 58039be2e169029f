// SPDX-License-Identifier: BSD-3-Clause
#include "io/texture/texture_io.h"
#include "io/format_table.h"
#include "io/points/parse_file.h"
#include <algorithm>
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/io/mesh_io.h>
namespace fresco {
namespace io {
namespace {
/// The functions behind a row of the table of formats that is marked as textured.
struct TextureFormat {
  const char* extension;
  TexturedMesh (*read)(const std::string& path);
  void (*write)(const std::string& path, const TexturedMesh& model, int jpeg_quality);
};

TexturedMesh readGlb(const std::string& path)
{
  return parseFile(path, [&](std::string_view content) {
    return parseGlb(content, std::filesystem::path(path).parent_path().string());
  });
}
void writeObjModel(const std::string& path, const TexturedMesh& model, int) { writeTexturedObj(path, model); }

const TextureFormat& textureFormatOf(const Format& row)
{
  static constexpr TextureFormat all[] = {{".obj", readTexturedObj, writeObjModel}, {".glb", readGlb, writeGlb}};
  return *std::find_if(std::begin(all), std::end(all),
                       [&](const TextureFormat& format) { return row.extensions[0] == std::string(format.extension); });
}
} // namespace
} // namespace io

void validateTexturedMesh(const TexturedMesh& model)
{
  validateMesh(model.mesh);
  const Index faces = model.mesh.faceCount(), texcoords = model.texcoords.cols();
  const auto atlases = static_cast<Index>(model.atlases.size());
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
                image.data.size() == static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 3,
            "textured mesh: an atlas is no RGB image");
}

void writeTexturedMesh(const std::string& path, const TexturedMesh& model, int jpeg_quality)
{
  validateTexturedMesh(model);
  require(jpeg_quality >= 0 && jpeg_quality <= 100, "textured mesh: JPEG quality ", jpeg_quality, " is not in 0..100");
  io::textureFormatOf(io::formatToWrite(path, FileKind::textured_mesh)).write(path, model, jpeg_quality);
}

TexturedMesh readTexturedMesh(const std::string& path)
{
  return io::textureFormatOf(io::formatToRead(path, FileKind::textured_mesh)).read(path);
}
} // namespace fresco
