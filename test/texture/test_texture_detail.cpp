// SPDX-License-Identifier: BSD-3-Clause
#include "charts/patch_map.h"
#include "charts/texel_spans.h"
#include "texture/texture_scene.h"
#include <gtest/gtest.h>
using namespace fresco::texture;
namespace fresco::test {
namespace {
/// Structure of a few pixels in the photographs below, no two places alike.
Eigen::Vector3d fine(const Eigen::Vector3d& p)
{
  const double a = std::sin(60 * p.x() + 7 * p.y()) + std::sin(9 * p.x() - 55 * p.y() + 3 * p.z()) +
                   std::sin(58 * p.z() + 5 * p.x());
  const double b = std::sin(4 * p.x() + 3 * p.y()) + std::cos(5 * p.z() - 2 * p.y());
  return {128 + 25 * a + 20 * b, 128 + 25 * a - 20 * b, 128 + 20 * b};
}

/// Every pixel the mean of what it sees: a photograph twice as large, shrunk.
TextureView shrunk(const TextureView& large)
{
  TextureView out = large;
  out.camera = camera(large.camera.width / 2, large.camera.height / 2, large.camera.fx / 2);
  out.image = Image(out.camera.width, out.camera.height);
  for (int y = 0; y < out.image.height; ++y)
    for (int x = 0; x < out.image.width; ++x)
      for (int c = 0; c < 3; ++c)
        out.image.pixel(x, y)[c] = static_cast<std::uint8_t>(
            (large.image.pixel(2 * x, 2 * y)[c] + large.image.pixel(2 * x + 1, 2 * y)[c] +
             large.image.pixel(2 * x, 2 * y + 1)[c] + large.image.pixel(2 * x + 1, 2 * y + 1)[c] + 2) /
            4);
  return out;
}

std::vector<TextureView> finePhotographs(const TriangleMesh& mesh)
{
  std::vector<TextureView> views = photographsAround(mesh, fine, 3.2, camera(560, 560, 740));
  for (TextureView& view : views)
    view = shrunk(view);
  return views;
}

TextureOptions withRounds(int rounds, int threads = 0)
{
  TextureOptions options = withThreads(threads);
  options.rounds = rounds;
  return options;
}
} // namespace

TEST(TextureDetail, AllPhotographsTogetherShowMoreThanTheBestOne)
{
  const TriangleMesh mesh = cube();
  const auto views = finePhotographs(mesh);
  const TextureResult painted = reconstructTexture(mesh, views, withRounds(0)),
                      corrected = reconstructTexture(mesh, views, withRounds(2));
  ASSERT_LT(corrected.disagreement_after, 0.5);
  EXPECT_LT(colorError(corrected.model, fine).mean, 0.85 * colorError(painted.model, fine).mean);
}

/// The photograph bent by a pixel, each row by its own: no camera explains it.
void bend(double phase, Image& photo)
{
  const Image straight = photo;
  for (int y = 0; y < photo.height; ++y)
    for (int x = 0; x < photo.width; ++x) {
      const double from = std::clamp(x + std::sin(0.15 * y + phase), 0.0, photo.width - 1.001);
      const int i = static_cast<int>(from);
      for (int c = 0; c < 3; ++c) {
        const double left = straight.pixel(i, y)[c], right = straight.pixel(i + 1, y)[c];
        photo.pixel(x, y)[c] = static_cast<std::uint8_t>(std::lround(left + (from - i) * (right - left)));
      }
    }
}

TEST(TextureDetail, PhotographsThatAreOffDoNoHarm)
{
  const TriangleMesh mesh = cube();
  std::vector<TextureView> views = photographsAround(mesh, detailed);
  for (std::size_t v = 0; v < views.size(); ++v)
    bend(v, views[v].image);
  const TextureResult painted = reconstructTexture(mesh, views, withRounds(0)),
                      corrected = reconstructTexture(mesh, views, withRounds(2));
  ASSERT_GT(corrected.disagreement_after, 0.5);
  EXPECT_LT(colorError(corrected.model, detailed).mean, 1.02 * colorError(painted.model, detailed).mean);
  EXPECT_LT(colorError(corrected.model, detailed).largest, 1.1 * colorError(painted.model, detailed).largest);
}

TEST(TextureDetail, ThreadsDoNotChangeIt)
{
  const TriangleMesh mesh = cube();
  const auto views = finePhotographs(mesh);
  EXPECT_TRUE(sameAtlases(reconstructTexture(mesh, views, withRounds(2, 1)),
                          reconstructTexture(mesh, views, withRounds(2, 4))));
}

TEST(TextureDetail, NotWherePhotographsAreNotKnownToAgree)
{
  const TriangleMesh mesh = cube();
  const auto views = finePhotographs(mesh);
  TextureOptions painted = withRounds(0), asked = withRounds(3);
  painted.refine = asked.refine = false;
  EXPECT_TRUE(sameAtlases(reconstructTexture(mesh, views, painted), reconstructTexture(mesh, views, asked)));
}

/// As by a hand that moves askew while the shutter is open; then noise of the sensor.
void smear(int pixels, Image& photo)
{
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 2);
  const Image still = photo;
  for (int y = 0; y < photo.height; ++y)
    for (int x = 0; x < photo.width; ++x)
      for (int c = 0; c < 3; ++c) {
        double sum = 0;
        for (int k = 0; k < pixels; ++k)
          sum += still.pixel(std::clamp(x + k - pixels / 2, 0, photo.width - 1),
                             std::clamp(y + k - pixels / 2, 0, photo.height - 1))[c];
        photo.pixel(x, y)[c] = static_cast<std::uint8_t>(std::clamp(sum / pixels + noise(random), 0.0, 255.0));
      }
}

/// Two rings of photographs, the second one nearer and darker. Smeared by so many pixels.
std::vector<TextureView> farAndNear(const TriangleMesh& mesh, int smeared)
{
  std::vector<TextureView> views = photographsAround(mesh, fine, 4);
  const Pattern darker = [](const Eigen::Vector3d& p) { return Eigen::Vector3d(0.7 * fine(p)); };
  for (TextureView& view : photographsAround(mesh, darker, 3.6)) {
    smear(smeared, view.image);
    views.push_back(std::move(view));
  }
  return views;
}

TEST(TextureDetail, SharpPhotographsAreTakenBeforeNearerOnesThatAreSmeared)
{
  const TriangleMesh mesh = cube();
  for (const int smeared : {1, 8}) {
    const auto views = farAndNear(mesh, smeared);
    const TextureResult result = reconstructTexture(mesh, views, withRounds(2, 1));
    const int half = static_cast<int>(views.size()) / 2;
    for (Index f = 0; f < mesh.faceCount(); ++f)
      EXPECT_EQ(result.face_view[f] >= half, smeared == 1) << f; // darkness and noise are not blur
    EXPECT_TRUE(sameAtlases(result, reconstructTexture(mesh, views, withRounds(2, 4))));
  }
}

TEST(TextureDetail, PatchMapIsTheProjection)
{
  PatchMesh patches;
  patches.vertices.resize(3, 3);
  patches.vertices << 0.f, 0.1f, 0.02f, 0.f, 0.01f, 0.12f, 0.f, 0.03f, -0.02f;
  patches.faces.resize(3, 1);
  patches.faces << 0, 1, 2;
  CameraModel lens = camera();
  lens.k1 = -0.2;
  lens.p1 = 0.01;
  Eigen::Matrix<double, 2, 3> corners;
  corners << 1003.5, 1020.1, 1007, 2001.2, 2003.9, 2022.4;
  for (const CameraModel& model : {camera(), lens}) {
    const Projector view(model, lookAt({0.4, 0.3, 2}, {0.1, 0.1, 0}), Eigen::Vector3d::Zero());
    PatchMap map(patches, 0, corners, {1000, 2000});
    ASSERT_TRUE(map.look(view));
    for (const Eigen::Vector3f& weights : {Eigen::Vector3f(1, 0, 0), Eigen::Vector3f(0, 1, 0), Eigen::Vector3f(0, 0, 1),
                                           Eigen::Vector3f(0.2f, 0.5f, 0.3f)}) {
      const Eigen::Vector2f at = map.place(weights);
      EXPECT_LT((map.weights(at.x(), at.y()) - weights).norm(), 1e-4f);
      const Eigen::Vector2f truth = view(patches.vertices * weights).head<2>();
      EXPECT_LT((map.pixel(at.x(), at.y()) - truth).norm(), model.hasDistortion() ? 0.02f : 2e-3f); // of 16 pixels
    }
  }
  const Projector behind(camera(), lookAt({0, 0, -2}, {0, 0, -4}), Eigen::Vector3d::Zero());
  PatchMap map(patches, 0, corners, {1000, 2000});
  EXPECT_FALSE(map.look(behind));
}

TEST(TextureDetail, SpansHoldEveryTexelOnce)
{
  std::mt19937 random(3);
  constexpr int width = 23, height = 17;
  std::vector<int> owner(width * height);
  for (int& o : owner)
    o = static_cast<int>(random() % 5) - 1;
  const OwnedTexels texels = OwnedTexels::from(owner, width);
  std::vector<int> back(owner.size(), -1);
  for (std::size_t s = 0; s < texels.patches.size(); ++s)
    texels.forTexels(static_cast<int>(s), [&](int x, int y) {
      EXPECT_EQ(back[y * width + x], -1);
      back[y * width + x] = texels.patches[s];
    });
  EXPECT_EQ(back, owner);
  EXPECT_EQ(texels.count(), static_cast<std::size_t>(owner.size() - std::count(owner.begin(), owner.end(), -1)));
  EXPECT_EQ(OwnedTexels::from({}, 0).count(), 0u);
}
} // namespace fresco::test
