// SPDX-License-Identifier: BSD-3-Clause
#include "common/shapes.h"
#include <fresco/core/mesh.h>
#include <gtest/gtest.h>
namespace {
using namespace fresco;
using test::box;
using test::sphere;

TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b)
{
  TriangleMesh both;
  both.vertices.resize(3, a.vertexCount() + b.vertexCount());
  both.vertices << a.vertices, b.vertices;
  both.faces.resize(3, a.faceCount() + b.faceCount());
  both.faces << a.faces, (b.faces.array() + static_cast<int>(a.vertexCount())).matrix();
  return both;
}

TriangleMesh withFaces(const TriangleMesh& mesh, std::initializer_list<Eigen::Vector3i> faces)
{
  TriangleMesh result = mesh;
  result.faces.resize(3, static_cast<Index>(faces.size()));
  Index f = 0;
  for (const Eigen::Vector3i& face : faces)
    result.faces.col(f++) = face;
  return result;
}

TEST(Mesh, BoxVolumeAreaNormals)
{
  const TriangleMesh mesh = box({2.f, 3.f, 4.f});
  EXPECT_NEAR(signedVolume(mesh), 24.0, 1e-9);
  EXPECT_NEAR(surfaceArea(mesh), 2.0 * (6 + 8 + 12), 1e-9);
  const Points normals = faceNormals(mesh);
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const Eigen::Vector3f middle = mesh.vertices(Eigen::all, mesh.faces.col(f)).rowwise().mean();
    EXPECT_GT(normals.col(f).dot(middle - Eigen::Vector3f(1.f, 1.5f, 2.f)), 0.f) << f;
    EXPECT_NEAR(normals.col(f).norm(), 1.f, 1e-6f);
  }
  TriangleMesh inverted = mesh;
  inverted.faces.row(0).swap(inverted.faces.row(1));
  EXPECT_NEAR(signedVolume(inverted), -24.0, 1e-9);
}

TEST(Mesh, VolumeSurvivesLargeCoordinates)
{
  TriangleMesh mesh = box();
  mesh.vertices.colwise() += Eigen::Vector3f(65536.f, -32768.f, 16384.f);
  EXPECT_NEAR(signedVolume(mesh), 1.0, 1e-6);
}

TEST(Mesh, SphereNormalsPointOutwardForAnyThreadCount)
{
  const TriangleMesh mesh = sphere(2.f, 4);
  const Points one = vertexNormals(mesh, 1);
  EXPECT_EQ(one, vertexNormals(mesh, 4));
  EXPECT_GT((one.cwiseProduct(mesh.vertices / 2.f)).colwise().sum().minCoeff(), 0.999f);
}

TEST(Mesh, TopologyOfClosedMeshes)
{
  for (const TriangleMesh& mesh : {box(), sphere(1.f, 3), joined(box(), sphere(1.f, 2))}) {
    const MeshTopology t = meshTopology(mesh);
    EXPECT_TRUE(t.watertight);
    EXPECT_EQ(t.euler, 2 * t.components);
    EXPECT_EQ(2 * t.edges, 3 * mesh.faceCount());
    EXPECT_EQ(t.referenced_vertices, mesh.vertexCount());
  }
  EXPECT_EQ(meshTopology(joined(box(), sphere(1.f, 2))).components, 2);
}

TEST(Mesh, TopologyNamesEveryFault)
{
  TriangleMesh open = box();
  open.faces.conservativeResize(3, 11);
  EXPECT_EQ(meshTopology(open).boundary_edges, 3);
  EXPECT_FALSE(meshTopology(open).watertight);

  TriangleMesh flipped = box();
  std::swap(flipped.faces(0, 0), flipped.faces(1, 0));
  EXPECT_EQ(meshTopology(flipped).inconsistent_edges, 3);
  EXPECT_FALSE(meshTopology(flipped).watertight);

  const TriangleMesh fin = withFaces(box(), {{0, 1, 2}, {1, 0, 4}, {0, 1, 7}});
  EXPECT_EQ(meshTopology(fin).nonmanifold_edges, 1);

  const TriangleMesh bowtie = withFaces(box(), {{0, 1, 2}, {0, 4, 5}});
  EXPECT_EQ(meshTopology(bowtie).nonmanifold_vertices, 1);
  EXPECT_EQ(meshTopology(bowtie).components, 1);

  const TriangleMesh degenerate = withFaces(box(), {{0, 1, 2}, {3, 3, 4}});
  EXPECT_EQ(meshTopology(degenerate).referenced_vertices, 3);
  EXPECT_FALSE(meshTopology(TriangleMesh()).watertight);
}

TEST(Mesh, RemoveUnreferencedVerticesKeepsAttributes)
{
  TriangleMesh mesh = withFaces(box(), {{7, 3, 1}});
  mesh.colors = Colors::Random(3, 8);
  mesh.normals = Points::Random(3, 8);
  mesh.fields["support"] = Eigen::VectorXf::LinSpaced(8, 0.f, 7.f);
  const TriangleMesh small = removeUnreferencedVertices(mesh);
  ASSERT_EQ(small.vertexCount(), 3);
  for (int k = 0; k < 3; ++k) {
    const int before = mesh.faces(k, 0), after = small.faces(k, 0);
    EXPECT_EQ(small.vertices.col(after), mesh.vertices.col(before));
    EXPECT_EQ(small.colors.col(after), mesh.colors.col(before));
    EXPECT_EQ(small.normals.col(after), mesh.normals.col(before));
    EXPECT_EQ(small.fields.at("support")[after], static_cast<float>(before));
  }
}

TEST(Mesh, ValidateNamesWhatIsWrong)
{
  EXPECT_NO_THROW(validateMesh(box()));
  EXPECT_THROW(validateMesh(withFaces(box(), {{0, 1, 8}})), std::invalid_argument);
  EXPECT_THROW(meshTopology(withFaces(box(), {{0, 1, -1}})), std::invalid_argument);
  TriangleMesh colors = box();
  colors.colors.resize(3, 7);
  EXPECT_THROW(validateMesh(colors), std::invalid_argument);
  TriangleMesh hole = box();
  hole.vertices(1, 3) = std::nanf("");
  EXPECT_THROW(validateMesh(hole), std::invalid_argument);
}
} // namespace
