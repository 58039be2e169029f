// SPDX-License-Identifier: BSD-3-Clause
#include "targets.h"
#include "common/io/e57_file.h"
#include "input/model_input.h"
#include "job/stage_log.h"
#include "layouts.h"
#include "support/args.h"
#include <algorithm>
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/io/camera_files.h>
#include <fresco/io/cloud_file.h>
#include <fresco/io/colmap.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <fresco/io/pose_file.h>
#include <fresco/io/scan_file.h>
#include <fresco/io/scan_images.h>
#include <fstream>
using namespace fresco::model;
namespace fresco::fuzz {
namespace {
namespace fs = std::filesystem;
using Bytes = std::string_view;

void store(const std::string& path, Bytes bytes)
{
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

void expect(bool ok, const std::string& what)
{
  if (!ok)
    throw std::logic_error(what);
}

/// Runs `read`; its errors must be those that the readers promise.
void readChecked(const std::string& folder, const std::function<void()>& read)
try {
  read();
} catch (const std::runtime_error& error) {
  const std::string text = error.what();
  expect(text.find('\n') == std::string::npos, "an error of several lines: " + text);
  expect(text.find(folder) != std::string::npos, "an error that names no file: " + text);
}

void checkMesh(const TriangleMesh& mesh)
{
  expect(mesh.vertexCount() > 0, "a mesh without vertices");
  expect(mesh.faceCount() == 0 || (mesh.faces.minCoeff() >= 0 && mesh.faces.maxCoeff() < mesh.vertexCount()),
         "a face of vertices that are not there");
  for (const Index count : {mesh.normals.cols(), mesh.colors.cols()})
    expect(count == 0 || count == mesh.vertexCount(), "an attribute without or with too many values");
  for (const auto& [name, values] : mesh.fields)
    expect(values.size() == mesh.vertexCount(), "a field without or with too many values");
  expect(mesh.origin.allFinite(), "an origin that is not finite");
}

void checkModel(const TexturedMesh& model)
{
  checkMesh(model.mesh);
  const Index faces = model.mesh.faceCount();
  expect(model.face_atlas.size() == faces && model.texcoord_faces.cols() == faces, "faces without texture indices");
  for (Index f = 0; f < faces; ++f) {
    expect(model.face_atlas[f] < static_cast<int>(model.atlases.size()), "an atlas that is not there");
    for (int k = 0; k < 3; ++k)
      expect(model.texcoord_faces(k, f) < model.texcoords.cols(), "a texture coordinate that is not there");
  }
}

void readPointsAndCloud(const std::string& path)
{
  const PointSet set = readPoints(path);
  expect(set.size() > 0 && set.origin.allFinite(), "no point, or an origin that is not finite");
  validatePointSet(set);
  expect(toPointSet(readCloud(path)).size() == set.size(), "a cloud and its points differ in size");
}

/// Every scan of a file of several, whole and in windows.
void readScans(const std::string& path)
{
  std::vector<ScanPath> scans = scansOf({path});
  scans.resize(std::min<std::size_t>(scans.size(), 8)); // an E57 is opened anew for each
  for (const ScanPath& scan : scans) {
    const PointSet set = readPoints(scan);
    validatePointSet(set);
    Index streamed = 0;
    streamPoints(scan, 100, [&](const PointSet& window) {
      expect(window.size() > 0 && window.size() <= 100, "a window of a wrong size");
      streamed += window.size();
      return true;
    });
    expect(streamed <= set.size(), "windows have more points than the scan"); // an organised one has empty places
  }
}

/// The bytes without checksums, which get theirs here: otherwise hardly any input would come past them.
void readE57(Bytes bytes, const std::string& folder)
{
  const std::string path = folder + "/input.e57";
  std::string logical(bytes);
  logical.resize((logical.size() + 1019) / 1020 * 1020);
  if (logical.size() >= 24)
    logical.replace(16, 8, test::e57::raw(std::uint64_t{logical.size() / 1020 * 1024}));
  store(path, test::e57::File::withChecksums(logical));
  readChecked(folder, [&] { readPointsAndCloud(path); });
  readChecked(folder, [&] { readScans(path); });
  readChecked(folder, [&] {
    const std::size_t images = readScanImages(path).size();
    for (std::size_t i = 0; i < images; ++i)
      expect(!readScanImageBytes(path, static_cast<Index>(i)).empty(), "an empty picture");
  });
}

/// One file of the given type.
Target fileTarget(const std::string& name, std::vector<std::function<void(const std::string&)>> readers)
{
  return {name, [name, readers = std::move(readers)](Bytes bytes, const std::string& folder) {
            const std::string path = folder + "/input." + name;
            store(path, bytes);
            for (const auto& read : readers)
              readChecked(folder, [&] { read(path); });
          }};
}

const auto as_points = [](const std::string& path) { readPointsAndCloud(path); };
const auto as_scans = [](const std::string& path) { readScans(path); };
const auto as_mesh = [](const std::string& path) { checkMesh(readMesh(path)); };
const auto as_model = [](const std::string& path) { checkModel(readTexturedMesh(path)); };

/// Part one: OBJ, part two: the material library input.mtl.
void readObj(Bytes bytes, const std::string& folder)
{
  const std::string path = folder + "/input.obj";
  store(path, takePart(bytes));
  store(folder + "/input.mtl", bytes);
  for (const auto& read :
       {std::function<void()>([&] { as_points(path); }), std::function<void()>([&] { as_mesh(path); }),
        std::function<void()>([&] { as_model(path); })})
    readChecked(folder, read);
}

void checkViews(const CameraSet& set)
{
  for (const View& view : set.views) {
    expect(view.camera >= 0 && view.camera < static_cast<int>(set.cameras.size()), "a camera that is not there");
    expect(view.T_camera_world.matrix().allFinite(), "a pose that is not finite");
  }
  for (const CameraModel& camera : set.cameras) {
    validateCamera(camera);
    if (camera.hasDistortion())
      unproject(camera, {0.3 * camera.width, 0.7 * camera.height});
  }
}

void checkTracks(const SparsePoints& points, std::size_t views)
{
  for (const SparsePoint& point : points) {
    expect(point.position.allFinite() && std::isfinite(point.error), "a point that is not finite");
    for (const Observation& seen : point.track)
      expect(seen.view >= 0 && std::size_t(seen.view) < views, "a view that is not there");
  }
}

/// Part one: cameras, part two: images.
void readColmapModel(Bytes bytes, const std::string& folder, const std::string& kind)
{
  store(folder + "/cameras" + kind, takePart(bytes));
  store(folder + "/images" + kind, bytes);
  readChecked(folder, [&] { checkViews(readColmap(folder)); });
}

/// Part one: the extension, part two: the cameras of photographs a.jpg and b.jpg.
void readCameras(Bytes bytes, const std::string& folder)
{
  const std::string extension(takePart(bytes)), images = folder + "/images";
  const char* const known[] = {".xml", ".out", ".nvm", ".json"};
  if (std::find(std::begin(known), std::end(known), extension) == std::end(known))
    return;
  if (!fs::exists(images + "/b.jpg")) {
    makeFolder(images);
    for (const char* name : {"a.jpg", "b.jpg"})
      writeImage(images + "/" + name, Image(64, 48));
    store(folder + "/list.txt", "a.jpg\nb.jpg\n");
  }
  const std::string path = folder + "/cameras" + extension;
  store(path, bytes);
  for (const std::string& photographs : {images, std::string()})
    readChecked(folder, [&] {
      const CameraFile file = readCameraFile(path, photographs);
      checkViews(file.set);
      checkTracks(file.points, file.set.views.size());
    });
}

/// Part one: images, part two: points3D.
void readColmapTracks(Bytes bytes, const std::string& folder, const std::string& kind)
{
  const std::string camera = test::e57::raw(std::uint64_t{1}) + test::e57::raw(std::uint32_t{1}) +
                             test::e57::raw(std::int32_t{0}) + test::e57::raw(std::uint64_t{64}) +
                             test::e57::raw(std::uint64_t{48}) + test::e57::raw(60.) + test::e57::raw(32.) +
                             test::e57::raw(24.);
  for (const char* other : {".txt", ".bin"}) // of which only one kind may be there
    for (const char* name : {"/cameras", "/images", "/points3D"})
      fs::remove(folder + name + other);
  store(folder + "/cameras" + kind, kind == ".txt" ? "1 SIMPLE_PINHOLE 64 48 60 32 24\n" : camera);
  store(folder + "/images" + kind, takePart(bytes));
  store(folder + "/points3D" + kind, bytes);
  readChecked(folder, [&] {
    const std::size_t views = readColmap(folder).views.size();
    checkTracks(readColmapPoints(folder), views);
  });
}

/// A photograph, mask or depth image.
void readPicture(Bytes bytes, const std::string& folder)
{
  const std::string path = folder + "/picture";
  store(path, bytes);
  readChecked(folder, [&] {
    const ImageSize size = readImageSize(path);
    const Image image = readImage(path);
    expect(image.width == size.width && image.height == size.height && image.channels == 3 &&
               image.data.size() == std::size_t{3} * image.width * image.height,
           "a picture of another size than its header tells");
  });
  readChecked(folder, [&] {
    const Image16 image = readDepthFile(path).image;
    expect(image.data.size() == std::size_t{1} * image.width * image.height, "a depth image without some pixels");
  });
}

void readPoseFile(Bytes bytes, const std::string& folder)
{
  const std::string path = folder + "/poses.txt";
  store(path, bytes);
  readChecked(folder, [&] {
    const std::vector<Pose> poses = readPoses(path);
    for (const Pose& pose : poses)
      expect(!pose || (pose->allFinite() && std::abs(pose->topLeftCorner<3, 3>().determinant() - 1) < 0.1), "no pose");
    writePoses(path, poses);
    expect(readPoses(path).size() == poses.size(), "poses are lost on the way through a file");
  });
}

/// Part one: camera matrix, part two: pose of the first frame, part three: its depth image.
void readRgbd(Bytes bytes, const std::string& folder)
{
  store(folder + "/camera-intrinsics.txt", takePart(bytes));
  store(folder + "/frame-000000.pose.txt", takePart(bytes));
  writeImage(folder + "/frame-000000.color.jpg", Image(64, 48));
  store(folder + "/frame-000000.depth.png", bytes);
  readChecked(folder, [&] {
    const RgbdFolder room = *readModelInput(folder).rgbd;
    expect(room.camera.fx > 0 && room.camera.fy > 0 && !room.frames.empty(), "no camera or no frame");
    readDepth(room, 0);
  });
}

void checkFrames(const RgbdFolder& room)
{
  validateCamera(room.camera);
  for (const RgbdFrame& frame : room.frames) {
    validateCamera(frame.color_camera);
    expect(frame.T_world_camera.matrix().allFinite(), "a pose that is not finite");
  }
  expect(!room.frames.empty(), "no frame");
}

/// A folder for fresco_model, see layouts.h.
void readLayout(Bytes bytes, const std::string& folder)
{
  const std::string path = folder + "/layout";
  fs::remove_all(path);
  makeFolder(path);
  writeFolder(bytes, path);
  readChecked(path, [&] {
    const ModelInput input = readModelInput(path);
    expect(!input.scans.empty() || input.rgbd || input.hasPictures() || !input.video.empty(), "nothing");
    for (const CameraModel& camera : input.cameras.cameras)
      validateCamera(camera);
    for (const View& view : input.cameras.views)
      expect(view.T_camera_world.matrix().allFinite(), "a pose that is not finite");
    for (const Pose& pose : input.poses)
      expect(!pose || pose->allFinite(), "a pose that is not finite");
    for (const Panorama& panorama : input.panoramas)
      expect(std::size_t(panorama.scan) < input.scans.size(), "a panorama of no scan");
    for (const std::string& file : input.files())
      expect(fs::is_regular_file(file), "a file that is not there: " + file);
    if (input.rgbd)
      checkFrames(*input.rgbd);
    for (std::size_t f = 0; input.rgbd && f < input.rgbd->frames.size(); ++f)
      readDepth(*input.rgbd, Index(f));
  });
}

/// The record of a stage that an earlier run left.
void readStageLog(Bytes bytes, const std::string& folder)
{
  makeFolder(folder + "/work");
  store(folder + "/work/stage.json", bytes);
  readChecked(folder, [&] {
    StageLog log(folder + "/work", {"input"}, true, {});
    log.run({"stage", "options", {}, [](const Progress&) { return nlohmann::ordered_json{{"answer", 42}}; }});
    expect(log.records().size() == 1, "a stage without a record");
    log.records()[0].figures.dump();
  });
}

/// One word of the command line per line.
void parseArgs(Bytes bytes, const std::string&)
{
  int n = 1, width = 4, height = 3;
  float f = 1;
  double d = 1;
  std::string text;
  bool on = false;
  Args args("fresco_x IN OUT [options]", "Does things.");
  args.option("n", n, Range::any(), "whole number");
  args.option("f", f, Range::above(0).atMost(1), "number");
  args.option("d", d, Range::within(-2.5, 1e8).zero("none"), "number");
  args.option("text", text, "words");
  args.flag("on", on, "switch");
  args.size("size", width, height, Range::within(1, 65536), "of a picture");
  args.numbers("xyz", "X Y Z", Range::any(), "numbers", [&](const auto& given) { d = given[2]; });
  std::vector<std::string> words{"fresco_x"};
  for (std::size_t at = 0; at < bytes.size() && words.size() < 100;) {
    const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
    words.push_back(std::string(bytes.substr(at, end - at)).c_str()); // arguments end at their first zero
    at = end + 1;
  }
  std::vector<char*> pointers;
  for (std::string& word : words)
    pointers.push_back(word.data());
  try {
    const auto files = args.parse(static_cast<int>(pointers.size()), pointers.data(), 1, 3);
    expect(!files.empty() && files.size() <= 3, "too many or too few files");
    expect(f > 0 && f <= 1 && std::isfinite(d), "a number out of its range");
    expect(width > 0 && height > 0, "a picture without pixels");
    requireDistinct({files.back(), text}, {files.begin(), files.end() - 1});
    expect(files.size() < 2 || files[0].empty() || files[0] != files.back(), "an output that is an input");
  } catch (const UsageError&) {
  } catch (const HelpShown&) {
  }
}
} // namespace

std::string_view takePart(std::string_view& bytes)
{
  const std::size_t end = bytes.find(separator);
  const std::string_view part = bytes.substr(0, end);
  bytes.remove_prefix(end == std::string_view::npos ? bytes.size() : end + separator.size());
  return part;
}

const std::vector<Target>& targets()
{
  static const std::vector<Target> all = {
      fileTarget("ply", {as_points, as_mesh, as_model}),
      fileTarget("pcd", {as_points}),
      fileTarget("vtk", {as_points, as_mesh}),
      fileTarget("stl", {as_points, as_mesh}),
      fileTarget("xyz", {as_points}),
      fileTarget("ptx", {as_points, as_scans}),
      fileTarget("pts", {as_points, as_scans}),
      fileTarget("las", {as_points, as_scans}),
      {"e57", readE57},
      fileTarget("glb", {as_model}),
      {"obj", readObj},
      {"colmap_text", [](Bytes bytes, const std::string& folder) { readColmapModel(bytes, folder, ".txt"); }},
      {"colmap_binary", [](Bytes bytes, const std::string& folder) { readColmapModel(bytes, folder, ".bin"); }},
      {"points3d_text", [](Bytes bytes, const std::string& folder) { readColmapTracks(bytes, folder, ".txt"); }},
      {"points3d_binary", [](Bytes bytes, const std::string& folder) { readColmapTracks(bytes, folder, ".bin"); }},
      {"cameras", readCameras},
      {"picture", readPicture},
      {"poses", readPoseFile},
      {"rgbd", readRgbd},
      {"layout", readLayout},
      {"stage_log", readStageLog},
      {"args", parseArgs},
  };
  return all;
}

const Target& findTarget(const std::string& name)
{
  for (const Target& target : targets())
    if (target.name == name)
      return target;
  throw std::invalid_argument("no fuzz target '" + name + "'");
}
} // namespace fresco::fuzz
