// SPDX-License-Identifier: BSD-3-Clause
#include "support/version.h"
#include <link.h>
#include <string_view>
namespace fresco {
namespace {
bool isLoaded(std::string_view library)
{
  const auto look = [](dl_phdr_info* info, std::size_t, void* wanted) {
    const std::string path = info->dlpi_name;
    return path.find(*static_cast<std::string*>(wanted)) != std::string::npos ? 1 : 0;
  };
  std::string name = "/" + std::string(library);
  return dl_iterate_phdr(look, &name) != 0;
}
} // namespace

std::string versionLine()
{
  std::string line = "fresco " FRESCO_VERSION;
  const char* joint = " with ";
  static constexpr struct {
    const char *library, *name;
  } others[] = {{"libpcl_", "PCL " FRESCO_PCL_VERSION},
                {"libembree", "Embree " FRESCO_EMBREE_VERSION},
                {"libopencv_", "OpenCV " FRESCO_OPENCV_VERSION},
                {"libvtk", "VTK " FRESCO_VTK_VERSION}};
  for (const auto& [library, name] : others)
    if (isLoaded(library)) {
      line += joint + std::string(name);
      joint = ", ";
    }
  return line;
}
} // namespace fresco
