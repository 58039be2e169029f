// SPDX-License-Identifier: BSD-3-Clause
#include "deliverables/models.h"
#include <Eigen/LU>
#include <algorithm>
#include <fresco/deliverables/core/detail_baking.h>
#include <fresco/deliverables/core/simplification.h>
#include <fresco/texture/core/texture_layout.h>
#include <gtest/gtest.h>
namespace {
using namespace fresco;

double degreesBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / M_PI;
}

/// The normal that a viewer shows in the middle of a face.
Eigen::Vector3d shownNormal(const GltfModel& shown, const Eigen::Matrix4Xf& tangents, Index face)
{
  const TexturedMesh& model = shown.model;
  const Image& map = shown.normal_maps.at(model.face_atlas[face]);
  Eigen::Vector2f at = Eigen::Vector2f::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero(), along = normal;
  double sign = 0;
  for (int k = 0; k < 3; ++k) {
    const int texcoord = model.texcoord_faces(k, face);
    at += model.texcoords.col(texcoord) / 3;
    normal += model.mesh.normals.col(model.mesh.faces(k, face)).cast<double>() / 3;
    along += tangents.col(texcoord).head<3>().cast<double>() / 3;
    sign += tangents(3, texcoord);
  }
  normal.normalize();
  along.normalize();
  const std::uint8_t* pixel = map.pixel(std::clamp<int>(at.x() * map.width, 0, map.width - 1),
                                        std::clamp<int>((1 - at.y()) * map.height, 0, map.height - 1));
  const Eigen::Vector3d local = Eigen::Vector3d(pixel[0], pixel[1], pixel[2]) / 127.5 - Eigen::Vector3d::Ones();
  const Eigen::Vector3d across = (sign < 0 ? -1 : 1) * normal.cross(along);
  return (local.x() * along + local.y() * across + local.z() * normal).normalized();
}

TexturedMesh untextured(TriangleMesh mesh)
{
  TexturedMesh model;
  model.mesh = std::move(mesh);
  return model;
}

TriangleMesh simplified(const TriangleMesh& mesh, Index faces)
{
  SimplificationOptions options;
  options.faces = faces;
  return simplifyMesh(mesh, options);
}

TexturedMesh laidOut(const TriangleMesh& mesh, double texel)
{
  TextureLayoutOptions options;
  options.texel = texel;
  return layOutTexture(mesh, options);
}

TEST(DetailBaking, AFewFacesShowTheNormalsOfMany)
{
  const TriangleMesh full = test::sphere(1, 6);
  const GltfModel baked = bakeDetail(laidOut(simplified(full, 300), 0.01), untextured(full));
  const TexturedMesh& light = baked.model;
  const Eigen::Matrix4Xf tangents = texcoordTangents(light);
  std::vector<double> with, without;
  for (Index f = 0; f < light.mesh.faceCount(); ++f) {
    if (light.face_atlas[f] < 0)
      continue;
    const Eigen::Vector3d middle =
        faceCorner(light.mesh, f, 0) + faceCorner(light.mesh, f, 1) + faceCorner(light.mesh, f, 2);
    with.push_back(degreesBetween(shownNormal(baked, tangents, f), middle));
    Eigen::Vector3d flat = areaVector(light.mesh, f);
    without.push_back(degreesBetween(flat, middle));
  }
  ASSERT_GT(with.size(), 200u);
  std::sort(with.begin(), with.end());
  std::sort(without.begin(), without.end());
  EXPECT_LT(with[with.size() / 2], 0.7);      // eight bits and the place in the texel
  EXPECT_LT(with[with.size() * 95 / 100], 2); //
  EXPECT_GT(without[without.size() / 2], with[with.size() / 2]);
}

TEST(DetailBaking, GreenPointsUpAndRedToTheRight)
{
  // A flat light model in whose texture x points right and y up; the full one is inclined.
  for (const Eigen::Vector3f& normal : {Eigen::Vector3f(0.3f, 0, 0.954f), Eigen::Vector3f(0, 0.3f, 0.954f)}) {
    TriangleMesh inclined = test::square(2);
    for (Index v = 0; v < inclined.vertexCount(); ++v)
      inclined.vertices(2, v) =
          -(inclined.vertices.col(v).head<2>() - Eigen::Vector2f(1, 1)).dot(normal.head<2>()) / normal.z();
    BakingOptions options;
    options.cage = 0.5;
    const GltfModel baked = bakeDetail(test::texturedSquare(2), untextured(inclined), options);
    const Image& map = baked.normal_maps.at(0);
    const std::uint8_t* pixel = map.pixel(map.width / 5, map.height / 2);
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(pixel[k], 127.5 * (1 + normal[k]), 1.5) << normal.transpose() << " " << k;
  }
}

TEST(DetailBaking, ColoursAreThoseAcross)
{
  TexturedMesh full = untextured(test::square(32));
  full.mesh.colors.resize(3, full.mesh.vertexCount());
  full.mesh.colors.row(0) = (100 * full.mesh.vertices.row(0)).array().round().cast<std::uint8_t>();
  full.mesh.colors.row(1) = (100 * full.mesh.vertices.row(1)).array().round().cast<std::uint8_t>();
  full.mesh.colors.row(2).setConstant(77);
  full.mesh.vertices.row(2).setConstant(0.01f);
  full.mesh.origin = {10, 20, 30};
  TexturedMesh light = test::texturedSquare(2);
  light.mesh.origin = {9, 20, 30};
  light.mesh.vertices.row(0).array() += 1; // the same place in another frame
  const Image atlas = bakeDetail(light, full).model.atlases.at(0);
  for (int y = 10; y < 60; y += 7)
    for (int x = 2; x < 24; x += 7) { // the left chart
      EXPECT_NEAR(atlas.pixel(x, y)[0], 100 * (x + 0.5) / 64 / 0.4, 1.5);
      EXPECT_NEAR(atlas.pixel(x, y)[1], 100 * (1 - (y + 0.5) / 64) / 0.45, 1.5);
      EXPECT_EQ(atlas.pixel(x, y)[2], 77);
    }
}

TEST(DetailBaking, WhatNoChartCoversLooksLikeItsSurroundings)
{
  TexturedMesh full = untextured(test::square(4));
  full.mesh.colors.resize(3, full.mesh.vertexCount());
  full.mesh.colors.colwise() = Eigen::Matrix<std::uint8_t, 3, 1>(200, 40, 90);
  GltfModel baked = bakeDetail(test::texturedSquare(2), full);
  for (int halvings = 0; halvings < 4; ++halvings) {
    for (const std::uint8_t value : baked.model.atlases[0].data)
      EXPECT_TRUE(value == 200 || value == 40 || value == 90) << int(value);
    EXPECT_EQ(baked.model.atlases[0].width, 64 >> halvings);
    EXPECT_EQ(baked.normal_maps[0].width, 32 >> halvings);
    baked.model.atlases[0] = halfSize(baked.model.atlases[0]);
    baked.normal_maps[0] = halfSize(baked.normal_maps[0]);
  }
}

TEST(DetailBaking, OfItselfAModelIsTheSame)
{
  TexturedMesh model = test::texturedSquare(4);
  std::mt19937 random(1);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      model.atlases[0].pixel(x, y)[1] = 100 + 50 * std::sin(0.2 * x) * std::cos(0.3 * y);
  const GltfModel baked = bakeDetail(model, model);
  for (int y = 10; y < 60; ++y)
    for (int x = 2; x < 24; ++x)
      EXPECT_NEAR(baked.model.atlases[0].pixel(x, y)[1], model.atlases[0].pixel(x, y)[1], 1);
  const std::uint8_t* pixel = baked.normal_maps[0].pixel(5, 20);
  EXPECT_EQ(pixel[2], 255);
  EXPECT_NEAR(pixel[0], 127.5, 0.51);
}

// However large the pictures may be: more texels would hold nothing.
TEST(DetailBaking, WithoutATextureNormalsAreAsFineAsFaces)
{
  const TexturedMesh full = untextured(test::withNoise(test::sphere(1, 5), 0.002f));
  LightModelOptions options;
  options.faces = 1000;
  const auto texelsFor = [&](int atlas) {
    options.atlas = atlas;
    std::size_t texels = 0;
    for (const Image& map : makeLightModel(full, options).normal_maps)
      texels += std::size_t(map.width) * map.height;
    return texels;
  };
  const std::size_t texels = texelsFor(4096), faces = full.mesh.faceCount();
  EXPECT_EQ(texelsFor(2048), texels);
  EXPECT_GT(texels, faces);
  EXPECT_LT(texels, 4 * faces);
}

TEST(DetailBaking, ALightModelKeepsItsBounds)
{
  TexturedMesh full = laidOut(test::withNoise(test::sphere(1, 5), 0.002f), 0.004);
  LightModelOptions options;
  options.faces = 1000;
  options.atlas = 256;
  options.atlases = 2;
  options.threads = 1;
  const GltfModel made = makeLightModel(full, options);
  const TexturedMesh& light = made.model;
  EXPECT_NO_THROW(validateTexturedMesh(light));
  EXPECT_LE(light.mesh.faceCount(), 1000);
  EXPECT_LE(light.atlases.size(), 2u);
  EXPECT_EQ(made.normal_maps.size(), light.atlases.size());
  for (const Image& atlas : light.atlases)
    EXPECT_LE(std::max(atlas.width, atlas.height), 256);
  EXPECT_GT(typicalTexel(light), typicalTexel(full));
  options.threads = 4;
  const GltfModel again = makeLightModel(full, options);
  EXPECT_EQ(again.model.texcoords, light.texcoords);
  EXPECT_EQ(again.model.atlases[0].data, light.atlases[0].data);
  EXPECT_EQ(again.normal_maps[0].data, made.normal_maps[0].data);
}

TEST(DetailBaking, RefusesWrongArguments)
{
  const TexturedMesh model = test::texturedSquare(2);
  BakingOptions options;
  options.cage = -1;
  EXPECT_THROW(bakeDetail(model, model, options), std::invalid_argument);
  options = {};
  options.border = 65;
  EXPECT_THROW(bakeDetail(model, model, options), std::invalid_argument);
  options = {};
  options.coarser = 0;
  EXPECT_THROW(bakeDetail(model, model, options), std::invalid_argument);
  EXPECT_THROW(bakeDetail(model, TexturedMesh()), std::invalid_argument);
  LightModelOptions light;
  light.atlases = 0;
  EXPECT_THROW(makeLightModel(model, light), std::invalid_argument);
  light = {};
  light.faces = -1;
  EXPECT_THROW(makeLightModel(model, light), std::invalid_argument);
  EXPECT_THROW(layOutTexture(model.mesh, {}), std::invalid_argument);
  const Progress stop = [](std::string_view, double) { return false; };
  EXPECT_THROW(bakeDetail(model, model, {}, stop), Cancelled);
}

TEST(Tangents, PointWhereUGrows)
{
  TexturedMesh model = test::texturedSquare(3);
  model.mesh.normals = Eigen::Vector3f::UnitZ().replicate(1, model.mesh.vertexCount());
  const Eigen::Matrix4Xf tangents = texcoordTangents(model);
  for (const int texcoord : model.texcoord_faces.reshaped())
    EXPECT_TRUE(tangents.col(texcoord).isApprox(Eigen::Vector4f(1, 0, 0, 1), 1e-5f));
  model.texcoords.row(0) = 1 - model.texcoords.row(0).array(); // mirrored
  const Eigen::Matrix4Xf mirrored = texcoordTangents(model);
  for (const int texcoord : model.texcoord_faces.reshaped())
    EXPECT_TRUE(mirrored.col(texcoord).isApprox(Eigen::Vector4f(-1, 0, 0, -1), 1e-5f));
}
} // namespace
