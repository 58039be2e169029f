// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/isosurface/isosurface.h"
#include "poisson/isosurface/polygon.h"
#include "poisson/octree/radix_sort.h"
#include "poisson/solver/screening.h"
#include "poisson/solver/transfer.h"
#include <algorithm>
#include <fresco/core/mesh.h>
#include <fresco/core/morton.h>
#include <gtest/gtest.h>
#include <random>
#include <set>
using namespace fresco::poisson;
namespace fresco::poisson {
namespace {
TEST(VolumetricParts, MortonCodesRoundTrip)
{
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    const std::uint32_t x = random() & 0x1fffff, y = random() & 0x1fffff, z = random() & 0x1fffff;
    const std::array<int, 3> cell = mortonCell(mortonCode(x, y, z));
    EXPECT_EQ(cell, (std::array<int, 3>{static_cast<int>(x), static_cast<int>(y), static_cast<int>(z)}));
  }
}

TEST(VolumetricParts, RadixSortIsStable)
{
  std::mt19937_64 random(2);
  Array<std::uint64_t> items(100000);
  for (std::uint64_t i = 0; i < items.size(); ++i)
    items[i] = (random() & 0x3fffff) << 20 | i;
  Array<std::uint64_t> expected = items;
  std::stable_sort(expected.begin(), expected.end(),
                   [](std::uint64_t a, std::uint64_t b) { return a >> 20 < b >> 20; });
  sortBits(items, 20, 22, 3);
  EXPECT_EQ(items, expected);
}

TEST(VolumetricParts, InterpolationIsExactForLinearFunctionsAndRestrictionItsTranspose)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (int octant = 0; octant < 8; ++octant) {
    float parent[125], child[125], back[125] = {}, weights[125];
    const auto f = [](float x, float y, float z) { return 1 + 2 * x - 3 * y + 0.5f * z; };
    for (int i = 0; i < 125; ++i)
      parent[i] = f(static_cast<float>(i % 5), static_cast<float>(i / 5 % 5), static_cast<float>(i / 25));
    interpolateToChild(parent, octant, child);
    for (int i = 0; i < 125; ++i)
      EXPECT_NEAR(child[i],
                  f(static_cast<float>((octant & 1) * 2) + 0.5f * static_cast<float>(i % 5),
                    static_cast<float>((octant >> 1 & 1) * 2) + 0.5f * static_cast<float>(i / 5 % 5),
                    static_cast<float>((octant >> 2) * 2) + 0.5f * static_cast<float>(i / 25)),
                  1e-5f);
    double a = 0, b = 0;
    for (int i = 0; i < 125; ++i) {
      weights[i] = unit(random);
      a += weights[i] * child[i];
    }
    restrictToParent(weights, octant, 1.f, back);
    for (int i = 0; i < 125; ++i)
      b += back[i] * parent[i];
    EXPECT_NEAR(a, b, 1e-3);
  }
}

TEST(VolumetricParts, SamplesHoldHarderTheDenserTheyAreAndNoneTheNoisierTheyAre)
{
  EXPECT_EQ(softnessOf(-1.f, 0.f), 1.f);
  EXPECT_EQ(softnessOf(3.f, 0.1f), 1.f);
  for (float surplus = -2.f; surplus < 3.f; surplus += 0.25f)
    for (float noise = 0.f; noise < 0.2f; noise += 0.01f) {
      EXPECT_LE(softnessOf(surplus + 0.25f, noise), softnessOf(surplus, noise));
      EXPECT_GE(softnessOf(surplus, noise + 0.01f), softnessOf(surplus, noise));
      const float weight = screeningWeight(noise, softnessOf(surplus, noise));
      EXPECT_GE(weight, screeningWeight(noise));
      EXPECT_GE(weight, screeningWeight(noise + 0.01f, softnessOf(surplus, noise + 0.01f)));
    }
}

/// Entries of the matrix by which point_weight enters the system: weight B_j(p) B_k(p).
TEST(VolumetricParts, ScreeningAddsProductsOfHatFunctions)
{
  const HatWeights hat(Eigen::Vector3f(1.25f, 2.5f, 0.75f));
  MatrixRows rows = {};
  addScreening(hat, 3.f, rows);
  float sum = 0;
  for (int j = 0; j < 8; ++j)
    for (int k = 0; k < 8; ++k) {
      const int offset = offsetIndex((k & 1) - (j & 1), (k >> 1 & 1) - (j >> 1 & 1), (k >> 2) - (j >> 2));
      const int own = ownIndex(hat.x + (j & 1), hat.y + (j >> 1 & 1), hat.z + (j >> 2));
      EXPECT_FLOAT_EQ(rows[offset][own], 3.f * hat.value[j] * hat.value[k]);
      sum += rows[offset][own];
    }
  EXPECT_FLOAT_EQ(sum, 3.f); // hat functions add up to 1
  MatrixRows none = {};
  addScreening(hat, 0.f, none);
  for (const auto& row : none)
    for (const float entry : row)
      EXPECT_EQ(entry, 0.f);
}

TEST(VolumetricParts, BothSidesOfAFaceSeeTheSameSegments)
{
  std::mt19937 random(4);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (int i = 0; i < 2000; ++i) {
    float chi[4], mirrored[4];
    for (int k = 0; k < 4; ++k)
      chi[k] = unit(random);
    for (int k = 0; k < 4; ++k)
      mirrored[k] = chi[3 - k]; // corner order of the cell beyond; its side k is side 2 - k here
    const FaceCrossings a = crossFace(chi), b = crossFace(mirrored);
    std::set<std::pair<int, int>> from_here, from_there;
    for (int s = 0; s < a.count; ++s)
      from_here.insert({a.from[s], a.to[s]});
    for (int s = 0; s < b.count; ++s)
      from_there.insert({(6 - b.to[s]) % 4, (6 - b.from[s]) % 4});
    EXPECT_EQ(from_here, from_there);
  }
}

/// A tree that refines octants at random, with jumps of any size between neighbours.
Octree randomTree(int depth, double probability, std::mt19937& random)
{
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<std::vector<std::uint64_t>> codes(static_cast<std::size_t>(depth) + 1);
  codes[2] = {0};
  for (int d = 3; d <= depth; ++d)
    for (const std::uint64_t parent : codes[static_cast<std::size_t>(d) - 1])
      for (std::uint64_t octant = 0; octant < 8; ++octant)
        if (d == 3 || unit(random) < probability)
          codes[d].push_back(parent << 3 | octant);
  return linkBricks(std::move(codes), 3, 1);
}

bool isFree(const Octree& tree, int depth, int brick, int x, int y, int z)
{
  for (int k = 0; k < 8; ++k)
    if (normalized(tree, {depth, brick, x - (k & 1), y - (k >> 1 & 1), z - (k >> 2)}).brick < 0)
      return false;
  return true;
}

/// Random values, continuous across leaves of different size, of one sign on the cube's boundary.
std::vector<NodeField> randomValues(const Octree& tree, std::mt19937& random)
{
  std::uniform_real_distribution<float> unit(-1, 1);
  std::vector<NodeField> chi(tree.levels.size());
  for (int d = tree.full_depth; d <= tree.depth; ++d) {
    const auto i = static_cast<std::size_t>(d);
    const BrickLevel& level = tree.levels[i];
    chi[i] = NodeField(level);
    if (d > tree.full_depth)
      interpolateLevel(tree, d, chi[i - 1], 1, [&](Index b, const float* nodes) { chi[i].store(level, b, nodes); });
    const std::vector<float> ones(125, 1.f);
    for (Index b = 0; b < level.size(); ++b) {
      if (d == tree.full_depth)
        chi[i].store(level, b, ones.data());
      for (int n = 0; n < own_nodes; ++n)
        if (isFree(tree, d, static_cast<int>(b), n & 3, n >> 2 & 3, n >> 4))
          chi[i].own(b)[n] = unit(random);
    }
  }
  return chi;
}

TEST(VolumetricParts, LevelSetIsClosedAndManifoldOnRandomTrees)
{
  std::mt19937 random(5);
  Index faces = 0;
  for (const int depth : {3, 4, 5, 6})
    for (const double probability : {0.2, 0.5, 0.8, 1.0}) {
      if (depth == 6 && probability > 0.7)
        continue;
      const Octree tree = randomTree(depth, probability, random);
      std::vector<NodeField> chi = randomValues(tree, random);
      const IsoSurface surface = extractIsoSurface(tree, std::move(chi), 0.05f, 2);
      TriangleMesh mesh;
      mesh.vertices = surface.vertices;
      mesh.faces = surface.faces;
      const MeshTopology topology = meshTopology(mesh);
      EXPECT_TRUE(topology.watertight) << depth << ' ' << probability << ": " << topology.boundary_edges
                                       << " boundary, " << topology.nonmanifold_edges << " non-manifold, "
                                       << topology.nonmanifold_vertices;
      EXPECT_EQ(topology.referenced_vertices, mesh.vertexCount());
      EXPECT_GT(signedVolume(mesh), 0);
      faces += mesh.faceCount();
    }
  EXPECT_GT(faces, 10000);
}
} // namespace
} // namespace fresco::poisson
