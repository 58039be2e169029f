// SPDX-License-Identifier: BSD-3-Clause
#include "deliverables/models.h"
#include <fresco/core/pcl_conversions.h>
#include <fresco/deliverables/mesh_simplification.h>
#include <gtest/gtest.h>
namespace {
using namespace fresco;

TEST(MeshSimplificationClass, EqualsCore)
{
  const TriangleMesh mesh = test::sphere(1, 4);
  const auto input = pcl::make_shared<pcl::PolygonMesh>();
  toPolygonMesh(mesh, *input);
  MeshSimplification simplification;
  simplification.setInputMesh(input);
  simplification.setNumberOfFaces(200);
  simplification.setMaximumError(0.5);
  simplification.setThreads(2);
  EXPECT_EQ(simplification.getOptions().faces, 200);
  EXPECT_EQ(simplification.getMaximumError(), 0.5);
  EXPECT_EQ(simplification.getNumberOfThreads(), 2);
  simplification.process(*input); // the output may be the input
  const TriangleMesh expected = simplifyMesh(mesh, simplification.getOptions()), found = toTriangleMesh(*input);
  EXPECT_EQ(found.vertices, expected.vertices);
  EXPECT_EQ(found.faces, expected.faces);
  EXPECT_GT(simplification.getFigures().error, 0);
}

TEST(MeshSimplificationClass, RefusesAndStops)
{
  MeshSimplification simplification;
  pcl::PolygonMesh output;
  EXPECT_THROW(simplification.process(output), std::invalid_argument);
  const auto input = pcl::make_shared<pcl::PolygonMesh>();
  toPolygonMesh(test::sphere(1, 4), *input);
  simplification.setInputMesh(input);
  EXPECT_THROW(simplification.process(output), std::invalid_argument); // neither bound
  simplification.setNumberOfFaces(10);
  simplification.setProgress([](std::string_view, double) { return false; });
  EXPECT_THROW(simplification.process(output), Cancelled);
}
} // namespace
