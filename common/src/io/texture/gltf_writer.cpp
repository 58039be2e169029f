// SPDX-License-Identifier: BSD-3-Clause
#include "io/texture/texture_io.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <limits>
#include <streambuf>
#include <tiny_gltf.h>
#include <unordered_map>
#include <utility>
namespace fresco::io {
namespace {
using Color16 = Eigen::Matrix<std::uint16_t, 4, 1>;

/// Vertices and triangles of one primitive.
struct Part {
  std::vector<Eigen::Vector3f> positions, normals;
  std::vector<Eigen::Vector2f> texcoords; ///< v points down
  std::vector<Color16> colors;            ///< linear RGBA
  std::vector<std::uint16_t> indices;
};

/// Linear light of an sRGB byte as 16 bit (IEC 61966-2-1).
std::uint16_t linearLight(std::uint8_t value)
{
  const double s = value / 255.0;
  const double linear = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  return std::lround(65535.0 * linear);
}

/// Cuts the faces with one atlas into parts, face after face: each pair of vertex and texture coordinate gets one place in
/// a part.
class PartBuilder {
public:
  /// @param atlas -1: the faces without texture
  /// @param faces see facesByAtlas()
  PartBuilder(const TexturedMesh& model, const Groups& faces, int atlas)
      : model_(model), faces_(faces), textured_(atlas >= 0), at_(faces.begin[atlas + 1]), end_(faces.begin[atlas + 2])
  {
    for (int value = 0; value < 256; ++value)
      linear_[value] = linearLight(value);
  }

  /// The next part; without indices at the end.
  Part next()
  {
    constexpr std::size_t most_places = 65535; // so that 16 bits hold an index; 65535 itself has a meaning of its own
    part_ = {};
    first_.clear();
    for (; at_ < end_ && places_.size() + 3 <= most_places; ++at_)
      for (int k = 0, face = faces_.list[at_]; k < 3; ++k)
        part_.indices.push_back(place(model_.mesh.faces(k, face), textured_ ? model_.texcoord_faces(k, face) : -1));
    places_.clear();
    return std::move(part_);
  }

private:
  struct Place {
    int vertex, texcoord, next; ///< next place of the same vertex, -1: none
  };

  std::uint16_t place(int vertex, int texcoord)
  {
    int& first = first_.emplace(vertex, -1).first->second;
    for (int at = first; at >= 0; at = places_[at].next)
      if (places_[at].texcoord == texcoord)
        return at;
    places_.push_back({vertex, texcoord, first});
    first = places_.size() - 1;
    append(vertex, texcoord);
    return first;
  }

  void append(int vertex, int texcoord)
  {
    const TriangleMesh& mesh = model_.mesh;
    part_.positions.emplace_back(mesh.vertices.col(vertex));
    if (mesh.normals.cols() > 0)
      part_.normals.emplace_back(mesh.normals.col(vertex).normalized());
    if (textured_)
      part_.texcoords.emplace_back(model_.texcoords(0, texcoord), 1.f - model_.texcoords(1, texcoord));
    else if (mesh.colors.cols() > 0)
      part_.colors.emplace_back(linear_[mesh.colors(0, vertex)], linear_[mesh.colors(1, vertex)],
                                linear_[mesh.colors(2, vertex)], std::uint16_t{65535});
  }

  const TexturedMesh& model_;
  const Groups& faces_;
  bool textured_;
  Index at_, end_;                     ///< faces that are in no part yet
  std::unordered_map<int, int> first_; ///< place of each vertex of the part
  std::vector<Place> places_;
  std::uint16_t linear_[256];
  Part part_;
};

/// Column by column, as Eigen and glTF have matrices: x y z becomes x z -y.
const Eigen::Matrix3d R_gltf_model = (Eigen::Matrix3d() << 1, 0, 0, 0, 0, 1, 0, -1, 0).finished();

class GltfBuilder {
public:
  explicit GltfBuilder(const TexturedMesh& model) : source_(model), faces_(facesByAtlas(model))
  {
    gltf_.asset.version = "2.0";
    gltf_.asset.generator = "fresco";
    gltf_.buffers.emplace_back();
    gltf_.meshes.emplace_back();
  }

  /// @param atlas -1: the faces without texture
  /// @param image of the atlas
  void addPart(int atlas, const std::vector<std::uint8_t>& image, bool is_jpeg)
  {
    PartBuilder builder(source_, faces_, atlas);
    Part part = builder.next();
    if (part.indices.empty())
      return;
    tinygltf::Material material;
    tinygltf::PbrMetallicRoughness& surface = material.pbrMetallicRoughness;
    surface.metallicFactor = 0.0;
    surface.roughnessFactor = 1.0;
    if (atlas >= 0)
      surface.baseColorTexture.index = addTexture(image, is_jpeg);
    else if (part.colors.empty())
      surface.baseColorFactor = {0.5, 0.5, 0.5, 1.0};
    if (atlas >= 0 || !part.colors.empty()) { // photographs hold the light already: they are shown as they are
      material.extensions["KHR_materials_unlit"] = tinygltf::Value(tinygltf::Value::Object());
      gltf_.extensionsUsed = {"KHR_materials_unlit"};
    }
    gltf_.materials.push_back(material);
    for (; !part.indices.empty(); part = builder.next())
      addPrimitive(part, is_jpeg);
  }

  const tinygltf::Model& finish()
  {
    require(!gltf_.meshes[0].primitives.empty(), "glTF: the model has no faces");
    tinygltf::Node node;
    node.mesh = 0;
    const Eigen::Vector3d at = R_gltf_model * source_.mesh.origin;
    Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
    T.topLeftCorner<3, 3>() = R_gltf_model;
    T.topRightCorner<3, 1>() = at;
    node.matrix.assign(T.data(), T.data() + 16);
    gltf_.nodes.push_back(node);
    tinygltf::Scene scene;
    scene.nodes.push_back(0);
    gltf_.scenes.push_back(scene);
    gltf_.defaultScene = 0;
    return gltf_;
  }

private:
  int addTexture(const std::vector<std::uint8_t>& bytes, bool is_jpeg)
  {
    tinygltf::Image image;
    image.mimeType = is_jpeg ? "image/jpeg" : "image/png";
    image.bufferView = addView(bytes.data(), bytes.size(), 0);
    gltf_.images.push_back(image);
    if (gltf_.samplers.empty()) {
      gltf_.samplers.emplace_back();
      gltf_.samplers[0].minFilter = TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
      gltf_.samplers[0].magFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
      gltf_.samplers[0].wrapS = gltf_.samplers[0].wrapT = TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    }
    gltf_.textures.emplace_back();
    gltf_.textures.back().source = gltf_.images.size() - 1;
    gltf_.textures.back().sampler = 0;
    return gltf_.textures.size() - 1;
  }

  int addView(const void* data, std::size_t bytes, int target)
  {
    std::vector<unsigned char>& buffer = gltf_.buffers[0].data;
    buffer.resize((buffer.size() + 3) / 4 * 4);
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = buffer.size();
    view.byteLength = bytes;
    view.target = target;
    const auto* from = static_cast<const unsigned char*>(data);
    buffer.insert(buffer.end(), from, from + bytes);
    gltf_.bufferViews.push_back(view);
    return gltf_.bufferViews.size() - 1;
  }

  /// @return its number
  template <typename T>
  int addAccessor(const std::vector<T>& values, int component_type, int type)
  {
    const bool is_index = type == TINYGLTF_TYPE_SCALAR;
    tinygltf::Accessor accessor;
    accessor.bufferView = addView(values.data(), values.size() * sizeof(T),
                                  is_index ? TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER : TINYGLTF_TARGET_ARRAY_BUFFER);
    accessor.componentType = component_type;
    accessor.type = type;
    accessor.count = values.size();
    gltf_.accessors.push_back(accessor);
    return gltf_.accessors.size() - 1;
  }

  /// @param values 0..1
  int addFractions(const std::vector<Eigen::Vector2f>& values)
  {
    std::vector<Eigen::Matrix<std::uint16_t, 2, 1>> stored;
    for (const Eigen::Vector2f& value : values)
      stored.emplace_back((value.array() * 65535.f).round().cwiseMax(0.f).cwiseMin(65535.f).cast<std::uint16_t>());
    const int accessor = addAccessor(stored, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC2);
    gltf_.accessors[accessor].normalized = true;
    return accessor;
  }

  /// @param coarse whether texture coordinates have 16 bits, a tenth of a texel in an atlas of 6,500
  void addPrimitive(const Part& part, bool coarse)
  {
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    const Eigen::Map<const Points> positions(part.positions[0].data(), 3, part.positions.size());
    const Eigen::Vector3d low = positions.rowwise().minCoeff().cast<double>();
    const Eigen::Vector3d high = positions.rowwise().maxCoeff().cast<double>();
    const int vertices = addAccessor(part.positions, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
    gltf_.accessors[vertices].minValues.assign(low.data(), low.data() + 3);
    gltf_.accessors[vertices].maxValues.assign(high.data(), high.data() + 3);
    primitive.attributes["POSITION"] = vertices;
    const auto is_unit = [](const Eigen::Vector3f& normal) { return std::abs(normal.squaredNorm() - 1.f) < 1e-3f; };
    if (!part.normals.empty() && std::all_of(part.normals.begin(), part.normals.end(), is_unit))
      primitive.attributes["NORMAL"] = addAccessor(part.normals, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
    const auto is_fraction = [](const Eigen::Vector2f& at) { return at.minCoeff() >= 0 && at.maxCoeff() <= 1; };
    if (!part.texcoords.empty() && coarse && std::all_of(part.texcoords.begin(), part.texcoords.end(), is_fraction))
      primitive.attributes["TEXCOORD_0"] = addFractions(part.texcoords);
    else if (!part.texcoords.empty())
      primitive.attributes["TEXCOORD_0"] =
          addAccessor(part.texcoords, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC2);
    if (!part.colors.empty()) {
      const int colors = addAccessor(part.colors, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC4);
      gltf_.accessors[colors].normalized = true;
      primitive.attributes["COLOR_0"] = colors;
    }
    primitive.indices = addAccessor(part.indices, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_SCALAR);
    primitive.material = gltf_.materials.size() - 1;
    gltf_.meshes[0].primitives.push_back(primitive);
  }

  const TexturedMesh& source_;
  Groups faces_;
  tinygltf::Model gltf_;
};

/// Lets a library write to an OutputFile.
class FileStreambuf : public std::streambuf {
public:
  explicit FileStreambuf(OutputFile& file) : file_(file) {}

protected:
  std::streamsize xsputn(const char* data, std::streamsize count) override
  {
    file_.write(data, count);
    return count;
  }
  int_type overflow(int_type c) override
  {
    const char byte = traits_type::to_char_type(c);
    file_.write(&byte, 1);
    return c;
  }

private:
  OutputFile& file_;
};
} // namespace

void writeGlb(const std::string& path, const TexturedMesh& model, std::vector<std::vector<std::uint8_t>> images,
              bool are_jpeg)
{
  OutputFile file(path);
  GltfBuilder builder(model);
  for (std::size_t i = 0; i < images.size(); ++i)
    builder.addPart(i, std::exchange(images[i], {}), are_jpeg);
  builder.addPart(-1, {}, are_jpeg);
  const tinygltf::Model& gltf = builder.finish();
  // The header of the format counts bytes with 32 bits; one MiB is left for the JSON part.
  if (gltf.buffers[0].data.size() > std::numeric_limits<std::uint32_t>::max() - (std::size_t{1} << 20))
    throw std::runtime_error(path + ": the model is larger than the 4 GiB that binary glTF can hold");
  FileStreambuf buffer(file);
  std::ostream stream(&buffer);
  stream.exceptions(std::ios::badbit | std::ios::failbit);
  if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&gltf, stream, false, true))
    throw std::runtime_error(path + ": cannot be written as glTF");
  file.commit();
}
} // namespace fresco::io
