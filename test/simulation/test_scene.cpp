// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <fresco/simulation/scene/places.h>
#include <fresco/simulation/scene/scene_builder.h>
#include <fresco/simulation/sensors/lighting.h>
#include <fresco/simulation/sensors/random.h>
#include <gtest/gtest.h>
#include <map>
using namespace fresco;
using namespace fresco::simulation;
using Eigen::Vector3f;

namespace {
TriangleMesh objectMesh(const Scene& scene, const SceneObject& object)
{
  TriangleMesh mesh;
  mesh.vertices = scene.mesh.vertices;
  mesh.faces = scene.mesh.faces.middleCols(object.begin, object.end - object.begin);
  return removeUnreferencedVertices(mesh);
}

double smallestArea(const TriangleMesh& mesh)
{
  double least = 1e30;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const Vector3f a = mesh.vertices.col(mesh.faces(0, f)), b = mesh.vertices.col(mesh.faces(1, f)),
                   c = mesh.vertices.col(mesh.faces(2, f));
    least = std::min(least, 0.5 * static_cast<double>((b - a).cross(c - a).norm()));
  }
  return least;
}

const Scene& coarseRoom(const std::string& name)
{
  static std::map<std::string, Scene> built;
  const auto found = built.find(name);
  if (found != built.end())
    return found->second;
  if (name == "office")
    return built.emplace(name, makeOffice({4, 3})).first->second;
  return built.emplace(name, name == "two storeys" ? makeOffice({4, 3, 2}) : makeScene(name, 0.4f)).first->second;
}

Scene emptyRoom()
{
  SceneBuilder builder("box", 0.5f);
  Material paint;
  paint.color = {0.8f, 0.8f, 0.8f};
  const int wall = builder.add(paint);
  builder.beginObject("room");
  builder.boxes({{{-2, -2, 0}, {2, 2, 2.5f}, allSides(wall), false}}, true);
  builder.beginObject("block");
  builder.boxes({{{-0.5f, -0.5f, 0}, {0.5f, 0.5f, 0.8f}, allSides(wall), true}});
  builder.lamp({{0, 0, 2.49f}, {0, 0.3f, 0}, {0.3f, 0, 0}, Vector3f(10, 10, 10)});
  return builder.finish();
}
} // namespace

class VirtualRooms : public testing::TestWithParam<const char*> {};

TEST_P(VirtualRooms, ObjectsAreClosedAndFaceTheFreeSide)
{
  const Scene& scene = coarseRoom(GetParam());
  EXPECT_GT(scene.objects.size(), 50u);
  EXPECT_GT(smallestArea(scene.mesh), 1e-9);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const TriangleMesh mesh = objectMesh(scene, scene.objects[i]);
    const MeshTopology topology = meshTopology(mesh);
    EXPECT_EQ(topology.boundary_edges, 0) << scene.objects[i].name;
    EXPECT_EQ(topology.inconsistent_edges, 0) << scene.objects[i].name;
    EXPECT_EQ(topology.nonmanifold_edges, 0) << scene.objects[i].name;
    if (i == 0)
      EXPECT_LT(signedVolume(mesh), -50.0) << "the room's shell looks inwards";
    else
      EXPECT_GT(signedVolume(mesh), 0.0) << scene.objects[i].name;
  }
}

TEST_P(VirtualRooms, CellsAndFacesAgree)
{
  const Scene& scene = coarseRoom(GetParam());
  ASSERT_EQ(scene.face_cell.size(), static_cast<std::size_t>(scene.mesh.faceCount()));
  for (Index f = 0; f < scene.mesh.faceCount(); ++f) {
    const int code = scene.face_cell[f];
    const Cell& cell = scene.cells[code / 2];
    for (int k = 0; k < 3; ++k) {
      const CellPoint at = cellPoint(code % 2, k == 1 ? 1.f : 0.f, k == 2 ? 1.f : 0.f);
      EXPECT_LT((cellPosition(scene, cell, at) - scene.mesh.vertices.col(scene.mesh.faces(k, f))).norm(), 1e-5f);
    }
    EXPECT_NEAR(cell.normals[0].norm(), 1.f, 1e-4f);
  }
}

INSTANTIATE_TEST_SUITE_P(All, VirtualRooms, testing::Values("conference_room", "apartment", "office", "two storeys"));

TEST(VirtualOffice, TheSeedMakesTheFloor)
{
  const Scene first = makeOffice({6, 1}, 2.f), again = makeOffice({6, 1}, 2.f), other = makeOffice({6, 2}, 2.f);
  EXPECT_EQ(first.mesh.vertices, again.mesh.vertices);
  EXPECT_NE(first.mesh.vertices.cols(), other.mesh.vertices.cols());
  const Scene large = makeOffice({12, 1}, 2.f);
  EXPECT_LT(signedVolume(objectMesh(large, large.objects[0])), 1.3 * signedVolume(objectMesh(first, first.objects[0])))
      << "the shells look inwards";
  EXPECT_THROW(makeOffice({3, 1}), std::invalid_argument);
  EXPECT_THROW(makeOffice({33, 1}), std::invalid_argument);
  EXPECT_THROW(makeOffice({4, 1, 0}), std::invalid_argument);
  EXPECT_THROW(makeOffice({4, 1, 3}), std::invalid_argument);
}

TEST(VirtualScene, RefusesBadRequests)
{
  EXPECT_THROW(makeScene("kitchen"), std::invalid_argument);
  EXPECT_THROW(makeScene("apartment", 0.f), std::invalid_argument);
  EXPECT_THROW(makeScene("apartment", std::nanf("")), std::invalid_argument);
  EXPECT_THROW(meshScene({}), std::runtime_error);
  TriangleMesh mesh;
  mesh.vertices = Points::Zero(3, 3);
  mesh.faces = Eigen::Vector3i(0, 1, 2);
  EXPECT_THROW(meshScene(mesh), std::runtime_error); // no area
  mesh.vertices(0, 0) = std::nanf("");
  EXPECT_THROW(meshScene(mesh), std::runtime_error);
}

TEST(VirtualScene, UnionOfBoxesHasNoInnerFaces)
{
  SceneBuilder builder("boxes", 10.f);
  const int paint = builder.add({});
  builder.beginObject("boxes");
  builder.boxes({{{0, 0, 0}, {2, 1, 1}, allSides(paint), true}, {{1, 0, 0}, {3, 1, 1}, allSides(paint), true}});
  const Scene scene = builder.finish();
  EXPECT_NEAR(surfaceArea(scene.mesh), 14.0, 1e-4);
  EXPECT_NEAR(signedVolume(scene.mesh), 3.0, 1e-4);
}

TEST(VirtualScene, RoundBodiesApproachTheirVolume)
{
  SceneBuilder builder("round", 10.f);
  const int paint = builder.add({});
  builder.beginObject("cylinder");
  builder.lathe({{0, 0}, {1, 0}, {1, 2}, {0, 2}}, paint, 96);
  const Scene scene = builder.finish();
  EXPECT_NEAR(signedVolume(scene.mesh), 6.2831853, 0.01);
  EXPECT_TRUE(meshTopology(scene.mesh).watertight);
}

TEST(VirtualLight, FallsOnTheLitSideAndNotBelowABlock)
{
  const Scene scene = emptyRoom();
  const RayScene rays(scene.mesh);
  const Lightmap light = bakeLight(scene, rays, {});
  const LitScene lit{scene, rays, light};
  const auto seen = [&](const Vector3f& from, const Vector3f& to) {
    return surfaceColor(lit, rays.intersect({from, to - from}), 0.01f).mean();
  };
  const float open_floor = seen({1.2f, 1.2f, 1}, {1.2f, 1.2f, 0}), top = seen({0, 0, 2}, {0, 0, 0.8f});
  const float side = seen({1.5f, 0, 0.2f}, {0.5f, 0, 0.2f}), corner = seen({0.7f, 0, 0.5f}, {0.505f, 0, 0});
  EXPECT_GT(top, open_floor);
  EXPECT_GT(open_floor, corner);
  EXPECT_GT(side, 0.1f) << "light from the walls";
}

TEST(VirtualLight, DoesNotDependOnThreads)
{
  const Scene scene = emptyRoom();
  const RayScene rays(scene.mesh);
  LightingOptions one, four;
  one.threads = 1, four.threads = 4;
  const Lightmap a = bakeLight(scene, rays, one), b = bakeLight(scene, rays, four);
  for (std::size_t c = 0; c < scene.cells.size(); ++c)
    EXPECT_EQ(a.at(static_cast<int>(c), {0.3f, 0.6f}), b.at(static_cast<int>(c), {0.3f, 0.6f}));
  one.spacing = 0.f;
  EXPECT_THROW(bakeLight(scene, rays, one), std::invalid_argument);
}

TEST(VirtualMaterial, DetailFadesWithDistance)
{
  for (const Finish finish : {Finish::plain, Finish::plaster, Finish::carpet, Finish::planks, Finish::wood,
                              Finish::fabric, Finish::ceiling_tile, Finish::metal, Finish::cardboard, Finish::leaf}) {
    Material material;
    material.finish = finish;
    const auto variation = [&](float footprint) {
      float sum = 0.f;
      for (int i = 0; i < 400; ++i) {
        const Vector3f at(0.0137f * static_cast<float>(i), 0.41f, 0.f), next = at + Vector3f(0.004f, 0, 0);
        sum += (albedo(material, {at, Vector3f::UnitZ(), footprint}) -
                albedo(material, {next, Vector3f::UnitZ(), footprint}))
                   .norm();
      }
      return sum;
    };
    EXPECT_GT(variation(0.0005f), 0.05f) << static_cast<int>(finish);
    EXPECT_LT(variation(0.1f), 0.6f * variation(0.0005f)) << static_cast<int>(finish);
  }
}

TEST(VirtualRandom, IsAFunctionOfItsCounters)
{
  EXPECT_EQ(CounterRandom(1, 2, 3).uniform(), CounterRandom(1, 2, 3).uniform());
  EXPECT_NE(CounterRandom(1, 2, 3).uniform(), CounterRandom(1, 3, 2).uniform());
  double sum = 0, squares = 0;
  constexpr int count = 100000;
  for (int i = 0; i < count; ++i) {
    const double x = CounterRandom(5, 6, static_cast<std::uint64_t>(i)).gaussian();
    sum += x, squares += x * x;
  }
  EXPECT_NEAR(sum / count, 0.0, 0.015); // 5 deviations of the mean
  EXPECT_NEAR(squares / count, 1.0, 0.023);
}
