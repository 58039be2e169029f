// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/simulation/sensors/random.h>
#include <fresco/simulation/sensors/views.h>
#include <iomanip>
#include <queue>
namespace fresco::simulation {
using Eigen::Matrix3f;
using Eigen::Vector3f;

namespace {
constexpr int yaw_steps = 12;
constexpr float radian = 0.01745329252f;

/// Camera axes (rows: right, down, forward) for a direction of view. Angles in degrees.
Matrix3f lookAlong(float yaw, float pitch, float roll)
{
  const float y = yaw * radian, p = pitch * radian;
  const Vector3f forward(std::cos(y) * std::cos(p), std::sin(y) * std::cos(p), std::sin(p));
  const Vector3f right(std::sin(y), -std::cos(y), 0.f);
  Matrix3f axes;
  axes << right.transpose(), forward.cross(right).transpose(), forward.transpose();
  return Eigen::AngleAxisf(roll * radian, Vector3f::UnitZ()).toRotationMatrix() * axes;
}

/// One place to take photographs from with all directions that are tried.
struct Candidate {
  Index place = 0;
  float yaw = 0, pitch = 0; ///< degrees
};

std::vector<Candidate> allCandidates(Index places)
{
  std::vector<Candidate> all;
  for (Index p = 0; p < places; ++p)
    for (const float pitch : {-50.f, -15.f, 20.f, 60.f})
      for (int k = 0; k < yaw_steps; ++k)
        all.push_back({p, 360.f / yaw_steps * (k + (pitch < 0 ? 0.f : 0.5f)), pitch});
  return all;
}

class Planner {
public:
  Planner(const PlanningInput& in, const CameraModel& camera, const Points& places)
      : in_(in), places_(places), quality_(viewQuality(in, places, 2.2f * sceneUnit(in.scene))),
        reached_(Eigen::VectorXf::Zero(quality_.cols())),
        limit_x_(0.47f * static_cast<float>(camera.width / camera.fx)),
        limit_y_(0.47f * static_cast<float>(camera.height / camera.fy))
  {}

  float gain(const Candidate& c) const
  {
    float sum = 0.f;
    forEachSeen(c, [&](Index s, float q) { sum += worth(reached_[s] + q) - worth(reached_[s]); });
    return sum;
  }

  void take(const Candidate& c)
  {
    forEachSeen(c, [&](Index s, float q) { reached_[s] += q; });
  }

private:
  static float worth(float quality) { return 1.f - std::exp(-quality / 0.9f); }

  template <typename Action>
  void forEachSeen(const Candidate& c, const Action& action) const
  {
    const Matrix3f axes = lookAlong(c.yaw, c.pitch, 0.f);
    for (Index s = 0; s < quality_.cols(); ++s) {
      const float q = quality_(c.place, s);
      if (q <= 0.f)
        continue;
      const Vector3f at = axes * (in_.samples.positions.col(s) - places_.col(c.place));
      if (at.z() > 0.f && std::fabs(at.x()) < limit_x_ * at.z() && std::fabs(at.y()) < limit_y_ * at.z())
        action(s, q);
    }
  }

  const PlanningInput& in_;
  const Points& places_;
  Eigen::MatrixXf quality_;
  Eigen::VectorXf reached_; ///< per sample, quality of all views taken so far
  float limit_x_, limit_y_;
};

/// Greedy choice; a gain can only fall as views are taken, so old gains are bounds (Minoux 1978).
std::vector<Candidate> greedy(Planner& planner, const std::vector<Candidate>& all, int count, int threads)
{
  std::vector<float> gains(all.size());
  parallelFor(all.size(), threads, [&](Index i) { gains[i] = planner.gain(all[i]); });
  using Entry = std::pair<float, std::ptrdiff_t>; // gain, minus index: ties go to the first
  std::priority_queue<Entry> queue;
  for (std::size_t i = 0; i < all.size(); ++i)
    queue.push({gains[i], -Index(i)});
  std::vector<Candidate> chosen;
  while (static_cast<int>(chosen.size()) < count && !queue.empty()) {
    Entry top = queue.top();
    queue.pop();
    const Candidate& candidate = all[-top.second];
    top.first = planner.gain(candidate);
    if (!queue.empty() && top < queue.top()) {
      queue.push(top);
      continue;
    }
    planner.take(candidate);
    chosen.push_back(candidate);
  }
  return chosen;
}

Points cameraPlaces(const PlanningInput& in)
{
  PlaceRules rules;
  rules.heights = {0.45f, 1.1f, 1.6f, 2.05f};
  rules.spacing = 0.7f;
  rules.clearance = 0.4f;
  rules.on_floor = false;
  return freePlaces(in, rules);
}
} // namespace

CameraSet chooseViews(const PlanningInput& in, const CameraModel& camera, int count)
{
  require(count >= 1, "views: ", count, " is not positive");
  const Points places = cameraPlaces(in);
  Planner planner(in, camera, places);
  CameraSet set;
  set.cameras.push_back(camera);
  for (const Candidate& c : greedy(planner, allCandidates(places.cols()), count, in.threads)) {
    const auto number = set.views.size();
    CounterRandom random(in.seed, 51, number);
    const auto stray = [&](double range) { return random.uniformFloat(-range, range); };
    View view;
    view.image = concat("view_", std::setfill('0'), std::setw(3), number, ".jpg");
    const Eigen::Matrix3d R =
        Eigen::Quaterniond(lookAlong(c.yaw + stray(3), c.pitch + stray(3), stray(3)).cast<double>())
            .normalized()
            .toRotationMatrix();
    const Eigen::Vector3d center = places.col(c.place).cast<double>() + in.scene.mesh.origin;
    view.T_camera_world.linear() = R;
    view.T_camera_world.translation() = -R * center;
    set.views.push_back(view);
  }
  return set;
}
} // namespace fresco::simulation
