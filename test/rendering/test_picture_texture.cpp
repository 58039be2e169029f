// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/picture_fixtures.h"
#include <gtest/gtest.h>
namespace fresco {
namespace {
using namespace test;
using Rgb = std::array<int, 3>;

void fill(Image& image, int x0, int y0, const Rgb& color)
{
  for (int y = 0; y < image.height / 2; ++y)
    for (int x = 0; x < image.width / 2; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        image.pixel(x0 + x, y0 + y)[c] = static_cast<std::uint8_t>(color[c]);
}

constexpr Rgb upper_left{250, 10, 20}, upper_right{30, 240, 40}, lower_left{50, 60, 230}, lower_right{220, 210, 15};

/// A quarter of each colour; rows of an image begin at the top.
Image quarters(int side)
{
  Image image(side, side);
  fill(image, 0, 0, upper_left);
  fill(image, side / 2, 0, upper_right);
  fill(image, 0, side / 2, lower_left);
  fill(image, side / 2, side / 2, lower_right);
  return image;
}

PictureOptions squareOptions(int side)
{
  PictureOptions options = optionsFor(Shading::Texture, side, side);
  options.view = squareView();
  return options;
}

TEST(TexturePicture, CornersOfTheAtlasAppearWhereTheyBelong)
{
  for (const int side : {64, 250, 1024}) {
    const Image image = renderPicture(texturedSquare(quarters(side)), squareOptions(100));
    EXPECT_LE(difference(rgb(image, 10, 10), upper_left), 1) << side;
    EXPECT_LE(difference(rgb(image, 89, 10), upper_right), 1) << side;
    EXPECT_LE(difference(rgb(image, 10, 89), lower_left), 1) << side;
    EXPECT_LE(difference(rgb(image, 89, 89), lower_right), 1) << side;
  }
}

TEST(TexturePicture, ColorsAreThoseOfTheAtlasWhateverTheAngle)
{
  for (const Rgb& color : {Rgb{0, 0, 0}, Rgb{128, 64, 200}, Rgb{255, 255, 255}, Rgb{17, 99, 3}}) {
    Image atlas(32, 32);
    for (int y = 0; y < 32; y += 16)
      for (int x = 0; x < 32; x += 16)
        fill(atlas, x, y, color);
    PictureOptions options = squareOptions(50);
    options.view->eye = {2.0, -0.5, 1.0};
    EXPECT_LE(difference(rgb(renderPicture(texturedSquare(atlas), options), 25, 25), color), 1);
  }
}

TEST(TexturePicture, TexelsMapToPixelsOneToOne)
{
  Image atlas(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      for (int c = 0; c < 3; ++c)
        atlas.pixel(x, y)[c] = static_cast<std::uint8_t>((x * 37 + y * 91 + c * 50) % 256);
  const Image image = renderPicture(texturedSquare(atlas), squareOptions(64));
  for (int y = 2; y < 62; ++y)
    for (int x = 2; x < 62; ++x)
      ASSERT_LE(difference(rgb(image, x, y), rgb(atlas, x, y)), 2) << x << " " << y;
}

TEST(TexturePicture, SmallFinePatternIsFiltered)
{
  Image atlas(512, 512);
  for (int y = 0; y < 512; ++y)
    for (int x = 0; x < 512; ++x)
      std::fill_n(atlas.pixel(x, y), 3, static_cast<std::uint8_t>((x + y) % 2 ? 255 : 0));
  const Image image = renderPicture(texturedSquare(atlas), squareOptions(60));
  for (int i = 5; i < 55; ++i)
    EXPECT_NEAR(image.pixel(i, 30)[0], 127, 12); // not the stripes of single texels
}

TEST(TexturePicture, EachFaceShowsItsOwnAtlasAndFacesWithoutAreGrey)
{
  TexturedMesh model = texturedSquare(Image(8, 8, 3, 40));
  model.atlases.emplace_back(8, 8, 3, 210);
  model.face_atlas << 0, 1;
  Image image = renderPicture(model, squareOptions(60));
  EXPECT_LE(difference(rgb(image, 45, 45), {40, 40, 40}), 1);
  EXPECT_LE(difference(rgb(image, 15, 15), {210, 210, 210}), 1);
  model.face_atlas << -1, 1;
  model.texcoord_faces.col(0).setConstant(-1);
  image = renderPicture(model, squareOptions(60));
  EXPECT_LE(difference(rgb(image, 15, 15), {210, 210, 210}), 1);
  EXPECT_GT(difference(rgb(image, 45, 45), {40, 40, 40}), 20);
  EXPECT_GT(difference(rgb(image, 45, 45), {255, 255, 255}), 20);
}

TEST(TexturePicture, OtherShadingsShowTheMesh)
{
  PictureOptions options = squareOptions(40);
  options.shading = Shading::Normals;
  EXPECT_LE(difference(rgb(renderPicture(texturedSquare(Image(4, 4)), options), 20, 20), {128, 128, 255}), 1);
}

TEST(TexturePicture, SeriesShowsWhatSinglePicturesShow)
{
  const TexturedMesh model = texturedSquare(quarters(64));
  Viewpoint behind = squareView();
  behind.eye = 2 * behind.look - behind.eye;
  for (const Shading shading : {Shading::Texture, Shading::Normals, Shading::Gouraud}) {
    PictureOptions options = squareOptions(60);
    options.shading = shading;
    std::vector<Image> series;
    {
      PictureSeries pictures(model, options);
      for (const bool cull : {false, true})
        for (const Viewpoint& view : {squareView(), behind})
          series.push_back(pictures.draw(view, cull));
    }
    std::size_t i = 0;
    for (const bool cull : {false, true})
      for (const Viewpoint& view : {squareView(), behind}) {
        options.view = view;
        options.cull_back_faces = cull;
        EXPECT_EQ(series[i++].data, renderPicture(model, options).data) << i;
      }
    EXPECT_NE(series[1].data, series[3].data); // nothing is left of the square from behind
  }
  EXPECT_THROW(PictureSeries(model, optionsFor(Shading::Wireframe)), std::invalid_argument);
}

TEST(TexturePicture, BadModelsAreRefused)
{
  const TexturedMesh good = texturedSquare(Image(4, 4));
  const auto refused = [](const TexturedMesh& model) {
    EXPECT_THROW(renderPicture(model, optionsFor(Shading::Texture)), std::invalid_argument);
  };
  TexturedMesh bad = good;
  bad.atlases.clear();
  refused(bad);
  bad = good;
  bad.atlases[0].data.pop_back();
  refused(bad);
  bad = good;
  bad.face_atlas[0] = 1;
  refused(bad);
  bad = good;
  bad.texcoord_faces(1, 1) = 4;
  refused(bad);
  bad = good;
  bad.texcoord_faces(1, 1) = -1;
  refused(bad);
  bad = good;
  bad.texcoords(0, 0) = std::numeric_limits<float>::quiet_NaN();
  refused(bad);
  bad = good;
  bad.face_atlas.resize(1);
  refused(bad);
  refused(TexturedMesh{});
}
} // namespace
} // namespace fresco
