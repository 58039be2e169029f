// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/mesh.h>
#include <fresco/io/file.h>
#include <fresco/io/mesh_io.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
namespace fresco::test {
/// The columns of a part go where runs tell. @return how many there were
template <typename Matrix>
Index placeRuns(const nlohmann::json& runs, const Matrix& part, Matrix& whole)
{
  Index at = 0;
  for (const auto& run : runs) {
    const Index first = run[0], count = run[1];
    whole.middleCols(first, count) = part.middleCols(at, count);
    at += count;
  }
  EXPECT_EQ(at, part.cols());
  return at;
}

/// Where vertices of a part lie in the whole.
inline std::vector<int> numbersOf(const nlohmann::json& runs)
{
  std::vector<int> numbers;
  for (const auto& run : runs)
    for (int i = 0; i < int(run[1]); ++i)
      numbers.push_back(int(run[0]) + i);
  return numbers;
}

/// The whole mesh, by what its index says. Checks what each part promises.
inline TriangleMesh joinedParts(const std::string& folder, const std::string& index)
{
  const auto json = nlohmann::json::parse(readFile(folder + "/" + index));
  EXPECT_EQ(json["format"], "fresco mesh parts 1");
  EXPECT_EQ(json["part_count"], json["parts"].size());
  TriangleMesh whole;
  const Index n = json["vertices"];
  whole.vertices.setConstant(3, n, -1e30f);
  whole.faces.setConstant(3, Index(json["faces"]), -1);
  Index faces = 0;
  for (const auto& entry : json["parts"]) {
    TriangleMesh part = readMesh(folder + "/" + std::string(entry["file"]));
    validateMesh(part);
    EXPECT_EQ(part.vertexCount(), entry["vertices"]);
    EXPECT_EQ(part.faceCount(), entry["faces"]);
    whole.origin = part.origin;
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(part.origin[k] + part.vertices.row(k).minCoeff(), double(entry["lowest"][k]), 1e-6);
      EXPECT_NEAR(part.origin[k] + part.vertices.row(k).maxCoeff(), double(entry["highest"][k]), 1e-6);
    }
    const auto& runs = entry["vertex_runs"];
    placeRuns(runs, part.vertices, whole.vertices);
    if (part.normals.cols() > 0) {
      whole.normals.conservativeResize(3, n);
      placeRuns(runs, part.normals, whole.normals);
    }
    if (part.colors.cols() > 0) {
      whole.colors.conservativeResize(3, n);
      placeRuns(runs, part.colors, whole.colors);
    }
    for (const auto& [name, values] : part.fields) {
      Eigen::RowVectorXf row = whole.fields[name].transpose();
      row.conservativeResize(n);
      placeRuns(runs, Eigen::RowVectorXf(values.transpose()), row);
      whole.fields[name] = row.transpose();
    }
    const std::vector<int> numbers = numbersOf(runs);
    for (Index c = 0; c < part.faces.size(); ++c)
      part.faces.data()[c] = numbers.at(part.faces.data()[c]);
    faces += placeRuns(entry["face_runs"], part.faces, whole.faces);
  }
  EXPECT_EQ(faces, whole.faceCount());
  return whole;
}
} // namespace fresco::test
