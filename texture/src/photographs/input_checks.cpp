// SPDX-License-Identifier: BSD-3-Clause
#include "photographs/input_checks.h"
#include "photographs/projector.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fresco/core/machine_memory.h>
#include <fresco/core/parallel.h>
#include <fresco/core/poses.h>
#include <fresco/core/require.h>
#include <fstream>
#include <iomanip>
#include <numeric>
namespace fresco::texture {
namespace {
void validateView(const TextureView& view, std::size_t index)
{
  const std::string name = view.path.empty() ? concat("view ", index) : view.path;
  const CameraModel& c = view.camera;
  require(c.width >= 3 && c.height >= 3 && c.width <= 65535 && c.height <= 65535, "texture: ", name, ": camera of ",
          c.width, "x", c.height, " pixels");
  try {
    validateCamera(c);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(concat("texture: ", name, ": ", error.what()));
  }
  require(c.projection != CameraProjection::spherical || c.width == 2 * c.height, "texture: ", name, ": a panorama of ",
          c.width, "x", c.height, " pixels is not twice as wide as high");
  require(isRigid(view.T_camera_world.matrix(), 1e-3), "texture: ", name,
          ": the pose is not finite or no rigid motion");
  require(!view.image.empty() || !view.path.empty(), "texture: ", name, ": neither an image nor a path");
}

/// Bytes of a TIFF block in either byte order; 0 beyond its end.
class Tiff {
public:
  explicit Tiff(std::vector<std::uint8_t> bytes) : bytes_(std::move(bytes)), low_first_(byte(0) == 'I') {}
  std::uint32_t number(std::size_t at, int length) const
  {
    std::uint32_t value = 0;
    for (int i = 0; i < length; ++i)
      value |= byte(at + i) << 8 * (low_first_ ? i : length - 1 - i);
    return value;
  }

private:
  std::uint32_t byte(std::size_t at) const { return at < bytes_.size() ? bytes_[at] : 0U; }
  std::vector<std::uint8_t> bytes_;
  bool low_first_;
};

int orientationIn(const Tiff& tiff)
{
  const std::size_t table = tiff.number(4, 4);
  const std::uint32_t entries = std::min(tiff.number(table, 2), 512U);
  for (std::uint32_t i = 0; i < entries; ++i)
    if (const std::size_t entry = table + 2 + 12 * i; tiff.number(entry, 2) == 274) {
      const int value = tiff.number(entry + 8, 2);
      return value >= 1 && value <= 8 ? value : 1;
    }
  return 1;
}

void warnOfRotations(const std::vector<ViewPart>& parts, TextureResult& result)
{
  std::string first;
  Index count = 0;
  for (const ViewPart& part : parts)
    if (part.given->image.empty() && part.R_part_view.isIdentity(0) && exifOrientation(part.given->path) != 1 &&
        count++ == 0)
      first = part.given->path;
  if (count > 0)
    result.warnings.push_back(
        concat(first, count > 1 ? concat(" and ", count - 1, " more carry") : " carries",
               " an EXIF rotation, which is ignored: cameras belong to pixels as they are stored"));
}

/// Places inside of the faces, some thousands.
Points placesOf(const TriangleMesh& mesh)
{
  const Index stride = std::max<Index>(1, mesh.faceCount() / median_samples),
              rows = std::ceil(std::sqrt(2.0 * median_samples / mesh.faceCount()));
  std::vector<Eigen::Vector3f> places;
  for (Index f = 0; f < mesh.faceCount(); f += stride)
    for (Index i = 0; i < rows; ++i)
      for (Index j = 0; i + j < rows; ++j) {
        const Eigen::Vector2f at = Eigen::Vector2f(i + 1 / 3.f, j + 1 / 3.f) / rows;
        places.push_back((1 - at.sum()) * mesh.vertices.col(mesh.faces(0, f)) +
                         at[0] * mesh.vertices.col(mesh.faces(1, f)) + at[1] * mesh.vertices.col(mesh.faces(2, f)));
      }
  return Eigen::Map<const Points>(places[0].data(), 3, places.size());
}

/// Of the places that the view has before it, the share where the mask is 0.
double shareHidden(const Points& places, const Projector& view, const Image& mask)
{
  Index all = 0, hidden = 0;
  for (Index i = 0; i < places.cols(); ++i)
    if (const Eigen::Vector3f p = view(places.col(i));
        p.z() > 0 && p.x() >= 0 && p.y() >= 0 && p.x() < mask.width && p.y() < mask.height) {
      ++all;
      hidden += *mask.pixel(static_cast<int>(p.x()), static_cast<int>(p.y())) == 0;
    }
  return all > 0 ? 1.0 * hidden / all : 0;
}

std::string nameOf(const ViewPart& part)
{
  return part.given->path.empty() ? concat("photograph ", part.view) : part.given->path;
}

void warnOfPixels(const std::vector<ViewPart>& parts, TextureResult& result)
{
  const auto blank = [&](int view) {
    constexpr double few = 0.01; // outlines that are off by a pixel
    const double share = result.blank[view];
    return share > few ? concat(" (", std::fixed, std::setprecision(1), 100 * share, " %)") : "";
  };
  const auto fringed = [&](int view) {
    return result.fringes[view] > 0 ? concat(" (", result.fringes[view], " pixels)") : "";
  };
  const std::string none =
      " pixels that are no picture before the surface, of a border of one value or transparent: not used";
  const std::string violet = " a violet fringe beside what is overexposed: its colour is not used";
  warnOf(parts, blank, {"", " has" + none, " have" + none}, result);
  warnOf(parts, fringed, {"", " has" + violet, " have" + violet}, result);
}
} // namespace

void warnOf(const std::vector<ViewPart>& parts, const std::function<std::string(int)>& shown,
            const std::array<std::string, 3>& what, TextureResult& result)
{
  constexpr Index named = 3; // the others are in the result
  Index count = 0;
  std::string names;
  for (const ViewPart& part : parts)
    if (const std::string its = shown(part.view); part.R_part_view.isIdentity(0) && !its.empty() && count++ < named)
      names += concat(count > 1 ? ", " : "", nameOf(part), its);
  if (count > named)
    names += concat(" and ", count - named, " more");
  if (count > 0)
    result.warnings.push_back(what[0] + names + what[count > 1 ? 2 : 1]);
}

void validate(const TriangleMesh& mesh, const std::vector<TextureView>& views, const TextureOptions& options)
{
  validateMesh(mesh);
  require(mesh.faceCount() > 0 && surfaceArea(mesh) > 0, "texture: the mesh has no face of positive area");
  require(mesh.vertexCount() < (1 << 29) && mesh.faceCount() < (1 << 29), "texture: the mesh is too large");
  require(options.texel >= 0 && std::isfinite(options.texel), "texture: texel ", options.texel,
          " is negative or not finite");
  require(options.atlas == 0 || (options.atlas >= 128 && options.atlas <= 16384), "texture: atlas ", options.atlas,
          " is neither 0 nor in 128..16384");
  require(options.border >= 1 && options.border <= 16, "texture: border ", options.border, " is not in 1..16");
  require(options.smoothness >= 0 && std::isfinite(options.smoothness), "texture: smoothness ", options.smoothness,
          " is negative or not finite");
  require(options.margin >= 0 && options.margin <= 100, "texture: margin ", options.margin, " is not in 0..100");
  require(options.depth_tolerance >= 0 && options.depth_tolerance <= 0.5, "texture: depth tolerance ",
          options.depth_tolerance, " is not in 0..0.5");
  require(options.blend_width >= 0 && options.blend_width <= 100, "texture: blend width ", options.blend_width,
          " is not in 0..100");
  require(options.rounds >= 0 && options.rounds <= 100, "texture: rounds ", options.rounds, " is not in 0..100");
  require(options.tile_faces >= 0, "texture: ", options.tile_faces, " faces of a tile");
  require(options.memory >= 1, "texture: memory ", options.memory, " MB is below 1");
  for (std::size_t v = 0; v < views.size(); ++v)
    validateView(views[v], v);
}

Index tileFaces(Index faces, int asked, const MemoryNeed& need)
{
  constexpr std::size_t least = 100'000, usual = 1'000'000; // faces of a tile that memory asks for
  constexpr std::size_t surroundings = 2;                   // a tile takes with what lies around it so much more
  constexpr std::size_t megabyte = 1'000'000;
  const std::size_t there = machineMemory(), count = faces;
  if (asked > 0)
    return std::min<Index>(faces, asked);
  if (need.fixed + count * need.face_at_once <= there)
    return faces;
  const std::size_t kept = need.fixed + need.fixed_of_tiles + count * need.face_of_tiles,
                    tile_face = surroundings * need.face_at_once;
  if (kept + least * tile_face > there)
    throw std::runtime_error(concat("texture: ", faces, " faces take at least ", (kept + least * tile_face) / megabyte,
                                    " MB of memory, there are ", there / megabyte,
                                    "; a mesh of larger cells takes less"));
  constexpr std::size_t share = 2; // of the rest, for photographs, atlases and other programs
  return std::clamp((there - kept) / share / tile_face, least, usual);
}

void weld(TextureResult& result)
{
  TriangleMesh& mesh = result.model.mesh;
  const Faces faces = weldedFaces(mesh);
  const auto vertices = [&](const Faces& f) {
    std::vector<char> used(mesh.vertexCount(), 0);
    for (Index i = 0; i < f.size(); ++i)
      used[f.data()[i]] = 1;
    return std::count(used.begin(), used.end(), 1);
  };
  constexpr double hardly = 0.5; // vertices left: an unwelded closed mesh has a sixth, one cut along creases nearly all
  const auto before = vertices(mesh.faces), after = vertices(faces);
  if (after < hardly * before)
    result.warnings.push_back(concat("faces do not share their corners: ", before, " vertices stand at ", after,
                                     " places; they are taken as joined there"));
  mesh.faces = faces;
}

std::vector<Index> firstFaces(const Faces& faces)
{
  const auto key = [&](Index f) {
    std::array<int, 3> corners{faces(0, f), faces(1, f), faces(2, f)};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    return corners;
  };
  std::vector<Index> order(faces.cols()), kept;
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return std::make_pair(key(a), a) < std::make_pair(key(b), b); });
  for (std::size_t i = 0; i < order.size(); ++i)
    if (i == 0 || key(order[i]) != key(order[i - 1]))
      kept.push_back(order[i]);
  std::sort(kept.begin(), kept.end());
  return kept;
}

std::string duplicatesWarning(Index count)
{
  return concat(count, " faces are there twice; the second ones are left out");
}

TexturedMesh withoutDuplicates(const TexturedMesh& model, TextureResult& result)
{
  const std::vector<Index> kept = firstFaces(weldedFaces(model.mesh));
  if (Index(kept.size()) == model.mesh.faceCount())
    return model;
  result.warnings.push_back(duplicatesWarning(model.mesh.faceCount() - kept.size()));
  TexturedMesh out = model;
  out.mesh.faces = model.mesh.faces(Eigen::all, kept);
  if (model.texcoord_faces.cols() > 0) {
    out.texcoord_faces = model.texcoord_faces(Eigen::all, kept);
    out.face_atlas = model.face_atlas(kept);
  }
  return out;
}

namespace {
constexpr double other_scale = 100; // of cameras and mesh: units rather than a far or a narrow view

struct Boxes {
  Eigen::AlignedBox3d cameras, surface;

  /// Size of the surface by that of the cameras' places; 0 of a single camera.
  double scale() const
  {
    const double size = cameras.diagonal().norm();
    return size > 0 ? surface.diagonal().norm() / size : 0;
  }
};

Boxes boxesOf(const TriangleMesh& mesh, const std::vector<TextureView>& views)
{
  Boxes out;
  for (const TextureView& view : views)
    out.cameras.extend(Eigen::Vector3d(view.T_camera_world.inverse().translation()));
  for (Index i = 0; i < mesh.faces.size(); ++i)
    out.surface.extend(mesh.origin + mesh.vertices.col(mesh.faces.data()[i]).cast<double>());
  return out;
}
} // namespace

bool sameUnits(const TriangleMesh& mesh, const std::vector<TextureView>& views)
{
  const double scale = views.empty() ? 0 : boxesOf(mesh, views).scale();
  return scale == 0 || (scale < other_scale && scale > 1 / other_scale);
}

void warnOfLittleSeen(double seen, const std::vector<TextureView>& views, TextureResult& result)
{
  constexpr double little = 0.3; // a room that is photographed from its middle is seen by half
  if (seen >= little || views.empty())
    return;
  const Boxes boxes = boxesOf(result.model.mesh, views);
  const double scale = boxes.scale();
  const char* cause = "do the cameras' poses belong to this mesh?";
  if (scale > other_scale)
    cause = "is the mesh in millimetres and are the cameras in metres?";
  else if (scale > 0 && scale < 1 / other_scale)
    cause = "is the mesh in metres and are the cameras in millimetres?";
  else if (boxes.surface.exteriorDistance(boxes.cameras.center()) == 0)
    cause = "are the mesh's faces turned to the cameras?";
  result.warnings.push_back(
      concat("only ", std::fixed, std::setprecision(1), 100 * seen, " % of the surface is seen: ", cause));
}

int exifOrientation(const std::string& path)
{
  if (!std::filesystem::is_regular_file(path)) // reading the photograph says what is wrong
    return 1;
  std::ifstream file(path, std::ios::binary);
  const auto next = [&] { return file.get() & 255U; };
  if (next() != 0xFF || next() != 0xD8)
    return 1;
  while (file && next() == 0xFF) {
    const unsigned marker = next();
    const unsigned high = next(), length = high << 8 | next();
    if (!file || marker == 0xDA || length < 2) // the picture itself begins
      return 1;
    std::vector<std::uint8_t> block(length - 2);
    if (marker != 0xE1) {
      file.seekg(block.size(), std::ios::cur);
      continue;
    }
    file.read(reinterpret_cast<char*>(block.data()), block.size());
    const std::string name = "Exif";
    if (file && block.size() > 14 && std::equal(name.begin(), name.end(), block.begin()))
      return orientationIn(Tiff({block.begin() + 6, block.end()}));
  }
  return 1;
}

void checkPhotos(PhotoStore& photos, const std::vector<ViewPart>& parts, const TextureOptions& options,
                 TextureResult& result)
{
  const TriangleMesh& mesh = result.model.mesh;
  const Points places = placesOf(mesh);
  std::vector<double> blank(parts.size(), 0);
  std::vector<int> fringes(parts.size());
  const auto read = [&](Index v) {
    photos.mask(v);
    if (const auto used = photos.unblank(v); !used->empty() && !parts[v].ofPanorama())
      blank[v] = shareHidden(places, {parts[v].camera, parts[v].given->T_camera_world, mesh.origin}, *used);
    fringes[v] = photos.fringe(v);
  };
  parallelFor(parts.size(), options.threads, read, 1);
  result.blank.resize(parts.empty() ? 0 : parts.back().view + 1);
  result.fringes.resize(result.blank.size());
  for (std::size_t v = 0; v < parts.size(); ++v) {
    result.blank[parts[v].view] = blank[v];
    result.fringes[parts[v].view] = fringes[v];
  }
  warnOfRotations(parts, result);
  warnOfPixels(parts, result);
}
} // namespace fresco::texture
