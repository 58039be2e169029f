// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/remarks.h"
#include "io/mesh/obj.h"
#include "io/points/text_numbers.h"
namespace fresco::io {
void writeObjVertices(TextWriter& writer, const TriangleMesh& mesh)
{
  const bool has_origin = !mesh.origin.isZero(0);
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    writer.text("v");
    for (int k = 0; k < 3; ++k)
      if (has_origin)
        writer.text(" ").number(mesh.origin[k] + static_cast<double>(mesh.vertices(k, v)));
      else
        writer.text(" ").number(mesh.vertices(k, v));
    for (int k = 0; k < 3 && mesh.colors.cols() > 0; ++k)
      writer.text(" ").number(static_cast<float>(mesh.colors(k, v)) / 255.f);
    writer.text("\n");
  }
  for (Index v = 0; v < mesh.normals.cols(); ++v) {
    writer.text("vn");
    for (int k = 0; k < 3; ++k)
      writer.text(" ").number(mesh.normals(k, v));
    writer.text("\n");
  }
}

void writeObj(const std::string& path, const TriangleMesh& mesh)
{
  validateMesh(mesh);
  if (!mesh.fields.empty())
    remark(concat(path, ": fields have no place in OBJ: ", mesh.fields.begin()->first,
                  mesh.fields.size() > 1 ? " ..." : ""));
  OutputFile file(path);
  TextWriter writer(file);
  writeObjVertices(writer, mesh);
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    writer.text("f");
    for (int k = 0; k < 3; ++k) {
      writer.text(" ").number(mesh.faces(k, f) + 1);
      if (mesh.normals.cols() > 0)
        writer.text("//").number(mesh.faces(k, f) + 1);
    }
    writer.text("\n");
  }
  writer.flush();
  file.commit();
}
} // namespace fresco::io
