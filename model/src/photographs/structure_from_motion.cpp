// SPDX-License-Identifier: BSD-3-Clause
#include "photographs/structure_from_motion.h"
#include "photographs/program.h"
#include <algorithm>
#include <filesystem>
#include <fresco/core/parallel.h>
#include <fresco/io/colmap.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/listed.h>
#include <fstream>
#include <regex>
#include <set>
namespace fresco::model {
namespace {
namespace fs = std::filesystem;
constexpr std::size_t most_exhaustive = 200; // 20,000 pairs: some hours; beyond, names tell what is near
constexpr std::size_t overlap = 20;          // neighbours that each is matched with then
} // namespace

std::size_t pairsToMatch(std::size_t photographs)
{
  return photographs > most_exhaustive ? overlap * photographs : photographs * (photographs - 1) / 2;
}

bool isOneCamera(const std::string& images, const std::vector<std::string>& names, int threads)
{
  constexpr std::streamsize head = 65536; // EXIF is one of the first blocks of a file
  std::vector<std::pair<int, int>> sizes(names.size());
  std::vector<char> told(names.size(), 0);
  parallelFor(
      names.size(), threads,
      [&](Index i) {
        const std::string path = images + "/" + names[i];
        std::ifstream file(path, std::ios::binary);
        std::string text(head, '\0');
        file.read(text.data(), head);
        told[i] = text.find("Exif") != std::string::npos;
        if (!told[i]) {
          const ImageSize size = readImageSize(path);
          sizes[i] = {size.width, size.height};
        }
      },
      1);
  return std::none_of(told.begin(), told.end(), [](char t) { return t != 0; }) &&
         std::all_of(sizes.begin(), sizes.end(), [&](const auto& size) { return size == sizes[0]; });
}

double shareToldBy(const std::string& line, std::size_t count)
{
  static const std::regex of(R"(\[(\d+)/(\d+)(?:, (\d+)/(\d+))?\])"), registered(R"(Registering image #\d+ \((\d+)\))");
  std::smatch found;
  if (std::regex_search(line, found, of)) {
    const double k = std::stod(found[1]), n = std::stod(found[2]);
    if (!found[3].matched)
      return n > 0 ? k / n : -1;
    const double k2 = std::stod(found[3]), n2 = std::stod(found[4]); // blocks of pairs, row by row
    return n > 0 && n2 > 0 ? ((k - 1) * n2 + k2 - 1) / (n * n2) : -1;
  }
  if (std::regex_search(line, found, registered) && count > 0)
    return std::min(1.0, std::stod(found[1]) / static_cast<double>(count));
  return -1;
}

void requireStructureFromMotion(const std::string& images, std::size_t count)
{
  if (count < 2)
    throw std::runtime_error(
        images +
        ": the camera of one photograph cannot be found; it takes two at least that overlap, or none beside scans");
  if (findProgram("colmap").empty())
    throw std::runtime_error(images + ": photographs without cameras need the program colmap; Debian's package colmap "
                                      "has it (apt-get install colmap)");
}

StructureFromMotion::StructureFromMotion(std::string images, std::vector<std::string> names, std::string folder,
                                         int threads)
    : images_(std::move(images)), names_(std::move(names)), folder_(std::move(folder)), threads_(threadCount(threads))
{}

void StructureFromMotion::run(std::vector<std::string> words, const std::string& step, const Progress& progress) const
{
  requireStructureFromMotion(images_, names_.size());
  double share = 0;
  words.insert(words.begin(), findProgram("colmap"));
  words.insert(words.end(), {"--database_path", database()});
  runProgram(
      words, folder_ + "/log.txt",
      [&](const std::string& line) { share = std::max(share, shareToldBy(line, names_.size())); },
      [&] { report(progress, step, std::min(share, 0.999)); });
}

void StructureFromMotion::findFeatures(const Progress& progress) const
{
  fs::remove_all(folder_);
  makeFolder(folder_);
  std::string list;
  for (const std::string& name : names_)
    list += name + "\n";
  writeFile(folder_ + "/photographs.txt", list);
  run({"feature_extractor", "--image_path", images_, "--image_list_path", folder_ + "/photographs.txt",
       "--ImageReader.single_camera", isOneCamera(images_, names_, threads_) ? "1" : "0", "--SiftExtraction.use_gpu",
       "0", "--SiftExtraction.num_threads", std::to_string(threads_)},
      "photographs", progress);
}

void StructureFromMotion::matchFeatures(const Progress& progress) const
{
  std::vector<std::string> words{"exhaustive_matcher"};
  if (names_.size() > most_exhaustive)
    words = {"sequential_matcher", "--SequentialMatching.overlap", std::to_string(overlap)};
  words.insert(words.end(), {"--SiftMatching.use_gpu", "0", "--SiftMatching.num_threads", std::to_string(threads_)});
  run(words, "pairs of photographs", progress);
}

std::vector<std::string> StructureFromMotion::findCameras(const Progress& progress) const
{
  const std::string found = folder_ + "/models";
  fs::remove_all(found);
  fs::remove_all(model());
  makeFolder(found);
  std::string failure;
  try {
    run({"mapper", "--image_path", images_, "--output_path", found, "--Mapper.num_threads", std::to_string(threads_)},
        "photographs placed", progress);
  } catch (const Cancelled&) {
    throw;
  } catch (const std::runtime_error& error) {
    if (!fs::is_empty(found))
      throw;
    failure = error.what();
  }
  std::vector<std::pair<std::size_t, std::string>> models;
  for (const auto& entry : fs::directory_iterator(found))
    if (entry.is_directory())
      models.emplace_back(readColmap(entry.path().string()).views.size(), entry.path().string());
  if (models.empty())
    throw std::runtime_error(
        concat(images_, ": colmap could place none of the ", names_.size(), " photographs: ",
               failure.empty() ? "they overlap too little, or show too little (its lines: " + folder_ + "/log.txt)"
                               : failure));
  std::sort(models.begin(), models.end(), [](const auto& a, const auto& b) {
    return a.first > b.first || (a.first == b.first && a.second < b.second);
  });
  const CameraSet set = readColmap(models[0].second);
  writeColmap(model(), set, readColmapPoints(models[0].second));
  std::vector<std::string> warnings;
  if (models.size() > 1) {
    std::string sizes;
    for (std::size_t m = 1; m < models.size(); ++m)
      sizes += concat(m > 1 ? ", " : "", models[m].first);
    warnings.push_back(concat("photographs fall into ", models.size(), " groups without overlap; the largest, of ",
                              models[0].first, ", is used; others: ", sizes));
  }
  std::set<std::string> placed;
  for (const View& view : set.views)
    placed.insert(view.image);
  std::vector<std::string> without;
  std::copy_if(names_.begin(), names_.end(), std::back_inserter(without),
               [&](const std::string& name) { return placed.count(name) == 0; });
  if (!without.empty())
    warnings.push_back(
        concat(without.size(), " of ", names_.size(), " photographs have no place: ", listed(without, 8)));
  return warnings;
}
} // namespace fresco::model
