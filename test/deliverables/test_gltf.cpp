// SPDX-License-Identifier: BSD-3-Clause
#include "deliverables/models.h"
#include "test_data.h"
#include <Eigen/Geometry>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fresco/deliverables/core/detail_baking.h>
#include <fresco/deliverables/core/model_file.h>
#include <fresco/deliverables/core/tileset.h>
#include <fresco/io/file.h>
#include <fresco/io/mesh_io.h>
#include <gtest/gtest.h>
#include <iostream>
namespace {
using namespace fresco;

GltfModel mappedSphere()
{
  LightModelOptions options;
  options.faces = 500;
  options.texel = 0.02;
  TexturedMesh full;
  full.mesh = test::withNoise(test::sphere(1, 5), 0.002f);
  full.mesh.origin = {1000, 2000, 30};
  full.mesh.colors.resize(3, full.mesh.vertexCount());
  full.mesh.colors.setConstant(120);
  return makeLightModel(full, options);
}

GltfOptions compact(int quality)
{
  GltfOptions options;
  options.compact = true;
  options.jpeg_quality = quality;
  return options;
}

TEST(Gltf, CompactModelsAreReadAgain)
{
  const std::string path = test::scratchFolder() + "/light.glb";
  const GltfModel written = mappedSphere();
  writeGltf(path, written, compact(0));
  const GltfModel again = readGltf(path);
  const TexturedMesh &model = written.model, &read = again.model;
  EXPECT_EQ(read.mesh.faceCount(), model.mesh.faceCount());
  EXPECT_EQ(read.mesh.vertexCount(), model.mesh.vertexCount()); // vertices are joined again
  EXPECT_EQ(meshTopology(read.mesh).watertight, meshTopology(model.mesh).watertight);
  for (Index f = 0; f < read.mesh.faceCount(); ++f) {
    const Eigen::Vector3d at = faceCorner(read.mesh, f, 0) + read.mesh.origin;
    double nearest = 1e9;
    for (Index other = 0; other < model.mesh.faceCount(); ++other)
      nearest = std::min(nearest, (faceCorner(model.mesh, other, 0) + model.mesh.origin - at).norm());
    EXPECT_LT(nearest, 2.1 * 1.8 / 131070 + 1e-6);
  }
  ASSERT_EQ(again.normal_maps.size(), written.normal_maps.size());
  EXPECT_EQ(again.normal_maps[0].data, written.normal_maps[0].data);
  EXPECT_EQ(read.atlases[0].data, model.atlases[0].data);
}

/// Positions of the corners of all faces, the least first.
std::vector<std::array<float, 9>> sortedFaces(const TriangleMesh& mesh)
{
  std::vector<std::array<float, 9>> faces;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    std::array<std::array<float, 3>, 3> corners;
    for (int k = 0; k < 3; ++k)
      Eigen::Map<Eigen::Vector3f>(corners[k].data()) = mesh.vertices.col(mesh.faces(k, f));
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    auto& face = faces.emplace_back();
    for (int k = 0; k < 9; ++k)
      face[k] = corners[k / 3][k % 3];
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

TEST(Gltf, CompressedModelsAreTheSameAndSmaller)
{
  const std::string folder = test::scratchFolder();
  const GltfModel model = mappedSphere();
  for (const bool is_compact : {true, false}) {
    GltfOptions options;
    options.compact = is_compact;
    writeGltf(folder + "/plain.glb", model, options);
    options.compress = true;
    writeGltf(folder + "/packed.glb", model, options);
    const GltfModel plain = readGltf(folder + "/plain.glb"), packed = readGltf(folder + "/packed.glb");
    EXPECT_EQ(sortedFaces(packed.model.mesh), sortedFaces(plain.model.mesh));
    EXPECT_EQ(packed.model.atlases[0].data, plain.model.atlases[0].data);
    EXPECT_EQ(packed.normal_maps[0].data, plain.normal_maps[0].data);
    EXPECT_LT(std::filesystem::file_size(folder + "/packed.glb"), std::filesystem::file_size(folder + "/plain.glb"));
  }
}

TEST(Gltf, DamagedCompressedModelsAreRefused)
{
  const std::string folder = test::scratchFolder(), path = folder + "/damaged.glb";
  GltfModel model;
  model.model.mesh = test::sphere(1, 3);
  GltfOptions options;
  options.compress = true;
  writeModel(folder + "/packed.glb", model, options);
  const std::string packed = readFile(folder + "/packed.glb");
  EXPECT_EQ(readGltf(folder + "/packed.glb").model.mesh.faceCount(), model.model.mesh.faceCount());
  const auto refuses = [&](const std::string& what, const std::string& by) {
    std::string damaged = packed;
    const std::size_t at = damaged.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    writeFile(path, damaged.replace(at, what.size(), by));
    EXPECT_THROW(readGltf(path), std::runtime_error) << what;
  };
  refuses("TRIANGLES", "TRIANGELS");
  refuses("\"count\":", "\"kount\":");
  refuses("\"byteStride\":", "\"byteWidths\":");
  for (std::size_t at = packed.size() - 5; at > packed.size() / 2;
       at -= 97) { // bytes of the code: any result but a crash
    std::string damaged = packed;
    damaged[at] ^= 0x55;
    writeFile(path, damaged);
    try {
      readGltf(path);
    } catch (const std::runtime_error&) {
      continue;
    }
  }
}

TEST(Gltf, OnePrimitiveOfMoreVerticesThanShortIndicesName)
{
  const std::string folder = test::scratchFolder();
  TexturedMesh model = test::texturedSquare(300); // 90,000 vertices
  model.atlases[0] = Image(16, 16, 3, 9);
  writeGltf(folder + "/many.glb", {model, {}});
  writeGltf(folder + "/one.glb", {model, {}}, compact(90));
  const auto primitives = [&](const std::string& name) {
    const std::string content = readFile(folder + name);
    std::size_t count = 0;
    for (std::size_t at = content.find("\"POSITION\""); at != std::string::npos;
         at = content.find("\"POSITION\"", at + 1))
      ++count;
    return count;
  };
  EXPECT_GT(primitives("/many.glb"), 1u);
  EXPECT_EQ(primitives("/one.glb"), 1u);
  EXPECT_EQ(readTexturedMesh(folder + "/one.glb").mesh.faceCount(), model.mesh.faceCount());
}

TEST(Gltf, ThePlaceInTheWorldIsKeptInTheNode)
{
  const std::string path = test::scratchFolder() + "/placed.glb";
  const TexturedMesh model = test::texturedSquare(2);
  for (const bool is_compact : {false, true}) {
    GltfOptions options;
    options.compact = is_compact;
    options.T_world_model.topLeftCorner<3, 3>() =
        Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    options.T_world_model.topRightCorner<3, 1>() << 500000.25, 5200000.5, 400;
    writeGltf(path, {model, {}}, options);
    const TriangleMesh read = readTexturedMesh(path).mesh;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), wanted = sum;
    for (Index v = 0; v < read.vertexCount(); ++v) {
      sum += read.origin + read.vertices.col(v).cast<double>();
      wanted += (options.T_world_model * model.mesh.vertices.col(v).cast<double>().homogeneous()).head<3>();
    }
    EXPECT_LT((sum - wanted).norm() / read.vertexCount(), 1e-4);
  }
  GltfOptions wrong;
  wrong.T_world_model.setZero();
  EXPECT_THROW(writeGltf(path, {model, {}}, wrong), std::invalid_argument);
}

TEST(Gltf, KhronosValidatorFindsNothing)
{
  const std::string folder = test::scratchFolder(), modules = test::buildFolder() + "/npm";
  makeFolder(modules);
  const std::string install = "npm install --no-audit --no-fund --prefix " + modules +
                              " gltf-validator@2.0.0-dev.3.10 > " + folder + "/npm.txt 2>&1";
  if (!std::filesystem::exists(modules + "/node_modules/gltf-validator") && std::system(install.c_str()) != 0) {
    std::cout << "*** SKIPPED: gltf-validator could not be had from npm ***\n";
    GTEST_SKIP();
  }
  const GltfModel mapped = mappedSphere();
  GltfModel bare;
  bare.model.mesh = test::box();
  bare.model.mesh.colors.resize(3, 8);
  bare.model.mesh.colors.setConstant(50);
  writeGltf(folder + "/mapped.glb", mapped, compact(90));
  writeGltf(folder + "/exact.glb", mapped);
  GltfOptions packed = compact(90);
  packed.compress = true;
  writeGltf(folder + "/packed.glb", mapped, packed);
  GltfOptions placed = compact(0);
  placed.lit = true;
  placed.T_world_model.topRightCorner<3, 1>() << 500000, 5200000, 400;
  writeGltf(folder + "/placed.glb", mapped, placed);
  writeGltf(folder + "/large.glb", {test::texturedSquare(300), {}}, compact(80));
  writeModel(folder + "/bare.glb", bare, compact(0));
  writeModel(folder + "/plain.glb", bare);
  writeTileset(folder, mapped.model, {mapped.model.mesh.faceCount() / 2});
  writeFile(folder + "/broken.glb", readFile(folder + "/plain.glb").substr(0, 300));
  const std::string validate = test::projectFolder() + "/scripts/validate_gltf " + modules + "/node_modules ";
  for (const char* name : {"mapped", "exact", "packed", "placed", "large", "bare", "plain", "tile_0", "tile_1"})
    EXPECT_EQ(std::system((validate + folder + "/" + name + ".glb").c_str()), 0) << name;
  EXPECT_NE(std::system((validate + folder + "/broken.glb > /dev/null").c_str()), 0);
}
} // namespace
