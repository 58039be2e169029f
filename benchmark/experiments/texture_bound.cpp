// SPDX-License-Identifier: BSD-3-Clause
// How well any texture could do: the true colours of a generated room, painted into the layout that fresco_texture made
// of its true mesh, at most as fine as photographs show them.
#include "support/tool.h"
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/io/colmap.h>
#include <fresco/io/mesh_io.h>
#include <fresco/simulation/sensors/dataset.h>
#include <fresco/simulation/sensors/lighting.h>
using namespace fresco;
using namespace fresco::simulation;

namespace {
/// Texels around a face that take its colours too, so that interpolation finds them beyond the border.
constexpr double border = 2.5;
/// Metres: as fine as what no photograph sees is painted.
constexpr float unseen = 0.5f;
/// What a camera sees over a pixel, as share of the pixel's side: a Gaussian-like prefilter.
constexpr float pixel_share = 0.7f;

struct BoundOptions {
  std::string cameras;
  int keep_out = 0;
  double texels = 1.0;
  float edge = 0.1f;
};

/// A face in its atlas, in texels, y downwards.
struct Corners {
  Eigen::Matrix<double, 2, 3> at;
  double twice_area;
};

Corners cornersOf(const TexturedMesh& model, Index face)
{
  const Image& atlas = model.atlases[model.face_atlas[face]];
  Corners corners;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector2d t = model.texcoords.col(model.texcoord_faces(k, face)).cast<double>();
    corners.at.col(k) = Eigen::Vector2d(t.x() * atlas.width, (1 - t.y()) * atlas.height);
  }
  const Eigen::Vector2d a = corners.at.col(1) - corners.at.col(0), b = corners.at.col(2) - corners.at.col(0);
  corners.twice_area = a.x() * b.y() - a.y() * b.x();
  return corners;
}

/// Texels that a place is inside of the nearest side of the face, negative outside.
double depthOf(const Corners& corners, const Eigen::Vector2d& place)
{
  const double turn = corners.twice_area > 0 ? 1 : -1;
  double least = 1e9;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector2d side = corners.at.col((k + 1) % 3) - corners.at.col(k), to = place - corners.at.col(k);
    least = std::min(least, turn * (side.x() * to.y() - side.y() * to.x()) / std::max(side.norm(), 1e-9));
  }
  return least;
}

std::array<Eigen::Vector3f, 3> triangleOf(const TriangleMesh& mesh, Index face)
{
  return {mesh.vertices.col(mesh.faces(0, face)), mesh.vertices.col(mesh.faces(1, face)),
          mesh.vertices.col(mesh.faces(2, face))};
}

/// Metres that a pixel of the view covers at the middle of a face; infinite where the view does not see it.
float footprint(const LitScene& lit, const CameraSet& set, std::size_t view_index, Index face)
{
  constexpr float nothing = std::numeric_limits<float>::infinity();
  const auto [a, b, c] = triangleOf(lit.scene.mesh, face);
  const Eigen::Vector3f middle = (a + b + c) / 3, normal = (b - a).cross(c - a).normalized();
  const View& view = set.views[view_index];
  const CameraModel& camera = set.cameras[view.camera];
  const Eigen::Vector3d seen = view.T_camera_world * (middle.cast<double>() + lit.scene.mesh.origin);
  const Eigen::Vector3f from = (view.center() - lit.scene.mesh.origin).cast<float>();
  const float cosine = normal.dot((from - middle).normalized());
  if (seen.z() < 0.05 || cosine < 0.05f)
    return nothing;
  const Eigen::Vector2d pixel = project(camera, seen);
  if (pixel.minCoeff() < 1 || pixel.x() > camera.width - 1 || pixel.y() > camera.height - 1)
    return nothing;
  const RayHit hit = lit.rays.intersect({from, middle - from, 1.1f});
  if (hit.face != static_cast<int>(face) && (hit.face < 0 || hit.distance < 0.999f))
    return nothing;
  return pixel_share * static_cast<float>(seen.z() / camera.fx) / std::sqrt(std::max(cosine, 0.1f));
}

/// Of each face, metres: what the best of the photographs that are not kept out resolves.
std::vector<float> finestFootprints(const LitScene& lit, const BoundOptions& options)
{
  std::vector<float> finest(lit.scene.mesh.faceCount(), 0.f);
  if (options.cameras.empty())
    return finest;
  const CameraSet set = readColmap(options.cameras);
  parallelFor(lit.scene.mesh.faceCount(), 0, [&](Index face) {
    float best = unseen;
    for (std::size_t v = 0; v < set.views.size(); ++v)
      if (options.keep_out <= 0 || (v + 1) % static_cast<std::size_t>(options.keep_out) != 0)
        best = std::min(best, footprint(lit, set, v, face));
    finest[face] = best;
  });
  return finest;
}

/// Paints faces with their true colours. Where several want a texel, that one gets it which has it deepest inside.
class Painter {
public:
  Painter(const LitScene& lit, TexturedMesh& model) : lit_(lit), model_(model)
  {
    for (const Image& atlas : model.atlases)
      owners_.emplace_back(static_cast<std::size_t>(atlas.width) * static_cast<std::size_t>(atlas.height), -1e9f);
  }

  /// @param texels, finest what is painted is no finer than so many texels, nor than so many metres
  void paint(Index face, double texels, float finest)
  {
    const Corners corners = cornersOf(model_, face);
    if (std::abs(corners.twice_area) < 1e-9)
      return;
    const auto [a, b, c] = triangleOf(lit_.scene.mesh, face);
    const double texel = std::sqrt((b - a).cross(c - a).norm() / std::abs(corners.twice_area));
    const float footprint = std::max(static_cast<float>(texels * texel), finest);
    const auto which = static_cast<std::size_t>(model_.face_atlas[face]);
    Image& atlas = model_.atlases[which];
    const Eigen::Array2d size(atlas.width, atlas.height);
    const Eigen::Array2i low = (corners.at.rowwise().minCoeff().array() - border).max(0.0).cast<int>(),
                         end = (corners.at.rowwise().maxCoeff().array() + border).min(size).ceil().cast<int>();
    for (int y = low.y(); y < end.y(); ++y)
      for (int x = low.x(); x < end.x(); ++x)
        if (claim(owners_[which][static_cast<std::size_t>(y) * static_cast<std::size_t>(atlas.width) +
                                 static_cast<std::size_t>(x)],
                  depthOf(corners, {x + 0.5, y + 0.5})))
          setColor(surfaceColor(lit_, hitAt(corners, face, {x + 0.5, y + 0.5}), footprint), atlas.pixel(x, y));
  }

private:
  /// @param owner depth of the texel in the face that has it so far
  static bool claim(float& owner, double depth)
  {
    if (depth < -border || owner >= 0 || depth <= owner)
      return false;
    owner = static_cast<float>(depth);
    return true;
  }

  static RayHit hitAt(const Corners& corners, Index face, const Eigen::Vector2d& place)
  {
    const Eigen::Vector2d u = corners.at.col(1) - corners.at.col(0), w = corners.at.col(2) - corners.at.col(0),
                          to = place - corners.at.col(0);
    return {static_cast<int>(face), 0.f, static_cast<float>((to.x() * w.y() - to.y() * w.x()) / corners.twice_area),
            static_cast<float>((u.x() * to.y() - u.y() * to.x()) / corners.twice_area)};
  }

  static void setColor(const Eigen::Vector3f& color, std::uint8_t* pixel)
  {
    for (int k = 0; k < 3; ++k)
      pixel[k] = static_cast<std::uint8_t>(std::clamp(255.f * color[k] + 0.5f, 0.f, 255.f));
  }

  const LitScene& lit_;
  TexturedMesh& model_;
  std::vector<std::vector<float>> owners_; ///< by atlas and texel
};

/// @throws std::invalid_argument unless `textured` shows the faces of the room, all of them with texture
void requireSameFaces(const TexturedMesh& textured, const TriangleMesh& truth)
{
  const TriangleMesh& model = textured.mesh;
  require(model.faceCount() == truth.faceCount(), "the model has ", model.faceCount(), " faces, the room ",
          truth.faceCount());
  require(model.faceCount() == 0 || textured.face_atlas.minCoeff() >= 0, "a face of the model has no texture");
  const Eigen::Vector3f shift = (truth.origin - model.origin).cast<float>();
  for (Index f = 0; f < truth.faceCount(); ++f)
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3f there = truth.vertices.col(truth.faces(k, f)) + shift;
      require((model.vertices.col(model.faces(k, f)) - there).norm() < 1e-3f, "face ", f,
              " of the model is not the room's");
    }
}

void run(int argc, char** argv)
{
  BoundOptions options;
  Args args("fresco_benchmark_texture_bound SCENE MODEL.obj OUT.obj [options]",
            "True colours of a generated room in the layout of MODEL.obj, which fresco_texture has made of the room's\n"
            "truth.ply: what a judge of textured models says of OUT.obj bounds what any colours can reach there.");
  args.option("cameras", options.cameras, "COLMAP folder: no finer than the best of its photographs shows it");
  args.option("keep_out", options.keep_out, "of them, every N-th does not count");
  args.option("texels", options.texels, "no finer than so many texels");
  args.option("edge", options.edge, "as given to fresco_scan, metres");
  const std::vector<std::string> files = args.parse(argc, argv, 3);
  const Scene scene = loadScene(files[0], options.edge);
  const RayScene rays(scene.mesh);
  const Lightmap light = bakeLight(scene, rays, {});
  const LitScene lit{scene, rays, light};
  TexturedMesh model = readTexturedMesh(files[1]);
  requireSameFaces(model, scene.mesh);
  const std::vector<float> finest = finestFootprints(lit, options);
  Painter painter(lit, model);
  for (Index face = 0; face < scene.mesh.faceCount(); ++face)
    painter.paint(face, options.texels, finest[face]);
  writeTexturedMesh(files[2], model);
}
} // namespace

int main(int argc, char** argv)
{
  return runTool("fresco_benchmark_texture_bound", [&] { run(argc, argv); });
}
