// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "painting/painted_part.h"
#include "views/photo_consistency.h"
#include "views/visible_surface.h"
#include <chrono>
#include <string>
namespace fresco::texture {
/// Reports the steps and measures their time.
class Steps {
public:
  Steps(const Progress& progress, TextureResult& result) : progress_(progress), result_(result) {}

  /// Ends the step before.
  /// @param share of the whole work that is done, 0..1
  void begin(const std::string& step, double share);
  /// Lets the shares 0.25..1 of the steps that follow stand for a part of the work, which has a name.
  void setPart(const std::string& name, double from, double to)
  {
    part_ = name;
    from_ = from;
    to_ = to;
  }

private:
  const Progress& progress_;
  TextureResult& result_;
  std::string step_, part_;
  double from_ = 0.25, to_ = 1;
  std::chrono::steady_clock::time_point begin_;
};

/// @return one per part, in the mesh's coordinates
std::vector<Projector> projectorsOf(const TriangleMesh& mesh, const std::vector<ViewPart>& parts,
                                    const std::vector<PlacedCamera>& cameras);

/// @param projectors of the parts @param result with what is known of the cameras
ViewList viewList(const std::vector<Projector>& projectors, PhotoStore& photos, const std::vector<ViewPart>& parts,
                  const TextureResult& result);

/// What all steps read and write.
struct Job {
  const TextureOptions& options;
  const ViewList& views;
  Steps& steps;
  TextureResult& result;
};

/// Which photograph each patch is painted from.
struct ViewChoice {
  VisibleSurface surface;
  Photometry photometry;
  PhotoConsistency consistency;
  Eigen::VectorXi view; ///< P, -1 = unseen
};

/// From patches that several views show; fills what the result says of it.
Photometry findPhotometry(const Candidates& candidates, const Job& job);

/// Fills the choice's consistency.
void compareViews(const VisibilityInput& input, ViewChoice& choice);

/// Fills the choice's views. @param seam_cost mesh units
void chooseViews(const TextureOptions& options, double seam_cost, ViewChoice& choice);

/// Paints the result's model. @param choice patches that turn out to be hidden lose their view
/// @return 3xP, mean colours of the own patches, if they are a tile's
Points paintModel(const Job& job, ViewChoice& choice, const PaintedPart& part);

/// Rounds of blending for a mesh that is painted as a whole.
int blendRounds(const Job& job, const ViewChoice& choice);
} // namespace fresco::texture
