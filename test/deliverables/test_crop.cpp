// SPDX-License-Identifier: BSD-3-Clause
#include "deliverables/models.h"
#include "deliverables/plan_shapes.h"
#include "test_data.h"
#include <fresco/deliverables/core/crop.h>
#include <fstream>
#include <gtest/gtest.h>
namespace {
using namespace fresco;

Eigen::Matrix2Xd outline(const std::vector<Eigen::Vector2d>& points)
{
  return Eigen::Map<const Eigen::Matrix2Xd>(points[0].data(), 2, points.size());
}

double areaOf(const Eigen::Matrix2Xd& outline)
{
  double sum = 0;
  for (Index k = 0, last = outline.cols() - 1; k < outline.cols(); last = k++)
    sum += outline(0, last) * outline(1, k) - outline(0, k) * outline(1, last);
  return 0.5 * std::abs(sum);
}

const Eigen::Matrix2Xd star =
    outline({{0.3, 0.2}, {1.0, 0.7}, {1.8, 0.3}, {1.3, 1.0}, {1.7, 1.9}, {1.0, 1.2}, {0.2, 1.6}});
const Eigen::Matrix2Xd hole = outline({{0.9, 0.9}, {1.1, 0.9}, {1.0, 1.1}});

TEST(Crop, CutsThroughFacesAlongTheOutline)
{
  for (const int n : {1, 7, 40}) { // faces larger and smaller than the outline
    const TriangleMesh mesh = cropMesh(test::square(n), {{star, hole}});
    EXPECT_NEAR(surfaceArea(mesh), areaOf(star) - areaOf(hole), 1e-5) << n;
    const MeshTopology topology = meshTopology(mesh);
    EXPECT_EQ(topology.nonmanifold_edges + topology.inconsistent_edges + topology.nonmanifold_vertices, 0) << n;
    EXPECT_EQ(topology.euler, 0) << n; // a disk with a hole: no crack where faces were cut
    for (Index f = 0; f < mesh.faceCount(); ++f)
      EXPECT_GE(areaVector(mesh, f).z(), -1e-9) << n;
  }
}

TEST(Crop, HeightsAndPlaceInTheWorld)
{
  TriangleMesh box = test::box();
  box.origin = {500000, 4000000, 100};
  const TriangleMesh mesh = cropMesh(box, {{}, 100.25, 100.75});
  EXPECT_NEAR(surfaceArea(mesh), 4 * 0.5, 1e-6);
  EXPECT_NEAR(mesh.vertices.row(2).minCoeff(), 0.25, 1e-6);
  EXPECT_NEAR(mesh.vertices.row(2).maxCoeff(), 0.75, 1e-6);
  EXPECT_EQ(meshTopology(mesh).components, 1);
  EXPECT_EQ(cropMesh(box, {{}, 101.5, 200}).faceCount(), 0);
  const TriangleMesh whole = cropMesh(box, {{}, 0, 200});
  EXPECT_EQ(whole.faces, box.faces);
  EXPECT_EQ(whole.vertices, box.vertices);
}

TEST(Crop, PartsAddUpToTheWhole)
{
  const TriangleMesh sphere = test::withNoise(test::sphere(1, 5), 0.002f);
  CropRegion low, high;
  low.high = high.low = 0.123;
  EXPECT_NEAR(surfaceArea(cropMesh(sphere, low)) + surfaceArea(cropMesh(sphere, high)), surfaceArea(sphere), 1e-4);
  EXPECT_EQ(meshTopology(cropMesh(sphere, low)).euler, 1);
}

TEST(Crop, TextureColoursAndFieldsFollow)
{
  TexturedMesh model = test::texturedSquare(6);
  model.mesh.fields["x"] = model.mesh.vertices.row(0);
  model.mesh.colors.resize(3, model.mesh.vertexCount());
  model.mesh.colors.setConstant(9);
  model.mesh.normals = Eigen::Vector3f::UnitZ().replicate(1, model.mesh.vertexCount());
  const TexturedMesh cut = cropModel(model, {{star}});
  EXPECT_NO_THROW(validateTexturedMesh(cut));
  EXPECT_LT(test::textureError(cut), 1e-5);
  EXPECT_LT((cut.mesh.fields.at("x") - cut.mesh.vertices.row(0).transpose()).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_TRUE((cut.mesh.colors.array() == 9).all());
  EXPECT_EQ(cut.mesh.normals.row(2).minCoeff(), 1);
  EXPECT_EQ(cut.atlases.size(), 1u);
}

TEST(Crop, OutlinesOfFiles)
{
  const std::string folder = test::scratchFolder();
  const auto file = [&](const std::string& name, const std::string& content) {
    std::ofstream(folder + "/" + name) << content;
    return folder + "/" + name;
  };
  const Eigen::Matrix2Xd wanted = outline({{1, -2}, {3, -2}, {3, -4}, {1, -4}});
  for (const std::string drawn : {"<polygon points='1,2 3,2 3,4 1,4'/>", "<rect x='1' y='2' width='2' height='2'/>",
                                  "<path d='M1 2L3 2V4H1Z'/>", "<g><path d='m1,2 2,0 0,2-2,0z'/></g>"}) {
    const auto outlines = readOutlines(file("a.svg", "<svg xmlns='http://www.w3.org/2000/svg'>" + drawn + "</svg>"));
    ASSERT_EQ(outlines.size(), 1u) << drawn;
    EXPECT_EQ(outlines[0], wanted) << drawn;
  }
  const std::string ring = "[[1,-2],[3,-2],[3,-4],[1,-4],[1,-2]]";
  for (const std::string& drawn :
       {"{\"type\":\"Polygon\",\"coordinates\":[" + ring + "]}",
        "{\"type\":\"MultiPolygon\",\"coordinates\":[[" + ring + "]]}",
        "{\"type\":\"FeatureCollection\",\"features\":[{\"type\":\"Feature\",\"properties\":{},\"geometry\":"
        "{\"type\":\"Polygon\",\"coordinates\":[" +
            ring + "]}}]}"}) {
    const auto outlines = readOutlines(file("a.geojson", drawn));
    ASSERT_EQ(outlines.size(), 1u) << drawn;
    EXPECT_EQ(outlines[0], wanted) << drawn;
  }
  for (const char* bad :
       {"<svg/>", "<svg><path d='M0 0C1 1 2 2 3 3'/></svg>", "<svg><path d='L1 1'/></svg>", "<svg",
        "<svg><g transform='scale(2)'><rect width='1' height='1'/></g></svg>", "<svg><path d='M0 x'/></svg>"})
    EXPECT_THROW(readOutlines(file("bad.svg", bad)), std::runtime_error) << bad;
  for (const char* bad : {"{}", "[", "{\"type\":\"Point\",\"coordinates\":[0,0]}", "{\"type\":\"Polygon\"}",
                          "{\"type\":\"Polygon\",\"coordinates\":[[[\"a\",1]]]}"})
    EXPECT_THROW(readOutlines(file("bad.geojson", bad)), std::runtime_error) << bad;
  EXPECT_THROW(readOutlines(folder + "/missing.svg"), std::runtime_error);
}

TEST(Crop, RefusesWhatIsNoRegion)
{
  EXPECT_THROW(cropMesh(test::box(), {{}, 1, 0}), std::invalid_argument);
  EXPECT_THROW(cropMesh(test::box(), {{outline({{0, 0}, {4, 4}, {4, 0}, {0, 4}})}}), std::invalid_argument);
}
/// Area of the faces of two rooms whose corners lie on one side of x = 4.05, halfway through their wall.
double areaOfRoom(const TriangleMesh& mesh, bool first)
{
  double area = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
    if ((faceCorner(mesh, f, 0).x() < 4.05) == first && (faceCorner(mesh, f, 1).x() < 4.05) == first &&
        (faceCorner(mesh, f, 2).x() < 4.05) == first)
      area += 0.5 * areaVector(mesh, f).norm();
  return area;
}

TEST(Crop, ARoomOfThePlanIsItsFacesAndTheOtherOneIsNot)
{
  const TriangleMesh rooms = test::twoRooms();
  const double sill = 0.5 * 0.1 * 0.9;    // half of that in the door
  for (const double tilt : {0.0, 0.02}) { // radians: what drawPlan() makes level
    const Eigen::AngleAxisd turn(tilt, Eigen::Vector3d(1, 2, 0).normalized());
    TriangleMesh mesh = rooms;
    mesh.vertices = (turn.toRotationMatrix() * mesh.vertices.cast<double>()).cast<float>();
    mesh.origin = {500000, -4000000, 100};
    const FloorPlan plan = drawPlan(mesh);
    ASSERT_EQ(plan.rooms.size(), 2u);
    for (const int number : {1, 2}) { // the larger one is the first
      const TriangleMesh room = cropMesh(mesh, regionOfRoom(plan, {number}));
      EXPECT_NEAR(surfaceArea(room), areaOfRoom(rooms, number == 1) + sill, 0.005) << number << ", tilt " << tilt;
      ASSERT_EQ(drawPlan(room).rooms.size(), 1u);
      EXPECT_NEAR(drawPlan(room).rooms[0].area, plan.rooms[number - 1].area, 0.02);
    }
  }
}

TEST(Crop, TheMarginOfARoomGrowsItsOutlineAndShrinksItsColumns)
{
  FloorPlan plan;
  PlanRoom room;
  const auto closed = [](const Eigen::Matrix2Xd& line) {
    Polyline polyline(2, line.cols() + 1);
    polyline << line, line.col(0);
    return polyline;
  };
  room.outline = closed(outline({{0, 0}, {4, 0}, {4, 3}, {0, 3}}));
  room.columns = {closed(outline({{1, 1}, {1, 2}, {2, 2}, {2, 1}}))};
  plan.rooms = {room};
  for (const double margin : {0.0, 0.1, 0.45}) {
    const CropRegion region = regionOfRoom(plan, {1, margin});
    ASSERT_EQ(region.outlines.size(), 2u);
    EXPECT_NEAR(areaOf(region.outlines[0]), (4 + 2 * margin) * (3 + 2 * margin), 1e-6);
    EXPECT_NEAR(areaOf(region.outlines[1]), std::pow(1 - 2 * margin, 2), 1e-6);
    EXPECT_NO_THROW(validateCropRegion(region));
  }
  EXPECT_EQ(regionOfRoom(plan, {1, 0.6}).outlines.size(), 1u); // nothing of the column is left
  for (const RoomChoice& bad : {RoomChoice{0}, RoomChoice{2}, RoomChoice{1, -0.1}, RoomChoice{1, NAN}})
    EXPECT_THROW(regionOfRoom(plan, bad), std::invalid_argument);
}
} // namespace
