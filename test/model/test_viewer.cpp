// SPDX-License-Identifier: BSD-3-Clause
#include "test_data.h"
#include "viewer/viewer.h"
#include <algorithm>
#include <array>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <set>
#include <sys/wait.h>
using namespace fresco::model;
namespace fresco::test {
namespace {
constexpr std::array<std::array<int, 3>, 4> quarters = {
    {{200, 40, 40}, {40, 180, 60}, {50, 70, 210}, {220, 210, 50}}}; // upper left, upper right, lower left, lower right

/// An upright square of side 2 in the plane y = 0 that faces -y; x to the right, z up. The quarters of its picture
/// differ, and each has a fine pattern of its own.
TexturedMesh board()
{
  TexturedMesh model;
  model.mesh.origin = {500000, 4000000, 100}; // single precision does not suffice for the place
  model.mesh.vertices.resize(3, 4);
  model.mesh.vertices << -1, 1, 1, -1, 0, 0, 0, 0, -1, -1, 1, 1;
  model.mesh.faces.resize(3, 2);
  model.mesh.faces << 0, 0, 1, 2, 2, 3;
  model.texcoords.resize(2, 4);
  model.texcoords << 0, 1, 1, 0, 0, 0, 1, 1;
  model.texcoord_faces = model.mesh.faces;
  model.face_atlas = Eigen::VectorXi::Zero(2);
  Image atlas(256, 256);
  for (int y = 0; y < atlas.height; ++y)
    for (int x = 0; x < atlas.width; ++x)
      for (int c = 0; c < 3; ++c)
        atlas.pixel(x, y)[c] =
            static_cast<std::uint8_t>(quarters[x / 128 + 2 * (y / 128)][c] + (x * 7 + y * 13) % 31 - 15);
  model.atlases = {atlas};
  return model;
}

/// Exit status of a command; -1 if it did not end by itself.
int run(const std::string& command)
{
  const int status = std::system(("timeout 300 " + command).c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Name of the browser; empty: none is installed.
std::string chromium()
{
  for (const std::string name : {"chromium", "chromium-browser", "google-chrome"})
    if (run("sh -c 'command -v " + name + "' > /dev/null 2>&1") == 0)
      return name;
  return "";
}

bool isBlank(const Image& picture)
{
  const std::uint8_t* first = picture.pixel(0, 0);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      if (!std::equal(first, first + 3, picture.pixel(x, y)))
        return false;
  return true;
}

/// On a busy machine the clock of the page can run out before its modules are read: what is blank then is tried again.
Image screenshot(const std::string& folder, const std::string& page, int tries = 3)
{
  const std::string picture = folder + "/picture.png";
  run("env HOME=" + folder + " " + chromium() +
      " --headless=new --no-sandbox --disable-dev-shm-usage --use-angle=swiftshader --enable-unsafe-swiftshader"
      " --allow-file-access-from-files --hide-scrollbars --window-size=800,600 --force-device-scale-factor=1"
      " --virtual-time-budget=20000 --user-data-dir=" +
      folder + "/profile --screenshot=" + picture + " file://" + folder + "/" + page + " > " + folder +
      "/browser.txt 2>&1");
  const Image shown = readImage(picture);
  return tries > 1 && isBlank(shown) ? screenshot(folder, page, tries - 1) : shown;
}

/// That the four quarters lie around (x, y), at `step` pixels to either side, with many shades of each.
void expectBoard(const Image& picture, int x, int y, int step)
{
  std::set<std::array<int, 3>> shades;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const int left = x + (quarter % 2 ? step : -step), top = y + (quarter / 2 ? step : -step);
    std::array<double, 3> mean{};
    for (int j = -20; j < 20; ++j)
      for (int i = -20; i < 20; ++i) {
        const std::uint8_t* p = picture.pixel(left + i, top + j);
        shades.insert({p[0], p[1], p[2]});
        for (int c = 0; c < 3; ++c)
          mean[c] += p[c] / 1600.0;
      }
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(mean[c], quarters[quarter][c], 6) << "quarter " << quarter;
  }
  EXPECT_GT(shades.size(), 60U);
}

std::string boardBytes(const std::string& folder)
{
  writeTexturedMesh(folder + "/model.glb", board());
  return readFile(folder + "/model.glb");
}

ViewerOptions before()
{
  const Eigen::Vector3d middle = board().mesh.origin;
  ViewerOptions options;
  options.places = {{"In front", middle + Eigen::Vector3d(0, -3, 0), middle, 60, "Views", {}}};
  return options;
}

#define FRESCO_NEED_CHROMIUM()                                                                                         \
  if (chromium().empty()) {                                                                                            \
    std::cout << "*** SKIPPED: no Chromium (Debian package chromium) ***\n";                                           \
    GTEST_SKIP();                                                                                                      \
  }

TEST(Viewer, ShowsTheModelFromAFile)
{
  FRESCO_NEED_CHROMIUM();
  const std::string folder = scratchFolder();
  writeFile(folder + "/page.html", viewerHtml(boardBytes(folder), before()));
  const Image picture = screenshot(folder, "page.html");
  expectBoard(picture, picture.width / 2, picture.height / 2, 80);
}

/// Folder of node's modules, with `package` in it; "": it cannot be had.
std::string nodeModules(const std::string& package, const std::string& version)
{
  const std::string folder = buildFolder() + "/npm", modules = folder + "/node_modules";
  makeFolder(folder);
  if (!std::filesystem::exists(modules + "/" + package) &&
      run("npm install --no-audit --no-fund --prefix " + folder + " " + package + "@" + version + " > " +
          scratchFolder() + "/npm.txt 2>&1") != 0)
    return "";
  return modules;
}

TEST(Viewer, MouseFingersAndKeys)
{
  FRESCO_NEED_CHROMIUM();
  const std::string folder = scratchFolder(), modules = nodeModules("playwright-core", "1.65.1");
  if (modules.empty()) {
    std::cout << "*** SKIPPED: playwright-core could not be had from npm ***\n";
    GTEST_SKIP();
  }
  ViewerOptions options = before();
  options.places.push_back(options.places[0]);
  const std::vector<std::uint8_t> photograph = encodeImage(Image(40, 30, 3, 90), ".jpg");
  options.places[1].photograph = {photograph.begin(), photograph.end()};
  options.places[1].aspect = 4.0 / 3;
  std::string text;
  for (int k = 0; k < 60; ++k)
    text += "<p>What is said about the model.</p>\n";
  writeFile(folder + "/page.html",
            "<!DOCTYPE html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
            "content=\"width=device-width, initial-scale=1\"><title>Board</title></head>\n<body><div "
            "style=\"height:500px\">" +
                viewerElement(boardBytes(folder), options) + "</div>\n<a href=\"#\">A link</a>" + text +
                "</body></html>\n");
  const std::string script = projectFolder() + "/test/model/use_viewer.js";
  EXPECT_EQ(run("sh -c 'HOME=" + folder + " node " + script + " " + modules + " $(command -v " + chromium() + ") " +
                folder + "/page.html'"),
            0);
}

TEST(Viewer, SaysWhatIsWrongWithAModel)
{
  FRESCO_NEED_CHROMIUM();
  const std::string folder = scratchFolder();
  std::string page = viewerHtml(boardBytes(folder));
  page.insert(page.find("frescoViewer(document"), "bytes.fill(0);");
  writeFile(folder + "/page.html", page);
  EXPECT_EQ(run("env HOME=" + folder + " " + chromium() + " --headless=new --no-sandbox --user-data-dir=" + folder +
                "/profile --virtual-time-budget=5000 --dump-dom file://" + folder + "/page.html > " + folder +
                "/dom.txt 2> /dev/null"),
            0);
  EXPECT_NE(readFile(folder + "/dom.txt").find("no binary glTF"), std::string::npos);
}

TEST(Viewer, ThreeJsReadsTheGlb)
{
  FRESCO_NEED_CHROMIUM();
  const std::string folder = scratchFolder(), modules = nodeModules("three", "0.169.0");
  if (modules.empty()) {
    std::cout << "*** SKIPPED: three.js could not be had from npm ***\n";
    GTEST_SKIP();
  }
  boardBytes(folder);
  writeFile(folder + "/page.html", R"(<!DOCTYPE html><html><body style="margin:0"><script type="importmap">
{"imports": {"three": "MODULES/three/build/three.module.js", "three/addons/": "MODULES/three/examples/jsm/"}}
</script><script type="module">
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
const renderer = new THREE.WebGLRenderer();
renderer.setSize(800, 600);
document.body.append(renderer.domElement);
const camera = new THREE.PerspectiveCamera(60, 800 / 600, 0.1, 100), scene = new THREE.Scene();
const { scene: model } = await new GLTFLoader().loadAsync('model.glb');
model.position.sub(new THREE.Box3().setFromObject(model).getCenter(new THREE.Vector3()));
scene.add(model);
camera.up.set(0, 1, 0);
camera.position.set(0, 0, 3);
camera.lookAt(0, 0, 0);
renderer.setAnimationLoop(() => renderer.render(scene, camera));
</script></body></html>)");
  std::string page = readFile(folder + "/page.html");
  for (std::size_t at; (at = page.find("MODULES")) != std::string::npos;)
    page.replace(at, 7, "file://" + modules);
  writeFile(folder + "/page.html", page);
  const Image picture = screenshot(folder, "page.html");
  expectBoard(picture, picture.width / 2, picture.height / 2, 80);
}

TEST(Viewer, WhatItRefuses)
{
  EXPECT_THROW(viewerHtml("no model"), std::invalid_argument);
  const std::string glb = boardBytes(scratchFolder());
  ViewerOptions options = before();
  options.up.setZero();
  EXPECT_THROW(viewerHtml(glb, options), std::invalid_argument);
  options = before();
  options.places[0].look = options.places[0].eye;
  EXPECT_THROW(viewerHtml(glb, options), std::invalid_argument);
  options = before();
  options.places[0].angle = 0;
  EXPECT_THROW(viewerHtml(glb, options), std::invalid_argument);
}

TEST(Viewer, PhotographsAreInThePage)
{
  const std::string glb = boardBytes(scratchFolder()), bytes = "no picture", mark = "\"photograph\":\"data:image/jpeg;";
  ViewerOptions options = before();
  EXPECT_EQ(viewerHtml(glb, options).find(mark), std::string::npos);
  options.places[0].photograph = bytes;
  options.places[0].aspect = 1.5;
  const std::string page = viewerHtml(glb, options);
  EXPECT_NE(page.find(mark + "base64," + base64(bytes)), std::string::npos);
  EXPECT_NE(page.find("\"aspect\":1.5"), std::string::npos);
}

TEST(Viewer, NamesCannotBreakOutOfThePage)
{
  ViewerOptions options = before();
  options.title = "<b>&\"";
  options.places[0].name = "</script><script>alert(\"1\")";
  const std::string page = viewerHtml(boardBytes(scratchFolder()), options);
  EXPECT_EQ(page.find("</script><script>alert"), std::string::npos);
  EXPECT_NE(page.find("<title>&lt;b&gt;&amp;&quot;</title>"), std::string::npos);
}

TEST(Viewer, Base64)
{
  EXPECT_EQ(base64("M"), "TQ==");
  EXPECT_EQ(base64("Ma"), "TWE=");
  EXPECT_EQ(base64("Man"), "TWFu");
}
} // namespace
} // namespace fresco::test
