// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/point_formats.h"
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fresco/io/file.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
namespace fresco::io {
namespace {
/// A folder of its own, gone with this object.
class TemporaryFolder {
public:
  TemporaryFolder()
  {
    std::string name = (std::filesystem::temp_directory_path() / "fresco-XXXXXX").string();
    if (!::mkdtemp(name.data()))
      throw std::runtime_error(concat(name, ": ", std::strerror(errno)));
    path_ = name;
  }
  ~TemporaryFolder()
  {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string file(const char* name) const { return path_ + "/" + name; }

private:
  std::string path_;
};

/// Runs the program laszip, silently. @throws std::runtime_error if it is not installed or fails
void runLaszip(const std::string& from, const std::string& to)
{
  std::string words[] = {"laszip", "-i", std::filesystem::absolute(from), "-o", to};
  char* arguments[] = {words[0].data(), words[1].data(), words[2].data(), words[3].data(), words[4].data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&actions, descriptor, "/dev/null", O_RDWR, 0);
  pid_t process = 0;
  const int error = ::posix_spawnp(&process, "laszip", &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  expect(error == 0, "compressed (LAZ): install the program laszip, which reads and writes it, or use .las");
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR)
    ;
  expect(status == 0 && std::filesystem::exists(to), "the program laszip could not convert it");
}
} // namespace

std::unique_ptr<ScanReader> openLaz(const ScanPath& path)
{
  expect(std::filesystem::is_regular_file(path.file), "no such file");
  const TemporaryFolder folder;
  runLaszip(path.file, folder.file("points.las"));
  return openLas({folder.file("points.las")}); // which stays open
}

void writeLaz(const std::string& path, PointTable table)
{
  namingFile(path, [&] {
    const TemporaryFolder folder;
    writeLas(folder.file("points.las"), std::move(table));
    runLaszip(folder.file("points.las"), folder.file("points.laz"));
    OutputFile file(path);
    file.write(readFile(folder.file("points.laz")));
    file.commit();
  });
}
} // namespace fresco::io
