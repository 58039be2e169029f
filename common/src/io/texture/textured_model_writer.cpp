// SPDX-License-Identifier: BSD-3-Clause
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
namespace fresco {
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
} // namespace fresco
