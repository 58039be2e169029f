// SPDX-License-Identifier: BSD-3-Clause
#include <fresco/core/pcl_cloud_table.h>
#include <fresco/core/pcl_conversions.h>
#include <fresco/core/polygon_fans.h>
#include <fresco/core/require.h>
namespace fresco {
namespace core {
namespace {
/// Coordinates with `origin` added in double, rounded to float.
template <typename Derived>
Points inWorld(const Eigen::MatrixBase<Derived>& points, const Eigen::Vector3d& origin)
{
  if (origin.isZero(0))
    return points;
  return (points.template cast<double>().colwise() + origin).template cast<float>();
}

const Column* sourceOf(const PointTable& table, const pcl::PCLPointField& field)
{
  return table.find(field.name == "rgba" ? "rgb" : field.name);
}

void convertCell(const PointTable& table, Index row, const Column& from, const pcl::PCLPointField& to, std::uint8_t* at)
{
  if (from.name == "rgb") {
    const std::uint32_t opaque = loadScalar<std::uint32_t>(table.cell(row, from)) | 0xff000000U;
    std::memcpy(at, &opaque, sizeof(opaque));
    return;
  }
  storeValue(scalarOfField(to.datatype), loadScalar<float>(table.cell(row, from)), at);
}
} // namespace

PointSet pointsFromBytes(const std::vector<pcl::PCLPointField>& fields, const PointBytes& bytes,
                         const pcl::Indices* indices)
{
  PointTable table;
  for (const pcl::PCLPointField& field : fields)
    table.columns.push_back(
        {field.name, scalarOfField(field.datatype), std::max<std::size_t>(field.count, 1), field.offset});
  table.stride = bytes.stride;
  const auto* points = static_cast<const std::uint8_t*>(bytes.data);
  if (!indices) {
    table.rows = bytes.count;
    table.view = points;
    return tableToPoints(table);
  }
  table.allocate(indices->size());
  std::uint8_t* to = table.data.data();
  for (const std::ptrdiff_t index : *indices) {
    require(index >= 0 && std::size_t(index) < bytes.count, "index ", index, " is not one of ", bytes.count, " points");
    std::memcpy(to, points + index * bytes.stride, bytes.stride);
    to += bytes.stride;
  }
  return tableToPoints(table);
}

void pointsToBytes(const PointSet& set, const std::vector<pcl::PCLPointField>& fields, void* data, std::size_t stride)
{
  PointSet world = set;
  world.points = inWorld(set.points, set.origin);
  world.viewpoints = inWorld(set.viewpoints, set.origin);
  world.origin.setZero();
  const PointTable table = pointsToTable(world);
  for (const pcl::PCLPointField& field : fields) {
    const Column* column = sourceOf(table, field);
    if (!column)
      continue;
    std::uint8_t* at = static_cast<std::uint8_t*>(data) + field.offset;
    for (Index row = 0; row < table.rows; ++row, at += stride)
      convertCell(table, row, *column, field, at);
  }
}
} // namespace core

void toPolygonMesh(const TriangleMesh& mesh, pcl::PolygonMesh& polygons)
{
  validateMesh(mesh);
  TriangleMesh vertices = mesh;
  vertices.vertices = core::inWorld(mesh.vertices, mesh.origin);
  vertices.origin.setZero();
  vertices.faces.resize(3, 0);
  const pcl::PCLHeader header = polygons.cloud.header;
  polygons.cloud = core::cloudOfTable(core::meshToTable(vertices));
  polygons.cloud.header = header;
  polygons.polygons.resize(mesh.faceCount());
  for (Index f = 0; f < mesh.faceCount(); ++f)
    polygons.polygons[f].vertices = {mesh.faces(0, f), mesh.faces(1, f), mesh.faces(2, f)};
}

TriangleMesh toTriangleMesh(const pcl::PolygonMesh& polygons)
try {
  TriangleMesh mesh = core::tableToMesh(core::tableOfCloud(polygons.cloud));
  core::FaceCollector collector;
  for (const pcl::Vertices& polygon : polygons.polygons) {
    const std::vector<std::int64_t> corners(polygon.vertices.begin(), polygon.vertices.end());
    collector.addPolygon(corners.data(), corners.size());
  }
  mesh.faces = collector.faces(mesh.vertexCount());
  return mesh;
} catch (const std::runtime_error& error) {
  throw std::invalid_argument(std::string("mesh: ") + error.what());
}
} // namespace fresco
