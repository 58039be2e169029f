// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/remarks.h"
#include "io/mesh/obj.h"
#include "io/points/text_numbers.h"
namespace fresco::io {
void writeObjVertices(OutputFile& file, const TriangleMesh& mesh)
{
  const bool has_origin = !mesh.origin.isZero(0);
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    file.write("v");
    for (int k = 0; k < 3; ++k)
      if (has_origin)
        file.write(textOf(' ', mesh.origin[k] + static_cast<double>(mesh.vertices(k, v))));
      else
        file.write(textOf(' ', mesh.vertices(k, v)));
    for (int k = 0; k < 3 && mesh.colors.cols() > 0; ++k)
      file.write(textOf(' ', static_cast<float>(mesh.colors(k, v)) / 255.f));
    file.write("\n");
  }
  for (Index v = 0; v < mesh.normals.cols(); ++v)
    file.write(textOf("vn ", mesh.normals(0, v), ' ', mesh.normals(1, v), ' ', mesh.normals(2, v), '\n'));
}

void writeObjFace(OutputFile& file, const TriangleMesh& mesh, Index f, const int* texcoords)
{
  file.write("f");
  for (int k = 0; k < 3; ++k) {
    const int vertex = mesh.faces(k, f) + 1;
    file.write(texcoords ? textOf(' ', vertex, '/', texcoords[k] + 1) : textOf(' ', vertex));
    if (mesh.normals.cols() > 0)
      file.write(textOf(texcoords ? "/" : "//", vertex));
  }
  file.write("\n");
}

void writeObj(const std::string& path, const TriangleMesh& mesh)
{
  validateMesh(mesh);
  if (!mesh.fields.empty())
    remark(concat(path, ": fields have no place in OBJ: ", mesh.fields.begin()->first,
                  mesh.fields.size() > 1 ? " ..." : ""));
  OutputFile file(path);
  writeObjVertices(file, mesh);
  for (Index f = 0; f < mesh.faceCount(); ++f)
    writeObjFace(file, mesh, f);
  file.commit();
}
} // namespace fresco::io
