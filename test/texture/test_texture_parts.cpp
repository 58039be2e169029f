// SPDX-License-Identifier: BSD-3-Clause
#include "texture/texture_scene.h"
#include "views/visible_surface.h"
#include <gtest/gtest.h>
using namespace fresco::texture;
namespace fresco::test {
namespace {
/// A floor of patches as long as a tenth of it, and a board that hides another part of it from each of two cameras.
struct BoardScene {
  TriangleMesh mesh;
  std::vector<TextureView> views;
  std::vector<Projector> projectors;
  PatchMesh patches;

  BoardScene()
  {
    appendBox({-1, -1, -0.2f}, {1, 1, 0}, false, mesh);
    appendBox({-0.43f, -0.37f, 0.3f}, {0.41f, 0.39f, 0.35f}, false, mesh);
    for (const double x : {-0.8, 0.8}) {
      const CameraModel model = camera(400, 400, 480);
      const Eigen::Isometry3d T = lookAt({x, 0.1, 3}, {0, 0, 0});
      views.push_back({model, T, Image(400, 400), "", true, false, Image(), ""});
      projectors.emplace_back(model, T, mesh.origin);
    }
    patches = cutFaces(mesh, 0.2f, 1);
  }

  PatchMesh cut(int threads, std::vector<char> used = {1, 1}) const
  {
    const std::vector<ViewPart> whole = partsOf(views);
    PhotoStore photos(whole, 1 << 24);
    TextureOptions options;
    options.threads = threads;
    const RayScene scene(mesh);
    const ViewList list{projectors, photos, std::move(used), {0, 1}, 0.2, {}, {}};
    return cutHiddenParts(patches, {&scene, list, options}, coarseMaps({&scene, list, options}));
  }

  Candidates candidates(const PatchMesh& parts) const
  {
    const std::vector<ViewPart> whole = partsOf(views);
    PhotoStore photos(whole, 1 << 24);
    const RayScene scene(mesh);
    return findCandidates(parts, {&scene, {projectors, photos, {1, 1}, {0, 1}, 0.2, {}, {}}, TextureOptions{}},
                          Progress{});
  }

  bool isSeen(const Eigen::Vector3d& p) const
  {
    return std::any_of(views.begin(), views.end(), [&](const TextureView& view) {
      const Eigen::Vector3d eye = view.T_camera_world.inverse().translation();
      return hitDistance(mesh, eye, p - eye) > 1 - 1e-6;
    });
  }
};

double area(const PatchMesh& patches) { return patches.areas.cast<double>().sum(); }

/// Share of the floor's top whose place some camera sees though its patch has no view.
double wronglyUnseen(const BoardScene& scene, const PatchMesh& patches)
{
  const Candidates candidates = scene.candidates(patches);
  double wrong = 0, all = 0;
  for (Index i = 0; i < patches.size(); ++i) {
    if (patches.parent[i] >= 12 || patches.normals(2, i) < 0.9f)
      continue;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k)
      middle += patches.vertices.col(patches.faces(k, i)).cast<double>() / 3;
    for (int k = 0; k < 4; ++k) { // a quarter of the area each
      Eigen::Vector3d p = middle;
      if (k < 3)
        p = 0.5 * (middle + patches.vertices.col(patches.faces(k, i)).cast<double>());
      all += patches.areas[i] / 4;
      wrong += candidates.count(i) == 0 && scene.isSeen(p) ? patches.areas[i] / 4 : 0;
    }
  }
  return wrong / all;
}
} // namespace

TEST(TextureParts, WhatIsSeenBesideAnObstacleIsNotGivenUpWithWhatItHides)
{
  const BoardScene scene;
  const double before = wronglyUnseen(scene, scene.patches), after = wronglyUnseen(scene, scene.cut(1));
  EXPECT_GT(before, 0.03);
  EXPECT_LT(after, 0.4 * before); // patches along the shadow have a quarter of the side
}

TEST(TextureParts, CutsCoverTheSameSurfaceAndMeet)
{
  const BoardScene scene;
  const PatchMesh parts = scene.cut(1);
  EXPECT_GT(parts.size(), scene.patches.size());
  EXPECT_NEAR(area(parts), area(scene.patches), 1e-4 * area(scene.patches));
  EXPECT_GE(parts.neighbors.minCoeff(), 0); // boxes are closed
  for (Index i = 1; i < parts.size(); ++i)
    ASSERT_GE(parts.parent[i], parts.parent[i - 1]);
}

TEST(TextureParts, NothingIsCutWhereNothingIsHiddenInPart)
{
  const BoardScene scene;
  EXPECT_EQ(scene.cut(1, {0, 0}).size(), scene.patches.size()); // no view: all is unseen
}

TEST(TextureParts, ThreadsDoNotChangeThem)
{
  const BoardScene scene;
  const PatchMesh one = scene.cut(1), four = scene.cut(4);
  EXPECT_EQ(one.faces, four.faces);
  EXPECT_EQ(one.vertices, four.vertices);
}
} // namespace fresco::test
