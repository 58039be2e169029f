// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/picture_fixtures.h"
#include <gtest/gtest.h>
namespace fresco {
namespace {
using namespace test;

/// Two faces that show to the side of `towards`.
void addQuad(TriangleMesh& mesh, const std::array<int, 4>& corners, const Eigen::Vector3d& towards)
{
  for (const auto& [a, b] : {std::pair(1, 2), std::pair(2, 3)}) {
    mesh.faces.conservativeResize(3, mesh.faceCount() + 1);
    auto face = mesh.faces.rightCols<1>();
    face << corners[0], corners[a], corners[b];
    if (areaVector(mesh, mesh.faceCount() - 1).dot(towards) < 0)
      std::swap(face(1), face(2));
  }
}

/// A room of 4 x 4 x 2 with a shelf on the wall at x = 2, which sticks out by `depth`; below 0 a niche.
TriangleMesh roomWithShelf(float depth)
{
  TriangleMesh room;
  addBox(room, {-2, -2, -1}, {2, 2, 1}, true);
  room.faces.conservativeResize(3, 10); // without the wall at x = 2, whose corners are 1, 3, 7, 5
  room.vertices.conservativeResize(3, 16);
  int v = 8; // of the shelf on the wall 8 to 11, of its front 12 to 15
  for (const float x : {2.f, 2.f - depth})
    for (const auto& [y, z] :
         {std::pair(-0.6f, 0.f), std::pair(0.6f, 0.f), std::pair(0.6f, 0.1f), std::pair(-0.6f, 0.1f)})
      room.vertices.col(v++) << x, y, z;
  const std::array<int, 4> wall{1, 3, 7, 5};
  const std::array<Eigen::Vector3d, 4> sides{-Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY(),
                                             Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitY()};
  for (int k = 0; k < 4; ++k) {
    const int next = (k + 1) % 4;
    addQuad(room, {wall[k], wall[next], 8 + next, 8 + k}, -Eigen::Vector3d::UnitX());
    addQuad(room, {8 + k, 8 + next, 12 + next, 12 + k}, depth * sides[k]);
  }
  addQuad(room, {12, 13, 14, 15}, -Eigen::Vector3d::UnitX());
  return room;
}

TEST(CulledPicture, WhatHangsOnCulledWallsDoesNotFloat)
{
  PictureOptions options = optionsFor(Shading::Normals, 160, 120);
  options.view = from({9, 2, 8}, 30);
  options.cull_back_faces = true;
  const Image bare = renderPicture(roomWithShelf(0), options);
  for (const float depth : {0.5f, -0.5f})
    EXPECT_EQ(renderPicture(roomWithShelf(depth), options).data, bare.data) << depth;
  TriangleMesh furnished = roomWithShelf(0.5f);
  addBox(furnished, {-1, -0.5f, -1}, {0, 0.5f, -0.5f}, false);
  EXPECT_NE(renderPicture(furnished, options).data, bare.data) << "furniture stays";
  TriangleMesh far = roomWithShelf(0.5f); // on the wall that is looked at
  far.vertices.row(0) *= -1;
  far.faces.row(1).swap(far.faces.row(2));
  EXPECT_NE(renderPicture(far, options).data, bare.data);
}

TEST(CulledPicture, ClosedThingsStayAsTheyLook)
{
  for (const float depth : {0.5f, -0.5f}) { // a pocket, a knob
    TriangleMesh thing = roomWithShelf(depth);
    thing.faces.row(1).swap(thing.faces.row(2));
    for (const Eigen::Vector3d& eye :
         {Eigen::Vector3d(9, 2, 8), Eigen::Vector3d(-9, 2, 8), Eigen::Vector3d(3, 2, -8)}) {
      PictureOptions options = optionsFor(Shading::Normals, 160, 120);
      options.view = from(eye, 30);
      const Image whole = renderPicture(thing, options);
      options.cull_back_faces = true;
      const Image culled = renderPicture(thing, options);
      Index other = 0;
      for (std::size_t i = 0; i < whole.data.size(); ++i)
        other += culled.data[i] != whole.data[i];
      EXPECT_LE(other, 6) << depth << ": " << eye.transpose();
    }
  }
}
} // namespace
} // namespace fresco
