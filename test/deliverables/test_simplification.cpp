// SPDX-License-Identifier: BSD-3-Clause
#include "deliverables/models.h"
#include <fresco/deliverables/core/simplification.h>
#include <gtest/gtest.h>
#include <limits>
namespace {
using namespace fresco;

SimplificationOptions toFaces(Index faces)
{
  SimplificationOptions options;
  options.faces = faces;
  return options;
}

SimplificationOptions toError(double error)
{
  SimplificationOptions options;
  options.error = error;
  return options;
}

/// Share of the area whose faces do not look away from the origin.
double turnedShare(const TriangleMesh& mesh)
{
  double turned = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
    if (const Eigen::Vector3d area = areaVector(mesh, f); area.dot(faceCorner(mesh, f, 0)) <= 0)
      turned += area.norm() / 2;
  return turned / surfaceArea(mesh);
}

TEST(Simplification, SphereStaysAManifoldWithoutFlippedFacesAndConverges)
{
  const TriangleMesh full = test::sphere(1, 6); // 32,768 faces
  double before = std::numeric_limits<double>::infinity();
  for (const Index faces : {100, 1000, 10000}) {
    SimplificationFigures figures;
    const TriangleMesh mesh = simplifyMesh(full, toFaces(faces), &figures);
    EXPECT_LE(mesh.faceCount(), faces);
    EXPECT_GT(mesh.faceCount(), faces - 2);
    EXPECT_FALSE(figures.exhausted);
    const MeshTopology topology = meshTopology(mesh);
    EXPECT_TRUE(topology.watertight) << faces;
    EXPECT_EQ(topology.euler, 2) << faces;
    EXPECT_EQ(turnedShare(mesh), 0) << faces;
    const double lost = 4.0 / 3 * M_PI - signedVolume(mesh);
    EXPECT_LT(std::abs(lost), before / 5) << faces; // the error falls as 1 / faces
    before = std::abs(lost);
  }
}

TEST(Simplification, NoisyShapesOfTwoPartsKeepTheirTopology)
{
  TriangleMesh two = test::withNoise(test::sphere(1, 5), 0.01f); // noise of a third of an edge
  const TriangleMesh other = test::sphere(0.5f, 4);
  const Index vertices = two.vertexCount(), faces = two.faceCount();
  two.vertices.conservativeResize(3, vertices + other.vertexCount());
  two.vertices.rightCols(other.vertexCount()) = other.vertices.colwise() + Eigen::Vector3f(3, 0, 0);
  two.faces.conservativeResize(3, faces + other.faceCount());
  two.faces.rightCols(other.faceCount()) = other.faces.array() + int(vertices);
  const MeshTopology topology = meshTopology(simplifyMesh(two, toFaces(60)));
  EXPECT_TRUE(topology.watertight);
  EXPECT_EQ(topology.components, 2);
  EXPECT_EQ(topology.euler, 4);
}

TEST(Simplification, AFlatSquareKeepsItsBorderWithFewFaces)
{
  const TriangleMesh mesh = simplifyMesh(test::square(40), toError(1e-3));
  EXPECT_LT(mesh.faceCount(), 40); // of 3,200
  EXPECT_NEAR(surfaceArea(mesh), 4, 0.01);
  EXPECT_EQ(meshTopology(mesh).euler, 1);
  for (Index f = 0; f < mesh.faceCount(); ++f)
    EXPECT_GT(areaVector(mesh, f).z(), 0);
}

TEST(Simplification, CreasesStayWhereTheyAre)
{
  TriangleMesh bent = test::square(32); // a roof along x = 1
  for (Index v = 0; v < bent.vertexCount(); ++v)
    bent.vertices(2, v) = -std::abs(bent.vertices(0, v) - 1);
  const TriangleMesh mesh = simplifyMesh(bent, toError(1e-3));
  EXPECT_LT(mesh.faceCount(), 100);
  for (Index v = 0; v < mesh.vertexCount(); ++v)
    EXPECT_NEAR(mesh.vertices(2, v), -std::abs(mesh.vertices(0, v) - 1), 5e-3);
  EXPECT_NEAR(surfaceArea(mesh), 4 * std::sqrt(2.0), 0.02);
}

TEST(Simplification, TextureAndSeamsStay)
{
  const TexturedMesh model = simplifyModel(test::texturedSquare(40), toFaces(100));
  EXPECT_NO_THROW(validateTexturedMesh(model));
  EXPECT_LE(model.mesh.faceCount(), 100);
  EXPECT_LT(test::textureError(model), 1e-3); // of a chart that is 0.4 wide
  double left = 0;
  for (Index f = 0; f < model.mesh.faceCount(); ++f) {
    double sum = 0;
    for (const int v : model.mesh.faces.col(f))
      sum += model.mesh.vertices(0, v);
    left += sum < 3 ? areaVector(model.mesh, f).norm() / 2 : 0;
  }
  EXPECT_NEAR(left, 2, 0.01);
}

TEST(Simplification, ColoursAndFieldsAreInterpolated)
{
  TriangleMesh ramp = test::square(32);
  ramp.colors.resize(3, ramp.vertexCount());
  ramp.colors.setConstant(7);
  ramp.colors.row(0) = (100 * ramp.vertices.row(0)).array().round().cast<std::uint8_t>();
  ramp.fields["x"] = ramp.vertices.row(0);
  ramp.normals = Eigen::Vector3f::UnitZ().replicate(1, ramp.vertexCount());
  const TriangleMesh mesh = simplifyMesh(ramp, toFaces(200));
  ASSERT_EQ(mesh.colors.cols(), mesh.vertexCount());
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    EXPECT_NEAR(mesh.fields.at("x")[v], mesh.vertices(0, v), 0.03);
    EXPECT_NEAR(mesh.colors(0, v), 100 * mesh.vertices(0, v), 5);
    EXPECT_EQ(mesh.colors(1, v), 7);
    EXPECT_EQ(mesh.normals.col(v), Eigen::Vector3f::UnitZ());
  }
}

TEST(Simplification, WhatIsNotManifoldStays)
{
  TriangleMesh book = test::square(20); // a third page on the line x = 1
  const Index vertices = book.vertexCount(), faces = book.faceCount();
  std::map<int, int> copy;
  std::vector<Eigen::Vector3f> places;
  Faces page = book.faces;
  Index kept = 0;
  for (Index f = 0; f < faces; ++f) {
    if (std::max({book.vertices(0, page(0, f)), book.vertices(0, page(1, f)), book.vertices(0, page(2, f))}) > 1.001f)
      continue;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3f at = book.vertices.col(book.faces(k, f));
      if (at.x() > 0.999f) {
        page(k, kept) = book.faces(k, f);
        continue;
      }
      const auto [entry, is_new] = copy.try_emplace(book.faces(k, f), vertices + places.size());
      if (is_new)
        places.emplace_back(1.f, at.y(), 1 - at.x());
      page(k, kept) = entry->second;
    }
    ++kept;
  }
  book.vertices.conservativeResize(3, vertices + places.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    book.vertices.col(vertices + i) = places[i];
  book.faces.conservativeResize(3, faces + kept);
  book.faces.rightCols(kept) = page.leftCols(kept);
  const Index spine = meshTopology(book).nonmanifold_edges;
  ASSERT_EQ(spine, 20);
  const TriangleMesh mesh = simplifyMesh(book, toError(1e-3));
  EXPECT_LT(mesh.faceCount(), 200); // of 1,200
  EXPECT_EQ(meshTopology(mesh).nonmanifold_edges, spine);
  EXPECT_NEAR(surfaceArea(mesh), 6, 0.05);
}

TEST(Simplification, ThreadsAndMovesDoNotMatter)
{
  SimplificationOptions options = toFaces(500);
  options.threads = 1;
  const TriangleMesh full = test::withNoise(test::sphere(1, 5), 0.003f), one = simplifyMesh(full, options);
  options.threads = 4;
  const TriangleMesh four = simplifyMesh(full, options);
  EXPECT_EQ(one.vertices, four.vertices);
  EXPECT_EQ(one.faces, four.faces);
  TriangleMesh moved = full;
  moved.origin = {5e5, 4e6, 100};
  const TriangleMesh there = simplifyMesh(moved, options);
  EXPECT_EQ(there.vertices, one.vertices);
  EXPECT_EQ(there.origin, moved.origin);
}

TEST(Simplification, BoundsThatCannotBeReachedAreSaid)
{
  SimplificationFigures figures;
  const TriangleMesh least = simplifyMesh(test::sphere(1, 3), toFaces(1), &figures);
  EXPECT_TRUE(figures.exhausted);
  EXPECT_TRUE(meshTopology(least).watertight);
  const TriangleMesh same = simplifyMesh(test::box(), toFaces(1000), &figures);
  EXPECT_EQ(same.faceCount(), 12);
  EXPECT_FALSE(figures.exhausted);
}

TEST(Simplification, RefusesWrongArguments)
{
  EXPECT_THROW(simplifyMesh(test::box(), {}), std::invalid_argument);
  EXPECT_THROW(simplifyMesh(test::box(), toFaces(-1)), std::invalid_argument);
  EXPECT_THROW(simplifyMesh(test::box(), toError(-1)), std::invalid_argument);
  EXPECT_THROW(simplifyMesh(test::box(), toError(std::nan(""))), std::invalid_argument);
  TriangleMesh wrong = test::box();
  wrong.faces(0, 0) = 99;
  EXPECT_THROW(simplifyMesh(wrong, toFaces(4)), std::invalid_argument);
  TexturedMesh lost = test::texturedSquare(4);
  lost.texcoord_faces(0, 0) = 9999;
  EXPECT_THROW(simplifyModel(lost, toFaces(4)), std::invalid_argument);
  const Progress stop = [](std::string_view, double) { return false; };
  EXPECT_THROW(simplifyMesh(test::sphere(1, 4), toFaces(4), nullptr, stop), Cancelled);
}
} // namespace
