// SPDX-License-Identifier: BSD-3-Clause
#include "deliverables/plan_shapes.h"
#include "tools/tool_runs.h"
#include <nlohmann/json.hpp>
namespace {
using namespace fresco;
using namespace fresco::test;

std::string roomFolder()
{
  std::string folder = scratchFolder();
  RoomBuilder b;
  b.room({{0, 0}, {4, 0}, {4, 3}, {0, 3}}, 2.5);
  TriangleMesh mesh = b.mesh();
  mesh.colors = Colors::Constant(3, mesh.vertexCount(), 90);
  writeMesh(folder + "/room.ply", mesh);
  writePoints(folder + "/cloud.pcd", scanOf(mesh, 3000, 0.002));
  return folder;
}

TEST(PlanTool, WritesPlanTablesSectionsAndOrthophoto)
{
  const std::string folder = roomFolder();
  const Outcome outcome = run(folder, "plan room.ply plan.svg -ortho -pixel 0.02 -sections x 1.5");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(get(folder + "/plan.json"));
  EXPECT_NEAR(json["rooms"][0]["area"].get<double>(), 12, 1e-3);
  for (const char* name :
       {"plan.svg", "plan.csv", "plan_ortho.png", "plan_ortho.pgw", "plan_x+1.50.svg", "plan_x+3.00.svg"})
    EXPECT_TRUE(fs::exists(folder + "/" + name)) << name;
  EXPECT_EQ(readImage(folder + "/plan_ortho.png").width, 200);
  EXPECT_EQ(run(folder, "plan cloud.pcd plan.dxf -quiet").status, 0);
  EXPECT_EQ(run(folder, "plan room.ply plan.png -pixel 0.02 -quiet").status, 0);
  EXPECT_TRUE(fs::exists(folder + "/plan.pgw"));
}

TEST(PlanTool, SaysWhatIsWrongAndWritesNothing)
{
  const std::string folder = roomFolder();
  put(folder + "/empty.ply", "");
  const auto before = listing(folder);
  const auto refuses = [&](const std::string& arguments, int status, const std::string& words) {
    const Outcome outcome = run(folder, "plan " + arguments);
    EXPECT_EQ(outcome.status, status) << arguments;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
    EXPECT_EQ(listing(folder), before) << arguments;
  };
  refuses("room.ply plan.svg -quiet -height 9", 1, "from 0 to 2.5 m");
  refuses("room.ply plan.svg -height nan", 2, "height");
  refuses("room.ply plan.txt", 2, "plan.txt");
  refuses("room.ply plan.svg -sections w 1", 2, "w");
  refuses("room.ply plan.svg -sections x 0", 2, "STEP");
  refuses("room.ply plan.svg -tolerance 0", 2, "tolerance");
  refuses("cloud.pcd plan.svg -quiet -sections x 1", 1, "cloud.pcd");
  refuses("cloud.pcd plan.svg -quiet -ortho", 1, "no colours");
  refuses("empty.ply plan.svg -quiet", 1, "empty.ply");
  refuses("missing.ply plan.svg -quiet", 1, "missing.ply");
  refuses("room.ply nowhere/plan.svg -quiet", 1, "nowhere");
}
} // namespace
