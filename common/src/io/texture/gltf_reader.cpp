// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/remarks.h"
#include "io/texture/gltf_loader.h"
#include "io/texture/texture_io.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fresco/core/point_table.h>
#include <fresco/io/byte_hash.h>
#include <fresco/io/image_io.h>
#include <limits>
#include <unordered_map>
namespace fresco::io {
namespace {
template <typename T>
const T& at(const std::vector<T>& items, int index, const char* what)
{
  expect(index >= 0 && std::size_t(index) < items.size(), "glTF: there is no ", what, ' ', index);
  return items[index];
}

Scalar componentType(int type)
{
  static const std::map<int, Scalar> types = {
      {TINYGLTF_COMPONENT_TYPE_BYTE, Scalar::int8},           {TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, Scalar::uint8},
      {TINYGLTF_COMPONENT_TYPE_SHORT, Scalar::int16},         {TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, Scalar::uint16},
      {TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, Scalar::uint32}, {TINYGLTF_COMPONENT_TYPE_FLOAT, Scalar::float32}};
  const auto found = types.find(type);
  expect(found != types.end(), "glTF: unknown component type ", type);
  return found->second;
}

/// Bytes `offset` .. `offset + length` of a buffer view.
std::string_view viewBytes(const tinygltf::Model& gltf, int index, std::size_t offset, std::size_t length)
{
  const tinygltf::BufferView& view = at(gltf.bufferViews, index, "buffer view");
  const std::vector<unsigned char>& data = at(gltf.buffers, view.buffer, "buffer").data;
  expect(view.byteOffset <= data.size() && view.byteLength <= data.size() - view.byteOffset &&
             offset <= view.byteLength && length <= view.byteLength - offset,
         "glTF: truncated: buffer view ", index, " does not fit into its buffer");
  return {reinterpret_cast<const char*>(data.data()) + view.byteOffset + offset, length};
}

/// Values of an accessor, `components` x count; integers that stand for fractions as 0..1.
Eigen::MatrixXd readAccessor(const tinygltf::Model& gltf, int index, int components)
{
  const tinygltf::Accessor& accessor = at(gltf.accessors, index, "accessor");
  const Scalar type = componentType(accessor.componentType);
  const int stored = tinygltf::GetNumComponentsInType(accessor.type);
  expect(stored >= components && !accessor.sparse.isSparse, "glTF: accessor ", index,
         " is not of the kind that its use asks for");
  const tinygltf::BufferView& view = at(gltf.bufferViews, accessor.bufferView, "buffer view");
  const std::size_t element = scalarSize(type) * stored;
  const std::size_t stride = view.byteStride == 0 ? element : view.byteStride;
  expect(accessor.count != 0 && stride >= element && accessor.count <= view.byteLength / stride + 1,
         "glTF: truncated: accessor ", index, " of ", accessor.count, " elements does not fit");
  const char* bytes =
      viewBytes(gltf, accessor.bufferView, accessor.byteOffset, (accessor.count - 1) * stride + element).data();
  Eigen::MatrixXd values(components, accessor.count);
  visitScalar(type, [&](auto zero) {
    using T = decltype(zero);
    const bool fraction = accessor.normalized && std::is_integral_v<T>;
    const double scale = fraction ? 1.0 / std::numeric_limits<T>::max() : 1.0;
    for (Index i = 0; i < values.cols(); ++i)
      for (int k = 0; k < components; ++k) {
        const double value = scale * loadScalar<T>(bytes + i * stride + k * sizeof(T));
        values(k, i) = fraction ? std::max(value, -1.0) : value; // signed ones reach a step further down
      }
  });
  return values;
}

/// sRGB byte of linear light 0..1 (IEC 61966-2-1).
std::uint8_t displayByte(double linear)
{
  const double s = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
  return s > 0 ? std::lround(255.0 * std::min(s, 1.0)) : 0;
}

Image readImageOf(const tinygltf::Model& gltf, const tinygltf::Image& source)
{
  if (source.bufferView < 0)
    return decodeImage({reinterpret_cast<const char*>(source.image.data()), source.image.size()});
  const std::size_t length = at(gltf.bufferViews, source.bufferView, "buffer view").byteLength;
  return decodeImage(viewBytes(gltf, source.bufferView, 0, length));
}

struct PositionHash {
  std::size_t operator()(const std::array<float, 3>& p) const { return hashBytes(p.data(), sizeof(p)); }
};

/// Joins the primitives of a scene.
class ModelBuilder {
public:
  /// @param file_bytes what bounds the elements that may be read
  ModelBuilder(const tinygltf::Model& gltf, std::size_t file_bytes)
      : gltf_(gltf), atlas_of_image_(gltf.images.size(), -1),
        elements_left_(least_elements + elements_per_byte * file_bytes)
  {}

  void setOrigin(const Eigen::Vector3d& origin) { model_.mesh.origin = origin; }

  /// @param T_scene_mesh where the mesh stands, less the origin
  void addPrimitive(const tinygltf::Primitive& primitive, const Eigen::Affine3d& T_scene_mesh)
  {
    if (primitive.mode >= 0 && primitive.mode < TINYGLTF_MODE_TRIANGLES) {
      remark("points and lines are left out");
      return;
    }
    const Eigen::MatrixXd positions = attribute(primitive, "POSITION", 3);
    expect(positions.cols() != 0, "glTF: a primitive has no positions");
    const std::vector<int> vertices = addVertices(primitive, T_scene_mesh, positions);
    const int atlas = atlasOf(primitive);
    const Eigen::MatrixXd texcoords = atlas < 0 ? Eigen::MatrixXd() : textureCoordinates(primitive);
    const int first_texcoord = texcoords_.size();
    for (Index i = 0; i < texcoords.cols(); ++i)
      texcoords_.emplace_back(texcoords(0, i), 1.0 - texcoords(1, i));
    std::vector<std::size_t> corners = triangleCorners(cornerIndices(primitive, positions.cols()), primitive.mode);
    if (T_scene_mesh.linear().determinant() < 0) // mirrored
      for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
        std::swap(corners[i + 1], corners[i + 2]);
    addFaces(corners, vertices, texcoords.cols() > 0 ? atlas : -1, first_texcoord);
  }

  GltfModel take()
  {
    expect(!faces_.empty(), "glTF: no triangles");
    if (!normal_maps_.empty())
      normal_maps_.resize(model_.atlases.size());
    TriangleMesh& mesh = model_.mesh;
    mesh.vertices = Eigen::Map<const Points>(positions_[0].data(), 3, positions_.size());
    if (has_normals_)
      mesh.normals = Eigen::Map<const Points>(normals_[0].data(), 3, normals_.size());
    if (has_colors_)
      mesh.colors = Eigen::Map<const Colors>(colors_[0].data(), 3, colors_.size());
    const Index faces = atlases_.size();
    mesh.faces = Eigen::Map<const Faces>(faces_.data(), 3, faces);
    model_.texcoord_faces = Eigen::Map<const Faces>(texcoord_faces_.data(), 3, faces);
    model_.face_atlas = Eigen::Map<const Eigen::VectorXi>(atlases_.data(), faces);
    model_.texcoords.resize(2, texcoords_.size());
    for (Index i = 0; i < model_.texcoords.cols(); ++i)
      model_.texcoords.col(i) = texcoords_[i];
    return {std::move(model_), std::move(normal_maps_)};
  }

private:
  using Color = Eigen::Matrix<std::uint8_t, 3, 1>;

  Eigen::MatrixXd attribute(const tinygltf::Primitive& primitive, const char* name, int components)
  {
    const auto found = primitive.attributes.find(name);
    return found == primitive.attributes.end() ? Eigen::MatrixXd() : read(found->second, components);
  }

  /// Many primitives may share an accessor: a small file could ask for any amount of memory.
  Eigen::MatrixXd read(int accessor, int components)
  {
    const std::size_t count = at(gltf_.accessors, accessor, "accessor").count;
    expect(count <= elements_left_, "glTF: its meshes repeat the same data more often than there is room for");
    elements_left_ -= count;
    return readAccessor(gltf_, accessor, components);
  }

  /// @return vertex of the model for each position of the primitive
  std::vector<int> addVertices(const tinygltf::Primitive& primitive, const Eigen::Affine3d& T_scene_mesh,
                               const Eigen::MatrixXd& positions)
  {
    const Eigen::MatrixXd normals = attribute(primitive, "NORMAL", 3), colors = attribute(primitive, "COLOR_0", 3);
    has_normals_ |= normals.cols() == positions.cols();
    has_colors_ |= colors.cols() == positions.cols();
    const Eigen::Matrix3d normal_matrix = T_scene_mesh.linear().inverse().transpose();
    const bool moved = !T_scene_mesh.matrix().isIdentity(0);
    std::vector<int> vertices;
    for (Index i = 0; i < positions.cols(); ++i) {
      const Eigen::Vector3d p = positions.col(i);
      const Eigen::Vector3f position = (moved ? T_scene_mesh * p : p).cast<float>();
      const auto [entry, is_new] = known_.try_emplace({position.x(), position.y(), position.z()}, positions_.size());
      if (is_new) {
        positions_.push_back(position);
        normals_.emplace_back(Eigen::Vector3f::Zero());
        colors_.emplace_back(Color::Constant(255));
      }
      const std::size_t vertex = entry->second;
      if (normals.cols() == positions.cols())
        normals_[vertex] = (moved ? (normal_matrix * normals.col(i)).normalized() : normals.col(i)).cast<float>();
      if (colors.cols() == positions.cols())
        colors_[vertex] << displayByte(colors(0, i)), displayByte(colors(1, i)), displayByte(colors(2, i));
      vertices.push_back(vertex);
    }
    return vertices;
  }

  std::vector<std::size_t> cornerIndices(const tinygltf::Primitive& primitive, Index positions)
  {
    std::vector<std::size_t> corners;
    if (primitive.indices < 0) {
      for (Index i = 0; i < positions; ++i)
        corners.push_back(i);
    } else {
      const Eigen::MatrixXd indices = read(primitive.indices, 1);
      for (Index i = 0; i < indices.cols(); ++i) {
        expect(indices(0, i) >= 0 && indices(0, i) < positions, "glTF: a triangle names vertex ", indices(0, i),
               ", there are ", positions);
        corners.push_back(indices(0, i));
      }
    }
    return corners;
  }

  /// Three corners of each triangle, from a list, strip or fan.
  static std::vector<std::size_t> triangleCorners(std::vector<std::size_t> corners, int mode)
  {
    if (mode != TINYGLTF_MODE_TRIANGLE_STRIP && mode != TINYGLTF_MODE_TRIANGLE_FAN) {
      expect(corners.size() % 3 == 0, "glTF: the number of indices is no multiple of 3");
      return corners;
    }
    std::vector<std::size_t> triangles;
    for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
      const bool fan = mode == TINYGLTF_MODE_TRIANGLE_FAN, odd = i % 2 != 0;
      const std::array<std::size_t, 3> t = fan ? std::array<std::size_t, 3>{i + 1, i + 2, 0}
                                               : std::array<std::size_t, 3>{i, i + (odd ? 2 : 1), i + (odd ? 1 : 2)};
      if (const std::size_t a = corners[t[0]], b = corners[t[1]], c = corners[t[2]]; a != b && b != c && a != c)
        triangles.insert(triangles.end(), {a, b, c});
    }
    return triangles;
  }

  /// Those that the texture of the base colour asks for, with its transform (KHR_texture_transform).
  Eigen::MatrixXd textureCoordinates(const tinygltf::Primitive& primitive)
  {
    const tinygltf::TextureInfo& texture = gltf_.materials[primitive.material].pbrMetallicRoughness.baseColorTexture;
    const auto extension = texture.extensions.find("KHR_texture_transform");
    const auto value = [&](const char* name, int index, double otherwise) {
      if (extension == texture.extensions.end() || !extension->second.Has(name))
        return otherwise;
      const tinygltf::Value& found = extension->second.Get(name);
      const tinygltf::Value& number = found.IsArray() ? found.Get(index) : found;
      return number.IsNumber() ? number.GetNumberAsDouble() : otherwise;
    };
    const int set = std::clamp(value("texCoord", 0, texture.texCoord), -1.0, 99.0);
    Eigen::MatrixXd texcoords = attribute(primitive, concat("TEXCOORD_", set).c_str(), 2);
    if (texcoords.cols() == 0 || extension == texture.extensions.end())
      return texcoords;
    const Eigen::Matrix2d R = Eigen::Rotation2Dd(value("rotation", 0, 0)).toRotationMatrix();
    const Eigen::Vector2d scale(value("scale", 0, 1), value("scale", 1, 1)),
        offset(value("offset", 0, 0), value("offset", 1, 0));
    return ((R * scale.asDiagonal() * texcoords).colwise() + offset).eval();
  }

  void addFaces(const std::vector<std::size_t>& corners, const std::vector<int>& vertices, int atlas,
                int first_texcoord)
  {
    const std::size_t texcoords = texcoords_.size() - first_texcoord;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      expect(atlas < 0 || corners[i] < texcoords, "glTF: fewer texture coordinates than positions");
      faces_.push_back(vertices[corners[i]]);
      texcoord_faces_.push_back(atlas < 0 ? -1 : first_texcoord + int(corners[i]));
      if (i % 3 == 0)
        atlases_.push_back(atlas);
    }
  }

  /// Image of a texture, that exists.
  int sourceOf(int texture) const
  {
    const int source = at(gltf_.textures, texture, "texture").source;
    at(gltf_.images, source, "image");
    return source;
  }

  /// Atlas of the material's base colour, -1 if it has none.
  int atlasOf(const tinygltf::Primitive& primitive)
  {
    if (primitive.material < 0)
      return -1;
    const tinygltf::Material& material = at(gltf_.materials, primitive.material, "material");
    const int texture = material.pbrMetallicRoughness.baseColorTexture.index;
    if (texture < 0)
      return -1;
    const int source = sourceOf(texture);
    int& atlas = atlas_of_image_[source];
    if (atlas < 0) {
      atlas = model_.atlases.size();
      model_.atlases.push_back(readImageOf(gltf_, gltf_.images[source]));
      if (const int map = material.normalTexture.index; map >= 0) {
        normal_maps_.resize(model_.atlases.size());
        normal_maps_.back() = readImageOf(gltf_, gltf_.images[sourceOf(map)]);
      }
    }
    return atlas;
  }

  // Enough for any file whose meshes stand in several places, and read within seconds.
  static constexpr std::size_t least_elements = 2000000, elements_per_byte = 16;

  const tinygltf::Model& gltf_;
  std::vector<int> atlas_of_image_;
  std::size_t elements_left_;
  TexturedMesh model_;
  std::vector<Image> normal_maps_;
  std::unordered_map<std::array<float, 3>, std::size_t, PositionHash> known_;
  std::vector<Eigen::Vector3f> positions_, normals_;
  std::vector<Color> colors_;
  std::vector<Eigen::Vector2f> texcoords_;
  std::vector<int> faces_, texcoord_faces_, atlases_;
  bool has_normals_ = false, has_colors_ = false;
};

Eigen::Affine3d nodeTransform(const tinygltf::Node& node)
{
  Eigen::Affine3d T = Eigen::Affine3d::Identity();
  if (node.matrix.size() == 16) {
    T.matrix() = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());
    return T;
  }
  if (node.translation.size() == 3)
    T.translate(Eigen::Vector3d(node.translation[0], node.translation[1], node.translation[2]));
  if (node.rotation.size() == 4)
    T.rotate(Eigen::Quaterniond(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]));
  if (node.scale.size() == 3)
    T.scale(Eigen::Vector3d(node.scale[0], node.scale[1], node.scale[2]));
  return T;
}

struct PlacedMesh {
  int mesh;
  Eigen::Affine3d T_scene_mesh;
};

/// Meshes of a scene, walked without recursion since the nodes of a damaged file may form a circle.
std::vector<PlacedMesh> collectMeshes(const tinygltf::Model& gltf, const tinygltf::Scene& scene)
{
  std::vector<PlacedMesh> meshes;
  Eigen::Affine3d T_model_scene = Eigen::Affine3d::Identity(); // z-up from y-up
  T_model_scene.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  std::vector<std::pair<int, Eigen::Affine3d>> open; // node and its parent's transform
  for (auto node = scene.nodes.rbegin(); node != scene.nodes.rend(); ++node)
    open.emplace_back(*node, T_model_scene);
  for (std::size_t visited = 0; !open.empty(); ++visited) {
    expect(visited + open.size() <= gltf.nodes.size() + 1, "glTF: the nodes of the scene are no tree");
    const auto [index, T_scene_parent] = open.back();
    open.pop_back();
    const tinygltf::Node& node = at(gltf.nodes, index, "node");
    const Eigen::Affine3d T_scene_node = T_scene_parent * nodeTransform(node);
    if (node.mesh >= 0)
      meshes.push_back({node.mesh, T_scene_node});
    for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
      open.emplace_back(*child, T_scene_node);
  }
  return meshes;
}
} // namespace

GltfModel parseGlb(std::string_view content, const std::string& folder)
{
  const tinygltf::Model gltf = loadGltf(content, folder);
  for (const std::string& name : gltf.extensionsRequired)
    expect(name.find("compression") == std::string::npos, "glTF: compressed by the extension ", name,
           ", which is not read");
  const std::vector<PlacedMesh> meshes = collectMeshes(gltf, at(gltf.scenes, std::max(gltf.defaultScene, 0), "scene"));
  ModelBuilder builder(gltf, content.size());
  const Eigen::Vector3d origin = meshes.empty() ? Eigen::Vector3d::Zero() : meshes[0].T_scene_mesh.translation().eval();
  builder.setOrigin(origin);
  for (const PlacedMesh& placed : meshes)
    for (const tinygltf::Primitive& primitive : at(gltf.meshes, placed.mesh, "mesh").primitives)
      builder.addPrimitive(primitive, Eigen::Translation3d(-origin) * placed.T_scene_mesh);
  return builder.take();
}
} // namespace fresco::io
