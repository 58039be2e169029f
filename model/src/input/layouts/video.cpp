// SPDX-License-Identifier: BSD-3-Clause
// A video: its sharpest frames become photographs.
#include "input/parts.h"
#include <fresco/core/require.h>
namespace fresco::model {
void readVideo(const Survey& found, std::optional<Reading>, ModelInput& input)
{
  input.is_cloud = true;
  const std::vector<std::string> videos = found.match("<videos>");
  if (videos.size() > 1)
    throw std::runtime_error(
        concat(found.path(), ": ", videos.size(), " videos; name one of them: ", found.at(videos[0])));
  input.video = found.at(videos[0]);
  input.found.push_back(videos[0] + ": a video; the program ffmpeg takes its frames, the sharpest become photographs");
  input.warnings.push_back(roughOnly());
}
} // namespace fresco::model
