// SPDX-License-Identifier: BSD-3-Clause
// Every format of cameras. A new one is a row of the table below and, in docs/inputs.md, a row of the list.
#include "io/cameras/camera_format.h"
#include "io/colmap/colmap_rows.h"
#include "io/files/remarks.h"
#include <algorithm>
#include <filesystem>
#include <fresco/io/colmap.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/listed.h>
#include <fresco/io/natural_order.h>
#include <fresco/io/text_rows.h>
#include <fstream>
namespace fresco {
namespace {
namespace fs = std::filesystem;

/// Of programs that write one file; COLMAP writes a folder.
constexpr io::CameraFormat formats[] = {
    {"Metashape", ".xml", io::isMetashape, io::readMetashape},
    {"Bundler", ".out", io::isBundler, io::readBundler},
    {"NVM", ".nvm", io::isNvm, io::readNvm},
    {"NeRF", ".json", io::isTransforms, io::readTransforms},
    {"OpenMVG", ".json", io::isOpenMvg, io::readOpenMvg},
};

const io::CameraFormat* formatOf(const std::string& file)
{
  std::string head;
  for (const io::CameraFormat& format : formats) {
    if (extension(file) != format.extension)
      continue;
    if (head.empty()) {
      head.resize(4096);
      std::ifstream stream(file, std::ios::binary);
      stream.read(head.data(), std::streamsize(head.size()));
      head.resize(std::size_t(std::max<std::streamsize>(0, stream.gcount())));
    }
    if (format.begins(head))
      return &format;
  }
  return nullptr;
}

/// Files in a folder that are recognised.
std::vector<std::string> recognised(const std::string& folder)
{
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && formatOf(entry.path().string()))
      files.push_back(entry.path().string());
  std::sort(files.begin(), files.end(), isNaturallyBefore);
  return files;
}

bool isPicture(const fs::path& file)
{
  const std::string kind = extension(file.string());
  const char* const kinds[] = {".jpg", ".jpeg", ".png", ".tif", ".tiff", ".bmp", ".webp"};
  return std::any_of(std::begin(kinds), std::end(kinds), [&](const char* each) { return kind == each; });
}
} // namespace

io::CameraFileBuilder::CameraFileBuilder(const std::string& path, std::string images)
    : folder_(fs::absolute(path).parent_path().string()), images_(std::move(images))
{
  if (images_.empty())
    return;
  expect(fs::is_directory(images_), "the folder of its photographs, ", images_, ", is not there");
  for (fs::recursive_directory_iterator entry(images_), end; entry != end; ++entry)
    if (entry->is_directory() && entry->path().filename() == "masks") // which are named as what they mask
      entry.disable_recursion_pending();
    else if (entry->is_regular_file() && isPicture(entry->path()))
      by_stem_.emplace(entry->path().stem().string(), entry->path().lexically_relative(images_).string());
}

std::string io::CameraFileBuilder::nameBelow(const std::string& told) const
{
  std::string name = told;
  std::replace(name.begin(), name.end(), '\\', '/'); // of Windows
  std::string place = fs::path(name).lexically_normal().relative_path().string();
  if (const std::size_t up = place.rfind("../"); up != std::string::npos)
    place.erase(0, up + 3);
  if (images_.empty())
    return fs::path(name).is_absolute() ? fs::path(name).filename().string() : place;
  for (std::string rest = place;; rest.erase(0, rest.find('/') + 1)) {
    if (!rest.empty() && fs::is_regular_file(images_ + "/" + rest))
      return rest;
    if (rest.find('/') == std::string::npos)
      break;
  }
  const fs::path last = fs::path(place).filename();
  for (const std::string& stem : {last.string(), last.stem().string()}) // names may have come without an extension
    if (const auto [first, end] = by_stem_.equal_range(stem); first != end) {
      if (std::next(first) != end)
        throw std::runtime_error(concat("photograph ", told, " may be ", first->second, " or ",
                                        std::next(first)->second, " of ", images_, ": move one of them elsewhere"));
      return first->second;
    }
  throw std::runtime_error(concat("names ", told, ", but there is no such photograph in ", images_,
                                  ": copy it there, or export the cameras again without it"));
}

CameraModel io::CameraFileBuilder::cameraOf(const std::string& photograph) const
{
  expect(!images_.empty(), "does not tell how large the photographs are: their folder is needed (-images)");
  const ImageSize size = readImageSize(images_ + "/" + nameBelow(photograph));
  CameraModel camera{size.width, size.height};
  camera.cx = 0.5 * size.width, camera.cy = 0.5 * size.height;
  return camera;
}

int io::CameraFileBuilder::addView(const std::string& photograph, const CameraModel& camera,
                                   const Eigen::Matrix4d& T_camera_world)
{
  const Pose T = rigidPose("photograph " + photograph, T_camera_world);
  expect(T.has_value(), "photograph ", photograph, ": its pose is not finite");
  namingFile("photograph " + photograph, [&] { validateCamera(camera); });
  View view;
  view.image = nameBelow(photograph);
  view.camera = int(file_.set.cameras.size());
  view.T_camera_world = Eigen::Isometry3d(*T);
  file_.set.cameras.push_back(camera);
  file_.set.views.push_back(view);
  return int(file_.set.views.size()) - 1;
}

void io::CameraFileBuilder::addPoint(const Eigen::Vector3d& position, const Eigen::Vector3d& color,
                                     const std::vector<Observation>& track)
{
  expect(isInReach(position), "a point is not finite or too far away");
  SparsePoint point;
  point.position = position;
  point.color = color.array().isFinite().select(color.array(), 0).max(0).min(255).cast<std::uint8_t>();
  point.error = -1;
  point.track = track;
  file_.points.push_back(std::move(point));
}

Eigen::Vector2d io::CameraFileBuilder::middleOf(int view) const
{
  return 0.5 * Eigen::Vector2d(file_.set.cameras[view].width, file_.set.cameras[view].height);
}

CameraFile io::CameraFileBuilder::take()
{
  expect(!file_.set.views.empty(),
         "no photograph in it has a pose: align the photographs first, then export their cameras");
  return std::move(file_);
}

std::string cameraFileIn(const std::string& path)
{
  if (!fs::is_directory(path))
    return formatOf(path) ? path : "";
  if (!io::colmapKind(path).empty())
    return path;
  const std::vector<std::string> files = recognised(path);
  return files.size() == 1 ? files[0] : "";
}

CameraFile readCameraFile(const std::string& path, const std::string& images)
{
  const std::string file = cameraFileIn(path);
  if (file.empty() && fs::is_directory(path)) {
    const std::vector<std::string> files = recognised(path);
    throw std::runtime_error(path + (files.empty() ? ": no cameras in it that are read: " + cameraFormats()
                                                   : ": several files of cameras: say which: " + listed(files, 3)));
  }
  expect(!file.empty() || fs::exists(path), path, ": no such file or folder of cameras");
  expect(!file.empty(), path, ": no cameras that are read: ", cameraFormats());
  if (fs::is_directory(file)) {
    CameraFile found{readColmap(file), readColmapPoints(file)};
    for (const View& view : found.set.views)
      expect(images.empty() || fs::exists(images + "/" + view.image), images, "/", view.image,
             ": no such photograph, but ", file, " names it");
    return found;
  }
  const std::string content = readFile(file);
  return io::namingFile(file, [&] {
    io::CameraFileBuilder cameras(file, images);
    formatOf(file)->read(content, cameras);
    return cameras.take();
  });
}

std::string cameraFormats()
{
  std::string text = "COLMAP (folder)";
  for (const io::CameraFormat& format : formats)
    text += std::string(", ") + format.name + " (" + format.extension + ")";
  return text;
}
} // namespace fresco
