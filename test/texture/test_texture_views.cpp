// SPDX-License-Identifier: BSD-3-Clause
#include "texture/texture_scene.h"
#include "views/visibility.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <random>
using namespace fresco::texture;
namespace fresco::test {
namespace {
TEST(TextureViews, ExposureIsBroughtTogether)
{
  const TriangleMesh mesh = cube();
  const auto soft = [](const Eigen::Vector3d& p) { return Eigen::Vector3d(0.6 * waves(p).array() + 30); };
  std::vector<TextureView> views = photographsAround(mesh, soft);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> factor(0.8, 1.2);
  Points inverse(3, static_cast<Index>(views.size()));
  for (std::size_t v = 0; v < views.size(); ++v) {
    const Eigen::Vector3d gain(factor(random), factor(random), factor(random));
    views[v] = photograph(mesh, soft, views[v].camera, views[v].T_camera_world, gain);
    inverse.col(static_cast<Index>(v)) = gain.cwiseInverse().cast<float>();
  }
  const TextureResult result = reconstructTexture(mesh, views);
  ASSERT_EQ(result.gains.cols(), inverse.cols());
  EXPECT_LT(result.gains.array().log().rowwise().mean().abs().maxCoeff(), 1e-3);
  for (int c = 0; c < 3; ++c) { // found up to one factor per channel
    const Eigen::ArrayXf ratio = (result.gains.row(c).array() / inverse.row(c).array()).transpose();
    EXPECT_LT(ratio.maxCoeff() / ratio.minCoeff(), 1.03f) << c;
  }
}

TEST(TextureViews, VignettingIsFoundAndTakenAway)
{
  const TriangleMesh mesh = cube();
  const auto soft = [](const Eigen::Vector3d& p) { return Eigen::Vector3d(0.6 * waves(p).array() + 60); };
  const std::vector<TextureView> clear = photographsAround(mesh, soft);
  std::vector<TextureView> dark = clear;
  const auto transmission = [](double r2) { return 1 - 0.4 * r2; };
  for (TextureView& view : dark)
    for (int y = 0; y < 200; ++y)
      for (int x = 0; x < 200; ++x) {
        const double r2 = (std::pow(x + 0.5 - 100, 2) + std::pow(y + 0.5 - 100, 2)) / 2e4;
        for (int c = 0; c < 3; ++c)
          view.image.pixel(x, y)[c] = static_cast<std::uint8_t>(view.image.pixel(x, y)[c] * transmission(r2) + 0.5);
      }
  EXPECT_TRUE(reconstructTexture(mesh, clear).vignetting.isZero(0)); // nothing is corrected where nothing is wrong
  const TextureResult result = reconstructTexture(mesh, dark);
  const Eigen::Vector3f a = result.vignetting.col(0);
  for (const float r2 : {0.1f, 0.2f, 0.4f}) // the cube fills the middle of the pictures
    EXPECT_NEAR(std::exp(r2 * (a[0] + r2 * (a[1] + r2 * a[2]))), transmission(r2), 0.02) << r2;
  double worst = 0;
  forPlaces(mesh, 500, [&](Index f, const Eigen::Vector3d& w) {
    const Eigen::Vector3d truth = soft(pointAt(mesh, f, w));
    worst = std::max(worst, (colorAt(result.model, f, w) - truth).cwiseAbs().maxCoeff() / truth.mean());
  });
  EXPECT_LT(worst, 0.08);
}

/// Photographs of different exposure through one curve give what photographs of one exposure show through it.
TEST(TextureViews, ResponseCurveIsFoundAndUndone)
{
  const TriangleMesh mesh = cube();
  const auto soft = [](const Eigen::Vector3d& p) { return Eigen::Vector3d(0.6 * waves(p).array() + 30); };
  const auto curve = [](double value) {
    const double v = value / 255;
    return 255 * (0.3 * v + 0.7 * (3 * v * v - 2 * v * v * v));
  };
  const auto curved = [&](const Eigen::Vector3d& p) { return Eigen::Vector3d(soft(p).unaryExpr(curve)); };
  std::vector<TextureView> straight = photographsAround(mesh, soft), bent;
  for (std::size_t v = 0; v < straight.size(); ++v) { // mean logarithm 0
    const double gain = std::exp(0.5 * (2.0 * v / (straight.size() - 1) - 1));
    straight[v] = photograph(mesh, soft, straight[v].camera, straight[v].T_camera_world, {gain, gain, gain});
    bent.push_back(straight[v]);
    for (std::uint8_t& value : bent[v].image.data)
      value = static_cast<std::uint8_t>(std::lround(curve(value)));
  }
  EXPECT_TRUE(reconstructTexture(mesh, straight).response.isZero(0));
  const TextureResult result = reconstructTexture(mesh, bent, withThreads(1));
  EXPECT_FALSE(result.response.isZero(0));
  EXPECT_LT(colorError(result.model, curved).mean, 1.5);
  EXPECT_LT(colorError(result.model, curved).largest, 8);
  EXPECT_TRUE(sameAtlases(result, reconstructTexture(mesh, bent, withThreads(2))));
}

/// Photographs with something green in their middles, hidden by masks.
TEST(TextureViews, NothingIsTakenFromWhatMasksHide)
{
  const TriangleMesh mesh = cube();
  std::vector<TextureView> views = photographsAround(mesh, waves);
  for (TextureView& view : views) {
    view.mask = Image(200, 200, 1, 255);
    for (int y = 70; y < 120; ++y)
      for (int x = 70; x < 110; ++x) {
        *view.mask.pixel(x, y) = 0;
        std::copy_n(std::array<std::uint8_t, 3>{0, 255, 0}.data(), 3, view.image.pixel(x, y));
      }
  }
  TextureOptions options;
  options.consistency = false; // masks alone
  const TextureResult result = reconstructTexture(mesh, views, options);
  EXPECT_LT(colorError(result.model, waves).mean, 2.0); // other photographs show each place
  double greenest = 0;
  forPlaces(mesh, 300, [&](Index f, const Eigen::Vector3d& w) {
    const Eigen::Vector3d more = colorAt(result.model, f, w) - waves(pointAt(mesh, f, w));
    greenest = std::max(greenest, more.y() - 0.5 * (more.x() + more.z()));
  });
  EXPECT_LT(greenest, 15); // of 255
  EXPECT_GT(result.coverage, 0.99);
  for (TextureView& view : views)
    view.mask = Image(200, 200, 1, 0);
  EXPECT_EQ(reconstructTexture(mesh, views).coverage, 0);
  views[1].mask = Image(100, 200, 1, 255);
  EXPECT_THROW(reconstructTexture(mesh, views), std::runtime_error);
}

/// One photograph is squeezed: no pose nor lens of its own makes it fit, since all share a camera.
TEST(TextureViews, APhotographThatDoesNotFitIsNamed)
{
  const TriangleMesh mesh = cube();
  std::vector<TextureView> views = photographsAround(mesh, detailed, 4, camera(400, 400, 520));
  for (std::size_t v = 0; v < views.size(); ++v)
    views[v].path = "photo " + std::to_string(v);
  TextureResult result = reconstructTexture(mesh, views);
  ASSERT_EQ(result.fits.size(), views.size());
  for (const PhotographFit& fit : result.fits)
    EXPECT_LT(fit.median, 0.5);
  EXPECT_TRUE(result.warnings.empty());
  CameraModel squeezed = views[3].camera;
  squeezed.k1 = 0.3;
  views[3].image = photograph(mesh, detailed, squeezed, views[3].T_camera_world).image;
  result = reconstructTexture(mesh, views);
  for (std::size_t v = 0; v < views.size(); ++v)
    if (v != 3) {
      EXPECT_GT(result.fits[3].median, 2 * result.fits[v].median) << v;
    }
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_NE(result.warnings[0].find("photo 3 by"), std::string::npos) << result.warnings[0];
}

TEST(TextureViews, FacesInsideOutAreTurnedAndDuplicatesLeftOut)
{
  const TriangleMesh mesh = cube();
  const auto views = photographsAround(mesh, waves);
  EXPECT_TRUE(reconstructTexture(mesh, views).warnings.empty());
  TriangleMesh bad = mesh;
  bad.faces.conservativeResize(3, 14);
  bad.faces.col(12) = mesh.faces.col(3);
  bad.faces.col(13) << mesh.faces(1, 5), mesh.faces(2, 5), mesh.faces(0, 5);
  for (const Index f : {0, 1, 6}) // a side, and half of one
    std::swap(bad.faces(0, f), bad.faces(1, f));
  const TextureResult result = reconstructTexture(bad, views);
  ASSERT_EQ(result.warnings.size(), 2U);
  EXPECT_NE(result.warnings[0].find("2 faces are there twice"), std::string::npos);
  EXPECT_NE(result.warnings[1].find("3 of 12 faces are turned inside out"), std::string::npos);
  ASSERT_EQ(result.model.mesh.faceCount(), 12);
  EXPECT_GT(result.coverage, 0.999);
  EXPECT_LT(colorError(result.model, waves).mean, 2.0);
  EXPECT_GT(signedVolume(result.model.mesh), 7.99);
}

TEST(TextureViews, UnweldedMeshIsTexturedAsTheWeldedOne)
{
  const TriangleMesh mesh = cube();
  TriangleMesh soup = mesh;
  soup.vertices = mesh.vertices(Eigen::all, std::vector<int>(mesh.faces.data(), mesh.faces.data() + mesh.faces.size()));
  for (Index i = 0; i < soup.faces.size(); ++i)
    soup.faces.data()[i] = static_cast<int>(i);
  const std::vector<TextureView> views = photographsAround(mesh, detailed);
  const TextureResult welded = reconstructTexture(mesh, views), unwelded = reconstructTexture(soup, views);
  EXPECT_EQ(unwelded.charts, welded.charts);
  EXPECT_EQ(unwelded.warnings.size(), welded.warnings.size() + 1);
  EXPECT_EQ(unwelded.model.mesh.faces, soup.faces);
  double worst = 0; // sums come in another order
  forPlaces(mesh, 200, [&](Index f, const Eigen::Vector3d& w) {
    worst = std::max(worst, (colorAt(unwelded.model, f, w) - colorAt(welded.model, f, w)).cwiseAbs().maxCoeff());
  });
  EXPECT_LT(worst, 3);
}

TEST(TextureViews, LittleSeenSurfaceIsAWarningWithItsLikelyCause)
{
  TriangleMesh mesh = cube();
  const std::vector<TextureView> views = photographsAround(mesh, waves);
  mesh.vertices *= 1000.f;
  const TextureResult result = reconstructTexture(mesh, views);
  ASSERT_FALSE(result.warnings.empty());
  EXPECT_NE(result.warnings.back().find("millimetres"), std::string::npos) << result.warnings.back();
}

TEST(TextureViews, SeamsAreLevelled)
{
  const TriangleMesh mesh = cube();
  const auto grey = [](const Eigen::Vector3d&) { return Eigen::Vector3d(120, 120, 120); };
  std::vector<TextureView> views = photographsAround(mesh, grey);
  for (std::size_t v = 0; v < views.size();
       ++v) // darker outwards, each in its own way: no gain and no common lens takes it away
    for (int y = 0; y < 200; ++y)
      for (int x = 0; x < 200; ++x) {
        const double r2 = (std::pow(x - 100, 2) + std::pow(y - 100, 2)) / 2e4, share = r2 * (v % 2 == 0 ? 2.0 : 0.2);
        for (int c = 0; c < 3; ++c)
          views[v].image.pixel(x, y)[c] =
              static_cast<std::uint8_t>(views[v].image.pixel(x, y)[c] * std::max(0.1, 1 - 0.3 * share));
      }
  TextureOptions options;
  options.smoothness = 0;
  const auto worstStep = [&](bool level) {
    options.level = level;
    const TextureResult result = reconstructTexture(mesh, views, options);
    double step = 0;
    forPlaces(mesh, 500, [&](Index f, const Eigen::Vector3d& w) {
      const Eigen::Vector3d beside = (w + 0.02 * (Eigen::Vector3d::Constant(1.0 / 3) - w));
      step = std::max(step, (colorAt(result.model, f, w) - colorAt(result.model, f, beside)).cwiseAbs().maxCoeff());
    });
    return step;
  };
  EXPECT_LT(worstStep(true), 0.7 * worstStep(false));
}

/// Cameras turned and shifted at random, and of another focal length than they have.
/// @param share of some pixels
std::vector<TextureView> disturbed(std::vector<TextureView> views, double share = 1)
{
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (TextureView& view : views) {
    const Eigen::Vector3d turn = share * 0.004 * Eigen::Vector3d(normal(random), normal(random), normal(random));
    const Eigen::Vector3d shift = share * 0.01 * Eigen::Vector3d(normal(random), normal(random), normal(random));
    Eigen::Isometry3d change = Eigen::Isometry3d::Identity();
    change.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
    change.translation() = shift;
    view.T_camera_world = change * view.T_camera_world;
    view.camera.fx *= 1 + 0.03 * share;
    view.camera.fy *= 1 + 0.03 * share;
  }
  return views;
}

TEST(TextureViews, CamerasAreRefined)
{
  const TriangleMesh mesh = cube();
  const auto views = photographsAround(mesh, detailed, 3.2, camera(320, 320, 420));
  TextureOptions given;
  given.refine = false;
  const TextureResult without = reconstructTexture(mesh, disturbed(views), given),
                      with = reconstructTexture(mesh, disturbed(views));
  EXPECT_GT(with.disagreement_before, 1.5);
  EXPECT_LT(with.disagreement_after, 0.5);
  EXPECT_NEAR(with.cameras[0].camera.fx, 420, 6);
  EXPECT_LT(colorError(with.model, detailed).mean, 0.6 * colorError(without.model, detailed).mean);
  EXPECT_EQ(without.cameras[0].camera.fx, 420 * 1.03);
  EXPECT_EQ(without.disagreement_before, 0);
  EXPECT_TRUE(with.refined);
  EXPECT_FALSE(without.refined);
}

TEST(TextureViews, FractionsOfAPixelAreRefined)
{
  const TriangleMesh mesh = cube();
  const TextureResult result =
      reconstructTexture(mesh, disturbed(photographsAround(mesh, detailed, 3.2, camera(320, 320, 420)), 0.03));
  EXPECT_LT(result.disagreement_before, 0.5);
  EXPECT_GT(result.disagreement_before, 0.15);
  EXPECT_TRUE(result.refined);
  EXPECT_LT(result.disagreement_after, 0.7 * result.disagreement_before);
}

TEST(TextureViews, LargePhotographsAreMatchedByTheirOwnPixels)
{
  const TriangleMesh mesh = cube();
  const auto fine = [](const Eigen::Vector3d& p) { return detailed(5 * p); };
  std::vector<TextureView> views;
  for (const double x : {0.4, 1.2, 2.0, 2.8})
    views.push_back(photograph(mesh, fine, camera(1040, 1040, 1100), lookAt({x, 2, 1.8}, {0, 0, 0})));
  TextureOptions options;
  options.exposure = false;
  options.rounds = 0;
  options.texel = 0.05;
  const auto disagreement = [&](int memory) {
    options.memory = memory;
    const TextureResult result = reconstructTexture(mesh, disturbed(views, 0.1), options);
    EXPECT_TRUE(result.refined);
    return result.disagreement_after;
  };
  EXPECT_LT(disagreement(1024), 0.7 * disagreement(15)); // MB: too few for more than half of the pixels
}

TEST(TextureViews, RightCamerasAreLeftAlone)
{
  const TriangleMesh mesh = cube();
  const auto views = photographsAround(mesh, detailed, 3.2, camera(320, 320, 420));
  const TextureResult result = reconstructTexture(mesh, views);
  EXPECT_LT(result.disagreement_before, 0.5);
  EXPECT_EQ(result.disagreement_after, result.disagreement_before);
  EXPECT_FALSE(result.refined);
  for (std::size_t v = 0; v < views.size(); ++v)
    EXPECT_EQ(result.cameras[v].T_camera_world.matrix(), views[v].T_camera_world.matrix());
}

TEST(TextureViews, RefinementDoesNotDependOnThreads)
{
  const TriangleMesh mesh = cube();
  const auto views = disturbed(photographsAround(mesh, detailed, 3.2, camera(200, 200, 260)));
  EXPECT_TRUE(
      sameAtlases(reconstructTexture(mesh, views, withThreads(1)), reconstructTexture(mesh, views, withThreads(4))));
}

TEST(TextureViews, AViewKeptOutAddsNoColour)
{
  const TriangleMesh mesh = cube();
  auto views = photographsAround(mesh, waves);
  const TextureResult without = reconstructTexture(mesh, views);
  views.push_back(views.front());
  views.back().image = Image(200, 200, 3, 255);
  views.back().paint = false;
  const TextureResult with = reconstructTexture(mesh, views);
  EXPECT_TRUE(sameAtlases(without, with));
  EXPECT_EQ(with.cameras.size(), views.size());
}

TEST(TextureViews, SomebodyInTheWayIsIgnored)
{
  const TriangleMesh mesh = cube();
  auto views = photographsAround(mesh, waves);
  for (int y = 60; y < 140; ++y) // a green disc in front of a camera that sees one side best
    for (int x = 60; x < 140; ++x)
      if (std::hypot(x - 100, y - 100) < 35)
        for (int c = 0; c < 3; ++c)
          views[4].image.pixel(x, y)[c] = c == 1 ? 255 : 0;
  TextureOptions options;
  const double with = colorError(reconstructTexture(mesh, views, options).model, waves).mean;
  options.consistency = false;
  const double without = colorError(reconstructTexture(mesh, views, options).model, waves).mean;
  EXPECT_LT(with, 2.5);
  EXPECT_LT(with, 0.6 * without);
}

TEST(TextureViews, OfManyViewsThoseThatShowAPatchBestAreKept)
{
  constexpr Index patches = 50, views = 40, most = 8;
  std::mt19937 random(5);
  std::uniform_int_distribution<int> size(1, 12); // often the same
  CandidateTable table(patches, most);
  std::vector<std::vector<std::pair<float, int>>> added(patches); // -quality, view
  std::vector<std::vector<SeenPatch>> batch;
  for (int v = 0; v < views; ++v) {
    batch.emplace_back();
    for (Index p = 0; p < patches; ++p)
      if (random() % 2 == 0 && p % 5 != 0) {
        const float resolution = size(random);
        Candidate candidate{};
        candidate.view = v;
        candidate.quality = resolution;
        batch.back().push_back({static_cast<int>(p), candidate});
        added[p].emplace_back(-resolution, v);
      }
    if (v % 3 == 0 || v + 1 == views) {
      table.add(batch, 1 + v % 2);
      batch.clear();
    }
  }
  const Candidates kept = table.take();
  ASSERT_EQ(kept.begin.size(), static_cast<std::size_t>(patches + 1));
  for (Index p = 0; p < patches; ++p) {
    std::sort(added[p].begin(), added[p].end());
    added[p].resize(std::min<std::size_t>(added[p].size(), most));
    ASSERT_EQ(kept.count(p), static_cast<Index>(added[p].size())) << p;
    for (const auto& [quality, view] : added[p]) {
      ASSERT_NE(kept.find(p, view), nullptr) << p; // found only where views are in order
      EXPECT_EQ(kept.find(p, view)->quality, -quality);
    }
  }
  EXPECT_EQ(CandidateTable::mostPerPatch(100000, 60), 60); // a usual room: all
  EXPECT_GE(CandidateTable::mostPerPatch(100000000, 1000), 8);
}
} // namespace
} // namespace fresco::test
