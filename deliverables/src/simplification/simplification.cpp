// SPDX-License-Identifier: BSD-3-Clause
#include "kept_faces.h"
#include "simplification/corner_table.h"
#include "simplification/fixed_vertices.h"
#include "simplification/quadric.h"
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/deliverables/core/simplification.h>
#include <limits>
#include <queue>
#include <unordered_map>
namespace fresco {
using namespace deliverables;
namespace {
using Eigen::Vector3d;

void validate(const TexturedMesh& model, const SimplificationOptions& options)
{
  require(options.faces >= 0, "simplification: ", options.faces, " faces");
  require(options.error >= 0, "simplification: an error of ", options.error);
  require(options.faces > 0 || options.error > 0, "simplification: neither a number of faces nor an error");
  validateMesh(model.mesh);
  require(model.texcoord_faces.cols() == 0 || (model.texcoord_faces.cols() == model.mesh.faceCount() &&
                                               model.face_atlas.size() == model.mesh.faceCount()),
          "simplification: faces without texture coordinates or atlas");
  for (const int texcoord : model.texcoord_faces.reshaped())
    require(texcoord >= -1 && texcoord < model.texcoords.cols(), "simplification: a face names texture coordinate ",
            texcoord, ", there are ", model.texcoords.cols());
}

/// Gives each vertex texture coordinates of its own, each value once.
void separateTexcoords(TexturedMesh& model)
{
  struct Owned {
    int vertex;
    float u, v;
    bool operator==(const Owned& other) const { return vertex == other.vertex && u == other.u && v == other.v; }
  };
  struct Hash {
    std::size_t operator()(const Owned& at) const
    {
      return (std::hash<float>()(at.u) * 31 + std::hash<float>()(at.v)) * 31 + at.vertex;
    }
  };
  std::unordered_map<Owned, int, Hash> number;
  std::vector<Eigen::Vector2f> texcoords;
  for (Index f = 0; f < model.texcoord_faces.cols(); ++f)
    for (int k = 0; k < 3; ++k) {
      int& texcoord = model.texcoord_faces(k, f);
      if (texcoord < 0)
        continue;
      const Eigen::Vector2f at = model.texcoords.col(texcoord);
      const auto [entry, is_new] = number.try_emplace({model.mesh.faces(k, f), at.x(), at.y()}, texcoords.size());
      if (is_new)
        texcoords.push_back(at);
      texcoord = entry->second;
    }
  model.texcoords =
      Eigen::Map<Eigen::Matrix2Xf>(texcoords.empty() ? nullptr : texcoords[0].data(), 2, texcoords.size());
}

/// What a collapse would do.
struct Collapse {
  int from = -1, to = -1;
  Vector3d place = Vector3d::Zero();
  double share = 0; ///< of the way from `from` to `to`
  double cost = std::numeric_limits<double>::infinity();
};

class Simplifier {
public:
  /// @param fixed V: vertices that stay; or none
  Simplifier(TexturedMesh& model, const SimplificationOptions& options, const std::vector<bool>& fixed)
      : model_(model), mesh_(model.mesh), options_(options), table_(model), places_(mesh_.vertices.cast<double>()),
        quadrics_(mesh_.vertexCount()), version_(mesh_.vertexCount(), 0)
  {
    middle_ = 0.5 * (places_.rowwise().minCoeff() + places_.rowwise().maxCoeff());
    places_.colwise() -= middle_; // so that products of coordinates keep their digits
    for (std::size_t v = 0; v < fixed.size(); ++v)
      if (fixed[v])
        table_.fix(v);
    for (Index f = 0; f < mesh_.faceCount(); ++f)
      if (table_.isAlive(f))
        addPlanes(f);
  }

  SimplificationFigures run(const Progress& progress)
  {
    const Index first = table_.faces();
    // What could not collapse may do so when its surroundings have: one more round as long as that gains a hundredth.
    for (Index before = 2 * first; !isEnough() && 100 * (before - table_.faces()) >= before;) {
      before = table_.faces();
      seed();
      while (!isEnough() && !queue_.empty()) {
        const Entry next = queue_.top();
        queue_.pop();
        if (next.version != version_[next.from] + version_[next.to])
          continue;
        step(next);
        if (table_.faces() % 4096 < 2)
          report(progress, "collapsing edges",
                 1.0 * (first - table_.faces()) / std::max<Index>(1, first - options_.faces));
      }
      queue_ = {};
    }
    figures_.exhausted = !isEnough() && options_.faces > 0;
    for (Index v = 0; v < places_.cols(); ++v)
      mesh_.vertices.col(v) = (places_.col(v) + middle_).cast<float>();
    return figures_;
  }

private:
  struct Entry {
    float cost;
    int from, to;
    std::uint32_t version; ///< sum of those of its ends, which only grow
    bool operator<(const Entry& other) const
    {
      return std::tie(cost, from, to) > std::tie(other.cost, other.from, other.to); // least cost first
    }
  };

  bool isEnough() const { return options_.faces > 0 && table_.faces() <= options_.faces; }
  Vector3d corner(int face, int k) const { return places_.col(mesh_.faces(k, face)); }

  void addPlanes(int face)
  {
    constexpr double curve_weight = 3; // a border that moves shows more than a face that does
    const Vector3d normal = areaVector(corner(face, 0), corner(face, 1), corner(face, 2));
    const double area = 0.5 * normal.norm();
    if (!(area > 0))
      return;
    for (int k = 0; k < 3; ++k) {
      const int from = mesh_.faces(k, face), to = mesh_.faces((k + 1) % 3, face);
      quadrics_[from].addPlane(normal / (2 * area), places_.col(from), area / 3);
      if (table_.freedom(from) == Freedom::surface || table_.freedom(to) == Freedom::surface ||
          !table_.isCurve(table_.edge(from, to)))
        continue;
      const Vector3d along = places_.col(to) - places_.col(from);
      for (const int end : {from, to})
        quadrics_[end].addPlane(along.cross(normal).normalized(), places_.col(end),
                                0.5 * curve_weight * along.squaredNorm());
    }
  }

  void seed()
  {
    std::vector<Entry> entries;
    for (Index v = 0; v < places_.cols(); ++v)
      for (const int other : table_.neighbors(v))
        if (other > v)
          entries.push_back({0, int(v), other, version_[v] + version_[other]});
    parallelFor(entries.size(), options_.threads,
                [&](Index i) { entries[i].cost = evaluate(entries[i].from, entries[i].to).cost; });
    entries.erase(std::remove_if(entries.begin(), entries.end(), [](const Entry& e) { return !std::isfinite(e.cost); }),
                  entries.end());
    queue_ = std::priority_queue<Entry>({}, std::move(entries));
  }

  /// With infinite cost where the edge must not collapse, whatever is around it.
  Collapse evaluate(int a, int b) const
  {
    Collapse collapse;
    if (table_.freedom(a) > table_.freedom(b) || (table_.freedom(a) == table_.freedom(b) && a > b))
      std::swap(a, b); // the less free one stays
    const Freedom from = table_.freedom(a), to = table_.freedom(b);
    if (from == Freedom::none || (from == Freedom::curve && !table_.isCurve(table_.edge(a, b))))
      return collapse;
    collapse.from = a;
    collapse.to = b;
    Quadric sum = quadrics_[a];
    sum += quadrics_[b];
    const Vector3d start = places_.col(a), end = places_.col(b);
    collapse.share = from == to ? sum.leastBetween(start, end) : 1;
    collapse.place = start + collapse.share * (end - start);
    if (to == Freedom::surface) {
      const Vector3d best = sum.leastNear(collapse.place);
      if ((best - collapse.place).squaredNorm() <= (end - start).squaredNorm())
        collapse.place = best;
    }
    const double cost = sum.at(collapse.place);
    if (options_.error == 0 || cost <= options_.error * options_.error * sum.weight())
      collapse.cost = cost;
    return collapse;
  }

  void step(const Entry& entry)
  {
    const Collapse collapse = evaluate(entry.from, entry.to);
    const CornerTable::EdgeFaces at = table_.edge(collapse.from, collapse.to);
    if (!table_.mayCollapse(collapse.from, collapse.to, at) || !keepsFaces(collapse.from, collapse, at) ||
        !keepsFaces(collapse.to, collapse, at) || !keepsTexture(collapse, at))
      return;
    mergeAttributes(collapse);
    table_.collapse(collapse.from, collapse.to, collapse.share);
    quadrics_[collapse.to] += quadrics_[collapse.from];
    places_.col(collapse.to) = collapse.place;
    ++version_[collapse.from];
    const std::uint32_t own = ++version_[collapse.to];
    figures_.error =
        std::max(figures_.error, std::sqrt(collapse.cost / std::max(quadrics_[collapse.to].weight(), 1e-300)));
    for (const int other : table_.neighbors(collapse.to))
      if (const Collapse next = evaluate(collapse.to, other); std::isfinite(next.cost))
        queue_.push({float(next.cost), next.from, next.to, own + version_[other]});
  }

  /// Whether no face around `vertex` turns or becomes a sliver when it moves.
  bool keepsFaces(int vertex, const Collapse& collapse, const CornerTable::EdgeFaces& at) const
  {
    constexpr double least_cosine = 0.26; // 75 degrees
    constexpr double least_shape = 0.02;  // of 4 sqrt(3) area / sum of squared sides, 1 = equilateral: 1 : 60
    bool keeps = true;
    table_.forFaces(vertex, [&](int face, int k) {
      if (!keeps || face == at.face[0] || face == at.face[1])
        return;
      const Vector3d b = corner(face, (k + 1) % 3), c = corner(face, (k + 2) % 3);
      const Vector3d before = areaVector(places_.col(vertex), b, c), after = areaVector(collapse.place, b, c);
      const double turned = before.dot(after), sizes = before.norm() * after.norm();
      keeps = turned > least_cosine * sizes || (before.isZero() && !after.isZero());
      if (keeps && shape(after, collapse.place, b, c) < least_shape)
        keeps = shape(after, collapse.place, b, c) >= shape(before, places_.col(vertex), b, c);
    });
    return keeps;
  }

  static double shape(const Vector3d& area, const Vector3d& a, const Vector3d& b, const Vector3d& c)
  {
    const double sides = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
    return 2 * std::sqrt(3.0) * area.norm() / std::max(sides, 1e-300);
  }

  /// Whether no face is mirrored in the texture.
  bool keepsTexture(const Collapse& collapse, const CornerTable::EdgeFaces& at) const
  {
    if (model_.texcoord_faces.cols() == 0)
      return true;
    const auto texcoord = [&](int corner) { return model_.texcoord_faces(corner % 3, corner / 3); };
    bool keeps = true;
    for (const int vertex : {collapse.from, collapse.to})
      table_.forFaces(vertex, [&](int face, int k) {
        const int own = model_.texcoord_faces(k, face);
        if (face == at.face[0] || face == at.face[1] || own < 0)
          return;
        for (int i = 0; i < std::min(at.count, 2); ++i) {
          const int from = texcoord(at.from[i]), to = texcoord(at.to[i]);
          if (from < 0 || to < 0 || own != (vertex == collapse.from ? from : to))
            continue;
          const Eigen::Vector2d a = model_.texcoords.col(from).cast<double>(),
                                b = model_.texcoords.col(to).cast<double>();
          const Eigen::Vector2d place = a + collapse.share * (b - a), old = model_.texcoords.col(own).cast<double>();
          keeps = keeps && mirrors(face, k, old) == mirrors(face, k, place);
          break;
        }
      });
    return keeps;
  }

  /// Sign of the area in the texture of a face with corner k at `place`: -1, 0 or 1.
  int mirrors(int face, int k, const Eigen::Vector2d& place) const
  {
    const Eigen::Vector2d u = model_.texcoords.col(model_.texcoord_faces((k + 1) % 3, face)).cast<double>() - place;
    const Eigen::Vector2d v = model_.texcoords.col(model_.texcoord_faces((k + 2) % 3, face)).cast<double>() - place;
    const double area = u.x() * v.y() - u.y() * v.x();
    return area > 0 ? 1 : area < 0 ? -1 : 0;
  }

  void mergeAttributes(const Collapse& collapse)
  {
    const auto [from, to, share] = std::tuple(collapse.from, collapse.to, float(collapse.share));
    if (mesh_.normals.cols() > 0) {
      const Eigen::Vector3f sum = (1 - share) * mesh_.normals.col(from) + share * mesh_.normals.col(to);
      if (sum.norm() > 1e-3f)
        mesh_.normals.col(to) = sum.normalized();
    }
    if (mesh_.colors.cols() > 0)
      mesh_.colors.col(to) =
          ((1 - share) * mesh_.colors.col(from).cast<float>() + share * mesh_.colors.col(to).cast<float>())
              .array()
              .round()
              .cast<std::uint8_t>();
    for (auto& [name, values] : mesh_.fields)
      values[to] += (1 - share) * (values[from] - values[to]);
  }

  TexturedMesh& model_;
  TriangleMesh& mesh_;
  const SimplificationOptions& options_;
  CornerTable table_;
  Eigen::Matrix3Xd places_; ///< relative to middle_
  Vector3d middle_;
  std::vector<Quadric> quadrics_;
  std::vector<std::uint32_t> version_;
  std::priority_queue<Entry> queue_;
  SimplificationFigures figures_;
};

TexturedMesh simplified(TexturedMesh model, const SimplificationOptions& options, const std::vector<bool>& fixed,
                        SimplificationFigures* figures, const Progress& progress = {})
{
  validate(model, options);
  if (model.texcoord_faces.cols() > 0)
    separateTexcoords(model);
  const SimplificationFigures found = Simplifier(model, options, fixed).run(progress);
  if (figures)
    *figures = found;
  std::vector<bool> keep(model.mesh.faceCount());
  for (std::size_t f = 0; f < keep.size(); ++f)
    keep[f] = model.mesh.faces(0, f) >= 0;
  keepFaces(keep, model);
  report(progress, "done", 1.0);
  return model;
}
} // namespace

TriangleMesh deliverables::simplifyBetween(const std::vector<bool>& fixed, TriangleMesh mesh,
                                           const SimplificationOptions& options, SimplificationFigures& figures)
{
  TexturedMesh model;
  model.mesh = std::move(mesh);
  return simplified(std::move(model), options, fixed, &figures).mesh;
}

TexturedMesh simplifyModel(TexturedMesh model, const SimplificationOptions& options, SimplificationFigures* figures,
                           const Progress& progress)
{
  return simplified(std::move(model), options, {}, figures, progress);
}

TriangleMesh simplifyMesh(TriangleMesh mesh, const SimplificationOptions& options, SimplificationFigures* figures,
                          const Progress& progress)
{
  TexturedMesh model;
  model.mesh = std::move(mesh);
  return simplifyModel(std::move(model), options, figures, progress).mesh;
}
} // namespace fresco
