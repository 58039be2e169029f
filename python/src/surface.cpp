// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.h"
#include "call.h"
namespace fresco::python {
namespace {
void addReconstruction(const py::module_& module)
{
  addRecord<VolumetricResult>(module);
  addFunction<VolumetricOptions>(
      module, {"reconstruct", "reconstructVolumetric", {{"points", "PointSet"}}, "VolumetricResult"},
      [](const Call& call) {
        const auto set = lendPoints(call);
        const auto options = call.options<VolumetricOptions>();
        return call.run([&](const Progress& progress) { return reconstructVolumetric(*set, options, progress); });
      });
}

void addOptimization(const py::module_& module)
{
  addRecord<NormalFilteringResult>(module);
  addRecord<NormalFilteringStep>(module);
  addFunction<NormalFilteringOptions>(
      module,
      {"optimize", "filterSurface", {{"mesh", "TriangleMesh"}, {"points", "PointSet"}}, "NormalFilteringResult"},
      [](const Call& call) {
        const auto mesh = lendMesh(call);
        const auto set = lendPoints(call);
        const auto options = call.options<NormalFilteringOptions>();
        return call.run([&](const Progress& progress) { return filterSurface(*mesh, *set, options, progress); });
      });
}

void addDistance(const py::module_& module)
{
  addRecord<MeshDistanceResult>(module);
  addRecord<TwoSidedDistance>(module);
  addRecord<DistanceStatistics>(module);
  addRecord<NormalDeviation>(module);
  addFunction<MeshDistanceOptions>(module,
                                   {"compare",
                                    "measureMeshDistance",
                                    {{"mesh", "TriangleMesh"}, {"reference", "TriangleMesh"}},
                                    "MeshDistanceResult"},
                                   [](const Call& call) {
                                     const auto mesh = lendMesh(call), reference = lendMesh(call, "reference");
                                     const auto options = call.options<MeshDistanceOptions>();
                                     return call.run([&](const Progress& progress) {
                                       return measureMeshDistance(*mesh, *reference, options, progress);
                                     });
                                   });
}

/// Depth images of Python, which stay there.
class DepthArrays {
public:
  DepthArrays(const Call& call, const CameraModel& camera) : height_(camera.height), width_(camera.width)
  {
    const std::vector<py::object> entries = toEntries(call["depths"], "depths", "Floats");
    for (std::size_t i = 0; i < entries.size(); ++i) {
      arrays_.push_back(checkedArray(entries[i], concat("depths[", i, ']'), py::dtype::of<float>(), width_));
      if (arrays_.back().shape(0) != height_)
        throw py::value_error(concat("depths[", i, "]: ", arrays_.back().shape(0), " rows, the camera has ", height_));
      data_.push_back(static_cast<const float*>(arrays_.back().data()));
    }
  }
  std::size_t size() const { return data_.size(); }
  DepthImage operator()(Index frame) const { return Eigen::Map<const DepthImage>(data_[frame], height_, width_); }

private:
  Index height_, width_;
  std::vector<py::array> arrays_;
  std::vector<const float*> data_; ///< what is looked at without the GIL
};

void addFusion(const py::module_& module)
{
  addRecord<DepthFusionResult>(module);
  addFunction<DepthFusionOptions>(
      module,
      {"fuse_depth_images",
       "fuseDepthImages",
       {{"camera", "CameraModel"}, {"T_world_camera", "Sequence[ArrayLike]"}, {"depths", "Sequence[Floats]"}},
       "DepthFusionResult",
       "`depths` are float32, (height, width) of the camera, along its axis in the unit of the poses; 0 or NaN = "
       "none."},
      [](const Call& call) {
        DepthFrames frames;
        frames.camera = call.value<CameraModel>("camera");
        frames.T_world_camera = call.value<std::vector<Eigen::Isometry3d>>("T_world_camera");
        const DepthArrays depths(call, frames.camera);
        require(depths.size() == frames.T_world_camera.size(), "depths: ", depths.size(),
                ", T_world_camera: ", frames.T_world_camera.size());
        frames.depth = [&depths](Index frame) { return depths(frame); };
        const auto options = call.options<DepthFusionOptions>();
        return call.run([&](const Progress& progress) { return fuseDepthImages(frames, options, progress); });
      });
}
} // namespace

void addSurface(const py::module_& module)
{
  addReconstruction(module);
  addOptimization(module);
  addDistance(module);
  addFusion(module);
}
} // namespace fresco::python
