// SPDX-License-Identifier: BSD-3-Clause
#include "common/io/test_io_data.h"
#include "io/files/format_table.h"
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
namespace {
using namespace fresco;

/// A row of the list in docs/formats.md.
std::string rowOf(const io::Format& format)
{
  std::string row = std::string("| ") + format.name + " |";
  for (const char* type : format.extensions)
    row += std::string(" `") + type + '`';
  for (const FileKind kind : {FileKind::points, FileKind::mesh, FileKind::textured_mesh})
    row += std::string(" | ") + (format.reads(kind) ? "reads" : "") +
           (format.reads(kind) && format.writes(kind) ? ", " : "") + (format.writes(kind) ? "writes" : "");
  return row + " |\n";
}

TEST(Formats, DocumentationListsTheTable)
{
  const std::string page = readFile(test::projectFolder() + "/docs/formats.md");
  std::string table = "| format | extensions | points | mesh | textured model |\n|---|---|---|---|---|\n";
  for (const io::Format& format : io::formats())
    table += rowOf(format);
  EXPECT_NE(page.find(table), std::string::npos) << "docs/formats.md lacks:\n" << table;
}

TEST(Formats, ExtensionsAreKnownInAnyCase)
{
  EXPECT_EQ(readableExtensions(FileKind::textured_mesh), ".ply, .obj or .glb");
  EXPECT_TRUE(isReadable("a/scan.PCD", FileKind::points));
  EXPECT_FALSE(isReadable("a/scan.pcd", FileKind::mesh));
  EXPECT_FALSE(isWritable("scan.stl", FileKind::points));
  EXPECT_TRUE(isWritable("scan.stl", FileKind::mesh));
}

TEST(Formats, WhatTheTablePromisesIsDone)
{
  const std::string folder = test::scratchFolder();
  for (const io::Format& format : io::formats())
    for (const char* type : format.extensions) {
      const std::string path = folder + "/file" + type;
      SCOPED_TRACE(path);
      const bool compressed = std::string(type) == ".laz"; // by a program that may be missing
      if (format.writes(FileKind::points) && !compressed) {
        writePoints(path, test::fullPointSet(6));
        EXPECT_EQ(readPoints(path).size(), std::string(type) == ".las" ? 5 : 6); // NaN has no place in LAS
      }
      if (format.writes(FileKind::mesh)) {
        writeMesh(path, test::fullMesh(3));
        if (format.reads(FileKind::mesh)) {
          EXPECT_EQ(readMesh(path).vertexCount(), 9);
        }
      }
      if (format.writes(FileKind::textured_mesh)) {
        writeTexturedMesh(path, test::fullTexturedMesh(3, 1));
        EXPECT_EQ(readTexturedMesh(path).mesh.faceCount(), 8);
      }
    }
}

TEST(Formats, MessagesNameTheExtensions)
{
  for (const FileKind kind : {FileKind::points, FileKind::mesh, FileKind::textured_mesh}) {
    const std::string reading = test::errorOf([&] { io::formatToRead("a.png", kind); });
    EXPECT_NE(reading.find(readableExtensions(kind)), std::string::npos) << reading;
    const std::string writing = test::errorOf([&] { io::formatToWrite("a.png", kind); });
    EXPECT_NE(writing.find(writableExtensions(kind)), std::string::npos) << writing;
  }
}
} // namespace
