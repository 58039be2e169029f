// SPDX-License-Identifier: BSD-3-Clause
#include "kept_faces.h"
#include <cmath>
#include <fresco/core/require.h>
#include <fresco/deliverables/core/crop.h>
#include <map>
namespace fresco {
using namespace deliverables;
namespace {
/// Points of a plane: normal . point = offset.
struct Plane {
  Eigen::Vector3d normal;
  double offset;
};

/// A column that lies between two earlier ones.
struct Between {
  int from, to;
  float share; ///< of the way

  template <typename Columns>
  auto of(const Columns& columns) const
  {
    return ((1 - share) * columns.col(from).template cast<float>() + share * columns.col(to).template cast<float>())
        .eval();
  }
};

/// Splits faces along planes of the region's frame.
class Splitter {
public:
  Splitter(TexturedMesh& model, const Eigen::Isometry3d& T_region_mesh)
      : model_(model), T_region_mesh_(T_region_mesh), textured_(model.texcoord_faces.cols() > 0),
        vertices_(model.mesh.vertexCount()), texcoords_(model.texcoords.cols())
  {
    const TriangleMesh& mesh = model.mesh;
    for (Index v = 0; v < vertices_; ++v)
      places_.emplace_back(T_region_mesh * mesh.vertices.col(v).cast<double>());
    tolerance_ = 4e-7 * mesh.vertices.cwiseAbs().maxCoeff(); // what float keeps of a coordinate
    for (Index f = 0; f < mesh.faceCount(); ++f)
      faces_.push_back({mesh.faces.col(f), textured_ ? model.texcoord_faces.col(f).eval() : Eigen::Vector3i(-1, -1, -1),
                        textured_ ? model.face_atlas[f] : -1});
  }

  /// Splits the faces that reach into `box`, x y, and in their neighbours the edges that both share.
  void split(const Plane& plane, const Eigen::AlignedBox2d& box)
  {
    side_.resize(places_.size());
    for (std::size_t v = 0; v < places_.size(); ++v) {
      const double distance = plane.normal.dot(places_[v]) - plane.offset;
      side_[v] = std::abs(distance) <= tolerance_ ? 0 : distance;
    }
    new_vertices_.clear();
    new_texcoords_.clear();
    for (const Face& face : faces_)
      if (crosses(face) && box.intersects(boxOf(face)))
        for (int k = 0; k < 3; ++k)
          if (isCut(face, k))
            addVertex(face, k);
    for (std::size_t f = 0, before = faces_.size(); f < before && !new_vertices_.empty(); ++f)
      if (crosses(faces_[f]))
        splitFace(f);
  }

  /// Puts what was split into the model.
  void finish()
  {
    TriangleMesh& mesh = model_.mesh;
    const Index all = places_.size(), added = between_.size();
    for (Points* columns : {&mesh.vertices, &mesh.normals})
      if (columns->cols() > 0)
        columns->conservativeResize(3, all);
    if (mesh.colors.cols() > 0)
      mesh.colors.conservativeResize(3, all);
    for (auto& [name, values] : mesh.fields)
      values.conservativeResize(all);
    for (Index i = 0; i < added; ++i)
      fillVertex(vertices_ + i, between_[i]);
    model_.texcoords.conservativeResize(2, texcoords_ + texcoord_between_.size());
    for (std::size_t i = 0; i < texcoord_between_.size(); ++i)
      model_.texcoords.col(texcoords_ + i) = texcoord_between_[i].of(model_.texcoords);
    mesh.faces.resize(3, faces_.size());
    model_.texcoord_faces.resize(3, textured_ ? faces_.size() : 0);
    model_.face_atlas.resize(textured_ ? faces_.size() : 0);
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      mesh.faces.col(f) = faces_[f].vertices;
      if (textured_) {
        model_.texcoord_faces.col(f) = faces_[f].texcoords;
        model_.face_atlas[f] = faces_[f].atlas;
      }
    }
  }

private:
  struct Face {
    Eigen::Vector3i vertices, texcoords;
    int atlas;
  };

  bool isCut(const Face& face, int k) const { return side_[face.vertices[k]] * side_[face.vertices[(k + 1) % 3]] < 0; }
  bool crosses(const Face& face) const { return isCut(face, 0) || isCut(face, 1) || isCut(face, 2); }

  Eigen::AlignedBox2d boxOf(const Face& face) const
  {
    Eigen::AlignedBox2d box;
    for (const int v : face.vertices)
      box.extend(places_[v].head<2>());
    return box;
  }

  /// The ends of side k, the lower number first: both faces of an edge get the same vertex.
  static std::pair<int, int> ends(const Eigen::Vector3i& face, int k)
  {
    return std::minmax({face[k], face[(k + 1) % 3]});
  }

  double shareAt(int from, int to) const { return side_[from] / (side_[from] - side_[to]); }

  void addVertex(const Face& face, int k)
  {
    const auto [from, to] = ends(face.vertices, k);
    if (!new_vertices_.emplace(std::pair(from, to), places_.size()).second)
      return;
    const double share = shareAt(from, to);
    between_.push_back({from, to, float(share)});
    places_.emplace_back(places_[from] + share * (places_[to] - places_[from]));
  }

  /// @return -1: without texture
  int addTexcoord(const Face& face, int k)
  {
    if (face.texcoords[k] < 0)
      return -1;
    const auto [from, to] = ends(face.texcoords, k);
    const auto [entry, is_new] = new_texcoords_.emplace(std::pair(from, to), texcoords_ + texcoord_between_.size());
    if (is_new) {
      const double share = shareAt(face.vertices[k], face.vertices[(k + 1) % 3]);
      texcoord_between_.push_back({from, to, float(from == face.texcoords[k] ? share : 1 - share)});
    }
    return entry->second;
  }

  /// A plane cuts two sides of a face, of which one or both have a new vertex, or one side and the corner across.
  void splitFace(std::size_t number)
  {
    const Face face = faces_[number];
    int at[3] = {-1, -1, -1}, texcoord[3] = {-1, -1, -1}, first = -1, count = 0;
    for (int k = 0; k < 3; ++k)
      if (const auto found = new_vertices_.find(ends(face.vertices, k));
          isCut(face, k) && found != new_vertices_.end()) {
        at[k] = found->second;
        texcoord[k] = addTexcoord(face, k);
        first = first < 0 || (first == 0 && k == 2) ? k : first; // the second one follows it around the face
        ++count;
      }
    if (count == 0)
      return;
    const int k = first, next = (k + 1) % 3, last = (k + 2) % 3;
    const auto part = [&](std::array<int, 3> vertices, std::array<int, 3> texcoords) {
      return Face{Eigen::Vector3i(vertices.data()), Eigen::Vector3i(texcoords.data()), face.atlas};
    };
    const Eigen::Vector3i &v = face.vertices, &t = face.texcoords;
    if (count == 1) {
      faces_[number] = part({v[k], at[k], v[last]}, {t[k], texcoord[k], t[last]});
      faces_.push_back(part({at[k], v[next], v[last]}, {texcoord[k], t[next], t[last]}));
      return;
    }
    faces_[number] = part({at[k], v[next], at[next]}, {texcoord[k], t[next], texcoord[next]});
    faces_.push_back(part({v[k], at[k], at[next]}, {t[k], texcoord[k], texcoord[next]}));
    faces_.push_back(part({v[k], at[next], v[last]}, {t[k], texcoord[next], t[last]}));
  }

  void fillVertex(Index v, const Between& between)
  {
    TriangleMesh& mesh = model_.mesh;
    mesh.vertices.col(v) = (T_region_mesh_.inverse() * places_[v]).cast<float>();
    if (mesh.normals.cols() > 0)
      mesh.normals.col(v) = between.of(mesh.normals).stableNormalized();
    if (mesh.colors.cols() > 0)
      mesh.colors.col(v) = between.of(mesh.colors).array().round().cast<std::uint8_t>();
    for (auto& [name, values] : mesh.fields)
      values[v] = (1 - between.share) * values[between.from] + between.share * values[between.to];
  }

  TexturedMesh& model_;
  Eigen::Isometry3d T_region_mesh_; ///< without the mesh's origin, as seen in the region
  bool textured_;
  Index vertices_, texcoords_; ///< that the model came with
  double tolerance_;
  std::vector<Face> faces_;
  std::vector<Eigen::Vector3d> places_;
  std::vector<Between> between_, texcoord_between_; ///< what the new ones lie between
  std::vector<double> side_;                        ///< of the plane, of each vertex; 0 = on it
  std::map<std::pair<int, int>, int> new_vertices_, new_texcoords_;
};

void splitAlong(const CropRegion& region, TexturedMesh& model)
{
  constexpr double far = 1e300;
  const Eigen::Vector3d origin = region.T_region_world * model.mesh.origin;
  const Eigen::AlignedBox2d everywhere(Eigen::Vector2d(-far, -far), Eigen::Vector2d(far, far));
  Splitter splitter(model, Eigen::Isometry3d(region.T_region_world.linear()));
  for (const double height : {region.low, region.high})
    if (std::isfinite(height))
      splitter.split({Eigen::Vector3d::UnitZ(), height - origin.z()}, everywhere);
  for (const Eigen::Matrix2Xd& outline : region.outlines)
    for (Index k = 0, last = outline.cols() - 1; k < outline.cols(); last = k++) {
      const Eigen::Vector2d from = outline.col(last) - origin.head<2>(), to = outline.col(k) - origin.head<2>();
      const Eigen::Vector2d along = (to - from).normalized();
      const Eigen::Vector3d normal(along.y(), -along.x(), 0);
      splitter.split({normal, normal.head<2>().dot(from)}, Eigen::AlignedBox2d(from.cwiseMin(to), from.cwiseMax(to)));
    }
  splitter.finish();
}
} // namespace

TexturedMesh cropModel(TexturedMesh model, const CropRegion& region)
{
  validateMesh(model.mesh);
  validateCropRegion(region);
  if (model.mesh.faceCount() == 0)
    return model;
  splitAlong(region, model);
  std::vector<bool> keep(model.mesh.faceCount());
  for (std::size_t f = 0; f < keep.size(); ++f) {
    const Eigen::Vector3d sum =
        faceCorner(model.mesh, f, 0) + faceCorner(model.mesh, f, 1) + faceCorner(model.mesh, f, 2);
    keep[f] = isInside(region, model.mesh.origin + sum / 3);
  }
  keepFaces(keep, model);
  return model;
}

TriangleMesh cropMesh(TriangleMesh mesh, const CropRegion& region)
{
  TexturedMesh model;
  model.mesh = std::move(mesh);
  return cropModel(std::move(model), region).mesh;
}
} // namespace fresco
