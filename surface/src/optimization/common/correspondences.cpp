// SPDX-License-Identifier: BSD-3-Clause
#include "optimization/common/correspondences.h"
#include "optimization/common/face_shares.h"
#include <algorithm>
#include <fresco/core/parallel.h>
#include <fresco/search/closest_on_triangle.h>
#include <fresco/search/triangle_tree.h>
#include <numeric>
namespace fresco::optimization {
namespace {
using Eigen::Vector3d;

TriangleMesh workingMesh(const MeshGraph& graph, const Positions& x)
{
  TriangleMesh mesh;
  mesh.vertices = x.cast<float>();
  mesh.faces = graph.faces;
  return mesh;
}

struct SearchedMesh {
  const MeshGraph& graph;
  const Positions& x;
  const TriangleTree& tree;
};

// Queries whose answer looks the wrong way are repeated from a place one edge length along their normal, which lies
// nearer to the side of a thin part that the point was seen on.
void repeatFromOutside(const SearchedMesh& mesh, const Eigen::Matrix3Xd& queries, const Points& normals,
                       std::vector<ClosestPoint>& found, double reach, int threads)
{
  parallelFor(queries.cols(), threads, [&](Index i) {
    ClosestPoint& answer = found[i];
    const Vector3d normal = normals.col(i).cast<double>();
    if (answer.face < 0 || !normal.allFinite() || areaVector(mesh.graph, mesh.x, answer.face).dot(normal) >= 0.0)
      return;
    answer = mesh.tree.closest(queries.col(i) + normal, reach);
    if (answer.face < 0 || areaVector(mesh.graph, mesh.x, answer.face).dot(normal) < 0.0)
      answer.face = -1;
  });
}

struct Assigned {
  std::vector<Index> columns; // of the input
  std::vector<int> faces;
  std::vector<int> votes; // DataPoints::votes
};

// Adds DataPoints::votes of points with these normals.
void addVotes(const SearchedMesh& mesh, const Points& normals, const std::vector<ClosestPoint>& found, double reach,
              std::vector<int>& votes)
{
  for (std::size_t i = 0; i < found.size(); ++i)
    if (const int f = found[i].face; f >= 0 && found[i].distance <= reach && normals.col(i).allFinite())
      votes[f] += areaVector(mesh.graph, mesh.x, f).dot(normals.col(i).cast<double>()) < 0.0 ? -1 : 1;
}

Assigned assignFaces(const MeshGraph& graph, const Positions& x, const PointSet& set, const WorkingFrame& frame,
                     double reach, int threads)
{
  constexpr Index block_size = 1 << 19; // queries at a time: some tens of MB of answers, work for every core
  const TriangleTree tree(workingMesh(graph, x), threads);
  Assigned assigned;
  assigned.votes.assign(graph.faceCount(), 0);
  std::vector<Index> columns;
  for (Index begin = 0; begin < set.size(); begin += block_size) {
    columns.clear();
    for (Index i = begin; i < std::min(set.size(), begin + block_size); ++i)
      if (set.points.col(i).allFinite() && set.points.col(i).cwiseAbs().maxCoeff() < 1e15f)
        columns.push_back(i);
    const Eigen::Matrix3Xd queries =
        (set.points(Eigen::all, columns).cast<double>().colwise() + (set.origin - frame.center)) / frame.unit;
    std::vector<ClosestPoint> found = closestPoints(tree, queries, threads);
    if (set.hasNormals()) {
      const Points normals = set.normals(Eigen::all, columns);
      addVotes({graph, x, tree}, normals, found, reach, assigned.votes);
      repeatFromOutside({graph, x, tree}, queries, normals, found, reach, threads);
    }
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (found[i].face >= 0 && found[i].distance <= reach && graph.face_edges(0, found[i].face) >= 0) {
        assigned.columns.push_back(columns[i]);
        assigned.faces.push_back(found[i].face);
      }
  }
  return assigned;
}

FacePoints sortedByFace(const std::vector<int>& faces, Index face_count)
{
  FacePoints lists;
  std::vector<int>& begin = lists.begin;
  begin.assign(face_count + 1, 0);
  for (const int f : faces)
    ++begin[f + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<int> next(begin.begin(), begin.end() - 1);
  lists.order.resize(faces.size());
  int i = 0;
  for (const int f : faces)
    lists.order[next[f]++] = i++;
  return lists;
}

// Where on its triangle the closest point lies: inside (feature 0), on edge `corner` (1) or on the corner itself (2).
struct ClosestFeature {
  int feature, corner;
};

ClosestFeature featureOf(const Vector3d& foot)
{
  constexpr double rim = 1e-9; // of barycentric coordinates: some bits above their rounding
  for (int k = 0; k < 3; ++k)
    if (foot[k] >= 1.0 - rim)
      return {2, k};
  for (int k = 0; k < 3; ++k)
    if (foot[k] <= rim)
      return {1, (k + 1) % 3}; // the edge that joins the two other corners starts at the next one
  return {0, 0};
}

class Walk {
public:
  Walk(const MeshGraph& graph, const Positions& x, const Vector3d& point, const Vector3d& normal)
      : graph_(graph), x_(x), point_(point), normal_(normal)
  {}

  int from(int face)
  {
    face_ = face;
    foot_ = footOn(graph_, x_, face, point_);
    squared_ = offsetFrom(graph_, x_, face, foot_, point_).squaredNorm();
    constexpr int longest_walk = 16; // faces; a step moves the mesh by less than 16 edges
    for (int step = 0; step < longest_walk; ++step) {
      const int last = face_;
      const auto [feature, corner] = featureOf(foot_);
      if (feature == 1)
        consider(graph_.across(face_, corner));
      else if (feature == 2)
        for (const int f : facesAround(graph_, graph_.faces(corner, face_)))
          consider(f);
      if (face_ == last)
        break;
    }
    return face_;
  }

private:
  void consider(int face)
  {
    if (face < 0 || face == face_)
      return;
    const Vector3d foot = footOn(graph_, x_, face, point_);
    const double squared = offsetFrom(graph_, x_, face, foot, point_).squaredNorm();
    if (squared < squared_ && areaVector(graph_, x_, face).dot(normal_) >= 0.0) {
      face_ = face;
      foot_ = foot;
      squared_ = squared;
    }
  }

  const MeshGraph& graph_;
  const Positions& x_;
  const Vector3d point_, normal_;
  int face_ = -1;
  Vector3d foot_;
  double squared_ = 0;
};

Vector3d normalOf(const DataPoints& data, Index i)
{
  return data.hasNormals() ? data.normals.col(i).cast<double>().eval() : Vector3d::Zero().eval();
}
} // namespace

DataPoints findCorrespondences(const MeshGraph& graph, const Positions& x, const PointSet& set,
                               const WorkingFrame& frame, double reach, int threads)
{
  Assigned assigned = assignFaces(graph, x, set, frame, reach, threads);
  const auto place = [&](Index column) -> Vector3d {
    return (set.points.col(column).cast<double>() + set.origin - frame.center) / frame.unit;
  };
  const auto normal = [&](Index column) -> Eigen::Vector3f {
    return set.hasNormals() && set.normals.col(column).allFinite() ? set.normals.col(column).stableNormalized()
                                                                   : Eigen::Vector3f::Zero();
  };
  const FacePrisms prisms(graph, x, threads);
  parallelRanges(assigned.columns.size(), threads, [&](Index first, Index end) { // of faces alike, always the same
    Sharing sharing(graph, x, prisms);
    for (Index i = first; i < end; ++i) {
      const Index column = assigned.columns[i];
      sharing.shares(assigned.faces[i], place(column), normal(column).cast<double>());
      assigned.faces[i] = sharing.most();
    }
  });
  const std::vector<int> order = sortedByFace(assigned.faces, graph.faceCount()).order;
  DataPoints data;
  const Index count = order.size();
  data.left_out = set.size() - count;
  data.votes = std::move(assigned.votes);
  data.points.resize(3, count);
  data.normals.resize(3, set.hasNormals() ? count : 0);
  data.face.resize(count);
  parallelFor(count, threads, [&](Index i) {
    const Index column = assigned.columns[order[i]];
    data.face[i] = assigned.faces[order[i]];
    data.points.col(i) = place(column).cast<float>();
    if (set.hasNormals())
      data.normals.col(i) = normal(column);
  });
  return data;
}

void followFaces(const MeshGraph& graph, const Positions& x, DataPoints& data, int threads)
{
  parallelFor(data.size(), threads, [&](Index i) {
    Walk walk(graph, x, data.points.col(i).cast<double>(), normalOf(data, i));
    data.face[i] = walk.from(data.face[i]);
  });
}

FacePoints pointsOfFaces(const DataPoints& data, Index faces)
{
  FacePoints lists = sortedByFace(data.face, faces);
  lists.share.assign(lists.order.size(), 1.f);
  return lists;
}

FacePoints sharePoints(const MeshGraph& graph, const Positions& x, DataPoints& data, int threads)
{
  constexpr Index block = 4096; // data that a thread takes at a time
  struct Entry {
    int point, face;
    float share;
  };
  const FacePrisms prisms(graph, x, threads);
  std::vector<std::vector<Entry>> parts((data.size() + block - 1) / block);
  parallelRanges(
      data.size(), threads,
      [&](Index begin, Index end) {
        Sharing sharing(graph, x, prisms);
        std::vector<Entry>& part = parts[begin / block];
        for (Index i = begin; i < end; ++i) {
          for (const FaceShare& s : sharing.shares(data.face[i], data.points.col(i).cast<double>(), normalOf(data, i)))
            part.push_back({static_cast<int>(i), s.face, s.share});
          data.face[i] = sharing.most();
        }
      },
      block);
  FacePoints lists;
  lists.begin.assign(graph.faceCount() + 1, 0);
  for (const auto& part : parts)
    for (const Entry& entry : part)
      ++lists.begin[entry.face + 1];
  std::partial_sum(lists.begin.begin(), lists.begin.end(), lists.begin.begin());
  lists.order.resize(lists.begin.back());
  lists.share.resize(lists.begin.back());
  std::vector<int> next(lists.begin.begin(), lists.begin.end() - 1);
  for (const auto& part : parts)
    for (const Entry& entry : part) {
      const int at = next[entry.face]++;
      lists.order[at] = entry.point;
      lists.share[at] = entry.share;
    }
  return lists;
}

Vector3d offsetFrom(const MeshGraph& graph, const Positions& x, Index f, const Vector3d& foot, const Vector3d& p)
{
  Vector3d offset = p;
  for (int k = 0; k < 3; ++k)
    offset -= foot[k] * x.col(graph.faces(k, f));
  return offset;
}

Vector3d footOn(const MeshGraph& graph, const Positions& x, Index f, const Vector3d& p)
{
  const Vector3d a = x.col(graph.faces(0, f)), b = x.col(graph.faces(1, f)), c = x.col(graph.faces(2, f));
  const Vector3d normal = (b - a).cross(c - a);
  const double squared = normal.squaredNorm();
  const auto onEdge = [&](const Vector3d& from, const Vector3d& to) {
    const double length2 = (to - from).squaredNorm();
    return length2 > 0.0 ? std::clamp((p - from).dot(to - from) / length2, 0.0, 1.0) : 0.0;
  };
  if (squared > 1e-20) {
    const double u = normal.dot((c - b).cross(p - b)) / squared, v = normal.dot((a - c).cross(p - c)) / squared,
                 w = 1.0 - u - v;
    if (u >= 0.0 && v >= 0.0 && w >= 0.0)
      return {u, v, w};
  }
  const double t_ab = onEdge(a, b), t_bc = onEdge(b, c), t_ca = onEdge(c, a);
  const double d_ab = (a + t_ab * (b - a) - p).squaredNorm(), d_bc = (b + t_bc * (c - b) - p).squaredNorm(),
               d_ca = (c + t_ca * (a - c) - p).squaredNorm();
  if (d_ab <= d_bc && d_ab <= d_ca)
    return {1.0 - t_ab, t_ab, 0.0};
  if (d_bc <= d_ca)
    return {0.0, 1.0 - t_bc, t_bc};
  return {t_ca, 0.0, 1.0 - t_ca};
}
} // namespace fresco::optimization
