// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <fresco/core/image.h>
#include <fresco/core/mesh.h>
#include <fresco/core/point_set.h>
#include <fresco/core/textured_mesh.h>
#include <fresco/rendering/viewpoint.h>
#include <memory>
#include <optional>
#include <string>
#include <vector>
namespace fresco::rendering {
enum class Shading {
  Normals,   ///< colour of a face = (n + 1) / 2 of its unit normal, without light
  Gouraud,   ///< lit, smooth except at creases; vertex colours where the mesh has them
  Flat,      ///< lit, one normal per face
  Wireframe, ///< flat with the edges drawn, paler where they lie dense; hidden ones stay hidden
  Texture,   ///< the atlases, without light
  Error,     ///< distance to a reference: red = zero, green, blue = large; with a scale bar
  PointCloud ///< the vertices alone
};

/// Name as in the tool's option: normals, gouraud, flat, wireframe, texture, error, points.
/// @throws std::invalid_argument if it is none of these
Shading shadingByName(const std::string& name);
const std::vector<std::string>& shadingNames(); ///< in the order of the enumeration

struct PictureOptions {
  Shading shading = Shading::Gouraud;
  int width = 1280, height = 960; ///< pixels, >= 1 (error pictures: >= 160 x 120)
  std::optional<Viewpoint> view;  ///< nothing: the whole model, from the default direction of Framing
  bool cull_back_faces = false;   ///< faces, and points with normals, seen from behind are left out, and what hangs on
                                  ///< walls of such faces: a room seen from outside shows its inside
  bool no_colors = false;         ///< colours and intensities of vertices and points are left out: the shape alone
  bool transparent = false;       ///< RGBA with alpha 0 where the model is not; else RGB
  std::array<std::uint8_t, 3> background{255, 255, 255};
  double crease_angle = 40; ///< Gouraud: edges that bend by more look sharp; degrees, 0..180; 180 = smooth everywhere
  double point_size = 0;    ///< pixels; 0 = chosen by the number of points
  double error_limit =
      0; ///< Error: distance that is blue, unit of the mesh; 0 = 99th percentile of the distances, rounded up
  std::string unit;     ///< Error: unit of the mesh for the scale bar, may be empty
  int oversampling = 1; ///< pixels drawn per pixel along each side, 1..4; 1 = multisampling in its place
  int threads = 0;      ///< 0 = all cores; the picture does not depend on it
};

/// Picture of a mesh; a mesh without faces is drawn as points. No display is needed. Colours and view: see the options.
/// @throws std::invalid_argument if the mesh is malformed or has no finite vertex, the shading needs what a plain mesh
///         does not have (Texture, Error) or an option is out of range
/// @throws std::runtime_error if the machine cannot make pictures (no EGL or OpenGL 3.2) or not of that size
Image renderPicture(const TriangleMesh& mesh, const PictureOptions& options = {});

/// Shading::Texture shows the atlases (faces without texture: lit, grey); the other shadings are those of `model.mesh`.
/// @throws as above, and std::invalid_argument if the model has no texture or its arrays do not fit together
Image renderPicture(const TexturedMesh& model, const PictureOptions& options = {});

/// Pictures of one model from several views: what the graphics system draws is made once. It is held for the whole life
/// of a series, other pictures wait.
class PictureSeries {
public:
  /// @param options of all pictures, as for renderPicture(); `view` and `cull_back_faces` are given with each. Shadings
  ///                Normals, Gouraud, Flat and Texture
  /// @throws as renderPicture()
  PictureSeries(const TexturedMesh& model, const PictureOptions& options);
  ~PictureSeries();
  Image draw(const Viewpoint& view, bool cull_back_faces);

private:
  struct Stage;
  std::unique_ptr<Stage> stage_;
};

/// Points in their own colours, else by intensity, else lit by their normals, else coloured by height. Non-finite
/// points are left out. Shading::Normals colours by normal; the other shadings make no difference.
Image renderPicture(const PointSet& set, const PictureOptions& options = {});

/// Shading::Error, whatever `options.shading` says: colours by `distances` with a scale bar at the right side; what a
/// picture without the bar shows is drawn smaller beside it.
/// @param distances V, distance of each vertex to the reference (vertexDistances()), unit of the mesh; >= 0 and finite
///                  where a face names the vertex
Image renderErrorPicture(const TriangleMesh& mesh, const Eigen::VectorXf& distances,
                         const PictureOptions& options = {});
} // namespace fresco::rendering
