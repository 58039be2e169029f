// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <fresco/core/camera.h>
#include <fresco/core/export.h>
#include <fresco/core/mesh.h>
#include <fresco/core/progress.h>
#include <fresco/core/textured_mesh.h>
#include <functional>
#include <string>
#include <utility>
#include <vector>
namespace fresco {
/// Texture reconstruction from calibrated photographs. Each face is painted from the view that shows it best; views are
/// a labelling with few seams, after Lempitsky & Ivanov 2007 and Waechter, Moehrle & Goesele 2014.
struct TextureOptions {
  double texel = 0; ///< side of a texel in mesh units, >= 0; 0 = as fine as the photographs show each part
  int atlas = 0;    ///< largest side of an atlas, 128..16384 pixels, more atlases beyond; 0 = 8192
  int border = 2;   ///< texels around each chart that continue its surface against bleeding, 1..16
  /// Weight of seams: length, in bounding-box diagonals, of seam that costs as much as one octave of resolution lost
  /// over a square of that side, >= 0; 0 = the best view of each face on its own.
  double smoothness = 0.004;
  /// Pixels kept away from the outline of anything nearer to the camera, 0..100; less where the photographs are found to
  /// agree to a fraction of a pixel.
  double margin = 4;
  /// How far a face may lie behind the surface seen, as a share of the photographs' typical distance, 0..0.5.
  double depth_tolerance = 0.01;
  /// Correct poses, focal length, lens and mount so that the photographs agree on the mesh. Not done, with a warning,
  /// for more than 4,000 views.
  bool refine = true;
  bool exposure = true;    ///< bring exposure and white balance of the photographs together
  bool consistency = true; ///< avoid photographs whose colour differs from what most show of the same surface
  bool level = true;       ///< seam levelling: take away what steps of colour are left at seams
  double blend_width = 6;  ///< pixels over which one photograph passes into the next at a seam (feathering), 0..100
  /// Rounds of back-projection: texels are made of all photographs together, 0..100. Those that refinement leaves off by more
  /// count less where they differ. Only where `refine` and `exposure` are on.
  int rounds = 2;
  int memory = 1024; ///< MB of photographs kept at a time, decoded or as grey copies, >= 1
  int threads = 0;   ///< 0 = all cores; the result does not depend on it
  /// Most faces that are textured at a time, >= 0. A mesh of more is cut into tiles with atlases of their own. 0: all faces,
  /// or as many as machineMemory() holds.
  int tile_faces = 0;
};

/// Takes the atlases of a mesh in tiles, each with its mask as soon as it is painted, in their order; the result then has
/// their sizes alone. It is not called where the mesh is textured as a whole.
using AtlasSink = std::function<void(const Image& atlas, const Image& mask)>;

/// One photograph or panorama (sphericalCamera(), cut into six views inside) with its calibration.
struct TextureView {
  CameraModel camera;
  Eigen::Isometry3d T_camera_world = Eigen::Isometry3d::Identity();
  Image image;           ///< empty: read from `path` when needed
  std::string path;      ///< file of the photograph; names it in messages
  bool paint = true;     ///< false: its camera is refined with the others, but nothing is coloured from it
  bool mirrored = false; ///< a panorama that goes around to the left
  Image mask; ///< of the photograph's size: what is darker than 128 is not used, nor what is beside; empty: see
  std::string mask_path; ///< file of the mask; empty: all of the photograph is used
};

/// A camera at its place.
struct PlacedCamera {
  CameraModel camera;
  Eigen::Isometry3d T_camera_world = Eigen::Isometry3d::Identity();
};

/// How far a photograph is off from the others that show the same places, pixels.
struct PhotographFit {
  Index matches = 0; ///< places that were compared
  double median = 0;
  double upper = 0; ///< nine tenths of the places are off by less
};

struct TextureResult {
  TexturedMesh model;
  /// One per atlas, grey: 255 where no photograph saw the surface and the colour is inpainted.
  std::vector<Image> masks;
  Eigen::VectorXi face_view; ///< F, index of the view that most of the face is taken from; -1 = unseen
  double coverage = 0;       ///< share of the mesh's area that at least one view sees, 0..1
  double used = 0;           ///< share of the atlases' texels that lie in charts or their borders, 0..1
  double texel = 0;          ///< side of a texel in mesh units, median over the area
  Index charts = 0;
  Index views_used = 0;              ///< views that some face is taken from
  double seam_length = 0;            ///< mesh units, along which two views meet
  std::vector<PlacedCamera> cameras; ///< of each view, as used: refined where that made the photographs agree better
  Points gains; ///< 3xV, factors on RGB that bring the photographs together; their mean logarithm is 0
  /// 3xV, vignetting found: light that arrives at distance r from the principal point, in half diagonals of the image, is
  /// exp(a_1 r^2 + a_2 r^4 + a_3 r^6) of that in the middle; zeros where nothing is known. Colours are corrected by it.
  Points vignetting;
  /// 2xV, tone curve found: a value v, as a share of white, stands for the light v exp(b_1 v + b_2 v^3), on which gains and
  /// vignetting act; zeros where it is straight or nothing is known.
  Eigen::Matrix2Xf response;
  double disagreement_before = 0;  ///< pixels, median, between photographs on the mesh; 0 where it was not measured
  double disagreement_after = 0;   ///< with `cameras`; the same where these were left as given
  std::vector<PhotographFit> fits; ///< of each view, with `cameras`; empty where it was not measured
  /// Of each view, the share of the surface before it that is hidden by pixels that are no picture, 0..1: a border of one
  /// value that undistortion or masking has left, or transparent. They are not used.
  std::vector<double> blank;
  /// Of each view, the width in pixels of the violet fringe beside what is clipped; 0 = none. Its colour is not used.
  std::vector<int> fringes;
  /// Whether `cameras` differ from what was given: not where no correction makes the photographs agree
  /// clearly better.
  bool refined = false;
  std::vector<std::string> warnings;                   ///< what was left out or ignored, a sentence each
  std::vector<std::pair<std::string, double>> seconds; ///< time of each step
};

/// Faces that are there twice are left out of the result, and faces that all photographs see from behind are turned, with
/// a warning each.
/// @param mesh  as validateMesh() wants it, with at least one face of positive area
/// @param take  empty: atlases of tiles are kept
/// @throws std::invalid_argument if the mesh, an option or a view (pose, intrinsics) is out of range
/// @throws std::runtime_error naming the photograph or mask that is missing, no image, or of another size than its camera
/// @throws std::runtime_error if the texture would be larger than a thousand megatexels
/// @throws std::runtime_error if the mesh takes more than machineMemory() even in tiles
/// @throws Cancelled if `progress` asks to stop
FRESCO_EXPORT TextureResult reconstructTexture(TriangleMesh mesh, const std::vector<TextureView>& views,
                                               const TextureOptions& options = {}, const Progress& progress = {},
                                               const AtlasSink& take = {});

/// The same, painted in the layout that the model has: its texture coordinates stay. Its atlases give their sizes alone;
/// those below 16 texels or without any get what the photographs ask for. `options.atlas` is the longest side then, which
/// keeps their shape; `options.texel` must be 0.
/// @throws std::invalid_argument also if a face with area has no texture coordinates, or such beyond 0..1, or if two
///         faces cover one texel
FRESCO_EXPORT TextureResult reconstructTexture(const TexturedMesh& model, const std::vector<TextureView>& views,
                                               const TextureOptions& options = {}, const Progress& progress = {});
} // namespace fresco
