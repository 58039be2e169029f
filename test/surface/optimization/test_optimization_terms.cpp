// SPDX-License-Identifier: BSD-3-Clause
// The parts of the optimiser: correspondences, solver, inverted faces, flips.
#include "common/shapes.h"
#include "optimization/common/inversion_guard.h"
#include "optimization/normal_filtering/edge_flips.h"
#include "optimization/normal_filtering/vertex_energy.h"
#include "optimization/normal_filtering/vertex_solver.h"
#include "surface/optimization/optimization_shapes.h"
#include <gtest/gtest.h>
using namespace fresco::optimization;
namespace fresco {
namespace {
OptimizationProblem problemOf(const TriangleMesh& mesh, const PointSet& points)
{
  OptimizationProblem problem;
  problem.graph = buildGraph(mesh.faces, mesh.vertexCount(), 1);
  problem.x = mesh.vertices.cast<double>();
  problem.frame.unit = meanEdgeLength(problem.graph, problem.x, 1);
  problem.x /= problem.frame.unit;
  problem.start = problem.x;
  problem.data = findCorrespondences(problem.graph, problem.x, points, problem.frame, 6, 1);
  problem.coverage =
      findCoverage(problem.graph, problem.x, problem.data, sharePoints(problem.graph, problem.x, problem.data, 1), 1);
  return problem;
}

Positions randomMove(Index vertices, double size, unsigned seed)
{
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, size);
  Positions move(3, vertices);
  for (Index i = 0; i < move.size(); ++i)
    move.data()[i] = normal(random);
  return move;
}

TEST(OptimizationTerms, FollowingFindsTheClosestFaceAgain)
{
  const PointSet points = [] {
    PointSet set;
    set.points = test::sphere(1.05f, 4).vertices;
    return set;
  }();
  const OptimizationProblem problem = problemOf(test::sphere(1.f, 3), points);
  const Positions moved = problem.x + randomMove(problem.x.cols(), 0.1, 2);
  DataPoints followed = problem.data;
  followFaces(problem.graph, moved, followed, 1);
  const auto distance = [&](Index i, int f) {
    const Eigen::Vector3d p = followed.points.col(i).cast<double>(), foot = footOn(problem.graph, moved, f, p);
    Eigen::Vector3d offset = -p;
    for (int k = 0; k < 3; ++k)
      offset += foot[k] * moved.col(problem.graph.faces(k, f));
    return offset.norm();
  };
  Index missed = 0;
  for (Index i = 0; i < followed.size(); ++i) {
    double best = 1e9;
    for (Index f = 0; f < problem.graph.faceCount(); ++f)
      best = std::min(best, distance(i, f));
    const double found = distance(i, followed.face[i]);
    missed += found > best + 1e-6 ? 1 : 0;
    EXPECT_LT(found, 1.3 * best + 0.1);
  }
  EXPECT_LT(missed, followed.size() / 10);
}

TEST(OptimizationTerms, SharesOfADatumAreOneAndChangeLittle)
{
  const PointSet points = test::cubePoints(3000, 0.02);
  OptimizationProblem problem = problemOf(test::roundedCube(8, 0.3), points);
  const auto sharesAt = [&](const Positions& x) {
    const FacePoints lists = sharePoints(problem.graph, x, problem.data, 1);
    Eigen::MatrixXf shares = Eigen::MatrixXf::Zero(problem.graph.faceCount(), problem.data.size());
    for (Index f = 0; f < problem.graph.faceCount(); ++f)
      for (int j = lists.begin[f]; j < lists.begin[f + 1]; ++j)
        shares(f, lists.order[j]) += lists.share[j];
    return shares;
  };
  const Eigen::MatrixXf before = sharesAt(problem.x);
  EXPECT_LT((before.colwise().sum().array() - 1.f).abs().maxCoeff(), 1e-5f);
  EXPECT_GT((before.array() > 0.f).count(), 1.02 * problem.data.size()) << "none is shared";
  const Eigen::MatrixXf after = sharesAt(problem.x + randomMove(problem.x.cols(), 1e-5, 3));
  EXPECT_LT((after - before).cwiseAbs().maxCoeff(), 1e-2f); // a whole one where faces are changed at once
}

TEST(OptimizationTerms, SolverReachesTheMinimum)
{
  OptimizationProblem problem = problemOf(test::roundedCube(6, 0.3), test::cubePoints(1000, 0.02));
  const FacePoints lists = sharePoints(problem.graph, problem.x, problem.data, 1);
  Eigen::Matrix3Xf normals = areaVectors(problem.graph, problem.x, 1).cast<float>();
  normals.colwise().normalize();
  TermWeights weights;
  weights.robust = 3;
  const QuadraticEnergy energy =
      makeEnergy(problem, lists, normals, dataResiduals(problem, lists, normals, 1), weights, 1);
  const Positions move = solveMoves(energy, problem.graph, problem.x, 1000, 1);
  const double least = evaluate(energy, problem.graph, problem.x, move, 1).sum();
  EXPECT_LT(least, evaluate(energy, problem.graph, problem.x, Positions::Zero(3, move.cols()), 1).sum());
  for (unsigned seed = 0; seed < 5; ++seed)
    EXPECT_GE(evaluate(energy, problem.graph, problem.x, move + randomMove(move.cols(), 1e-2, seed), 1).sum(), least);
}

TEST(OptimizationTerms, InvertedFacesAreRepaired)
{
  const TriangleMesh mesh = test::sphere(1.f, 3);
  const MeshGraph graph = buildGraph(mesh.faces, mesh.vertexCount(), 1);
  const Positions start = mesh.vertices.cast<double>() / meanEdgeLength(graph, mesh.vertices.cast<double>(), 1);
  Positions x = start;
  const int neighbour = graph.otherVertex(*edgesAround(graph, 7).begin(), 7);
  x.col(7) += 3 * (x.col(neighbour) - x.col(7)); // beyond its ring: faces turn over
  const auto inversions = [&] {
    const std::vector<char> inverted = invertedFaces(graph, x, 1);
    return std::count(inverted.begin(), inverted.end(), char{1});
  };
  EXPECT_GT(inversions(), 0);
  repairInverted(graph, start, Eigen::VectorXf::Ones(x.cols()), x, 1);
  EXPECT_EQ(inversions(), 0);
}

TEST(OptimizationTerms, MovesThatInvertAreShortened)
{
  const TriangleMesh mesh = test::sphere(1.f, 3);
  const MeshGraph graph = buildGraph(mesh.faces, mesh.vertexCount(), 1);
  const Positions x = mesh.vertices.cast<double>() / meanEdgeLength(graph, mesh.vertices.cast<double>(), 1);
  Eigen::Matrix3Xf normals = areaVectors(graph, x, 1).cast<float>();
  normals.colwise().normalize();
  Positions move = randomMove(x.cols(), 0.7, 1);
  limitMoves(graph, x, normals, move, 1);
  const Eigen::Matrix3Xd after = areaVectors(graph, x + move, 1);
  for (Index f = 0; f < graph.faceCount(); ++f)
    EXPECT_GT(after.col(f).dot(normals.col(f).cast<double>()), 0.0);
}

// A roof whose ridge is crossed by the diagonal of two of its faces.
TEST(OptimizationTerms, FlipsFollowTheCrease)
{
  TriangleMesh mesh;
  std::vector<Eigen::Vector3i> faces;
  const int n = 8;
  mesh.vertices.resize(3, (n + 1) * (n + 1));
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) // a grid turned so that its ridge x = y runs along the wrong diagonal
      mesh.vertices.col(i * (n + 1) + j) = Eigen::Vector3i(i, j, -std::abs(i - j)).cast<float>();
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j, b = a + n + 1;
      faces.emplace_back(a, b, a + 1);
      faces.emplace_back(b, b + 1, a + 1);
    }
  mesh.faces.resize(3, faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f)
    mesh.faces.col(f) = faces[f];
  PointSet points;
  points.points = mesh.vertices;
  OptimizationProblem problem = problemOf(mesh, points);
  const auto bending = [&] {
    const Eigen::Matrix3Xd areas = areaVectors(problem.graph, problem.x, 1);
    double sum = 0;
    for (const auto& [f, g] : problem.graph.edge_faces)
      if (g >= 0)
        sum += std::acos(std::min(1.0, areas.col(f).normalized().dot(areas.col(g).normalized())));
    return sum;
  };
  const double before = bending();
  Index flips = 0;
  for (Index found = 1; found > 0; flips += found)
    found = flipEdges(problem, 0.0, 1);
  EXPECT_GT(flips, 4);
  EXPECT_LT(bending(), 0.6 * before);
  TriangleMesh flipped = mesh;
  flipped.faces = problem.graph.faces;
  const MeshTopology topology = meshTopology(flipped);
  EXPECT_EQ(topology.nonmanifold_edges, 0);
  EXPECT_EQ(topology.inconsistent_edges, 0);
  EXPECT_EQ(topology.boundary_edges, 4 * n);
}
} // namespace
} // namespace fresco
