// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.h"
#include "call.h"
#include <fresco/core/similarity.h>
namespace fresco::python {
/// Cameras in the frame of scans, and how sure that is.
struct AlignedCameras {
  CameraSet cameras;
  Eigen::Matrix4d T_scans_cameras = Eigen::Matrix4d::Identity();
  CameraAlignmentResult found;
};

template <>
struct Fields<AlignedCameras> {
  static constexpr const char* name = "AlignedCameras";
  static constexpr const char* text = "Cameras in the frame of scans.";
  template <typename Visitor>
  static void visit(Visitor&& visit)
  {
    visit("cameras", &AlignedCameras::cameras, "in the frame of the scans");
    visit("T_scans_cameras", &AlignedCameras::T_scans_cameras, "(4, 4), with its scale: scans from cameras");
    visit("found", &AlignedCameras::found, "how well they fit");
  }
};

namespace {
py::object alignScans(const Call& call)
{
  const auto source = lendPoints(call, "source"), target = lendPoints(call, "target");
  const auto guess = call.value<Eigen::Matrix4d>("guess");
  const auto options = call.options<PointToPlaneOptions>();
  return call.run([&](const Progress& progress) {
    const float voxel = std::max(registrationVoxel(*source), registrationVoxel(*target));
    const auto a = prepareForRegistration(*source, voxel, options.threads);
    const auto b = prepareForRegistration(*target, voxel, options.threads);
    return alignPointToPlane(PreparedPair{*a, *b, guess}, options, progress);
  });
}

py::object alignFolder(const Call& call)
{
  const auto folder = call.value<std::string>("cameras");
  const auto images = call.value<std::optional<std::string>>("images");
  const auto surface = lendPoints(call, "surface");
  auto options = call.options<CameraAlignmentOptions>();
  AlignedCameras aligned;
  SparsePoints points;
  Call::access([&] {
    CameraFile file = readCameraFile(folder, images.value_or(""));
    aligned.cameras = std::move(file.set), points = std::move(file.points);
    return true;
  });
  if (images)
    options.photograph = [&](Index view) {
      const View& of = aligned.cameras.views[view];
      return readImage(*images + "/" + of.image, aligned.cameras.cameras[of.camera]);
    };
  return call.run([&](const Progress& progress) {
    aligned.found = alignCameras(aligned.cameras, points, *surface, options, progress);
    transformCameras(aligned.found.T_scans_cameras, aligned.cameras, points);
    aligned.T_scans_cameras = aligned.found.T_scans_cameras.matrix();
    return aligned;
  });
}

/// Frames that lie in arrays of Python, which stay there.
class FrameArrays {
public:
  FrameArrays(const Call& call, const char* name, const py::dtype& type)
  {
    const std::vector<py::object> entries = toEntries(call[name], name, "array");
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const auto array = py::array::ensure(entries[i]);
      if (!array || !array.dtype().equal(type) || array.ndim() < 2)
        throw py::type_error(concat(name, '[', i, "]: wanted an image of ", std::string(py::str(py::handle(type)))));
      arrays_.push_back(py::array(py::module_::import("numpy").attr("ascontiguousarray")(array)));
      frames_.push_back(
          {arrays_.back().data(), array.shape(0), array.shape(1), array.ndim() == 3 ? array.shape(2) : 1});
    }
  }
  Index count() const { return static_cast<Index>(frames_.size()); }

  /// The pixels, copied; without the GIL.
  template <typename Picture>
  Picture picture(Index frame) const
  {
    const Frame& from = frames_[frame];
    Picture out;
    out.height = static_cast<int>(from.height);
    out.width = static_cast<int>(from.width);
    if constexpr (std::is_same_v<Picture, Image>)
      out.channels = static_cast<int>(from.channels);
    using Value = typename decltype(out.data)::value_type;
    const auto* const first = static_cast<const Value*>(from.data);
    out.data.assign(first, first + from.height * from.width * from.channels);
    return out;
  }

private:
  struct Frame {
    const void* data;
    py::ssize_t height, width, channels;
  };
  std::vector<py::array> arrays_;
  std::vector<Frame> frames_;
};

py::object trackVideo(const Call& call)
{
  RgbdVideo video;
  video.camera = call.value<CameraModel>("camera");
  video.depth_unit = call.value<double>("depth_unit");
  const FrameArrays depths(call, "depths", py::dtype::of<std::uint16_t>());
  const FrameArrays colors(call, "colors", py::dtype::of<std::uint8_t>());
  video.count = depths.count();
  if (colors.count() != 0 && colors.count() != video.count)
    throw py::value_error(concat("depths: ", video.count, ", colors: ", colors.count()));
  video.read = [&](Index frame) {
    RgbdImage image;
    image.depth = depths.picture<Image16>(frame);
    if (colors.count() > 0)
      image.color = colors.picture<Image>(frame);
    return image;
  };
  const auto options = call.options<RgbdTrackingOptions>();
  return call.run([&](const Progress& progress) { return trackRgbd(video, options, progress); });
}
} // namespace

void addPoses(const py::module_& module)
{
  addRecord<PointToPlaneResult>(module);
  addRecord<CameraAlignmentResult>(module);
  addRecord<AlignedCameras>(module);
  addRecord<RgbdTrackingResult>(module);
  const Argument guess{"guess", "ArrayLike", "((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1))"};
  addFunction<PointToPlaneOptions>(
      module,
      {"align_scans",
       "alignPointToPlane",
       {{"source", "PointSet"}, {"target", "PointSet"}, guess},
       "PointToPlaneResult",
       "`guess` is (4, 4), target from source. register_scans() finds places without one."},
      alignScans);
  addFunction<CameraAlignmentOptions>(
      module,
      {"align_cameras",
       "alignCameras",
       {{"cameras", "Path"}, {"surface", "PointSet"}, {"images", "Optional[Path]", "None"}},
       "AlignedCameras",
       "`cameras` is a folder of COLMAP with points3D; `images` that of the photographs: with it they are matched with "
       "the "
       "colours of the surface."},
      alignFolder);
  addFunction<RgbdTrackingOptions>(
      module,
      {"track_rgbd",
       "trackRgbd",
       {{"camera", "CameraModel"},
        {"depths", "Sequence[NDArray[np.uint16]]"},
        {"colors", "Sequence[Bytes]", "()"},
        {"depth_unit", "float", "0.001"}},
       "RgbdTrackingResult",
       "`depths` are uint16, (height, width) of the camera, in units of `depth_unit` metres; "
       "`colors` uint8, (height, width, 3), of any size."},
      trackVideo);
}
} // namespace fresco::python
