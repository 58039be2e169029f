// SPDX-License-Identifier: BSD-3-Clause
#include "input/model_input.h"
#include "input/survey.h"
#include <algorithm>
#include <filesystem>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/io/image_io.h>
namespace fresco::model {
namespace fs = std::filesystem;

std::vector<std::string> ModelInput::files() const
{
  std::vector<std::string> all;
  for (const ScanPath& scan : scans)
    if (all.empty() || all.back() != scan.file)
      all.push_back(scan.file);
  for (const PictureFile& picture : pictures()) {
    all.push_back(picture.file);
    if (!picture.mask.empty())
      all.push_back(picture.mask);
  }
  if (rgbd)
    for (const RgbdFrame& frame : rgbd->frames)
      for (const std::string& file : {frame.depth, frame.confidence})
        if (!file.empty())
          all.push_back(file);
  if (!video.empty())
    all.push_back(video);
  return all;
}

std::vector<PictureFile> ModelInput::pictures() const
{
  std::vector<PictureFile> all;
  for (const View& view : cameras.views)
    all.push_back({images + "/" + view.image, maskFileOf(images, view.image), &cameras.cameras[view.camera]});
  for (const std::string& name : unplaced)
    all.push_back({images + "/" + name, maskFileOf(images, name)});
  if (rgbd)
    for (const RgbdFrame& frame : rgbd->frames)
      if (!frame.color.empty())
        all.push_back({frame.color, maskFileOf(fs::path(frame.color).parent_path(), fs::path(frame.color).filename()),
                       &frame.color_camera});
  for (const Panorama& panorama : panoramas) {
    const fs::path file(panorama.file);
    all.push_back({panorama.file, maskFileOf(file.parent_path().string(), file.filename().string()), nullptr, true});
  }
  return all;
}

std::string describe(const ModelInput& input)
{
  if (input.rgbd)
    return counted(input.rgbd->frames.size(), "RGB-D frame") + (input.rgbd->has_poses ? "" : " without poses") +
           (input.layout == "7-Scenes RGB-D" ? "" : " (" + input.layout + ")");
  const auto& inside = input.inside.pictures;
  const std::size_t panoramas_inside =
      std::count_if(inside.begin(), inside.end(), [](const ScanPicture& picture) { return picture.isPanorama(); });
  const std::size_t panoramas = input.panoramas.size() + panoramas_inside;
  const std::size_t photographs = input.cameras.views.size() + inside.size() - panoramas_inside;
  std::string text =
      input.is_cloud ? counted(input.scans.size(), "file") + " of one cloud" : counted(input.scans.size(), "scan");
  if (input.scans.empty())
    return input.video.empty() ? counted(photographs + input.unplaced.size(), "photograph") + " and no scans"
                               : "a video";
  if (panoramas > 0)
    text += ", " + counted(panoramas, "panorama");
  if (photographs > 0)
    text += ", " + counted(photographs, "photograph");
  if (!input.unplaced.empty())
    text += ", " + counted(input.unplaced.size(), "photograph") + " without cameras";
  return input.hasPictures() ? text : text + ", no pictures: the texture comes from the points";
}

void checkPhotographs(const ModelInput& input, int threads)
{
  const std::vector<PictureFile> photographs = input.pictures();
  std::vector<std::string> problems(photographs.size() + input.inside.pictures.size());
  const auto look = [&](Index i) {
    const auto& [file, mask, camera, panorama] = photographs[i];
    try {
      const Image image = camera ? readImage(file, *camera) : readImage(file);
      if (panorama && image.width != 2 * image.height)
        problems[i] =
            concat(file, ": a panorama of ", image.width, "x", image.height, " pixels is not twice as wide as high");
      if (mask.empty())
        return;
      if (const Image area = readImage(mask); area.width != image.width || area.height != image.height)
        problems[i] = concat(mask, ": is ", area.width, "x", area.height, " pixels, its photograph ", image.width, "x",
                             image.height);
    } catch (const std::runtime_error& error) {
      problems[i] = error.what();
    }
  };
  parallelFor(photographs.size(), threads, look, 1);
  const auto lookInside = [&](Index i) {
    try {
      readPicture(input.inside.pictures[i]);
    } catch (const std::runtime_error& error) {
      problems[photographs.size() + i] = error.what();
    }
  };
  parallelFor(input.inside.pictures.size(), threads, lookInside, 1);
  for (const std::string& problem : problems)
    if (!problem.empty())
      throw std::runtime_error(problem);
}
} // namespace fresco::model
