// SPDX-License-Identifier: BSD-3-Clause
#include <fresco/deliverables/core/model_file.h>
#include <fresco/io/file.h>
#include <fresco/io/formats.h>
#include <fresco/io/mesh_io.h>
#include <stdexcept>
namespace fresco {
bool isTextured(const TexturedMesh& model) { return (model.face_atlas.array() >= 0).any(); }

bool isColored(const TexturedMesh& model) { return model.mesh.colors.cols() > 0 || isTextured(model); }

std::optional<GltfModel> readModelIfAny(const std::string& path)
{
  GltfModel read;
  if (!isReadable(path, FileKind::mesh) && !isReadable(path, FileKind::textured_mesh))
    return {};
  if (extension(path) == ".glb")
    read = readGltf(path);
  else if (isReadable(path, FileKind::textured_mesh))
    read.model = readTexturedMesh(path);
  if (!isTextured(read.model)) {
    TriangleMesh mesh = extension(path) == ".glb" ? std::move(read.model.mesh) : readMesh(path);
    read = {};
    read.model.mesh = std::move(mesh);
  }
  if (read.model.mesh.faceCount() == 0)
    return {};
  return read;
}

GltfModel readModel(const std::string& path)
{
  if (std::optional<GltfModel> model = readModelIfAny(path))
    return std::move(*model);
  if (!isReadable(path, FileKind::mesh))
    readMesh(path); // says which files it reads
  throw std::runtime_error(path + ": has no faces");
}

void writeModel(const std::string& path, GltfModel written, const GltfOptions& options)
{
  TexturedMesh& model = written.model;
  const bool glb = extension(path) == ".glb";
  if (!isWritable(path, FileKind::textured_mesh) || (!isTextured(model) && !glb))
    return writeMesh(path, model.mesh);
  if (model.texcoord_faces.cols() == 0) {
    model.texcoord_faces = Faces::Constant(3, model.mesh.faceCount(), -1);
    model.face_atlas = Eigen::VectorXi::Constant(model.mesh.faceCount(), -1);
  }
  glb ? writeGltf(path, written, options) : writeTexturedMesh(path, model, options.jpeg_quality);
}
} // namespace fresco
