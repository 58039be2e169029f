// SPDX-License-Identifier: BSD-3-Clause
#include "actor.h"
#include <algorithm>
#include <cstring>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkTexture.h>
#include <vtkUnsignedCharArray.h>
namespace fresco::rendering {
namespace {
constexpr int keep_memory = 1; // the array does not own what it points to

/// VTK array over the columns of an Eigen matrix, without a copy.
template <typename Array, typename Matrix>
vtkSmartPointer<Array> viewOf(Matrix& matrix)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetNumberOfComponents(matrix.rows());
  array->SetArray(matrix.data(), matrix.size(), keep_memory);
  return array;
}

vtkSmartPointer<vtkCellArray> triangles(Faces& faces)
{
  const vtkNew<vtkIntArray> corners;
  corners->SetArray(faces.data(), faces.size(), keep_memory);
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(3, corners);
  return cells;
}

vtkSmartPointer<vtkCellArray> singlePoints(Index count)
{
  const vtkNew<vtkIntArray> points;
  points->SetNumberOfValues(count);
  for (Index i = 0; i < count; ++i)
    points->SetValue(i, i);
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(1, points);
  return cells;
}

vtkSmartPointer<vtkPolyData> toPolyData(DrawMesh& mesh)
{
  auto data = vtkSmartPointer<vtkPolyData>::New();
  const vtkNew<vtkPoints> points;
  points->SetData(viewOf<vtkFloatArray>(mesh.vertices));
  data->SetPoints(points);
  if (mesh.faces.cols() > 0)
    data->SetPolys(triangles(mesh.faces));
  else
    data->SetVerts(singlePoints(mesh.vertices.cols()));
  if (mesh.normals.cols() > 0)
    data->GetPointData()->SetNormals(viewOf<vtkFloatArray>(mesh.normals));
  if (mesh.texcoords.cols() > 0)
    data->GetPointData()->SetTCoords(viewOf<vtkFloatArray>(mesh.texcoords));
  if (mesh.face_colors.cols() > 0)
    data->GetCellData()->SetScalars(viewOf<vtkUnsignedCharArray>(mesh.face_colors));
  else if (mesh.colors.cols() > 0)
    data->GetPointData()->SetScalars(viewOf<vtkUnsignedCharArray>(mesh.colors));
  return data;
}

/// VTK's images begin with the lowest row.
vtkSmartPointer<vtkTexture> makeTexture(const Image& image, bool mipmap)
{
  const vtkNew<vtkImageData> data;
  data->SetDimensions(image.width, image.height, 1);
  data->AllocateScalars(VTK_UNSIGNED_CHAR, image.channels);
  const Index row = Index(image.width) * image.channels;
  auto* to = static_cast<unsigned char*>(data->GetScalarPointer());
  for (int y = image.height - 1; y >= 0; --y, to += row)
    std::memcpy(to, image.pixel(0, y), row);
  auto texture = vtkSmartPointer<vtkTexture>::New();
  texture->SetInputData(data);
  texture->SetColorModeToDirectScalars();
  texture->SetWrap(vtkTexture::ClampToEdge);
  texture->InterpolateOn();
  texture->SetMipmap(mipmap);
  texture->SetMaximumAnisotropicFiltering(1.f);
  return texture;
}

void setSurface(vtkProperty& property, const SurfaceLook& look)
{
  property.SetColor(look.color[0], look.color[1], look.color[2]);
  property.SetLighting(look.lit);
  property.SetAmbient(look.lit ? look.ambient : 1.0);
  property.SetDiffuse(look.lit ? 1.0 - look.ambient : 0.0);
  property.SetSpecular(look.specular);
  property.SetSpecularPower(25);
  property.SetPointSize(look.size);
  property.SetBackfaceCulling(look.cull_back_faces);
  if (look.edge_strength > 0) {
    property.EdgeVisibilityOn();
    property.SetLineWidth(look.size);
    const auto edge = [&](int c) { return (1 - look.edge_strength) * look.color[c]; };
    property.SetEdgeColor(edge(0), edge(1), edge(2));
  }
}
} // namespace

vtkSmartPointer<vtkActor> makeActor(DrawMesh& mesh, const SurfaceLook& look)
{
  const vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(toPolyData(mesh));
  const bool colored = mesh.face_colors.cols() > 0 || mesh.colors.cols() > 0;
  mapper->SetScalarVisibility(colored && !look.texture);
  mapper->SetColorModeToDirectScalars();
  if (mesh.face_colors.cols() > 0)
    mapper->SetScalarModeToUseCellData();
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  setSurface(*actor->GetProperty(), look);
  if (mesh.normals.cols() > 0)
    actor->GetProperty()->SetInterpolationToPhong();
  else
    actor->GetProperty()->SetInterpolationToFlat();
  if (look.texture)
    actor->SetTexture(makeTexture(*look.texture, look.mipmap));
  return actor;
}

void update(vtkActor& actor, DrawMesh& mesh)
{
  vtkPolyDataMapper::SafeDownCast(actor.GetMapper())->SetInputData(toPolyData(mesh));
}

Image shrinkTo(Image image, int largest)
{
  while (std::max(image.width, image.height) > largest) {
    Image half((image.width + 1) / 2, (image.height + 1) / 2, image.channels);
    for (int y = 0; y < half.height; ++y)
      for (int x = 0; x < half.width; ++x)
        for (int c = 0; c < image.channels; ++c) {
          const int right = std::min(2 * x + 1, image.width - 1), below = std::min(2 * y + 1, image.height - 1);
          const int sum = image.pixel(2 * x, 2 * y)[c] + image.pixel(right, 2 * y)[c] + image.pixel(2 * x, below)[c] +
                          image.pixel(right, below)[c];
          half.pixel(x, y)[c] = (sum + 2) / 4;
        }
    image = std::move(half);
  }
  return image;
}
} // namespace fresco::rendering
