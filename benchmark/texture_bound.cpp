// SPDX-License-Identifier: BSD-3-Clause
// How well any texture could do: the true colours of a generated room, painted into the layout that fresco_texture made
// of its true mesh, at most as fine as photographs show them.
#include "support/tool.h"
#include "virtual/dataset.h"
#include "virtual/lighting.h"
#include <cstdio>
#include <fresco/common/colmap.h>
#include <fresco/common/mesh_io.h>
#include <fresco/common/parallel.h>
#include <fresco/common/require.h>
using namespace fresco;

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
  const Image& atlas = model.atlases[static_cast<std::size_t>(model.face_atlas[face])];
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
  const CameraModel& camera = set.cameras[static_cast<std::size_t>(view.camera)];
  const Eigen::Vector3d seen = view.T_camera_world * (middle.cast<double>() + lit.scene.mesh.origin);
  const Eigen::Vector3f from = (view.center() - lit.scene.mesh.origin).cast<float>();
  const float cosine = normal.dot((from - middle).normalized());
  if (seen.z() < 0.05 || cosine < 0.05f)
    return nothing;
  const Eigen::Vector2d pixel = project(camera, seen);
  if (pixel.minCoeff() < 1 || pixel.x() > camera.width - 1 || pixel.y() > camera.height - 1)
    return nothing;
  const VirtualHit hit = lit.rays.intersect({from, middle - from, 1.1f});
  if (hit.face != static_cast<int>(face) && (hit.face < 0 || hit.distance < 0.999f))
    return nothing;
  return pixel_share * static_cast<float>(seen.z() / camera.fx) / std::sqrt(std::max(cosine, 0.1f));
}

/// Of each face, metres: what the best of the photographs that are not kept out resolves.
std::vector<float> finestFootprints(const LitScene& lit, const BoundOptions& options)
{
  std::vector<float> finest(static_cast<std::size_t>(lit.scene.mesh.faceCount()), 0.f);
  if (options.cameras.empty())
    return finest;
  const CameraSet set = readColmap(options.cameras);
  parallelFor(lit.scene.mesh.faceCount(), 0, [&](Index face) {
    float best = unseen;
    for (std::size_t v = 0; v < set.views.size(); ++v)
      if (options.keep_out <= 0 || (v + 1) % static_cast<std::size_t>(options.keep_out) != 0)
        best = std::min(best, footprint(lit, set, v, face));
    finest[static_cast<std::size_t>(face)] = best;
  });
  return finest;
}

/// Paints the texels of a face; where several faces want one, that gets it which has it deepest inside.
/// @param depths of the texels' owners so far
void paintFace(const LitScene& lit, const Corners& corners, Index face, float footprint, Image& atlas,
               std::vector<float>& depths)
{
  const Eigen::Vector2d u = corners.at.col(1) - corners.at.col(0), w = corners.at.col(2) - corners.at.col(0);
  const Eigen::Vector2d low = corners.at.rowwise().minCoeff(), high = corners.at.rowwise().maxCoeff();
  for (int y = std::max(0, static_cast<int>(low.y() - border)); y < std::min<double>(atlas.height, high.y() + border);
       ++y)
    for (int x = std::max(0, static_cast<int>(low.x() - border)); x < std::min<double>(atlas.width, high.x() + border);
         ++x) {
      const Eigen::Vector2d place(x + 0.5, y + 0.5), to = place - corners.at.col(0);
      const double depth = depthOf(corners, place);
      float& owner =
          depths[static_cast<std::size_t>(y) * static_cast<std::size_t>(atlas.width) + static_cast<std::size_t>(x)];
      if (depth < -border || owner >= 0 || depth <= owner)
        continue;
      owner = static_cast<float>(depth);
      const VirtualHit hit{static_cast<int>(face), 0.f,
                           static_cast<float>((to.x() * w.y() - to.y() * w.x()) / corners.twice_area),
                           static_cast<float>((u.x() * to.y() - u.y() * to.x()) / corners.twice_area)};
      const Eigen::Vector3f color = 255.f * surfaceColor(lit, hit, footprint);
      for (int k = 0; k < 3; ++k)
        atlas.pixel(x, y)[k] = static_cast<std::uint8_t>(std::clamp(color[k] + 0.5f, 0.f, 255.f));
    }
}

void paint(const LitScene& lit, const std::vector<float>& finest, double texels, TexturedMesh& model)
{
  std::vector<std::vector<float>> depths;
  for (const Image& atlas : model.atlases)
    depths.emplace_back(static_cast<std::size_t>(atlas.width) * static_cast<std::size_t>(atlas.height), -1e9f);
  for (Index face = 0; face < lit.scene.mesh.faceCount(); ++face) {
    const Corners corners = cornersOf(model, face);
    if (std::abs(corners.twice_area) < 1e-9)
      continue;
    const auto [a, b, c] = triangleOf(lit.scene.mesh, face);
    const double texel = std::sqrt((b - a).cross(c - a).norm() / std::abs(corners.twice_area));
    const float footprint = std::max(static_cast<float>(texels * texel), finest[static_cast<std::size_t>(face)]);
    const auto atlas = static_cast<std::size_t>(model.face_atlas[face]);
    paintFace(lit, corners, face, footprint, model.atlases[atlas], depths[atlas]);
  }
}

void requireSameFaces(const TriangleMesh& model, const TriangleMesh& truth)
{
  require(model.faceCount() == truth.faceCount(), "the model has ", model.faceCount(), " faces, the room ",
          truth.faceCount());
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
  Args args("bench_texture_bound SCENE MODEL.obj OUT.obj [options]",
            "True colours of a generated room in the layout of MODEL.obj, which fresco_texture has made of the room's\n"
            "truth.ply: what a judge of textured models says of OUT.obj bounds what any colours can reach there.");
  args.option("cameras", options.cameras, "COLMAP folder: no finer than the best of its photographs shows it");
  args.option("keep_out", options.keep_out, "of them, every N-th does not count");
  args.option("texels", options.texels, "no finer than so many texels");
  args.option("edge", options.edge, "as given to fresco_scan, metres");
  const std::vector<std::string> files = args.parse(argc, argv, 3);
  const Scene scene = loadScene(files[0], options.edge);
  const VirtualRays rays(scene.mesh);
  const Lightmap light = bakeLight(scene, rays, {});
  const LitScene lit{scene, rays, light};
  TexturedMesh model = readTexturedMesh(files[1]);
  requireSameFaces(model.mesh, scene.mesh);
  paint(lit, finestFootprints(lit, options), options.texels, model);
  writeTexturedMesh(files[2], model);
}
} // namespace

int main(int argc, char** argv)
{
  return runTool("bench_texture_bound", [&] { run(argc, argv); });
}
