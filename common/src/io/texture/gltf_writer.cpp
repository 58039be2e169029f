// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/expect.h"
#include "io/texture/gltf_compression.h"
#include <algorithm>
#include <cmath>
#include <fresco/io/file.h>
#include <limits>
#include <sstream>
#include <streambuf>
#include <tiny_gltf.h>
#include <utility>
namespace fresco::io {
namespace {
/// Column by column, as Eigen and glTF have matrices: x y z becomes x z -y.
const Eigen::Matrix3d R_gltf_model = (Eigen::Matrix3d() << 1, 0, 0, 0, 0, 1, 0, -1, 0).finished();

/// Images as they are stored, of one atlas.
struct StoredImages {
  std::vector<std::uint8_t> colors, normals; ///< normals: empty = none
};

/// What glTF calls a type. Its vectors are called by their length.
template <typename T>
constexpr int component_type = std::is_same_v<T, float>           ? TINYGLTF_COMPONENT_TYPE_FLOAT
                               : std::is_same_v<T, std::int16_t>  ? TINYGLTF_COMPONENT_TYPE_SHORT
                               : std::is_same_v<T, std::uint16_t> ? TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT
                                                                  : TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
static_assert(TINYGLTF_TYPE_VEC2 == 2 && TINYGLTF_TYPE_VEC3 == 3 && TINYGLTF_TYPE_VEC4 == 4);

bool isUnit(const Eigen::Vector3f& normal) { return std::abs(normal.squaredNorm() - 1.f) < 1e-3f; }
bool isFraction(const Eigen::Vector2f& at) { return at.minCoeff() >= 0 && at.maxCoeff() <= 1; }

class GltfBuilder {
public:
  GltfBuilder(const GltfScene& scene, const GltfOptions& options)
      : source_(scene.model), options_(options), faces_(facesByAtlas(scene.model))
  {
    gltf_.asset.version = "2.0";
    gltf_.asset.generator = "fresco";
    gltf_.buffers.emplace_back();
    gltf_.meshes.emplace_back();
    const TriangleMesh& mesh = scene.model.mesh;
    if (!scene.normal_maps.empty() && mesh.normals.cols() > 0)
      tangents_ = texcoordTangents(scene.model);
    if (options.compact) {
      const Eigen::Vector3f low = mesh.vertices.rowwise().minCoeff();
      low_ = low.cast<double>();
      step_ = (mesh.vertices.colwise() - low).maxCoeff() / 65535.0;
      step_ = step_ > 0 ? step_ : 1;
      gltf_.extensionsUsed = gltf_.extensionsRequired = {"KHR_mesh_quantization"};
    }
  }

  /// @param atlas -1: the faces without texture
  void addParts(int atlas, const StoredImages& images)
  {
    // Short indices: 65,535 itself has a meaning of its own. A compact model has one part for each atlas.
    const std::size_t most = options_.compact ? std::numeric_limits<std::int32_t>::max() : 65535;
    GltfPartBuilder builder(source_, faces_, atlas);
    const bool mapped = !images.normals.empty() && tangents_.cols() > 0;
    if (mapped)
      builder.addTangents(tangents_);
    GltfPart part = builder.next(most);
    if (part.indices.empty())
      return;
    tinygltf::Material material;
    tinygltf::PbrMetallicRoughness& surface = material.pbrMetallicRoughness;
    surface.metallicFactor = 0.0;
    surface.roughnessFactor = 1.0;
    if (atlas >= 0)
      surface.baseColorTexture.index = addTexture(images.colors);
    else if (part.colors.empty())
      surface.baseColorFactor = {0.5, 0.5, 0.5, 1.0};
    if (mapped)
      material.normalTexture.index = addTexture(images.normals);
    if (!options_.lit && (atlas >= 0 || !part.colors.empty()))
      setUnlit(material);
    gltf_.materials.push_back(material);
    for (; !part.indices.empty(); part = builder.next(most)) {
      if (options_.compress)
        orderForCompression(part);
      addPrimitive(part);
    }
  }

  const tinygltf::Model& finish()
  {
    require(!gltf_.meshes[0].primitives.empty(), "glTF: the model has no faces");
    tinygltf::Node node;
    node.mesh = 0;
    Eigen::Matrix4d T_world_mesh = Eigen::Matrix4d::Identity();
    T_world_mesh.topLeftCorner<3, 3>() *= step_;
    T_world_mesh.topRightCorner<3, 1>() = source_.mesh.origin + low_;
    T_world_mesh = options_.T_world_model * T_world_mesh;
    Eigen::Matrix4d T = T_world_mesh;
    T.topRows<3>() = R_gltf_model * T_world_mesh.topRows<3>();
    node.matrix.assign(T.data(), T.data() + 16);
    gltf_.nodes.push_back(node);
    tinygltf::Scene scene;
    scene.nodes.push_back(0);
    gltf_.scenes.push_back(scene);
    gltf_.defaultScene = 0;
    return gltf_;
  }

private:
  /// Photographs hold the light already: they are shown as they are.
  void setUnlit(tinygltf::Material& material)
  {
    const std::string name = "KHR_materials_unlit";
    material.extensions[name] = tinygltf::Value(tinygltf::Value::Object());
    if (std::find(gltf_.extensionsUsed.begin(), gltf_.extensionsUsed.end(), name) == gltf_.extensionsUsed.end())
      gltf_.extensionsUsed.push_back(name);
  }

  int addTexture(const std::vector<std::uint8_t>& bytes)
  {
    tinygltf::Image image;
    image.mimeType = options_.jpeg_quality > 0 ? "image/jpeg" : "image/png";
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

  /// @tparam T of a component @param type of an element @return its number
  template <typename T, typename Element>
  int addAccessor(const std::vector<Element>& values, int type)
  {
    const bool is_index = type == TINYGLTF_TYPE_SCALAR;
    tinygltf::Accessor accessor;
    accessor.bufferView = addView(values.data(), values.size() * sizeof(Element),
                                  is_index ? TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER : TINYGLTF_TARGET_ARRAY_BUFFER);
    if (sizeof(T) * tinygltf::GetNumComponentsInType(type) !=
        sizeof(Element)) // vertices begin at multiples of four bytes
      gltf_.bufferViews.back().byteStride = sizeof(Element);
    accessor.componentType = component_type<T>;
    accessor.type = type;
    accessor.count = values.size();
    gltf_.accessors.push_back(accessor);
    return gltf_.accessors.size() - 1;
  }

  /// Values -1..1 or 0..1 as floats, or as integers that stand for them.
  /// @tparam T of the integers @tparam stored components of an element in the file, of which the last ones may be none
  template <typename T, int stored, int components>
  int addFractions(const std::vector<Eigen::Matrix<float, components, 1>>& values, bool as_integers)
  {
    if (!as_integers)
      return addAccessor<float>(values, components);
    constexpr float largest = std::numeric_limits<T>::max();
    std::vector<std::array<T, stored>> elements;
    for (const auto& value : values) {
      auto& element = elements.emplace_back();
      for (int k = 0; k < components; ++k)
        element[k] = std::lround(std::min(std::max(value[k], std::is_signed_v<T> ? -1.f : 0.f), 1.f) * largest);
    }
    const int accessor = addAccessor<T>(elements, components);
    gltf_.accessors[accessor].normalized = true;
    return accessor;
  }

  template <typename T, typename Element>
  int addBounded(const std::vector<Element>& values)
  {
    const int accessor = addAccessor<T>(values, TINYGLTF_TYPE_VEC3);
    std::vector<double>&low = gltf_.accessors[accessor].minValues, &high = gltf_.accessors[accessor].maxValues;
    low.assign(3, std::numeric_limits<double>::infinity());
    high.assign(3, -std::numeric_limits<double>::infinity());
    for (const auto& value : values)
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min<double>(low[axis], value[axis]);
        high[axis] = std::max<double>(high[axis], value[axis]);
      }
    return accessor;
  }

  int addPositions(const std::vector<Eigen::Vector3f>& positions)
  {
    if (!options_.compact)
      return addBounded<float>(positions);
    std::vector<std::array<std::uint16_t, 4>> steps;
    for (const Eigen::Vector3f& position : positions) {
      const Eigen::Vector3d at = (position.cast<double>() - low_) / step_;
      steps.push_back({std::uint16_t(std::lround(at.x())), std::uint16_t(std::lround(at.y())),
                       std::uint16_t(std::lround(at.z())), 0});
    }
    return addBounded<std::uint16_t>(steps);
  }

  int addIndices(const GltfPart& part)
  {
    if (part.positions.size() > 65535)
      return addAccessor<std::uint32_t>(part.indices, TINYGLTF_TYPE_SCALAR);
    const std::vector<std::uint16_t> shorter(part.indices.begin(), part.indices.end());
    return addAccessor<std::uint16_t>(shorter, TINYGLTF_TYPE_SCALAR);
  }

  void addPrimitive(const GltfPart& part)
  {
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.attributes["POSITION"] = addPositions(part.positions);
    if (!part.normals.empty() && std::all_of(part.normals.begin(), part.normals.end(), isUnit))
      primitive.attributes["NORMAL"] = addFractions<std::int16_t, 4>(part.normals, options_.compact);
    if (!part.tangents.empty())
      primitive.attributes["TANGENT"] = addFractions<std::int16_t, 4>(part.tangents, options_.compact);
    // With JPEG, 16 bits: a tenth of a texel in an atlas of 6,500.
    const bool coarse = (options_.compact || options_.jpeg_quality > 0) &&
                        std::all_of(part.texcoords.begin(), part.texcoords.end(), isFraction);
    if (!part.texcoords.empty())
      primitive.attributes["TEXCOORD_0"] = addFractions<std::uint16_t, 2>(part.texcoords, coarse);
    if (!part.colors.empty()) {
      const int colors = addAccessor<std::uint16_t>(part.colors, TINYGLTF_TYPE_VEC4);
      gltf_.accessors[colors].normalized = true;
      primitive.attributes["COLOR_0"] = colors;
    }
    primitive.indices = addIndices(part);
    primitive.material = gltf_.materials.size() - 1;
    gltf_.meshes[0].primitives.push_back(primitive);
  }

  const TexturedMesh& source_;
  const GltfOptions& options_;
  Groups faces_;
  Eigen::Matrix4Xf tangents_;                     ///< without columns where there are no normal maps
  Eigen::Vector3d low_ = Eigen::Vector3d::Zero(); ///< position = low + step * what is stored
  double step_ = 1;
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

void writeGlb(const std::string& path, const GltfScene& scene, const GltfOptions& options,
              std::vector<std::vector<std::uint8_t>> images)
{
  OutputFile file(path);
  GltfBuilder builder(scene, options);
  for (std::size_t i = 0; i < images.size(); ++i) {
    StoredImages stored{std::exchange(images[i], {}), {}};
    if (i < scene.normal_maps.size() && !scene.normal_maps[i].empty())
      stored.normals = storedImage(scene.normal_maps[i], options.jpeg_quality);
    builder.addParts(i, stored);
  }
  builder.addParts(-1, {});
  const tinygltf::Model& gltf = builder.finish();
  // The header of the format counts bytes with 32 bits; one MiB is left for the JSON part.
  expect(gltf.buffers[0].data.size() <= std::numeric_limits<std::uint32_t>::max() - (std::size_t{1} << 20), path,
         ": the model is larger than the 4 GiB that binary glTF can hold");
  FileStreambuf buffer(file);
  std::ostream plain(&buffer);
  std::ostringstream packed;
  std::ostream& stream = options.compress ? packed : plain;
  stream.exceptions(std::ios::badbit | std::ios::failbit);
  expect(tinygltf::TinyGLTF().WriteGltfSceneToStream(&gltf, stream, false, true), path, ": cannot be written as glTF");
  if (options.compress)
    file.write(compressedGlb(packed.str()));
  file.commit();
}
} // namespace fresco::io
