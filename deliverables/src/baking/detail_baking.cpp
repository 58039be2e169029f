// SPDX-License-Identifier: BSD-3-Clause
#include "baking/full_surface.h"
#include "baking/texel_fill.h"
#include "baking/texel_owners.h"
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <fresco/core/grouped.h>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/deliverables/core/detail_baking.h>
#include <fresco/deliverables/core/model_file.h>
#include <fresco/deliverables/core/simplification.h>
#include <fresco/texture/core/texture_layout.h>
namespace fresco {
using namespace deliverables;
namespace {
void validate(const TexturedMesh& light, const TexturedMesh& full, const BakingOptions& options)
{
  validateTexturedMesh(light);
  validateMesh(full.mesh);
  require(full.mesh.faceCount() > 0, "baking: the full model has no faces");
  require(options.cage >= 0, "baking: a cage of ", options.cage);
  require(options.border >= 0 && options.border <= 64, "baking: border ", options.border, " is not in 0..64");
  require(options.coarser >= 1 && options.coarser <= 16, "baking: ", options.coarser,
          " texels a side are not in 1..16");
}

/// Light surface with what its normal maps are relative to.
class LightSurface {
public:
  LightSurface(const TexturedMesh& model, const Eigen::Vector3d& full_origin)
      : model_(model), tangents_(texcoordTangents(model)), to_full_((model.mesh.origin - full_origin).cast<float>())
  {}

  struct Place {
    Eigen::Vector3f position; ///< in the full mesh's coordinates
    Eigen::Vector3f normal;   ///< unit
    Eigen::Matrix3f frame;    ///< tangent, bitangent, normal
  };

  /// @param weights of the face's corners: negative ones continue its plane, with the frame of its rim
  Place at(Index face, const Eigen::Vector3f& weights) const
  {
    const Eigen::Vector3f inside = weights.cwiseMax(0) / weights.cwiseMax(0).sum();
    Place place{to_full_, Eigen::Vector3f::Zero(), {}};
    Eigen::Vector4f tangent = Eigen::Vector4f::Zero();
    for (int k = 0; k < 3; ++k) {
      const int vertex = model_.mesh.faces(k, face);
      place.position += weights[k] * model_.mesh.vertices.col(vertex);
      place.normal += inside[k] * model_.mesh.normals.col(vertex);
      tangent += inside[k] * tangents_.col(model_.texcoord_faces(k, face));
    }
    if (!(place.normal.norm() > 1e-3f))
      place.normal = areaVector(model_.mesh, face).cast<float>();
    place.normal.normalize();
    const Eigen::Vector3f along = tangent.head<3>().normalized();
    place.frame << along, std::copysign(1.f, tangent.w()) * place.normal.cross(along).normalized(), place.normal;
    return place;
  }

private:
  const TexturedMesh& model_;
  Eigen::Matrix4Xf tangents_;
  Eigen::Vector3f to_full_;
};

void store(const Eigen::Vector3f& value, std::uint8_t* pixel)
{
  for (int k = 0; k < 3; ++k)
    pixel[k] = std::lround(std::clamp(value[k], 0.f, 255.f));
}

/// A normal in a frame as the colour that stands for it; what faces away is laid into the surface.
Eigen::Vector3f normalColor(const Eigen::Vector3f& normal, const Eigen::Matrix3f& frame)
{
  Eigen::Vector3f local = frame.inverse() * normal;
  local.z() = std::max(local.z(), 0.f);
  if (!local.allFinite() || !(local.norm() > 1e-3f))
    local = Eigen::Vector3f::UnitZ();
  return 127.5f * (local.normalized().array() + 1);
}

class Baker {
public:
  Baker(const TexturedMesh& light, const TexturedMesh& full, const BakingOptions& options)
      : model_(light), light_(light, full.mesh.origin), full_(full, options.threads), options_(options),
        cage_(options.cage > 0 ? options.cage : 0.01 * diagonal(full.mesh)),
        faces_(
            grouped(light.mesh.faceCount(), light.atlases.size() + 1, [&](Index f) { return light.face_atlas[f] + 1; }))
  {}

  bool hasColors() const { return full_.hasColors(); }

  Image colors(int atlas) const
  {
    const Image& image = model_.atlases[atlas];
    return paint(atlas, {image.width, image.height}, options_.border,
                 [&](const LightSurface::Place&, const FullSurface::Point& point) { return full_.color(point); });
  }

  Image normals(int atlas) const
  {
    const Image& image = model_.atlases[atlas];
    const auto coarse = [&](int length) { return (length + options_.coarser - 1) / options_.coarser; };
    return paint(atlas, {coarse(image.width), coarse(image.height)}, (options_.border + 1) / options_.coarser + 1,
                 [&](const LightSurface::Place& place, const FullSurface::Point& point) {
                   return normalColor(full_.normal(point), place.frame);
                 });
  }

private:
  static double diagonal(const TriangleMesh& mesh)
  {
    return (mesh.vertices.rowwise().maxCoeff() - mesh.vertices.rowwise().minCoeff()).cast<double>().norm();
  }

  /// @param valueOf valueOf(place on the light surface, point of the full one) -> 0..255 each
  template <typename ValueOf>
  Image paint(int atlas, const PictureSize& size, int border, const ValueOf& valueOf) const
  {
    const std::vector<int> faces(faces_.list.begin() + faces_.begin[atlas + 1],
                                 faces_.list.begin() + faces_.begin[atlas + 2]);
    const std::vector<int> owners = texelOwners(model_, faces, size, border);
    std::vector<std::uint8_t> painted(owners.size(), 0);
    Image image(size.width, size.height);
    parallelFor(size.height, options_.threads, [&](Index y) {
      for (int x = 0; x < size.width; ++x)
        if (const int face = owners[y * size.width + x]; face >= 0) {
          const Eigen::Vector3d weights = weightsAt(cornersInPicture(model_, face, size), {x + 0.5, y + 0.5});
          if (!weights.allFinite())
            continue;
          const LightSurface::Place place = light_.at(face, weights.cast<float>());
          store(valueOf(place, full_.across(place.position, place.normal, cage_)), image.pixel(x, y));
          painted[y * size.width + x] = 1;
        }
    });
    fillUnpainted(image, std::move(painted));
    return image;
  }

  const TexturedMesh& model_;
  LightSurface light_;
  FullSurface full_;
  const BakingOptions& options_;
  float cage_;
  Groups faces_; ///< by atlas, those without first
};
} // namespace

GltfModel bakeDetail(TexturedMesh light, const TexturedMesh& full, const BakingOptions& options,
                     const Progress& progress)
{
  validate(light, full, options);
  if (light.mesh.normals.cols() == 0)
    light.mesh.normals = vertexNormals(light.mesh, options.threads);
  const Baker baker(light, full, options);
  const int count = light.atlases.size();
  std::vector<Image> colors(count), normals(count);
  for (int atlas = 0; atlas < count; ++atlas) {
    report(progress, "baking colours and normals", 1.0 * atlas / count);
    normals[atlas] = baker.normals(atlas);
    if (baker.hasColors())
      colors[atlas] = baker.colors(atlas);
  }
  if (baker.hasColors())
    light.atlases = std::move(colors);
  report(progress, "done", 1.0);
  return {std::move(light), std::move(normals)};
}

Image halfSize(const Image& image)
{
  require(image.channels == 3, "half size: an image of ", image.channels, " channels");
  std::vector<std::uint8_t> all(std::size_t(image.width) * image.height, 1);
  return halved(image, all);
}

double typicalTexel(const TexturedMesh& model)
{
  std::vector<std::pair<double, double>> texels; // with areas
  double total = 0;
  for (Index f = 0; f < model.face_atlas.size(); ++f) {
    if (model.face_atlas[f] < 0)
      continue;
    const Image& atlas = model.atlases[model.face_atlas[f]];
    const Eigen::Matrix<double, 2, 3> at = cornersInPicture(model, f, {atlas.width, atlas.height});
    const Eigen::Vector2d u = at.col(1) - at.col(0), v = at.col(2) - at.col(0);
    const double area = areaVector(model.mesh, f).norm(), pixels = std::abs(u.x() * v.y() - u.y() * v.x());
    if (!(area > 0 && pixels > 0))
      continue;
    texels.emplace_back(std::sqrt(area / pixels), area);
    total += area;
  }
  std::sort(texels.begin(), texels.end());
  double sum = 0;
  for (const auto& [texel, area] : texels)
    if ((sum += area) >= total / 2)
      return texel;
  return model.mesh.faceCount() > 0 ? std::sqrt(surfaceArea(model.mesh) / model.mesh.faceCount()) : 0;
}

GltfModel bakeLightModel(TriangleMesh light, const TexturedMesh& full, const LightModelOptions& options,
                         const Progress& progress)
{
  require(options.atlases >= 1, "light model: ", options.atlases, " atlases");
  light.normals.resize(3, 0); // a full model may lend it some that are not its own
  light.colors.resize(3, 0);  // are baked
  light.fields.clear();
  BakingOptions baking;
  baking.threads = options.threads;
  TextureLayoutOptions layout;
  layout.atlas = options.atlas;
  layout.threads = options.threads;
  const double most = 0.8 * options.atlases * options.atlas * options.atlas; // packing leaves a fifth or less
  const double detail = typicalTexel(full) / (full.atlases.empty() ? baking.coarser : 1); // normals as fine as faces
  layout.texel = std::max({options.texel > 0 ? options.texel : detail, std::sqrt(surfaceArea(light) / most), 1e-9});
  report(progress, "new atlas", 0.0);
  TexturedMesh model = layOutTexture(light, layout);
  for (; int(model.atlases.size()) > options.atlases; model = layOutTexture(light, layout))
    layout.texel *= 1.1;
  GltfModel baked = bakeDetail(std::move(model), full, baking, subProgress(progress, 0.2, 1));
  if (!isColored(full))
    for (Image& atlas : baked.model.atlases)
      atlas = Image(4, 4, 3, 200);
  return baked;
}

GltfModel makeLightModel(const TexturedMesh& full, const LightModelOptions& options, const Progress& progress)
{
  SimplificationOptions simplification;
  simplification.faces = options.faces;
  simplification.error = options.error;
  simplification.threads = options.threads;
  const bool fewer = options.faces != 0 || options.error != 0;
  TriangleMesh mesh =
      fewer ? simplifyMesh(full.mesh, simplification, nullptr, subProgress(progress, 0, 0.5)) : full.mesh;
  return bakeLightModel(std::move(mesh), full, options, subProgress(progress, 0.5, 1));
}
} // namespace fresco
