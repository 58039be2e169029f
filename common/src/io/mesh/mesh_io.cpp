// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/obj.h"
#include "io/mesh/ply.h"
#include "io/mesh/vtk_file.h"
#include "io/points/parse_file.h"
#include <fresco/io/mesh_io.h>
namespace fresco {
namespace {
TriangleMesh joinMesh(const io::PointTable& vertices, Faces faces)
{
  TriangleMesh mesh = io::tableToMesh(vertices);
  mesh.faces = std::move(faces);
  return mesh;
}

TriangleMesh parseObjMesh(std::string_view content)
{
  const io::ObjContent obj = io::parseObj(content);
  return joinMesh(io::objVertices(obj), io::objFaces(obj));
}

TriangleMesh parsePlyMesh(std::string_view content)
{
  io::PlyContent ply = io::parsePly(content);
  return joinMesh(ply.vertices, std::move(ply.faces));
}

TriangleMesh parseVtkMesh(std::string_view content)
{
  io::VtkContent vtk = io::parseVtk(content);
  return joinMesh(vtk.vertices, std::move(vtk.faces));
}
} // namespace

TriangleMesh readMesh(const std::string& path)
{
  const std::string type = extension(path);
  if (type == ".ply")
    return io::parseFile(path, parsePlyMesh);
  if (type == ".obj")
    return io::parseFile(path, parseObjMesh);
  if (type == ".vtk")
    return io::parseFile(path, parseVtkMesh);
  throw std::runtime_error(path + ": not a mesh file: expected .ply, .obj or .vtk");
}

void writeMesh(const std::string& path, const TriangleMesh& mesh)
{
  const std::string type = extension(path);
  if (type == ".ply")
    io::writePly(path, io::meshToTable(mesh), mesh.faces);
  else if (type == ".obj")
    io::writeObj(path, mesh);
  else if (type == ".vtk")
    io::writeVtk(path, io::meshToTable(mesh), mesh.faces);
  else
    throw std::runtime_error(path + ": cannot write this type of mesh file: use .ply, .obj or .vtk");
}
} // namespace fresco
