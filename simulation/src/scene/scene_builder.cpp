// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/simulation/scene/scene_builder.h>
namespace fresco::simulation {
using Eigen::Vector3f;

Eigen::Isometry3f standing(const Vector3f& at, float degrees)
{
  const float angle = degrees * static_cast<float>(radians_per_degree);
  return Eigen::Translation3f(at) * Eigen::Isometry3f(Eigen::AngleAxisf(angle, Vector3f::UnitZ()));
}

SceneBuilder::SceneBuilder(std::string name, float max_edge) : max_edge_(max_edge) { scene_.name = std::move(name); }

int SceneBuilder::add(const Material& material)
{
  scene_.materials.push_back(material);
  return scene_.materials.size() - 1;
}

void SceneBuilder::beginObject(const std::string& name, const Eigen::Isometry3f& T_world_object)
{
  if (!scene_.objects.empty())
    scene_.objects.back().end = faces_.size();
  scene_.objects.push_back({name, Index(faces_.size()), 0});
  T_world_object_ = T_world_body_ = T_world_object;
  part_of_material_.clear();
}

int SceneBuilder::part(int material)
{
  const auto [found, fresh] = part_of_material_.try_emplace(material, scene_.parts.size());
  if (fresh)
    scene_.parts.push_back({material, T_world_object_.inverse()});
  return found->second;
}

int SceneBuilder::vertex(const Vector3f& local)
{
  const auto key = [&](int axis) -> int { return std::lround(1e5f * local[axis]); };
  const auto [found, fresh] = welded_.try_emplace(std::make_tuple(key(0), key(1), key(2)), vertices_.size());
  if (fresh)
    vertices_.push_back(T_world_body_ * local);
  return found->second;
}

void SceneBuilder::cell(const std::array<Corner, 4>& corners, int material)
{
  Cell cell;
  for (std::size_t k = 0; k < 4; ++k) {
    cell.corners[k] = vertex(corners[k].position);
    cell.normals[k] = (T_world_body_.linear() * corners[k].normal).normalized();
  }
  cell.part = part(material);
  const int number = scene_.cells.size();
  const auto face = [&](int half, std::array<int, 3> v) {
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0])
      return;
    faces_.push_back(v);
    scene_.face_cell.push_back(2 * number + half);
  };
  face(0, {cell.corners[0], cell.corners[1], cell.corners[2]});
  face(1, {cell.corners[0], cell.corners[2], cell.corners[3]});
  scene_.cells.push_back(cell);
}

namespace {
constexpr float full_turn = 2 * pi; // radians

using Steps = std::vector<float>;

/// Coordinates of all box sides along an axis, with further ones so that no gap exceeds `max_edge`.
Steps gridLines(const std::vector<Box>& boxes, int axis, float max_edge)
{
  Steps sides;
  for (const Box& box : boxes)
    sides.insert(sides.end(), {box.min[axis], box.max[axis]});
  std::sort(sides.begin(), sides.end());
  sides.erase(std::unique(sides.begin(), sides.end(), [](float a, float b) { return b - a < 1e-4f; }), sides.end());
  Steps lines;
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const int parts = std::max<int>(1, std::ceil((sides[i + 1] - sides[i]) / max_edge - 1e-3f));
    for (int k = 0; k < parts; ++k)
      lines.push_back(sides[i] + (sides[i + 1] - sides[i]) * k / parts);
  }
  lines.push_back(sides.back());
  return lines;
}

/// The space of a union of boxes, cut into blocks by all grid lines.
struct Blocks {
  std::array<Steps, 3> lines;
  std::vector<int> box; ///< last box that covers a block, -1 none

  int count(int axis) const { return lines[axis].size() - 1; }
  int at(const Eigen::Vector3i& block) const
  {
    for (int axis = 0; axis < 3; ++axis)
      if (block[axis] < 0 || block[axis] >= count(axis))
        return -1;
    return box[(block[2] * count(1) + block[1]) * count(0) + block[0]];
  }
  float line(int axis, int i) const { return lines[axis][i]; }
};

int lastCover(const std::vector<Box>& boxes, const Vector3f& middle)
{
  for (int b = boxes.size() - 1; b >= 0; --b) {
    const Box& box = boxes[b];
    if ((middle.array() > box.min.array()).all() && (middle.array() < box.max.array()).all())
      return b;
  }
  return -1;
}

Blocks cutIntoBlocks(const std::vector<Box>& boxes, float max_edge)
{
  Blocks blocks;
  for (int axis = 0; axis < 3; ++axis)
    blocks.lines[axis] = gridLines(boxes, axis, max_edge);
  for (int z = 0; z < blocks.count(2); ++z)
    for (int y = 0; y < blocks.count(1); ++y)
      for (int x = 0; x < blocks.count(0); ++x) {
        const Vector3f middle =
            0.5f * Vector3f(blocks.line(0, x) + blocks.line(0, x + 1), blocks.line(1, y) + blocks.line(1, y + 1),
                            blocks.line(2, z) + blocks.line(2, z + 1));
        blocks.box.push_back(lastCover(boxes, middle));
      }
  return blocks;
}

/// Side `direction` (-x +x -y +y -z +z) of a block, counter-clockwise seen from outside, or with `inward` from within.
std::array<Vector3f, 4> blockSide(const Blocks& blocks, const Eigen::Vector3i& block, int direction, bool inward)
{
  const int axis = direction / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
  const bool positive = direction % 2 == 1;
  std::array<Vector3f, 4> side;
  const int du[4] = {0, 1, 1, 0}, dv[4] = {0, 0, 1, 1};
  for (int k = 0; k < 4; ++k) {
    const int from = positive != inward ? k : 3 - k;
    Vector3f corner;
    corner[axis] = blocks.line(axis, block[axis] + (positive ? 1 : 0));
    corner[u] = blocks.line(u, block[u] + du[from]);
    corner[v] = blocks.line(v, block[v] + dv[from]);
    side[k] = corner;
  }
  return side;
}
} // namespace

void SceneBuilder::boxes(const std::vector<Box>& list, bool background_solid)
{
  welded_.clear();
  const Blocks blocks = cutIntoBlocks(list, max_edge_);
  const auto solid = [&](int b) { return b < 0 ? background_solid : list[b].solid; };
  const auto sides = [&](const Eigen::Vector3i& block) {
    const int own = blocks.at(block);
    for (int direction = 0; direction < 6; ++direction) {
      const int axis = direction / 2;
      const bool positive = direction % 2 == 1;
      Eigen::Vector3i beside = block;
      beside[axis] += positive ? 1 : -1;
      const int other = blocks.at(beside);
      if (solid(own) == solid(other))
        continue;
      if (solid(own) ? own < 0 : other >= 0)
        continue;                    // the neighbour draws this side
      const bool flip = !solid(own); // free block in a solid background: the face looks into the block
      const Vector3f normal = (positive != flip ? 1.f : -1.f) * Vector3f(Vector3f::Unit(axis));
      const auto p = blockSide(blocks, block, direction, flip);
      cell({{{p[0], normal}, {p[1], normal}, {p[2], normal}, {p[3], normal}}}, list[own].materials[direction]);
    }
  };
  for (int z = 0; z < blocks.count(2); ++z)
    for (int y = 0; y < blocks.count(1); ++y)
      for (int x = 0; x < blocks.count(0); ++x)
        sides({x, y, z});
}

void SceneBuilder::closedLattice(const Lattice& rows, int material)
{
  welded_.clear();
  for (std::size_t i = 0; i + 1 < rows.size(); ++i)
    for (std::size_t j = 0; j + 1 < rows[i].size(); ++j) {
      const Corner &a = rows[i][j], &b = rows[i][j + 1], &c = rows[i + 1][j + 1], &d = rows[i + 1][j];
      const bool tip = (c.position - d.position).norm() < 1e-5f;
      const bool start = (a.position - b.position).norm() < 1e-5f;
      const bool same = (a.position - d.position).norm() < 1e-5f && (b.position - c.position).norm() < 1e-5f;
      if (same || (tip && start))
        continue;
      if (start)
        cell({{a, c, d, d}}, material);
      else if (tip)
        cell({{a, b, c, c}}, material);
      else
        cell({{a, b, c, d}}, material);
    }
}

void SceneBuilder::lathe(const std::vector<ProfilePoint>& profile, int material, int segments)
{
  Lattice rows;
  for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
    const ProfilePoint low = profile[k], high = profile[k + 1];
    const float dr = high.radius - low.radius, dz = high.z - low.z;
    const float length = std::hypot(dr, dz);
    const int parts = std::max<int>(1, std::ceil(length / max_edge_ - 1e-3f));
    for (int i = 0; i <= parts; ++i) {
      const float t = static_cast<float>(i) / parts;
      std::vector<Corner> row;
      for (int j = 0; j <= segments; ++j) {
        const float angle = full_turn * (j % segments) / segments;
        const Vector3f out(std::cos(angle), std::sin(angle), 0);
        const Vector3f normal = (dz * out - dr * Vector3f::UnitZ()) / length;
        row.push_back({(low.radius + t * dr) * out + (low.z + t * dz) * Vector3f::UnitZ(), normal});
      }
      rows.push_back(row);
    }
  }
  closedLattice(rows, material);
}

void SceneBuilder::sweep(const std::vector<SweepKnot>& knots, const Vector3f& width_axis, int material)
{
  constexpr int segments = 10;
  Lattice rows;
  const auto ring = [&](const SweepKnot& knot, const Vector3f& along, float scale, float tilt) {
    const Vector3f across = (width_axis - width_axis.dot(along) * along).normalized(), up = along.cross(across);
    std::vector<Corner> row;
    for (int j = 0; j <= segments; ++j) {
      const float angle = full_turn * (j % segments) / segments;
      const Vector3f offset = std::cos(angle) * knot.half_width * across + std::sin(angle) * knot.half_thickness * up;
      const Vector3f out = std::cos(angle) * knot.half_thickness * across + std::sin(angle) * knot.half_width * up;
      row.push_back(
          {knot.position + scale * offset, ((1 - std::fabs(tilt)) * out.normalized() + tilt * along).normalized()});
    }
    rows.push_back(row);
  };
  for (std::size_t k = 0; k < knots.size(); ++k) {
    const bool first = k == 0, last = k + 1 == knots.size();
    const Vector3f before = knots[first ? 0 : k - 1].position, after = knots[last ? k : k + 1].position;
    const Vector3f along = (after - before).normalized();
    if (first)
      ring(knots[k], along, 0.f, -1.f), ring(knots[k], along, 1.f, -1.f);
    ring(knots[k], along, 1.f, 0.f);
    if (last)
      ring(knots[k], along, 1.f, 1.f), ring(knots[k], along, 0.f, 1.f);
  }
  closedLattice(rows, material);
}

void SceneBuilder::tube(const std::vector<Vector3f>& line, float radius, int material)
{
  std::vector<SweepKnot> knots;
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const int parts = std::max<int>(1, std::ceil((line[k + 1] - line[k]).norm() / max_edge_ - 1e-3f));
    for (int i = 0; i < parts; ++i)
      knots.push_back({line[k] + (line[k + 1] - line[k]) * i / parts, radius, radius});
  }
  knots.push_back({line.back(), radius, radius});
  const Vector3f along = (line.back() - line.front()).normalized();
  int least = 0;
  along.cwiseAbs().minCoeff(&least);
  sweep(knots, Vector3f::Unit(least), material);
}

void SceneBuilder::cushion(const Vector3f& half_axes, int material)
{
  constexpr int segments = 32, rings = 16;
  Lattice rows;
  const auto power = [](float x, float e) { return std::copysign(std::pow(std::fabs(x), e), x); };
  for (int i = 0; i <= rings; ++i) {
    const float polar = full_turn / 2 * (static_cast<float>(i) / rings - 0.5f);
    std::vector<Corner> row;
    for (int j = 0; j <= segments; ++j) {
      const float angle = full_turn * (j % segments) / segments;
      const bool pole = i == 0 || i == rings;
      const Vector3f unit(pole ? 0.f : power(std::cos(polar), 0.5f) * power(std::cos(angle), 0.5f),
                          pole ? 0.f : power(std::cos(polar), 0.5f) * power(std::sin(angle), 0.5f),
                          power(std::sin(polar), 0.5f));
      const Vector3f gradient = unit.cwiseAbs().array().pow(3.f) * unit.cwiseSign().array() / half_axes.array();
      row.push_back({unit.cwiseProduct(half_axes), gradient.normalized()});
    }
    rows.push_back(row);
  }
  closedLattice(rows, material);
}

Scene SceneBuilder::finish()
{
  if (!scene_.objects.empty())
    scene_.objects.back().end = faces_.size();
  scene_.mesh.vertices = Eigen::Map<const Points>(vertices_.data()->data(), 3, vertices_.size());
  scene_.mesh.faces = Eigen::Map<const Faces>(faces_.data()->data(), 3, faces_.size());
  return std::move(scene_);
}
} // namespace fresco::simulation
