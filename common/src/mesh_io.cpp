// SPDX-License-Identifier: BSD-3-Clause
#include "obj.h"
#include "ply.h"
#include "point_io_parse.h"
#include "vtk_file.h"
#include <fresco/common/mesh_io.h>
namespace fresco {
namespace {
TriangleMesh joinMesh(const detail::PointTable& vertices, Faces faces)
{
  TriangleMesh mesh = detail::tableToMesh(vertices);
  mesh.faces = std::move(faces);
  return mesh;
}

TriangleMesh parseObjMesh(std::string_view content)
{
  const detail::ObjContent obj = detail::parseObj(content);
  return joinMesh(detail::objVertices(obj), detail::objFaces(obj));
}

TriangleMesh parsePlyMesh(std::string_view content)
{
  detail::PlyContent ply = detail::parsePly(content);
  return joinMesh(ply.vertices, std::move(ply.faces));
}

TriangleMesh parseVtkMesh(std::string_view content)
{
  detail::VtkContent vtk = detail::parseVtk(content);
  return joinMesh(vtk.vertices, std::move(vtk.faces));
}
} // namespace

TriangleMesh readMesh(const std::string& path)
{
  const std::string type = extension(path);
  if (type == ".ply")
    return detail::parseFile(path, parsePlyMesh);
  if (type == ".obj")
    return detail::parseFile(path, parseObjMesh);
  if (type == ".vtk")
    return detail::parseFile(path, parseVtkMesh);
  throw std::runtime_error(path + ": not a mesh file: expected .ply, .obj or .vtk");
}

void writeMesh(const std::string& path, const TriangleMesh& mesh)
{
  const std::string type = extension(path);
  if (type == ".ply")
    detail::writePly(path, detail::meshToTable(mesh), mesh.faces);
  else if (type == ".obj")
    detail::writeObj(path, mesh);
  else if (type == ".vtk")
    detail::writeVtk(path, detail::meshToTable(mesh), mesh.faces);
  else
    throw std::runtime_error(path + ": cannot write this type of mesh file: use .ply, .obj or .vtk");
}
} // namespace fresco
