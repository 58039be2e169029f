// SPDX-License-Identifier: BSD-3-Clause
#include "evidence/scan_patches.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <fresco/core/constants.h>
#include <map>
namespace fresco::registration {
namespace {
constexpr Index most_patches = 2500;
constexpr float large_share = 0.08f, medium_share = 0.02f; // of a scan's patches: a wall, a table
constexpr float same_plane = 0.97f;                        // cosine of 14 degrees: normals of one plane, with noise

// One point with a normal of each cell: the one nearest to its middle.
std::vector<Index> spreadEvenly(const ScanLevel& level, float spacing)
{
  std::map<std::array<int, 3>, std::pair<float, Index>> cells;
  for (Index i = 0; i < level.points.cols(); ++i) {
    if (level.normals.col(i).isZero())
      continue;
    const Eigen::Vector3f place = level.points.col(i) / spacing;
    const Eigen::Vector3f cell = place.array().floor();
    const float off =
        (place - cell).cwiseAbs2().sum() - (place - cell).sum(); // from the middle, squared, but a constant
    const std::array<int, 3> key{static_cast<int>(cell.x()), static_cast<int>(cell.y()), static_cast<int>(cell.z())};
    const auto [slot, fresh] = cells.try_emplace(key, off, i);
    if (!fresh && off < slot->second.first)
      slot->second = {off, i};
  }
  std::vector<Index> chosen;
  for (const auto& cell : cells)
    chosen.push_back(cell.second.second);
  return chosen;
}

void findNeighbours(ScanPatches& patches)
{
  constexpr float reach = 2.2f; // cells: the next but one, over a gap of one
  const PointTree tree(patches.points, 1);
  std::vector<Neighbor> found;
  patches.around.setConstant(8, patches.size(), -1);
  for (Index i = 0; i < patches.size(); ++i) {
    tree.nearest(patches.points.col(i), 8, found);
    for (std::size_t k = 0; k < found.size(); ++k)
      if (found[k].squared_distance < reach * reach * patches.spacing * patches.spacing)
        patches.around(k, i) = found[k].index;
  }
}

// Patches on the plane of one of them.
std::vector<Index> onPlaneOf(const ScanPatches& patches, Index i, float thickness)
{
  const Eigen::Vector3f normal = patches.normals.col(i);
  const float offset = normal.dot(patches.points.col(i));
  std::vector<Index> on_plane;
  for (Index k = 0; k < patches.size(); ++k)
    if (std::abs(normal.dot(patches.points.col(k)) - offset) < thickness &&
        normal.dot(patches.normals.col(k)) > same_plane)
      on_plane.push_back(k);
  return on_plane;
}

struct LargePlane {
  Eigen::Vector3f normal;
  float offset;
  std::vector<Index> patches;
};

// Sets the kinds. The large planes are chosen greedily, the largest first.
std::vector<LargePlane> findPlanes(ScanPatches& patches, float thickness)
{
  const float n = patches.size();
  std::vector<std::pair<Index, Index>> sizes; // negative size, patch
  for (Index i = 0; i < patches.size(); ++i) {
    const Index size = onPlaneOf(patches, i, thickness).size();
    patches.kinds.push_back(size > large_share * n    ? PatchKind::large
                            : size > medium_share * n ? PatchKind::medium
                                                      : PatchKind::small);
    sizes.emplace_back(-size, i);
  }
  std::sort(sizes.begin(), sizes.end());
  std::vector<char> taken(patches.size(), 0);
  std::vector<LargePlane> planes;
  for (const auto& [size, i] : sizes) {
    if (taken[i] != 0 || -size < medium_share * n)
      continue;
    LargePlane plane{patches.normals.col(i), patches.normals.col(i).dot(patches.points.col(i)), {}};
    for (const Index k : onPlaneOf(patches, i, thickness)) {
      if (taken[k] == 0)
        plane.patches.push_back(k);
      taken[k] = 1;
    }
    if (plane.patches.size() > medium_share * n)
      planes.push_back(plane);
  }
  return planes;
}

// Whether a plane lies around a place on it: an opening of it, such as a door, has the wall on most sides.
bool surrounds(const LargePlane& plane, const ScanPatches& patches, const Eigen::Vector3f& place, float reach)
{
  constexpr int sectors = 8, fewest = 5; // a wall that ends there takes four
  const Eigen::Vector3f u = plane.normal.unitOrthogonal(), v = plane.normal.cross(u);
  unsigned seen = 0;
  for (const Index k : plane.patches) {
    const Eigen::Vector3f off = patches.points.col(k) - place;
    if (off.squaredNorm() > reach * reach)
      continue;
    const float turn = std::atan2(off.dot(v), off.dot(u)) / static_cast<float>(pi) + 1.f; // 0..2
    seen |= 1u << std::min(sectors - 1, static_cast<int>(turn * sectors / 2));
  }
  int count = 0;
  for (int k = 0; k < sectors; ++k)
    count += seen >> k & 1u;
  return count >= fewest;
}

// A patch whose ray went through an opening of a large plane is of another room than the scanner.
void findRooms(const std::vector<LargePlane>& planes, float size, ScanPatches& patches)
{
  constexpr float beyond = 0.1f, reach = 0.5f; // of the scan's size: a wall's thickness, a door's width
  patches.rooms.assign(patches.size(), 0);
  for (Index i = 0; i < patches.size(); ++i) {
    float nearest = 1.f;
    for (std::size_t k = 0; k < planes.size() && k < 250; ++k) {
      const float height = planes[k].normal.dot(patches.points.col(i)); // the viewpoint is at 0
      if (std::abs(height) < std::abs(planes[k].offset) + beyond * size || height * planes[k].offset <= 0.f)
        continue;
      const float along = planes[k].offset / height; // of the ray
      if (along < nearest && surrounds(planes[k], patches, along * patches.points.col(i), reach * size)) {
        nearest = along;
        patches.rooms[i] = k + 1;
      }
    }
  }
  patches.room_count = planes.size() + 1;
}
} // namespace

ScanPatches makePatches(const PreparedScan& scan)
{
  constexpr float thickness = 1.5f; // voxels: of a plane, with noise
  const ScanLevel& level = scan.levels[check_level];
  ScanPatches patches;
  patches.spacing = 2.f * level.voxel;
  std::vector<Index> chosen = spreadEvenly(level, patches.spacing);
  while (static_cast<Index>(chosen.size()) > most_patches) {
    patches.spacing *= 1.02f * std::sqrt(1.f * chosen.size() / most_patches);
    chosen = spreadEvenly(level, patches.spacing);
  }
  patches.points = level.points(Eigen::all, chosen);
  patches.normals = level.normals(Eigen::all, chosen);
  findNeighbours(patches);
  findRooms(findPlanes(patches, thickness * level.voxel), scan.size, patches);
  return patches;
}
} // namespace fresco::registration
