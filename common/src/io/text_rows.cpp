// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/text_numbers.h"
#include "io/points/text_table.h"
#include <Eigen/Geometry>
#include <fresco/io/text_rows.h>
namespace fresco {
std::vector<std::string> cellsOf(std::string_view row)
{
  std::vector<std::string_view> cells;
  io::TableDialect().split(row, cells);
  return {cells.begin(), cells.end()};
}

std::vector<std::vector<std::string>> readTextRows(const std::string& path)
{
  const std::string content = readFile(path);
  std::vector<std::vector<std::string>> rows;
  for (io::TextScanner lines(content); !lines.done();)
    if (auto cells = cellsOf(lines.restOfLine()); !cells.empty())
      rows.push_back(std::move(cells));
  return rows;
}

double numberIn(const std::string& path, const std::string& cell)
{
  return io::parseNumberOr<double>(cell, path, ": '", cell, "' is no number");
}

Eigen::MatrixXd readMatrix(const std::string& path, int rows, int columns)
{
  std::vector<double> numbers;
  for (const auto& row : readTextRows(path))
    for (const std::string& cell : row)
      numbers.push_back(numberIn(path, cell));
  expect(Index(numbers.size()) == Index{rows} * columns, path, ": wants ", rows, "x", columns, " numbers, has ",
         numbers.size());
  return Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(numbers.data(), rows, columns);
}

Pose rigidPose(const std::string& path, const Eigen::Matrix4d& T)
{
  constexpr double rounded = 0.02;
  if (!T.allFinite())
    return {};
  expect(isRigid(T, rounded), path, ": not a rigid transform");
  Eigen::Matrix4d pose = T;
  pose.topLeftCorner<3, 3>() =
      Eigen::Quaterniond(Eigen::Matrix3d(T.topLeftCorner<3, 3>())).normalized().toRotationMatrix();
  return pose;
}
} // namespace fresco
