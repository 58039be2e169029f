// SPDX-License-Identifier: BSD-3-Clause
#include "common/io/test_io_data.h"
#include <algorithm>
#include <cstring>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <tiny_gltf.h>
namespace {
using namespace fresco;
using test::fullTexturedMesh;
using test::sameValues;

/// Place, texture coordinate, atlas and normal of each corner, face by face.
Eigen::MatrixXf corners(const TexturedMesh& model)
{
  Eigen::MatrixXf values(9, 3 * model.mesh.faceCount());
  for (Index i = 0; i < values.cols(); ++i) {
    const int vertex = model.mesh.faces(i % 3, i / 3), texcoord = model.texcoord_faces(i % 3, i / 3);
    values.col(i).head<3>() = model.mesh.vertices.col(vertex);
    values.col(i).segment<3>(3) = model.mesh.normals.col(vertex);
    values.col(i).segment<2>(6) =
        texcoord < 0 ? Eigen::Vector2f(-1, -1) : Eigen::Vector2f(model.texcoords.col(texcoord));
    values(8, i) = static_cast<float>(model.face_atlas[i / 3]);
  }
  return values;
}

void expectSameImages(const std::vector<Image>& a, const std::vector<Image>& b)
{
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].width, b[i].width);
    EXPECT_EQ(a[i].data, b[i].data) << i;
  }
}

TEST(TexturedIo, ObjSurvives)
{
  const std::string folder = test::scratchFolder();
  for (const int atlases : {0, 1, 3}) {
    TexturedMesh model = fullTexturedMesh(7, std::max(atlases, 1));
    if (atlases == 0) {
      model.atlases.clear();
      model.face_atlas.setConstant(-1);
      model.texcoord_faces.setConstant(-1);
    }
    const std::string path = folder + "/model" + std::to_string(atlases) + ".obj";
    writeTexturedMesh(path, model);
    const TexturedMesh back = readTexturedMesh(path);
    EXPECT_TRUE(sameValues(back.mesh.vertices, model.mesh.vertices));
    EXPECT_TRUE(sameValues(back.mesh.normals, model.mesh.normals));
    EXPECT_EQ(back.mesh.colors, model.mesh.colors);
    EXPECT_EQ(back.mesh.faces, model.mesh.faces);
    EXPECT_TRUE(sameValues(back.texcoords, model.texcoords));
    EXPECT_EQ(back.texcoord_faces, model.texcoord_faces);
    EXPECT_EQ(back.face_atlas, model.face_atlas);
    expectSameImages(back.atlases, model.atlases);
    EXPECT_EQ(readMesh(path).faces, model.mesh.faces);
  }
  EXPECT_TRUE(std::filesystem::exists(folder + "/model1.png"));
  EXPECT_TRUE(std::filesystem::exists(folder + "/model3_2.png"));
}

TEST(TexturedIo, GlbSurvives)
{
  const std::string path = test::scratchFolder() + "/model.glb";
  for (const int atlases : {1, 3}) {
    TexturedMesh model = fullTexturedMesh(7, atlases);
    model.mesh.origin = Eigen::Vector3d(691245.125, 5335001.5, 512.25);
    writeTexturedMesh(path, model);
    const TexturedMesh back = readTexturedMesh(path);
    EXPECT_EQ(back.mesh.origin, model.mesh.origin);
    EXPECT_EQ(back.mesh.vertexCount(), model.mesh.vertexCount());
    ASSERT_EQ(back.mesh.faceCount(), model.mesh.faceCount());
    // One rounding each for v -> 1 - v and for the length of a normal.
    EXPECT_LE((corners(back) - corners(model)).cwiseAbs().maxCoeff(), 3e-7f);
    EXPECT_EQ(corners(back).topRows<3>(), corners(model).topRows<3>());
    expectSameImages(back.atlases, model.atlases);
    for (Index f = model.mesh.faceCount() - 2; f < model.mesh.faceCount(); ++f)
      for (int k = 0; k < 3; ++k)
        EXPECT_EQ(back.mesh.colors.col(back.mesh.faces(k, f)).cast<int>(),
                  model.mesh.colors.col(model.mesh.faces(k, f)).cast<int>());
  }
}

template <typename T>
T value(const tinygltf::Model& gltf, int accessor, std::size_t index)
{
  const auto& a = gltf.accessors[accessor];
  const auto& view = gltf.bufferViews[a.bufferView];
  T result;
  std::memcpy(static_cast<void*>(&result), gltf.buffers[0].data.data() + view.byteOffset + index * sizeof(T),
              sizeof(T));
  return result;
}

tinygltf::Model loadGlb(const std::string& path)
{
  tinygltf::Model gltf;
  std::string error, warning;
  EXPECT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromFile(&gltf, &error, &warning, path)) << error;
  EXPECT_EQ(error + warning, "");
  return gltf;
}

TEST(TexturedIo, GlbIsWhatTinygltfExpects)
{
  const std::string path = test::scratchFolder() + "/model.glb";
  const TexturedMesh model = fullTexturedMesh(7, 2);
  writeTexturedMesh(path, model);
  const tinygltf::Model gltf = loadGlb(path);
  EXPECT_EQ(gltf.extensionsUsed, std::vector<std::string>{"KHR_materials_unlit"});
  EXPECT_TRUE(gltf.extensionsRequired.empty());
  ASSERT_EQ(gltf.images.size(), 2U);
  EXPECT_EQ(gltf.images[1].width, 17);
  EXPECT_EQ(gltf.images[1].image[4], model.atlases[1].data[3]); // RGBA against RGB, second texel
  ASSERT_EQ(gltf.meshes[0].primitives.size(), 3U);
  std::size_t indices = 0;
  for (const auto& primitive : gltf.meshes[0].primitives) {
    const bool textured = primitive.attributes.count("TEXCOORD_0") > 0;
    EXPECT_EQ(textured, indices + 6 < 3 * static_cast<std::size_t>(model.mesh.faceCount()));
    EXPECT_EQ(primitive.attributes.count("COLOR_0"), textured ? 0U : 1U);
    EXPECT_EQ(gltf.materials[primitive.material].extensions.count("KHR_materials_unlit"), 1U);
    const int position = primitive.attributes.at("POSITION");
    const auto& accessor = gltf.accessors[position];
    Eigen::Array3f low = Eigen::Array3f::Constant(1e9f), high = -low;
    for (std::size_t i = 0; i < accessor.count; ++i) {
      const Eigen::Array3f p = value<Eigen::Vector3f>(gltf, position, i).array();
      low = low.min(p);
      high = high.max(p);
    }
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(accessor.minValues[k], static_cast<double>(low[k]));
      EXPECT_EQ(accessor.maxValues[k], static_cast<double>(high[k]));
    }
    const std::size_t count = gltf.accessors[primitive.indices].count;
    for (std::size_t i = 0; i < count; ++i, ++indices) {
      const auto at = value<std::uint16_t>(gltf, primitive.indices, i);
      ASSERT_LT(at, accessor.count);
      const auto face = static_cast<Index>(indices / 3);
      const int k = indices % 3;
      EXPECT_EQ(value<Eigen::Vector3f>(gltf, position, at), model.mesh.vertices.col(model.mesh.faces(k, face)));
      if (!textured)
        continue;
      const auto uv = value<Eigen::Vector2f>(gltf, primitive.attributes.at("TEXCOORD_0"), at);
      const Eigen::Vector2f expected = model.texcoords.col(model.texcoord_faces(k, face));
      EXPECT_EQ(uv.x(), expected.x());
      EXPECT_EQ(uv.y(), 1.f - expected.y()); // glTF counts from the upper edge of the image
    }
  }
  EXPECT_EQ(indices, 3 * static_cast<std::size_t>(model.mesh.faceCount()));
}

TEST(TexturedIo, GlbWithJpegImages)
{
  const std::string path = test::scratchFolder() + "/model.glb";
  TexturedMesh model = fullTexturedMesh(5, 1);
  model.atlases[0] = Image(64, 64, 3, 90);
  writeTexturedMesh(path, model, 90);
  EXPECT_EQ(loadGlb(path).images[0].mimeType, "image/jpeg");
  const std::string object = std::filesystem::path(path).replace_extension(".obj").string();
  writeTexturedMesh(object, model, 90);
  EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(object).replace_extension(".jpg")));
  for (const std::string& file : {path, object}) {
    const TexturedMesh back = readTexturedMesh(file);
    ASSERT_EQ(back.atlases[0].width, 64);
    EXPECT_NEAR(back.atlases[0].data[100], 90, 2);
  }
}

TEST(TexturedIo, GlbOfManyVerticesHasSeveralPrimitives)
{
  const std::string path = test::scratchFolder() + "/model.glb";
  constexpr int side = 300; // 90,000 vertices, each in one place of a part
  TexturedMesh model;
  model.mesh.vertices.resize(3, side * side);
  model.texcoords.resize(2, side * side);
  for (int i = 0; i < side * side; ++i) {
    model.mesh.vertices.col(i) << i % side, i / side, 0;
    model.texcoords.col(i) = model.mesh.vertices.col(i).head<2>() / side;
  }
  const Index faces = Index{side - 1} * side - 1;
  model.mesh.faces.resize(3, faces);
  for (int f = 0; f < faces; ++f)
    model.mesh.faces.col(f) << f, f + 1, f + side;
  model.texcoord_faces = model.mesh.faces;
  model.face_atlas.setZero(faces);
  model.atlases.emplace_back(8, 8);
  for (const int quality : {0, 50}) {
    writeTexturedMesh(path, model, quality);
    EXPECT_EQ(loadGlb(path).meshes[0].primitives.size(), 2U);
    const TexturedMesh back = readTexturedMesh(path);
    ASSERT_EQ(back.mesh.faceCount(), faces);
    double farthest = 0, off = 0;
    for (Index f = 0; f < faces; ++f)
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3f p = back.mesh.vertices.col(back.mesh.faces(k, f));
        const Eigen::Vector2f at = back.texcoords.col(back.texcoord_faces(k, f));
        farthest = std::max<double>(farthest, (p - model.mesh.vertices.col(model.mesh.faces(k, f))).norm());
        off = std::max<double>(off, (at - p.head<2>() / side).cwiseAbs().maxCoeff());
      }
    EXPECT_EQ(farthest, 0);
    EXPECT_LT(off, quality > 0 ? 1e-5 : 1e-6);
  }
}

TEST(TexturedIo, GlbIsYUp)
{
  const std::string path = test::scratchFolder() + "/model.glb";
  TexturedMesh model = fullTexturedMesh(5, 1);
  model.mesh.origin = Eigen::Vector3d(10, 20, 30);
  writeTexturedMesh(path, model);
  const tinygltf::Model gltf = loadGlb(path);
  const Eigen::Matrix4d T = Eigen::Map<const Eigen::Matrix4d>(gltf.nodes[0].matrix.data());
  const Eigen::Vector4d place = T * Eigen::Vector4d(1, 2, 3, 1);
  EXPECT_EQ(place, Eigen::Vector4d(11, 33, -22, 1)); // 11 22 33 with z up
}

TEST(TexturedIo, GlbOfOthers)
{
  const std::string path = test::scratchFolder() + "/other.glb";
  tinygltf::Model gltf;
  gltf.asset.version = "2.0";
  const float data[] = {0, 0, 0, 1, 0, 0, 0, 1, 0}; // three positions, then three 16-bit indices
  gltf.buffers.emplace_back();
  gltf.buffers[0].data.resize(sizeof(data) + 6);
  std::memcpy(gltf.buffers[0].data.data(), data, sizeof(data));
  const std::uint16_t indices[] = {2, 0, 1};
  std::memcpy(gltf.buffers[0].data.data() + sizeof(data), indices, 6);
  for (const auto& [offset, length] : {std::pair<std::size_t, std::size_t>{0, 36}, {36, 6}}) {
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = offset;
    view.byteLength = length;
    gltf.bufferViews.push_back(view);
  }
  gltf.accessors.resize(2);
  gltf.accessors[0].bufferView = 0;
  gltf.accessors[0].componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
  gltf.accessors[0].type = TINYGLTF_TYPE_VEC3;
  gltf.accessors[0].count = 3;
  gltf.accessors[1].bufferView = 1;
  gltf.accessors[1].componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
  gltf.accessors[1].type = TINYGLTF_TYPE_SCALAR;
  gltf.accessors[1].count = 3;
  gltf.meshes.resize(1);
  gltf.meshes[0].primitives.resize(1);
  gltf.meshes[0].primitives[0].mode = TINYGLTF_MODE_TRIANGLES;
  gltf.meshes[0].primitives[0].attributes["POSITION"] = 0;
  gltf.meshes[0].primitives[0].indices = 1;
  gltf.nodes.resize(3);
  gltf.nodes[0].children = {1, 2};
  gltf.nodes[0].rotation = {0, 0, std::sqrt(0.5), std::sqrt(0.5)}; // a quarter turn about z, which is forward
  gltf.nodes[1].mesh = 0;
  gltf.nodes[2].mesh = 0;
  gltf.nodes[2].translation = {5, 0, 0};
  gltf.nodes[2].scale = {2, 2, 2};
  gltf.scenes.resize(1);
  gltf.scenes[0].nodes = {0};
  ASSERT_TRUE(tinygltf::TinyGLTF().WriteGltfSceneToFile(&gltf, path, true, true, false, true));
  const TexturedMesh model = readTexturedMesh(path);
  ASSERT_EQ(model.mesh.faceCount(), 2);
  const auto corner = [&](int k, Index face) { return model.mesh.vertices.col(model.mesh.faces(k, face)); };
  EXPECT_LT((corner(2, 0) - Eigen::Vector3f(0, 0, 1)).norm(), 1e-6f);
  EXPECT_LT((corner(2, 1) - Eigen::Vector3f(0, 0, 7)).norm(), 1e-6f);
  EXPECT_LT((corner(0, 1) - Eigen::Vector3f(-2, 0, 5)).norm(), 1e-6f);
  EXPECT_EQ(model.face_atlas, Eigen::Vector2i(-1, -1));
  gltf.nodes[1].children = {0}; // a circle
  ASSERT_TRUE(tinygltf::TinyGLTF().WriteGltfSceneToFile(&gltf, path, true, true, false, true));
  EXPECT_NE(test::errorOf([&] { readTexturedMesh(path); }).find("no tree"), std::string::npos);
}

TEST(TexturedIo, ObjOfOthers)
{
  const std::string folder = test::scratchFolder();
  std::filesystem::create_directory(folder + "/maps");
  writeImage(folder + "/maps/wood grain.png", Image(4, 4, 3, 7));
  test::writeText(folder + "/my room.mtl", "newmtl a b\nKd 1 1 1\nmap_Kd maps\\wood grain.png\n"
                                           "newmtl plain\nKd 1 0 0\nnewmtl again\nmap_Kd maps/wood grain.png\n");
  test::writeText(folder + "/room.obj",
                  "mtllib my room.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                  "usemtl a b\nf 1/1 2/2 3/3\nusemtl plain\nf 1/1 2/2 3/3\n"
                  "usemtl again\nf -1/-1 -2/-2 -3/-3\nf 1 2 3\n");
  const TexturedMesh model = readTexturedMesh(folder + "/room.obj");
  EXPECT_EQ(model.face_atlas, Eigen::Vector4i(0, -1, 0, -1));
  EXPECT_EQ(model.texcoord_faces.col(2), Eigen::Vector3i(2, 1, 0));
  ASSERT_EQ(model.atlases.size(), 1U);
  std::filesystem::remove(folder + "/maps/wood grain.png");
  EXPECT_NE(test::errorOf([&] { readTexturedMesh(folder + "/room.obj"); }).find("wood grain.png"), std::string::npos);
  std::filesystem::remove(folder + "/my room.mtl");
  EXPECT_NE(test::errorOf([&] { readTexturedMesh(folder + "/room.obj"); }).find("my room.mtl"), std::string::npos);
}

TEST(TexturedIo, FailedWritesLeaveNothingAndTouchNothing)
{
  const std::string folder = test::scratchFolder();
  EXPECT_THROW(writeTexturedMesh(folder + "/none/model.obj", fullTexturedMesh(3, 1)), std::runtime_error);
  EXPECT_THROW(writeTexturedMesh(folder + "/none/model.glb", fullTexturedMesh(3, 1)), std::runtime_error);
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  writeTexturedMesh(folder + "/model.obj", fullTexturedMesh(3, 1));
  // The place of the image is taken by a folder: neither .obj nor .mtl may change.
  std::filesystem::remove(folder + "/model.png");
  std::filesystem::create_directory(folder + "/model.png");
  const std::string before = readFile(folder + "/model.obj");
  EXPECT_THROW(writeTexturedMesh(folder + "/model.obj", fullTexturedMesh(4, 1)), std::runtime_error);
  EXPECT_EQ(readFile(folder + "/model.obj"), before);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 3);
}

TEST(TexturedIo, BrokenModelsAreRejected)
{
  const std::string path = test::scratchFolder() + "/model.obj";
  const auto expectThrow = [&](const std::function<void(TexturedMesh&)>& change) {
    TexturedMesh model = fullTexturedMesh(4, 2);
    change(model);
    EXPECT_THROW(writeTexturedMesh(path, model), std::invalid_argument);
  };
  expectThrow([](TexturedMesh& model) { model.face_atlas[0] = 2; });
  expectThrow([](TexturedMesh& model) { model.texcoord_faces(1, 0) = 1000; });
  expectThrow([](TexturedMesh& model) { model.texcoord_faces(1, 0) = -1; });
  expectThrow([](TexturedMesh& model) { model.texcoords(0, 0) = std::nanf(""); });
  expectThrow([](TexturedMesh& model) { model.atlases[1].data.pop_back(); });
  expectThrow([](TexturedMesh& model) { model.face_atlas.conservativeResize(3); });
  EXPECT_NE(test::errorOf([&] { writeTexturedMesh("model.fbx", fullTexturedMesh(4, 2)); }).find("model.fbx"),
            std::string::npos);
}
} // namespace
