// SPDX-License-Identifier: BSD-3-Clause
// EXT_meshopt_compression: Kapoulkine et al., Khronos' registry of extensions.
#include "io/texture/gltf_compression.h"
#include "io/files/expect.h"
#include <fresco/core/point_table.h>
#include <limits>
#include <meshoptimizer.h>
#include <nlohmann/json.hpp>
namespace fresco::io {
namespace {
using Json = nlohmann::json;
const char* const extension_name = "EXT_meshopt_compression";
constexpr std::uint32_t json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942, magic = 0x46546c67; // glTF 2.0, section 4.4

struct Glb {
  Json json;
  std::string_view data;
};

Glb opened(std::string_view glb)
{
  const auto number = [&](std::size_t at) { return loadScalar<std::uint32_t>(glb.data() + at); };
  expect(glb.size() >= 20 && number(0) == magic && number(16) == json_chunk && number(12) <= glb.size() - 20,
         "glTF: not binary glTF");
  const std::size_t end = 20 + std::size_t(number(12));
  Glb opened{Json::parse(glb.substr(20, end - 20), nullptr, false), {}};
  expect(opened.json.is_object(), "glTF: its JSON cannot be read");
  if (glb.size() >= end + 8 && number(end + 4) == binary_chunk)
    opened.data = glb.substr(end + 8, std::min<std::size_t>(number(end), glb.size() - end - 8));
  return opened;
}

void pad(std::string& bytes, char with) { bytes.resize((bytes.size() + 3) / 4 * 4, with); }

std::string closed(const Json& json, std::string data)
{
  std::string text = json.dump();
  pad(text, ' ');
  pad(data, '\0');
  std::string glb;
  const auto number = [&](std::size_t value) {
    const auto word = std::uint32_t(value);
    glb.append(reinterpret_cast<const char*>(&word), 4);
  };
  for (const std::size_t value :
       {std::size_t(magic), std::size_t(2), 28 + text.size() + data.size(), text.size(), std::size_t(json_chunk)})
    number(value);
  glb += text;
  number(data.size());
  number(binary_chunk);
  return glb + data;
}

/// What accessors keep in a view.
struct Content {
  enum Kind { other, indices, attributes } kind = other;
  std::size_t stride = 0, count = 0;
};

std::size_t elementSize(const Json& accessor)
{
  static const std::map<std::string, std::size_t> components = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                                                                {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
  const int type = accessor.at("componentType");
  const std::size_t bytes = type == 5120 || type == 5121 ? 1 : type == 5122 || type == 5123 ? 2 : 4;
  return bytes * components.at(accessor.at("type").get<std::string>());
}

std::vector<Content> contents(const Json& json)
{
  std::vector<Content> found(json.at("bufferViews").size());
  const auto note = [&](const Json& index, Content::Kind kind) {
    const Json& accessor = json.at("accessors").at(index.get<std::size_t>());
    const std::size_t view = accessor.at("bufferView");
    const std::size_t stride = json.at("bufferViews").at(view).value("byteStride", elementSize(accessor));
    if (kind == Content::indices || stride % 4 == 0)
      found.at(view) = {kind, stride, accessor.at("count")};
  };
  for (const Json& mesh : json.at("meshes"))
    for (const Json& primitive : mesh.at("primitives")) {
      note(primitive.at("indices"), Content::indices);
      for (const auto& [name, accessor] : primitive.at("attributes").items())
        note(accessor, Content::attributes);
    }
  return found;
}

std::string encoded(const char* bytes, const Content& content)
{
  std::string out;
  std::size_t size = 0;
  const auto buffer = [&] { return reinterpret_cast<unsigned char*>(out.data()); };
  if (content.kind == Content::attributes) {
    out.resize(meshopt_encodeVertexBufferBound(content.count, content.stride));
    size = meshopt_encodeVertexBuffer(buffer(), out.size(), bytes, content.count, content.stride);
  } else {
    std::vector<unsigned> indices(content.count);
    for (std::size_t i = 0; i < indices.size(); ++i)
      indices[i] = content.stride == 2 ? loadScalar<std::uint16_t>(bytes + 2 * i) : loadScalar<unsigned>(bytes + 4 * i);
    out.resize(meshopt_encodeIndexBufferBound(content.count, std::numeric_limits<std::int32_t>::max()));
    size = meshopt_encodeIndexBuffer(buffer(), out.size(), indices.data(), indices.size());
  }
  out.resize(size);
  return out;
}

/// A view as its extension describes it.
struct CompressedView {
  std::size_t stride, count;
  std::string mode, filter;
  std::string_view bytes;
};

/// Checks what the library takes for granted.
void validate(const CompressedView& view)
{
  const bool is_index = view.mode == "TRIANGLES" || view.mode == "INDICES";
  expect(is_index ? view.stride == 2 || view.stride == 4
                  : view.stride % 4 == 0 && view.stride != 0 && view.stride <= 256,
         "glTF: a compressed view has elements of a size that does not exist");
  expect((is_index || view.mode == "ATTRIBUTES") && (view.mode != "TRIANGLES" || view.count % 3 == 0),
         "glTF: a compressed view of an unknown kind");
  const bool fits = view.filter == "NONE" ||
                    (!is_index && ((view.filter == "OCTAHEDRAL" && (view.stride == 4 || view.stride == 8)) ||
                                   (view.filter == "QUATERNION" && view.stride == 8) || view.filter == "EXPONENTIAL"));
  expect(fits, "glTF: a compressed view with an unknown filter");
  expect(view.count <= 1024 * view.bytes.size() / view.stride, "glTF: a compressed view is too short");
}

std::string decoded(const CompressedView& view)
{
  validate(view);
  std::string out(view.count * view.stride, '\0');
  const auto* bytes = reinterpret_cast<const unsigned char*>(view.bytes.data());
  int error = 0;
  if (view.mode == "ATTRIBUTES")
    error = meshopt_decodeVertexBuffer(out.data(), view.count, view.stride, bytes, view.bytes.size());
  else if (view.mode == "TRIANGLES")
    error = meshopt_decodeIndexBuffer(out.data(), view.count, view.stride, bytes, view.bytes.size());
  else
    error = meshopt_decodeIndexSequence(out.data(), view.count, view.stride, bytes, view.bytes.size());
  expect(error == 0, "glTF: a compressed view is damaged");
  if (view.filter == "OCTAHEDRAL")
    meshopt_decodeFilterOct(out.data(), view.count, view.stride);
  else if (view.filter == "QUATERNION")
    meshopt_decodeFilterQuat(out.data(), view.count, view.stride);
  else if (view.filter == "EXPONENTIAL")
    meshopt_decodeFilterExp(out.data(), view.count, view.stride);
  return out;
}

std::string_view partOf(std::string_view data, const Json& view)
{
  const std::size_t at = view.value("byteOffset", std::size_t{0}), length = view.at("byteLength");
  expect(view.at("buffer") == 0 && at <= data.size() && length <= data.size() - at,
         "glTF: a view reaches beyond the file");
  return data.substr(at, length);
}

template <typename T>
void reorder(std::vector<T>& values, const std::vector<unsigned>& place)
{
  std::vector<T> ordered(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    ordered[place[i]] = values[i];
  values = std::move(ordered);
}
} // namespace

void orderForCompression(GltfPart& part)
{
  const std::size_t vertices = part.positions.size(), corners = part.indices.size();
  std::vector<unsigned> indices(corners), place(vertices);
  meshopt_optimizeVertexCache(indices.data(), part.indices.data(), corners, vertices);
  meshopt_optimizeVertexFetchRemap(place.data(), indices.data(), corners, vertices);
  meshopt_remapIndexBuffer(part.indices.data(), indices.data(), corners, place.data());
  reorder(part.positions, place);
  reorder(part.normals, place);
  reorder(part.tangents, place);
  reorder(part.texcoords, place);
  reorder(part.colors, place);
}

std::string compressedGlb(std::string_view glb)
{
  auto [json, data] = opened(glb);
  const std::vector<Content> content = contents(json);
  std::string packed;
  std::size_t plain = 0; // bytes of the buffer that exists for programs without the extension, without data
  for (std::size_t k = 0; k < content.size(); ++k) {
    Json& view = json["bufferViews"][k];
    const std::string_view bytes = partOf(data, view);
    if (content[k].kind == Content::other) {
      view["byteOffset"] = packed.size();
      packed += bytes;
    } else {
      const std::string code = encoded(bytes.data(), content[k]);
      view["extensions"][extension_name] = {{"buffer", 0},
                                            {"byteOffset", packed.size()},
                                            {"byteLength", code.size()},
                                            {"byteStride", content[k].stride},
                                            {"count", content[k].count},
                                            {"mode", content[k].kind == Content::indices ? "TRIANGLES" : "ATTRIBUTES"}};
      view["buffer"] = 1;
      view["byteOffset"] = plain;
      plain += (bytes.size() + 3) / 4 * 4;
      packed += code;
    }
    pad(packed, '\0');
  }
  json["buffers"] = {{{"byteLength", packed.size()}},
                     {{"byteLength", plain}, {"extensions", {{extension_name, {{"fallback", true}}}}}}};
  for (const char* list : {"extensionsUsed", "extensionsRequired"})
    json[list].push_back(extension_name);
  return closed(json, std::move(packed));
}

bool isCompressedGlb(std::string_view glb)
{
  const std::size_t length = loadScalar<std::uint32_t>(glb.data() + 12);
  return glb.substr(20, length).find(extension_name) != std::string_view::npos;
}

std::string uncompressedGlb(std::string_view glb)
try {
  auto [json, data] = opened(glb);
  std::string plain;
  for (Json& view : json.at("bufferViews")) {
    std::string bytes;
    if (view.contains("extensions") && view["extensions"].contains(extension_name)) {
      const Json how = view["extensions"][extension_name];
      bytes = decoded(
          {how.at("byteStride"), how.at("count"), how.at("mode"), how.value("filter", "NONE"), partOf(data, how)});
      view["extensions"].erase(extension_name);
    } else
      bytes = partOf(data, view);
    expect(plain.size() + bytes.size() <= std::numeric_limits<std::int32_t>::max(),
           "glTF: more than 2 GiB when it is unpacked");
    view["buffer"] = 0;
    view["byteOffset"] = plain.size();
    view["byteLength"] = bytes.size();
    plain += bytes;
    pad(plain, '\0');
  }
  json["buffers"] = {{{"byteLength", plain.size()}}};
  for (const char* list : {"extensionsUsed", "extensionsRequired"})
    if (json.contains(list))
      json[list].erase(std::remove(json[list].begin(), json[list].end(), extension_name), json[list].end());
  return closed(json, std::move(plain));
} catch (const Json::exception&) {
  throw std::runtime_error("glTF: its compressed views cannot be read");
}
} // namespace fresco::io
