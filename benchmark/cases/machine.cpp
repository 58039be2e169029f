// SPDX-License-Identifier: BSD-3-Clause
#include "cases/machine.h"
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <sys/utsname.h>
#include <thread>
namespace fresco::benchmark {
namespace {
// What follows `key` and a colon or equals sign in a file of such lines, "" if there is none.
std::string valueIn(const std::string& file, const std::string& key)
{
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    const std::size_t at = line.find_first_of(":=");
    if (line.compare(0, key.size(), key) != 0 || at == std::string::npos)
      continue;
    const std::size_t begin = line.find_first_not_of(" \t\"", at + 1), end = line.find_last_not_of(" \t\"");
    return begin == std::string::npos ? "" : line.substr(begin, end - begin + 1);
  }
  return "";
}

std::string today()
{
  const std::time_t time = std::time(nullptr);
  std::tm parts{};
  localtime_r(&time, &parts);
  std::ostringstream text;
  text << std::put_time(&parts, "%Y-%m-%d");
  return text.str();
}
} // namespace

std::string machineText()
{
  utsname system{};
  uname(&system);
  double load[1] = {0};
  getloadavg(load, 1);
  const double memory = std::atof(valueIn("/proc/meminfo", "MemTotal").c_str()) / (1024.0 * 1024.0);
  std::ostringstream text;
  text << "- date: " << today() << "\n- processor: " << valueIn("/proc/cpuinfo", "model name") << ", "
       << std::thread::hardware_concurrency() << " cores\n- memory: " << std::fixed << std::setprecision(1) << memory
       << " GiB\n- system: " << valueIn("/etc/os-release", "PRETTY_NAME") << ", " << system.sysname << " "
       << system.release << "\n- load of the machine before the first run: " << std::setprecision(2) << load[0] << "\n";
  return text.str();
}
} // namespace fresco::benchmark
