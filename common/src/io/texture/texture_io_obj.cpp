// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/obj.h"
#include "io/points/parse_file.h"
#include "io/points/text_numbers.h"
#include "io/texture/texture_io.h"
#include <algorithm>
#include <filesystem>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <map>
#include <memory>
namespace fresco::io {
namespace {
namespace fs = std::filesystem;

/// Writes `vt` lines and the faces of each material after another.
/// @param faces see facesByAtlas()
void writeFaces(OutputFile& file, const TexturedMesh& model, const Groups& faces, int atlas)
{
  for (Index i = faces.begin[atlas + 1]; i < faces.begin[atlas + 2]; ++i) {
    const int f = faces.list[i];
    writeObjFace(file, model.mesh, f, atlas < 0 ? nullptr : model.texcoord_faces.col(f).data());
  }
}

bool hasUntextured(const TexturedMesh& model) { return (model.face_atlas.array() < 0).any(); }

void writeMaterials(OutputFile& file, const TexturedMesh& model, const std::vector<std::string>& images)
{
  // No light: photographs hold it already.
  for (std::size_t i = 0; i < images.size(); ++i)
    file.write(textOf("newmtl material_", i, "\nKa 1 1 1\nKd 1 1 1\nKs 0 0 0\nillum 0\nmap_Kd ", images[i], "\n\n"));
  if (hasUntextured(model))
    file.write("newmtl untextured\nKa 0.7 0.7 0.7\nKd 0.7 0.7 0.7\nKs 0 0 0\nillum 1\n");
}

void writeModel(OutputFile& file, const TexturedMesh& model, const std::string& library)
{
  file.write("mtllib " + library + "\n");
  writeObjVertices(file, model.mesh);
  for (Index i = 0; i < model.texcoords.cols(); ++i)
    file.write(textOf("vt ", model.texcoords(0, i), ' ', model.texcoords(1, i), '\n'));
  const Groups faces = facesByAtlas(model);
  for (std::size_t i = 0; i < model.atlases.size(); ++i) {
    file.write(textOf("usemtl material_", i, "\n"));
    writeFaces(file, model, faces, i);
  }
  if (hasUntextured(model)) {
    file.write("usemtl untextured\n");
    writeFaces(file, model, faces, -1);
  }
}

/// File name of a map_Kd entry without options and quotes, relative to the .mtl file.
std::string imageName(std::string_view entry)
{
  const auto next = [&] {
    const std::size_t end = std::min(entry.find_first_of(" \t"), entry.size());
    const std::string_view word = entry.substr(0, end);
    entry.remove_prefix(std::min(entry.find_first_not_of(" \t", end), entry.size()));
    return word;
  };
  const auto is_number = [](std::string_view word) { return word.find_first_not_of("0123456789+-.eE") == word.npos; };
  while (entry.substr(0, 1) == "-") {
    const std::string_view option = next();
    if (option == "-o" || option == "-s" || option == "-t" || option == "-mm") // one to three numbers
      for (int i = 0; i < 3 && is_number(entry.substr(0, entry.find_first_of(" \t"))) && !entry.empty(); ++i)
        next();
    else
      next();
  }
  if (entry.size() > 1 && entry.front() == '"' && entry.back() == '"')
    entry = entry.substr(1, entry.size() - 2);
  return portablePath(std::string(entry));
}

/// Files that a statement mtllib names: one whose name holds blanks, or several.
std::vector<std::string> librariesIn(const std::string& folder, const std::string& entry)
{
  const std::string whole = portablePath(entry);
  std::vector<std::string> files;
  if (fs::is_regular_file(fs::path(folder) / whole))
    return {whole};
  for (std::size_t begin = 0; begin < whole.size();) {
    std::size_t end = begin;
    do // the next blank behind an extension
      end = std::min(whole.find(' ', end + 1), whole.size());
    while (end < whole.size() && extension(whole.substr(begin, end - begin)) != ".mtl");
    files.push_back(whole.substr(begin, end - begin));
    begin = std::min(whole.find_first_not_of(' ', end), whole.size());
  }
  return files;
}

/// Image file of each material name, "" for a material without one.
std::map<std::string, std::string> readLibraries(const std::string& path, const ObjContent& obj)
{
  std::map<std::string, std::string> images;
  const std::string folder = fs::path(path).parent_path().string();
  for (const std::string& entry : obj.libraries)
    for (const std::string& library : librariesIn(folder, entry))
      namingFile(path, [&] { // who wanted it
        const std::string file = fileBelow(folder, library);
        // Images lie beside the library, but not outside of the model's folder.
        const fs::path place = fs::path(library).parent_path();
        for (const auto& [name, map] : parseMtl(readFile(file)))
          images[name] = map.empty() ? "" : fileBelow(folder, (place / imageName(map)).string());
      });
  return images;
}

/// Reads each image once. @return atlas of each material, -1 where it has no image
std::vector<int> readAtlases(const std::string& path, const ObjContent& obj, std::vector<Image>& atlases)
{
  const auto files = readLibraries(path, obj);
  std::map<std::string, int> known;
  std::vector<int> of_material;
  for (const std::string& material : obj.materials) {
    const auto file = files.find(material);
    if (file == files.end() && !obj.libraries.empty())
      remark(concat("no library holds the material '", material, "': its faces have no texture"));
    if (file == files.end() || file->second.empty()) {
      of_material.push_back(-1);
      continue;
    }
    const auto [entry, is_new] = known.emplace(file->second, atlases.size());
    if (is_new)
      atlases.push_back(namingFile(path, [&] { return readImage(file->second); }));
    of_material.push_back(entry->second);
  }
  return of_material;
}

/// The rest of each line that begins with `keyword`.
std::vector<std::string> entriesOf(std::string_view text, std::string_view keyword)
{
  std::vector<std::string> entries;
  for (std::size_t at = text.find(keyword); at != std::string_view::npos; at = text.find(keyword, at + 1)) {
    const std::string_view line = text.substr(at, text.find_first_of("\r\n", at) - at);
    const std::size_t begin = line.find_first_not_of(" \t", keyword.size());
    if ((at == 0 || text[at - 1] == '\n') && begin != std::string_view::npos)
      entries.emplace_back(line.substr(begin));
  }
  return entries;
}
} // namespace

std::string portablePath(std::string name)
{
  std::replace(name.begin(), name.end(), '\\', '/');
  return name;
}

ImageFilesWriter::ImageFilesWriter(const std::string& path, int jpeg_quality)
    : folder_(fs::path(path).parent_path().string()), stem_(fs::path(path).stem().string()),
      kind_(jpeg_quality > 0 ? ".jpg" : ".png"), quality_(jpeg_quality), object_(path)
{
  if (extension(path) == ".obj")
    materials_ = std::make_unique<OutputFile>((fs::path(folder_) / (stem_ + ".mtl")).string());
}

void ImageFilesWriter::addAtlas(const Image& atlas, const std::string& suffix)
{
  const std::vector<std::uint8_t> bytes = encodeImage(atlas, kind_, quality_);
  names_.push_back(stem_ + suffix + kind_);
  images_.push_back(std::make_unique<OutputFile>((fs::path(folder_) / names_.back()).string()));
  images_.back()->write(bytes.data(), bytes.size());
}

void ImageFilesWriter::finish(const TexturedMesh& model)
{
  if (materials_) {
    writeMaterials(*materials_, model, names_);
    writeModel(object_, model, stem_ + ".mtl");
  } else
    writeTexturedPly(object_, model, names_);
  for (const auto& image : images_)
    image->commit();
  if (materials_)
    materials_->commit();
  object_.commit();
}

TexturedMesh readTexturedObj(const std::string& path, bool empty_atlases)
{
  const FileInHand in_hand(path);
  const ObjContent obj = parseFile(path, parseObj);
  TexturedMesh model;
  MeshTable mesh = objMesh(obj);
  model.mesh = tableToMesh(mesh.vertices, std::move(mesh.faces));
  model.texcoords = Eigen::Map<const Eigen::Matrix2Xf>(obj.texcoords.data(), 2, obj.texcoords.size() / 2);
  std::vector<int> atlas_of_material = readAtlases(path, obj, model.atlases);
  atlas_of_material.push_back(-1); // of faces without material
  for (const ObjTriangle& triangle : obj.triangles)
    if (int& atlas = triangle.material < 0 ? atlas_of_material.back() : atlas_of_material[triangle.material];
        atlas < 0 && empty_atlases) {
      atlas = model.atlases.size();
      model.atlases.emplace_back();
    }
  const Index faces = model.mesh.faceCount();
  model.texcoord_faces.setConstant(3, faces, -1);
  model.face_atlas.setConstant(faces, -1);
  for (Index f = 0; f < faces; ++f) {
    const ObjTriangle& triangle = obj.triangles[f];
    const Eigen::Vector3i texcoords(triangle.texcoords[0], triangle.texcoords[1], triangle.texcoords[2]);
    const int atlas = triangle.material < 0 ? atlas_of_material.back() : atlas_of_material[triangle.material];
    if (atlas < 0 || texcoords.minCoeff() < 0)
      continue;
    model.texcoord_faces.col(f) = texcoords;
    model.face_atlas[f] = atlas;
  }
  return model;
}
} // namespace fresco::io

std::vector<std::string> fresco::filesNamedBy(const std::string& path)
{
  std::vector<std::string> files;
  if (extension(path) != ".obj")
    return files;
  const io::fs::path folder = io::fs::path(path).parent_path();
  for (const std::string& entry : io::entriesOf(readFile(path), "mtllib "))
    for (const std::string& library : io::librariesIn(folder.string(), entry)) {
      files.push_back((folder / library).string());
      if (io::fs::is_regular_file(files.back()))
        for (const auto& [name, map] : io::parseMtl(readFile(files.back())))
          if (!map.empty())
            files.push_back((io::fs::path(folder / library).parent_path() / io::imageName(map)).string());
    }
  return files;
}
