// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.h"
#include "call.h"
#include <fresco/core/parallel.h>
#include <fresco/search/ray_scene.h>
#include <fresco/search/triangle_tree.h>
namespace fresco::python {
/// Answers of a mesh to questions about places.
struct MeshAnswers {
  Eigen::VectorXf distances;
  Eigen::VectorXi faces;
  Points points;
};

template <>
struct Fields<MeshAnswers> {
  static constexpr const char* name = "MeshAnswers";
  static constexpr const char* text = "What a mesh answers, a row per question.";
  template <typename Visitor>
  static void visit(Visitor&& visit)
  {
    visit("distances", &MeshAnswers::distances,
          "(N,), inf where nothing was found; of rays in lengths of the direction");
    visit("faces", &MeshAnswers::faces, "(N,), -1 where nothing was found");
    visit("points", &MeshAnswers::points,
          "(N, 3) on the surface, in the frame of the vertices; NaN where nothing was found");
  }
};

namespace {
MeshAnswers unanswered(Index count)
{
  MeshAnswers answers;
  answers.distances.setConstant(count, std::numeric_limits<float>::infinity());
  answers.faces.setConstant(count, -1);
  answers.points.setConstant(3, count, std::numeric_limits<float>::quiet_NaN());
  return answers;
}

MeshAnswers nearest(const TriangleMesh& mesh, const Points& queries, int threads)
{
  MeshAnswers answers = unanswered(queries.cols());
  const auto found = closestPoints(TriangleTree(mesh, threads), queries.cast<double>(), threads);
  for (Index i = 0; i < queries.cols(); ++i) {
    answers.distances[i] = static_cast<float>(found[i].distance);
    answers.faces[i] = static_cast<int>(found[i].face);
    answers.points.col(i) = found[i].point.cast<float>();
  }
  return answers;
}

MeshAnswers cast(const TriangleMesh& mesh, const Points& origins, const Points& directions, int threads)
{
  MeshAnswers answers = unanswered(origins.cols());
  const RayScene scene(mesh);
  parallelFor(origins.cols(), threads, [&](Index i) {
    const RayHit hit = scene.intersect({origins.col(i), directions.col(i)});
    if (hit.face < 0)
      return;
    answers.distances[i] = hit.distance;
    answers.faces[i] = hit.face;
    answers.points.col(i) = origins.col(i) + hit.distance * directions.col(i);
  });
  return answers;
}

/// A copy of rows of three.
Points finiteRows(const Call& call, const char* name)
{
  const Lent<Points> lent(call[name], name);
  Points rows = *lent;
  if (!rows.allFinite())
    throw py::value_error(concat(name, ": a row is not finite"));
  return rows;
}
} // namespace

void addQueries(const py::module_& module)
{
  addRecord<MeshAnswers>(module);
  addFunction(
      module,
      {"nearest_on_mesh",
       "",
       {{"mesh", "TriangleMesh"}, {"places", "ArrayLike"}, {"threads", "int", "0"}},
       "MeshAnswers",
       "The place of the surface that is closest to each of `places`, exactly: of several faces at one distance the "
       "one of "
       "the smallest index. `places` are (N, 3), finite, in the frame of the vertices (`mesh.origin` is not added).",
       false},
      [](const Call& call) {
        const auto mesh = lendMesh(call);
        const Points queries = finiteRows(call, "places");
        const int threads = call.value<int>("threads");
        return call.run([&](const Progress&) { return nearest(*mesh, queries, threads); });
      });
  addFunction(
      module,
      {"cast_rays",
       "",
       {{"mesh", "TriangleMesh"}, {"origins", "ArrayLike"}, {"directions", "ArrayLike"}, {"threads", "int", "0"}},
       "MeshAnswers",
       "The first face that each ray hits, by Embree in single precision. `origins` and `directions` are (N, 3), in "
       "the frame of the vertices (`mesh.origin` is not added); "
       "directions of any length but 0.",
       false},
      [](const Call& call) {
        const auto mesh = lendMesh(call);
        const Points origins = finiteRows(call, "origins"), directions = finiteRows(call, "directions");
        const int threads = call.value<int>("threads");
        if (origins.cols() != directions.cols())
          throw py::value_error(concat("origins: ", origins.cols(), ", directions: ", directions.cols()));
        if (directions.cols() > 0 && directions.colwise().squaredNorm().minCoeff() == 0)
          throw py::value_error("directions: one is zero");
        return call.run([&](const Progress&) { return cast(*mesh, origins, directions, threads); });
      });
}
} // namespace fresco::python
