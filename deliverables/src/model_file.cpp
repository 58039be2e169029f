// SPDX-License-Identifier: BSD-3-Clause
#include <fresco/deliverables/core/model_file.h>
#include <fresco/io/file.h>
#include <fresco/io/formats.h>
#include <fresco/io/mesh_io.h>
#include <stdexcept>
namespace fresco {
bool isTextured(const TexturedMesh& model) { return (model.face_atlas.array() >= 0).any(); }

TexturedMesh readModel(const std::string& path)
{
  TexturedMesh model;
  if (isReadable(path, FileKind::textured_mesh))
    model = readTexturedMesh(path);
  if (!isTextured(model)) {
    TriangleMesh mesh = extension(path) == ".glb" ? std::move(model.mesh) : readMesh(path);
    model = {};
    model.mesh = std::move(mesh);
  }
  if (model.mesh.faceCount() == 0)
    throw std::runtime_error(path + ": has no faces");
  return model;
}

void writeModel(const std::string& path, TexturedMesh model, int jpeg_quality)
{
  if (!isWritable(path, FileKind::textured_mesh) || (!isTextured(model) && extension(path) != ".glb"))
    return writeMesh(path, model.mesh);
  if (model.texcoord_faces.cols() == 0) {
    model.texcoord_faces = Faces::Constant(3, model.mesh.faceCount(), -1);
    model.face_atlas = Eigen::VectorXi::Constant(model.mesh.faceCount(), -1);
  }
  writeTexturedMesh(path, model, jpeg_quality);
}
} // namespace fresco
