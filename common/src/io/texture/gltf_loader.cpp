// SPDX-License-Identifier: BSD-3-Clause
#include "io/texture/gltf_loader.h"
#include "io/files/expect.h"
#include "io/texture/gltf_compression.h"
#include <algorithm>
#include <filesystem>
#include <fresco/core/point_table.h>
#include <fresco/io/file.h>
#include <functional>
#include <limits>
namespace fresco::io {
namespace {
/// The bytes of an image outside of the buffers; those inside are decoded later.
// NOLINTNEXTLINE(readability-function-size): tinygltf sets the parameters
bool keepImageBytes(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes,
                    int size, void*)
{
  if (image->bufferView < 0 && size > 0)
    image->image.assign(bytes, bytes + size);
  return true;
}

/// Refuses what the library's parser is not made for: it calls itself for nested values and keeps half a kilobyte for
/// each object, and for each value of an array.
void checkJson(std::string_view json)
{
  constexpr int deepest = 100;
  constexpr int most_objects = 100000, most_values = 1000000;
  int depth = 0, objects = 0, values = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (quoted && c == '\\')
      ++i;
    else if (c == '"')
      quoted = !quoted;
    if (quoted)
      continue;
    depth += c == '{' || c == '[' ? 1 : c == '}' || c == ']' ? -1 : 0;
    objects += c == '{' ? 1 : 0;
    values += c == ',' ? 1 : 0;
    expect(depth <= deepest, "glTF: nested more than ", deepest, " deep");
    expect(objects <= most_objects && values <= most_values, "glTF: more than ", most_objects, " objects or ",
           most_values, " values");
  }
}

/// Files that a model names: in its folder or below, and not more than a glTF buffer holds in all, since many buffers
/// may name the same file.
struct ExternalFiles {
  std::string folder;
  std::uintmax_t bytes_left = std::numeric_limits<std::uint32_t>::max();
};

/// What a callback of tinygltf does; an error goes back as a text.
bool answered(std::string* error, const std::function<void()>& what)
try {
  what();
  return true;
} catch (const std::runtime_error& reason) {
  *error = reason.what();
  return false;
}

bool readExternalFile(std::vector<unsigned char>* bytes, std::string* error, const std::string& name, void* files)
{
  return answered(error, [&] {
    auto& [folder, bytes_left] = *static_cast<ExternalFiles*>(files);
    const std::string path = fileBelow(folder, name);
    std::error_code missing;
    if (const std::uintmax_t size = std::filesystem::file_size(path, missing); !missing && size > bytes_left)
      throw std::runtime_error(path + ": too large");
    const std::string content = readFile(path);
    bytes_left -= std::min<std::uintmax_t>(bytes_left, content.size());
    bytes->assign(content.begin(), content.end());
  });
}

/// tinygltf asks for sizes since 2.9; 2.5 of Debian 12 knows no such member. That of a missing file is 1: readExternalFile() says so.
template <typename Callbacks>
auto tellSizes(Callbacks& callbacks, int) -> decltype(void(callbacks.GetFileSizeInBytes))
{
  callbacks.GetFileSizeInBytes = [](std::size_t* bytes, std::string* error, const std::string& name, void* files) {
    return answered(error, [&] {
      std::error_code missing;
      const auto size =
          std::filesystem::file_size(fileBelow(static_cast<ExternalFiles*>(files)->folder, name), missing);
      *bytes = missing ? 1 : size;
    });
  };
}
template <typename Callbacks>
void tellSizes(Callbacks&, ...)
{}

tinygltf::FsCallbacks callbacksFor(ExternalFiles& files)
{
  tinygltf::FsCallbacks callbacks{};
  callbacks.FileExists = [](const std::string&, void*) { return true; };
  callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
  callbacks.ReadWholeFile = readExternalFile;
  callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
  };
  callbacks.user_data = &files;
  tellSizes(callbacks, 0);
  return callbacks;
}
} // namespace

tinygltf::Model loadGltf(std::string_view content, const std::string& folder)
{
  constexpr std::size_t header = 20; // the header of the file and that of its first chunk, the JSON
  expect(content.size() >= header, "glTF: not binary glTF");
  checkJson(content.substr(header, loadScalar<std::uint32_t>(content.data() + 12)));
  std::string plain;
  if (isCompressedGlb(content))
    content = plain = uncompressedGlb(content);
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keepImageBytes, nullptr);
  ExternalFiles files{folder};
  loader.SetFsCallbacks(callbacksFor(files));
  tinygltf::Model gltf;
  std::string error, warning;
  expect(content.size() <= std::numeric_limits<std::uint32_t>::max(),
         "glTF: larger than the 4 GiB that binary glTF can hold");
  const auto* bytes = reinterpret_cast<const unsigned char*>(content.data());
  if (!loader.LoadBinaryFromMemory(&gltf, &error, &warning, bytes, content.size()))
    throw std::runtime_error("glTF: " + (error.empty() ? "not binary glTF" : error.substr(0, error.find('\n'))));
  return gltf;
}
} // namespace fresco::io
