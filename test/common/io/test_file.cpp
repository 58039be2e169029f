// SPDX-License-Identifier: BSD-3-Clause
#include "test_data.h"
#include <Eigen/Geometry>
#include <fresco/core/parallel.h>
#include <fresco/core/progress.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/pose_file.h>
#include <fresco/io/unfinished_files.h>
#include <fstream>
#include <sys/stat.h>
#include <unistd.h>
namespace {
using namespace fresco;
namespace fs = std::filesystem;

std::size_t entries(const std::string& folder)
{
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

void put(const std::string& path, const std::string& text)
{
  OutputFile file(path);
  file.write(text);
  file.commit();
}

Image gradient(int width, int height, int channels)
{
  Image image(width, height, channels);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c)
        image.pixel(x, y)[c] = static_cast<std::uint8_t>(x * (c + 1) + 2 * y);
  return image;
}

TEST(OutputFile, WholeOrAbsent)
{
  const std::string folder = test::scratchFolder(), path = folder + "/out.txt";
  {
    OutputFile file(path);
    file.write("half");
  }
  EXPECT_EQ(entries(folder), 0U);
  put(path, "whole");
  EXPECT_EQ(readFile(path), "whole");
  {
    OutputFile file(path);
    file.write(std::string(5 << 20, 'x'));
    EXPECT_EQ(readFile(path), "whole");
  }
  EXPECT_EQ(readFile(path), "whole");
  EXPECT_EQ(entries(folder), 1U);
}

TEST(OutputGroup, AllOrNone)
{
  const std::string folder = test::scratchFolder(), first = folder + "/first.txt";
  writeFile(first, "old");
  {
    OutputGroup group;
    writeFile(first, "new");
    writeFile(folder + "/second.txt", "new");
    EXPECT_EQ(readFile(first), "old");
    EXPECT_THROW(OutputGroup(), std::invalid_argument);
  }
  EXPECT_EQ(readFile(first), "old");
  EXPECT_EQ(entries(folder), 1U);
  {
    OutputGroup group;
    writeFile(first, "new");
    writeFile(folder + "/second.txt", "new");
    group.commit();
  }
  EXPECT_EQ(readFile(first), "new");
  EXPECT_EQ(readFile(folder + "/second.txt"), "new");
  EXPECT_EQ(entries(folder), 2U);
  writeFile(first, "newer");
  EXPECT_EQ(readFile(first), "newer");
}

TEST(OutputFile, LargeAndSmallWritesKeepTheirOrder)
{
  const std::string path = test::scratchFolder() + "/out.bin";
  std::string all;
  OutputFile file(path);
  for (int i = 0; i < 300; ++i) {
    const std::string part(static_cast<std::size_t>(i % 7 == 0 ? 1300000 : 17 * i), static_cast<char>('a' + i % 26));
    file.write(part);
    all += part;
  }
  file.commit();
  EXPECT_EQ(readFile(path), all);
}

TEST(OutputFile, ManyPiecesAreWhole)
{
  const std::string path = test::scratchFolder() + "/out.bin";
  std::string all(std::size_t{45} << 20, '\0');
  for (std::size_t i = 0; i < all.size(); i += 4096)
    all[i] = static_cast<char>(i >> 12);
  writeFile(path, all); // in one call
  EXPECT_TRUE(readFile(path) == all);
  OutputFile file(path);
  for (std::size_t at = 0; at < all.size(); at += 999999)
    file.write(all.substr(at, 999999));
  file.commit();
  EXPECT_TRUE(readFile(path) == all);
}

TEST(OutputFile, NamesWhatCannotBeWritten)
{
  const std::string folder = test::scratchFolder();
  for (const std::string& path : {folder + "/none/out.txt", folder, folder + "/", std::string("/dev/null/out.txt")})
    try {
      OutputFile file(path);
      ADD_FAILURE() << path;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
    }
}

TEST(OutputFile, ReplacesFilesOnly)
{
  const std::string folder = test::scratchFolder(), target = folder + "/target.txt";
  std::ofstream(target) << "other";
  fs::create_symlink(target, folder + "/link.txt");
  fs::create_symlink(folder + "/nowhere", folder + "/dangling.txt");
  ASSERT_EQ(mkfifo((folder + "/pipe.txt").c_str(), 0600), 0);
  for (const char* name : {"/link.txt", "/dangling.txt", "/pipe.txt"})
    EXPECT_THROW(put(folder + name, "new"), std::runtime_error) << name;
  for (const char* device : {"/dev/null", "/dev/full"})
    EXPECT_THROW(OutputFile file(device), std::runtime_error) << device;
  EXPECT_EQ(readFile(target), "other");
  EXPECT_TRUE(fs::is_fifo(folder + "/pipe.txt") && fs::is_symlink(folder + "/link.txt"));
}

TEST(OutputFile, TemporaryNamesAreItsOwn)
{
  const std::string folder = test::scratchFolder(), path = folder + "/out.txt", target = folder + "/target";
  std::ofstream(target) << "other";
  OutputFile first(path), second(path);
  EXPECT_NE(first.temporaryPath(), second.temporaryPath());
  first.write("first");
  second.write("second");
  second.commit();
  first.commit();
  EXPECT_EQ(readFile(path), "first");
  // What a killed run left is removed, a link of that name is not followed, other names are left alone.
  put(folder + "/.out.0123456789abcdef.part.txt", "left");
  put(folder + "/.out.0123456789abcdeg.part.txt", "not ours");
  fs::create_symlink(target, folder + "/.out.00000000deadbeef.part.txt");
  OutputFile third(path);
  EXPECT_FALSE(fs::exists(folder + "/.out.0123456789abcdef.part.txt"));
  EXPECT_TRUE(fs::exists(folder + "/.out.0123456789abcdeg.part.txt"));
  OutputFile fourth(path);
  EXPECT_TRUE(fs::exists(third.temporaryPath()));
  EXPECT_EQ(readFile(target), "other");
}

TEST(OutputFile, KeepsTheModeOfWhatItReplaces)
{
  const std::string path = test::scratchFolder() + "/out.txt";
  put(path, "old");
  fs::permissions(path, fs::perms(0640));
  put(path, "new");
  EXPECT_EQ(fs::status(path).permissions(), fs::perms(0640));
}

TEST(OutputFile, KeepsTheOwnerButNotTheRightToRunAsOne)
{
  const std::string path = test::scratchFolder() + "/out.txt";
  put(path, "old");
  const bool can_give = ::chown(path.c_str(), 1234, 2345) == 0;
  fs::permissions(path, fs::perms(06755));
  put(path, "new");
  struct stat found = {};
  ASSERT_EQ(::stat(path.c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 07777, 0755U);
  EXPECT_EQ(found.st_uid, can_give ? 1234 : ::getuid());
  EXPECT_EQ(found.st_gid, can_give ? 2345 : ::getgid());
}

TEST(OutputFile, LongNames)
{
  const std::string path = test::scratchFolder() + "/" + std::string(250, 'n') + ".txt";
  put(path, "x");
  EXPECT_EQ(readFile(path), "x");
}

TEST(OutputGroup, DoesNotReplaceInputs)
{
  const std::string folder = test::scratchFolder(), path = folder + "/in.txt";
  put(path, "input");
  fs::create_hard_link(path, folder + "/other_name.txt");
  EXPECT_EQ(readFile(path), "input");
  OutputGroup group;
  put(folder + "/out.txt", "new");
  EXPECT_NO_THROW(group.requireNoInputs());
  put(folder + "/other_name.txt", "new");
  EXPECT_THROW(group.requireNoInputs(), std::runtime_error);
}

TEST(Folder, OneProcessAtATime)
{
  const std::string folder = test::scratchFolder();
  {
    const FolderLock lock(folder, "tool");
    EXPECT_THROW(FolderLock(folder, "tool"), std::runtime_error);
  }
  EXPECT_NO_THROW(FolderLock(folder, "tool"));
}

TEST(Folder, EmptyOnesGoAfterAnError)
{
  const std::string folder = test::scratchFolder();
  makeFolder(folder + "/a/b");
  makeFolder(folder + "/c");
  put(folder + "/c/file", "x");
  removeEmptyFolders();
  EXPECT_FALSE(fs::exists(folder + "/a"));
  EXPECT_TRUE(fs::exists(folder + "/c/file"));
}

TEST(ReadFile, NamesWhatCannotBeRead)
{
  const std::string folder = test::scratchFolder();
  std::ofstream(folder + "/empty").flush();
  EXPECT_THROW(readFile(folder + "/missing"), std::runtime_error);
  EXPECT_THROW(readFile(folder), std::runtime_error);
  EXPECT_THROW(readFile(folder + "/empty"), std::runtime_error);
  ASSERT_EQ(mkfifo((folder + "/pipe").c_str(), 0600), 0);
  EXPECT_THROW(readFile(folder + "/pipe"), std::runtime_error);
  EXPECT_THROW(readFile("/dev/zero"), std::runtime_error);
  EXPECT_EQ(extension("a.b/C.PlY"), ".ply");
  EXPECT_EQ(extension("a.b/c"), "");
}

TEST(Folder, MadeOrNamed)
{
  const std::string folder = test::scratchFolder();
  makeFolder(folder + "/a/b");
  EXPECT_TRUE(fs::is_directory(folder + "/a/b"));
  put(folder + "/file", "x");
  EXPECT_THROW(makeFolder(folder + "/file"), std::runtime_error);
  EXPECT_THROW(makeFolder(folder + "/file/below"), std::runtime_error);
}

TEST(Images, PngRoundTripIsExact)
{
  const std::string folder = test::scratchFolder();
  for (const int channels : {1, 3, 4}) {
    const Image image = gradient(37, 21, channels);
    writeImage(folder + "/a.png", image);
    const Image back = readImage(folder + "/a.png");
    ASSERT_EQ(back.width, 37);
    ASSERT_EQ(back.channels, 3);
    for (int c = 0; c < 3; ++c)
      EXPECT_EQ(back.pixel(36, 20)[c], image.pixel(36, 20)[channels == 1 ? 0 : c]);
  }
}

TEST(Images, LargePngIsExactAndDoesNotDependOnThreads)
{
  Image image(700, 1900, 3); // several bands; smooth, rough and constant parts
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c)
        image.pixel(x, y)[c] = static_cast<std::uint8_t>(y < 600    ? x / 3 + y / 2 + c
                                                         : y < 1200 ? (x * 7919 + y * 104729 + c * 31) >> 3
                                                                    : 128);
  const std::string folder = test::scratchFolder();
  setDefaultThreads(1);
  const std::vector<std::uint8_t> one = encodeImage(image, ".png");
  setDefaultThreads(4);
  const std::vector<std::uint8_t> four = encodeImage(image, ".png");
  setDefaultThreads(0);
  EXPECT_EQ(one, four);
  EXPECT_LT(one.size(), image.data.size() * 3 / 4);
  put(folder + "/a.png", std::string(one.begin(), one.end()));
  EXPECT_EQ(readImage(folder + "/a.png").data, image.data);
}

TEST(Images, CutAnywhereIsAnError)
{
  const std::string folder = test::scratchFolder();
  for (const std::string name : {"a.png", "a.jpg"}) {
    writeImage(folder + "/" + name, gradient(64, 48, 3));
    const std::string whole = readFile(folder + "/" + name);
    for (std::size_t cut = 1; cut + 2 < whole.size(); cut += whole.size() / 50 + 1) {
      put(folder + "/cut_" + name, whole.substr(0, cut));
      EXPECT_THROW(readImage(folder + "/cut_" + name), std::runtime_error) << cut;
    }
  }
  put(folder + "/text.png", "no image at all");
  EXPECT_THROW(readImage(folder + "/text.png"), std::runtime_error);
  EXPECT_THROW(readImage16(folder + "/a.png"), std::runtime_error);
  EXPECT_THROW(writeImage(folder + "/a.bmp", gradient(4, 4, 3)), std::invalid_argument);
  EXPECT_THROW(writeImage(folder + "/b.png", Image()), std::invalid_argument);
}

TEST(Poses, RoundTripAndErrors)
{
  const std::string folder = test::scratchFolder(), path = folder + "/poses.txt";
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  T.topRightCorner<3, 1>() << 1.0 / 3.0, -2e6, 3;
  writePoses(path, {T, Pose(), T});
  const std::vector<Pose> back = readPoses(path);
  ASSERT_EQ(back.size(), 3U);
  EXPECT_EQ(*back[0], T);
  EXPECT_FALSE(back[1]);
  for (const char* bad :
       {"1 0 0 0", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 5", "2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1",
        "-1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "nan 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "# only a comment"}) {
    put(path, bad);
    EXPECT_THROW(readPoses(path), std::runtime_error) << bad;
  }
}

TEST(Progress, PartsOfAJobAndCancelling)
{
  std::vector<double> seen;
  const Progress all = [&](std::string_view, double fraction) {
    seen.push_back(fraction);
    return seen.size() < 3;
  };
  const Progress part = subProgress(all, 0.5, 0.7);
  report(part, "first", 0.0);
  report(part, "last", 1.0);
  EXPECT_DOUBLE_EQ(seen[0], 0.5);
  EXPECT_DOUBLE_EQ(seen[1], 0.7);
  EXPECT_THROW(report(part, "more", 0.5), Cancelled);
  EXPECT_NO_THROW(report(subProgress({}, 0, 1), "nobody listens", 0.5));
}
} // namespace
