// SPDX-License-Identifier: BSD-3-Clause
#include "io/texture/texture_io.h"
#include "io/files/format_table.h"
#include "io/points/parse_file.h"
#include <Eigen/LU>
#include <filesystem>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
namespace fresco {
namespace {
bool isGlb(const io::Format& format) { return format.extensions[0] == std::string(".glb"); }

/// All but the images.
void validateFaces(const TexturedMesh& model)
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
}

GltfOptions gltfOptions(int jpeg_quality)
{
  GltfOptions options;
  options.jpeg_quality = jpeg_quality;
  return options;
}
} // namespace

void validateTexturedMesh(const TexturedMesh& model)
{
  validateFaces(model);
  for (const Image& image : model.atlases)
    require(image.width > 0 && image.height > 0 && image.channels == 3 &&
                image.data.size() == std::size_t{3} * image.width * image.height,
            "textured mesh: an atlas is no RGB image");
}

void writeTexturedMesh(const std::string& path, const TexturedMesh& model, int jpeg_quality)
{
  validateTexturedMesh(model);
  TexturedMeshWriter writer(path, jpeg_quality, model.atlases.size() > 1);
  for (const Image& atlas : model.atlases)
    writer.addAtlas(atlas);
  writer.finish(model);
}

struct TexturedMeshWriter::Parts {
  std::string path;
  int quality;
  bool several;
  std::unique_ptr<io::ImageFilesWriter> files;   ///< null: .glb
  std::vector<std::vector<std::uint8_t>> images; ///< of a .glb
  std::size_t count = 0;
};

TexturedMeshWriter::TexturedMeshWriter(const std::string& path, int jpeg_quality, bool several)
    : parts_(new Parts{path, jpeg_quality, several, nullptr, {}})
{
  require(jpeg_quality >= 0 && jpeg_quality <= 100, "textured mesh: JPEG quality ", jpeg_quality, " is not in 0..100");
  if (!isGlb(io::formatToWrite(path, FileKind::textured_mesh)))
    parts_->files = std::make_unique<io::ImageFilesWriter>(path, jpeg_quality);
}

TexturedMeshWriter::~TexturedMeshWriter() = default;

void TexturedMeshWriter::addAtlas(const Image& atlas)
{
  if (parts_->files)
    parts_->files->addAtlas(atlas, parts_->several ? concat('_', parts_->count) : "");
  else
    parts_->images.push_back(io::storedImage(atlas, parts_->quality));
  ++parts_->count;
}

void TexturedMeshWriter::finish(const TexturedMesh& model)
{
  validateFaces(model);
  require(model.atlases.size() == parts_->count, "textured mesh: ", parts_->count, " atlases were added of ",
          model.atlases.size());
  if (parts_->files)
    parts_->files->finish(model);
  else
    io::writeGlb(parts_->path, {model, {}}, gltfOptions(parts_->quality), std::move(parts_->images));
}

std::string maskPath(const std::string& model, std::size_t index, std::size_t count)
{
  const std::string stem = model.substr(0, model.size() - extension(model).size());
  return stem + (count > 1 ? concat("_mask_", index, ".png") : "_mask.png");
}

TexturedModelWriter::TexturedModelWriter(std::vector<File> files) : files_(std::move(files))
{
  require(!files_.empty(), "textured model: no file");
}

TexturedModelWriter::~TexturedModelWriter() = default;

void TexturedModelWriter::addAtlas(const Image& atlas, const Image& mask)
{
  constexpr std::size_t several = 2;
  for (std::size_t i = writers_.size(); i < files_.size(); ++i)
    writers_.push_back(std::make_unique<TexturedMeshWriter>(files_[i].path, files_[i].jpeg_quality));
  for (const auto& writer : writers_)
    writer->addAtlas(atlas);
  writeImage(maskPath(files_[0].path, masks_++, several), mask);
}

void TexturedModelWriter::finish(const TexturedMesh& model, const std::vector<Image>& masks)
{
  for (const auto& writer : writers_)
    writer->finish(model);
  for (std::size_t i = writers_.size(); i < files_.size(); ++i)
    writeTexturedMesh(files_[i].path, model, files_[i].jpeg_quality);
  for (std::size_t i = masks_; i < masks.size(); ++i)
    writeImage(maskPath(files_[0].path, i, masks.size()), masks[i]);
}

void writeGltf(const std::string& path, const GltfModel& scene, const GltfOptions& options)
{
  const auto& [model, normal_maps] = scene;
  validateTexturedMesh(model);
  require(options.jpeg_quality >= 0 && options.jpeg_quality <= 100, "glTF: JPEG quality ", options.jpeg_quality,
          " is not in 0..100");
  require(normal_maps.empty() || normal_maps.size() == model.atlases.size(), "glTF: ", model.atlases.size(),
          " atlases, ", normal_maps.size(), " normal maps");
  for (const Image& image : normal_maps)
    require(image.channels == 3 && image.data.size() == std::size_t{3} * image.width * image.height,
            "glTF: a normal map is no RGB image");
  require(options.T_world_model.allFinite() && options.T_world_model.row(3) == Eigen::RowVector4d(0, 0, 0, 1) &&
              std::abs(options.T_world_model.determinant()) > 0,
          "glTF: the transform into the world is none");
  require(extension(path) == ".glb", path, ": glTF is written to .glb");
  std::vector<std::vector<std::uint8_t>> images;
  for (const Image& atlas : model.atlases)
    images.push_back(io::storedImage(atlas, options.jpeg_quality));
  io::writeGlb(path, {model, normal_maps}, options, std::move(images));
}

std::vector<std::uint8_t> io::storedImage(const Image& image, int jpeg_quality)
{
  return encodeImage(image, jpeg_quality > 0 ? ".jpg" : ".png", jpeg_quality);
}

GltfModel readGltf(const std::string& path)
{
  require(isGlb(io::formatToRead(path, FileKind::textured_mesh)), path, ": is no .glb");
  return io::parseFile(path, [&](std::string_view content) {
    return io::parseGlb(content, std::filesystem::path(path).parent_path().string());
  });
}

Groups io::facesByAtlas(const TexturedMesh& model)
{
  return grouped(model.mesh.faceCount(), model.atlases.size() + 1, [&](Index f) { return model.face_atlas[f] + 1; });
}

TexturedMesh readTexturedMesh(const std::string& path)
{
  if (isGlb(io::formatToRead(path, FileKind::textured_mesh)))
    return readGltf(path).model;
  return extension(path) == ".ply" ? io::readTexturedPly(path) : io::readTexturedObj(path);
}

TexturedMesh readTextureLayout(const std::string& path)
{
  io::formatToRead(path, FileKind::textured_mesh);
  return extension(path) == ".obj" ? io::readTexturedObj(path, true) : readTexturedMesh(path);
}
} // namespace fresco
