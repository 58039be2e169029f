// SPDX-License-Identifier: BSD-3-Clause
#include "texture/texture_scene.h"
#include <fresco/texture/point_texture_reconstruction.h>
#include <gtest/gtest.h>
#include <numeric>
#include <pcl/point_types.h>
namespace fresco::test {
namespace {
/// Points spread over the faces as seen from `eye`, those turned towards it alone; colours of the pattern times gain.
PointSet scanOf(const TriangleMesh& mesh, const Pattern& pattern, int count, const Eigen::Vector3d& eye,
                double gain = 1)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<double> areas;
  for (Index f = 0; f < mesh.faceCount(); ++f)
    areas.push_back(areaVector(mesh, f).norm());
  std::discrete_distribution<Index> face(areas.begin(), areas.end());
  std::vector<Eigen::Vector3f> points;
  while (static_cast<int>(points.size()) < count) {
    const Index f = face(random);
    double a = unit(random), b = unit(random);
    if (a + b > 1)
      a = 1 - a, b = 1 - b;
    const Eigen::Vector3d p = pointAt(mesh, f, {1 - a - b, a, b});
    if (areaVector(mesh, f).dot(eye - p) > 0)
      points.emplace_back((p - mesh.origin).cast<float>());
  }
  PointSet set;
  set.origin = mesh.origin;
  set.points = Eigen::Map<const Points>(points.front().data(), 3, count);
  set.viewpoints = (eye - mesh.origin).cast<float>().replicate(1, count);
  set.colors.resize(3, count);
  for (Index i = 0; i < count; ++i)
    set.colors.col(i) = (gain * pattern(set.points.col(i).cast<double>() + mesh.origin))
                            .array()
                            .round()
                            .max(0.0)
                            .min(255.0)
                            .cast<std::uint8_t>();
  return set;
}

/// All sides of the mesh, from the corners of a large cube.
PointSet scansAround(const TriangleMesh& mesh, const Pattern& pattern, int count,
                     const std::vector<double>& gains = {1})
{
  PointSet all;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d eye = mesh.origin + 4 * Eigen::Vector3d(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
    const PointSet scan = scanOf(mesh, pattern, count, eye, gains[k % gains.size()]);
    all = k == 0 ? scan : mergePoints(all, scan);
  }
  return all;
}

TEST(PointTexture, CornersAtOnePlaceAreOne)
{
  const TriangleMesh mesh = cube();
  TriangleMesh soup = mesh;
  soup.vertices = mesh.vertices(Eigen::all, std::vector<int>(mesh.faces.data(), mesh.faces.data() + mesh.faces.size()));
  std::iota(soup.faces.data(), soup.faces.data() + soup.faces.size(), 0);
  const PointSet points = scansAround(mesh, waves, 800);
  const PointTextureResult welded = reconstructPointTexture(mesh, points),
                           unwelded = reconstructPointTexture(soup, points);
  EXPECT_EQ(unwelded.charts, welded.charts);
  EXPECT_EQ(unwelded.warnings.size(), 1u);
  EXPECT_EQ(unwelded.model.mesh.faces, soup.faces);
}

TEST(PointTexture, ConvergesWithTheDensityOfThePoints)
{
  double before = 1e9;
  for (const int count : {100, 800, 6400}) {
    const PointTextureResult result = reconstructPointTexture(cube(), scansAround(cube(), waves, count));
    EXPECT_EQ(result.look, PointLook::colors);
    EXPECT_GT(result.coverage, 0.97); // random places leave gaps
    const double error = colorError(result.model, waves).mean;
    EXPECT_LT(error, 0.6 * before) << count; // eight times the points: below half the distance
    before = error;
  }
  EXPECT_LT(before, 3);
}

TEST(PointTexture, SidesOfAThinWallDoNotMix)
{
  TriangleMesh wall; // of 1 cm, points 2 cm apart, red before and blue behind
  appendBox({-1, -1, 0}, {1, 1, 0.01f}, false, wall);
  const Pattern sides = [](const Eigen::Vector3d& p) {
    return p.z() > 0.005 ? Eigen::Vector3d(200, 0, 20 + 10 * p.x()) : Eigen::Vector3d(0, 20 + 10 * p.x(), 200);
  };
  PointSet points = scansAround(wall, sides, 4000);
  points.points.row(2) += 0.002f * Eigen::RowVectorXf::Random(points.size()); // noise
  const PointTextureResult result = reconstructPointTexture(wall, points);
  forPlaces(wall, 200, [&](Index f, const Eigen::Vector3d& weights) {
    const Eigen::Vector3d p = pointAt(wall, f, weights);
    if (p.cwiseAbs().head<2>().maxCoeff() < 0.95) {
      EXPECT_LT((colorAt(result.model, f, weights) - sides(p)).cwiseAbs().maxCoeff(), 12);
    }
  });
}

TEST(PointTexture, ScansAreBroughtToOneExposure)
{
  const std::vector<double> gains{1.1, 0.9, 1.0, 0.8, 1.2};
  const PointSet points = scansAround(cube(), waves, 6000, gains);
  const PointTextureResult result = reconstructPointTexture(cube(), points);
  ASSERT_EQ(result.gains.cols(), 8);
  for (int k = 1; k < 8; ++k)
    EXPECT_NEAR(result.gains(1, k) * gains[k % 5] / (result.gains(1, 0) * gains[0]), 1, 0.02) << k;
  PointTextureOptions as_they_are;
  as_they_are.exposure = false;
  const double mean = std::exp(-std::log(result.gains(1, 0) * gains[0])); // the overall brightness is not known
  const auto error = [&](const PointTextureResult& r) {
    return colorError(r.model, [&](const Eigen::Vector3d& p) { return Eigen::Vector3d(waves(p) / mean); }).mean;
  };
  EXPECT_LT(error(result), 0.3 * error(reconstructPointTexture(cube(), points, as_they_are)));
}

TEST(PointTexture, IntensitiesAreFreedOfRangeAndIncidence)
{
  TriangleMesh room;
  appendBox({-1, -1, -1}, {1, 1, 1}, true, room);
  PointSet points;
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector3d eye(k & 1 ? 0.6 : -0.5, k & 2 ? 0.7 : -0.6, 0.2 * k - 0.3);
    PointSet scan = scanOf(room, waves, 6000, eye);
    scan.intensities.resize(scan.size());
    for (Index i = 0; i < scan.size(); ++i) {
      const Eigen::Vector3d p = scan.points.col(i).cast<double>(), beam = eye - p;
      Index axis; // of the wall
      p.cwiseAbs().maxCoeff(&axis);
      const double cosine = std::abs(beam.normalized()[axis]);
      scan.intensities[i] = static_cast<float>((1 + 0.2 * k) * waves(p)[0] * cosine / beam.squaredNorm());
    }
    scan.colors.resize(3, 0);
    points = k == 0 ? scan : mergePoints(points, scan);
  }
  const PointTextureResult result = reconstructPointTexture(room, points);
  EXPECT_EQ(result.look, PointLook::intensities);
  EXPECT_NEAR(result.range_exponent, -2, 0.1);
  EXPECT_NEAR(result.incidence_exponent, 1, 0.1);
  double product = 0, a = 0, b = 0, count = 0, sum_a = 0, sum_b = 0; // a display makes light of grey by the power 2.2
  forPlaces(room, 100, [&](Index f, const Eigen::Vector3d& weights) {
    const double x = std::pow(colorAt(result.model, f, weights)[0], 2.2), y = waves(pointAt(room, f, weights))[0];
    product += x * y, a += x * x, b += y * y, sum_a += x, sum_b += y, ++count;
  });
  const double correlation =
      (product - sum_a * sum_b / count) / std::sqrt((a - sum_a * sum_a / count) * (b - sum_b * sum_b / count));
  EXPECT_GT(correlation, 0.99);
}

TEST(PointTexture, WithoutColoursTheModelIsUntextured)
{
  PointSet points = scansAround(cube(), waves, 500);
  points.colors.setZero();
  points.intensities = Eigen::VectorXf::Constant(points.size(), 3.f);
  PointTextureResult result = reconstructPointTexture(cube(), points);
  EXPECT_EQ(result.look, PointLook::none);
  ASSERT_EQ(result.warnings.size(), 2u);
  EXPECT_NE(result.warnings[0].find("all black"), std::string::npos);
  EXPECT_NE(result.warnings[1].find("all equal"), std::string::npos);
  EXPECT_NO_THROW(validateTexturedMesh(result.model));
  EXPECT_TRUE(result.model.atlases.empty());
  points.intensities = Eigen::VectorXf::LinSpaced(points.size(), -1.f, 3.f); // black colours do not hide them
  EXPECT_EQ(reconstructPointTexture(cube(), points).look, PointLook::intensities);
}

TEST(PointTexture, WhereThereAreNoPointsTheMaskIsWhite)
{
  const PointTextureResult result = reconstructPointTexture(cube(), scanOf(cube(), waves, 9000, {0, 0, 5}));
  EXPECT_NEAR(result.coverage, 1.0 / 6, 0.02); // the upper side
  TexturedMesh mask = result.model;
  Image& image = mask.atlases.at(0);
  for (std::size_t i = 0; i < result.masks[0].data.size(); ++i)
    std::fill_n(image.data.begin() + 3 * i, 3, result.masks[0].data[i]);
  forPlaces(cube(), 60, [&](Index f, const Eigen::Vector3d& weights) {
    const Eigen::Vector3d p = pointAt(mask.mesh, f, weights);
    if (p.head<2>().cwiseAbs().maxCoeff() < 0.95 || p.z() < 0.9) {
      EXPECT_NEAR(colorAt(mask, f, weights)[0], p.z() > 0.99 ? 0 : 255, 1);
    }
  });
}

TEST(PointTexture, NeitherThreadsNorPlaceMatter)
{
  const auto textured = [](const Eigen::Vector3d& origin, int threads) {
    PointTextureOptions options;
    options.threads = threads;
    TriangleMesh mesh = cube();
    PointSet points = scansAround(mesh, waves, 2000);
    mesh.origin = points.origin = origin;
    return reconstructPointTexture(mesh, points, options);
  };
  const PointTextureResult one = textured({0, 0, 0}, 1), four = textured({0, 0, 0}, 4),
                           far = textured({1e6, 2e6, 0}, 1);
  EXPECT_EQ(one.model.atlases[0].data, four.model.atlases[0].data);
  EXPECT_EQ(one.model.atlases[0].data, far.model.atlases[0].data);
}

TEST(PointTexture, BadInputIsRefused)
{
  const PointSet points = scansAround(cube(), waves, 100);
  for (const auto& spoil : std::vector<std::function<void(PointTextureOptions&)>>{
           [](auto& o) { o.texel = -1; }, [](auto& o) { o.width = NAN; }, [](auto& o) { o.rounds = 21; },
           [](auto& o) { o.atlas = 5; }, [](auto& o) { o.border = 0; }}) {
    PointTextureOptions options;
    spoil(options);
    EXPECT_THROW(reconstructPointTexture(cube(), points, options), std::invalid_argument);
  }
  EXPECT_THROW(reconstructPointTexture(TriangleMesh(), points), std::invalid_argument);
  PointSet lost = points;
  lost.points.setConstant(NAN);
  EXPECT_THROW(reconstructPointTexture(cube(), lost), std::runtime_error);
}

TEST(PointTexture, ClassIsTheCore)
{
  const PointSet points = scansAround(cube(), waves, 500);
  pcl::PointCloud<pcl::PointXYZRGB> cloud;
  toPointCloud(points, cloud);
  const auto mesh = pcl::make_shared<pcl::PolygonMesh>();
  toPolygonMesh(cube(), *mesh);
  PointTextureReconstruction texture;
  pcl::TextureMesh out;
  EXPECT_THROW(texture.process(out), std::invalid_argument);
  texture.setInputMesh(mesh);
  texture.setInputCloud(cloud);
  texture.setTexelSize(0.02);
  texture.process(out);
  PointTextureOptions options;
  options.texel = 0.02;
  const PointTextureResult core = reconstructPointTexture(cube(), toPointSet(cloud), options);
  EXPECT_EQ(texture.getResult().model.atlases[0].data, core.model.atlases[0].data);
  EXPECT_EQ(out.tex_polygons.size(), 1u);
}
} // namespace
} // namespace fresco::test
