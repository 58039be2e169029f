// SPDX-License-Identifier: BSD-3-Clause
#include "stages/video.h"
#include "photographs/program.h"
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <iomanip>
#include <regex>
namespace fresco::model {
namespace {
namespace fs = std::filesystem;
constexpr int tried_a_second = 10, windows_a_second = 2; // frames that are looked at, and those that are kept

std::string frameFile(Index number) { return concat(std::setfill('0'), std::setw(6), number, ".jpg"); }

std::vector<std::string> framesIn(const std::string& folder)
{
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".jpg")
      names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}
} // namespace

void requireVideoProgram(const std::string& video)
{
  if (findProgram("ffmpeg").empty())
    throw std::runtime_error(
        video + ": frames of a video need the program ffmpeg; Debian's package ffmpeg has it (apt-get install "
                "ffmpeg)");
}

KeptFrames framesToKeep(const std::string& video)
{
  KeptFrames frames;
  const auto hear = [&](const std::string& line) {
    static const std::regex length(R"(Duration: (\d+):(\d+):(\d+))"), size(R"(Video: .*, (\d+)x(\d+))");
    std::smatch said;
    if (std::regex_search(line, said, length))
      frames.count = windows_a_second * (3600 * std::stod(said[1]) + 60 * std::stod(said[2]) + std::stod(said[3]) + 1);
    if (std::regex_search(line, said, size))
      frames.pixels = std::stod(said[1]) * std::stod(said[2]);
  };
  if (const std::string program = findProgram("ffmpeg"); !program.empty())
    try {
      runProgram({program, "-hide_banner", "-nostdin", "-i", video}, "/dev/null", hear, [] {});
    } catch (const std::runtime_error&) { // without an output that is an error to it
    }
  return frames;
}

double sharpness(const Image& image)
{
  double sum = 0;
  const auto grey = [&](int x, int y) { return int(image.pixel(x, y)[image.channels / 2]); };
  for (int y = 0; y + 1 < image.height; ++y)
    for (int x = 0; x + 1 < image.width; ++x) {
      const int across = grey(x + 1, y) - grey(x, y), down = grey(x, y + 1) - grey(x, y);
      sum += across * across + down * down;
    }
  return sum / std::max(1.0, double(image.width) * image.height);
}

nlohmann::ordered_json takeVideoFrames(const ModelInput& input, const ModelFiles& files, int threads,
                                       const Progress& progress)
{
  requireVideoProgram(input.video);
  fs::remove_all(files.video);
  makeFolder(files.video);
  std::vector<std::string> words{findProgram("ffmpeg"), "-hide_banner", "-nostdin", "-y", "-i", input.video};
  if (!input.rgbd)
    words.insert(words.end(), {"-vf", concat("fps=", tried_a_second)});
  words.insert(words.end(), {"-vsync", "0", "-qscale:v", "2", "-start_number", "0", files.video + "/%06d.jpg"});
  runProgram(
      words, files.work + "/video.txt", [](const std::string&) {}, [&] { report(progress, "frames", 0.1); });
  const std::vector<std::string> all = framesIn(files.video);
  if (all.empty())
    throw std::runtime_error(input.video + ": ffmpeg takes no frame of it (its lines: " + files.work + "/video.txt)");
  if (input.rgbd)
    return {{"frames", all.size()}};
  std::vector<double> values(all.size());
  const auto look = [&](Index i) { values[i] = sharpness(readImage(files.video + "/" + all[i])); };
  parallelFor(all.size(), threads, look, 1);
  constexpr std::size_t window = tried_a_second / windows_a_second;
  std::size_t kept = 0;
  for (std::size_t begin = 0; begin < all.size(); begin += window, ++kept) {
    const std::size_t end = std::min(begin + window, all.size());
    const std::size_t best = std::max_element(values.begin() + begin, values.begin() + end) - values.begin();
    for (std::size_t i = begin; i < end; ++i)
      if (i != best)
        fs::remove(files.video + "/" + all[i]);
  }
  return {{"frames", all.size()}, {"sharpest", kept}};
}

void useVideoFrames(ModelInput& input, const std::string& folder)
{
  if (!input.rgbd) {
    input.images = folder;
    input.unplaced = framesIn(folder);
    return;
  }
  for (RgbdFrame& frame : input.rgbd->frames) {
    frame.color = folder + "/" + frameFile(frame.video_frame);
    if (!fs::exists(frame.color))
      throw std::runtime_error(
          concat(input.video, ": has no frame ", frame.video_frame, ", which ", frame.depth, " belongs to"));
    const ImageSize size = readImageSize(frame.color);
    frame.color_camera = resized(frame.color_camera, size.width, size.height);
  }
}
} // namespace fresco::model
