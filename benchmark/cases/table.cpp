// SPDX-License-Identifier: BSD-3-Clause
#include "cases/table.h"
#include <algorithm>
#include <cstdio>
namespace fresco::benchmark {
namespace {
template <typename... Values>
std::string format(const char* pattern, Values... values)
{
  char line[256];
  std::snprintf(line, sizeof(line), pattern, values...);
  return line;
}

std::string row(const Measurement& m)
{
  std::string text = "| " + m.case_name + " | " + m.peer + " | ";
  if (!m.absent.empty())
    return text + m.absent + " | | | | | | | | | |\n";
  text += format("%.2f / %.2f | %.2f | %.0f | ", *std::min_element(m.wall.begin(), m.wall.end()), median(m.wall), m.cpu,
                 m.peak_memory / (1024.0 * 1024.0));
  if (!m.accuracy)
    return text + "| | | | | | |\n";
  const Accuracy& a = *m.accuracy;
  return text + format("%.4g | %.4g | %.4g | %.2f | %ld | %ld | %s |\n", a.max, a.mean, a.rms, a.normals, a.vertices,
                       a.faces, a.watertight ? "yes" : "no");
}
} // namespace

double median(std::vector<double> values)
{
  if (values.empty())
    return 0.0;
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

std::string markdownTable(const std::vector<Measurement>& measurements)
{
  std::string text =
      "| case | program | wall s (min / median) | CPU s | peak MB | max % | mean % | RMS % | normals deg | V | F "
      "| watertight |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Measurement& m : measurements)
    text += row(m);
  return text;
}

nlohmann::json measurementsJson(const std::vector<Measurement>& measurements)
{
  nlohmann::json list = nlohmann::json::array();
  for (const Measurement& m : measurements) {
    nlohmann::json entry = {{"case", m.case_name}, {"program", m.peer}};
    if (!m.absent.empty())
      entry["absent"] = m.absent;
    if (!m.wall.empty())
      entry.update({{"wall_seconds", m.wall}, {"cpu_seconds", m.cpu}, {"peak_bytes", m.peak_memory}});
    if (m.accuracy)
      entry["accuracy"] = {{"max_percent", m.accuracy->max},      {"mean_percent", m.accuracy->mean},
                           {"rms_percent", m.accuracy->rms},      {"normals_degrees", m.accuracy->normals},
                           {"vertices", m.accuracy->vertices},    {"faces", m.accuracy->faces},
                           {"watertight", m.accuracy->watertight}};
    list.push_back(entry);
  }
  return list;
}
} // namespace fresco::benchmark
