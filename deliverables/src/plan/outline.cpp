// SPDX-License-Identifier: BSD-3-Clause
#include "plan/outline.h"
#include <Eigen/Dense>
#include <fresco/core/constants.h>
#include <fresco/core/robust_weights.h>
#include <fresco/core/statistics.h>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>
namespace fresco::plan {
using Eigen::Vector2d;

namespace {
Vector2d leftOf(const Vector2d& d) { return {-d.y(), d.x()}; }
double crossed(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

std::vector<Vector2d> simplified(const Polyline& contour, double tolerance)
{
  std::vector<cv::Point2f> in, out;
  const Vector2d origin = contour.col(0);
  for (Index k = 0; k < contour.cols(); ++k)
    in.emplace_back(contour(0, k) - origin.x(), contour(1, k) - origin.y());
  cv::approxPolyDP(in, out, tolerance, true);
  std::vector<Vector2d> corners;
  for (const cv::Point2f& p : out)
    corners.push_back(origin + Vector2d(p.x, p.y));
  return corners;
}

/// Samples beside an edge: along it and to its right, where the wall is; metres.
std::vector<Vector2d> samplesBeside(const OutlineEdge& edge, const PlanePoints& samples, double cell)
{
  const double inside = 2 * cell, outside = 3 * cell; // the face nearest to the room, not the back of a recess
  const Vector2d d = (edge.to - edge.from).normalized(), right = -leftOf(d);
  const double length = edge.length(), margin = std::min(0.05, length / 4); // where the next wall begins
  std::vector<Vector2d> beside;
  samples.near(edge.from, edge.to, outside, [&](const Eigen::Vector3f& p) {
    const Vector2d offset = p.head<2>().cast<double>() - edge.from;
    const double t = d.dot(offset), o = right.dot(offset);
    if (t >= margin && t <= length - margin && o >= -inside && o <= outside)
      beside.emplace_back(t, o);
  });
  return beside;
}

/// o = offset + slope t by least squares with Cauchy's weights, whose width falls to the tolerance.
struct FittedLine {
  double offset = 0, slope = 0;
};

FittedLine fitLine(const std::vector<Vector2d>& samples, FittedLine line, const OutlineOptions& options, bool turns)
{
  for (double width = 1.5 * options.cell + options.tolerance; width > 0.3 * options.tolerance; width *= 0.6)
    for (int round = 0; round < 2; ++round) {
      double w = 0, wt = 0, wo = 0, wtt = 0, wto = 0;
      for (const Vector2d& s : samples) {
        const double r = (s.y() - line.offset - line.slope * s.x()) / width, weight = cauchyWeight(r * r);
        w += weight, wt += weight * s.x(), wo += weight * s.y();
        wtt += weight * s.x() * s.x(), wto += weight * s.x() * s.y();
      }
      const double spread = w * wtt - wt * wt;
      if (turns && spread > 1e-9 * w * w)
        line.slope = (w * wto - wt * wo) / spread;
      line.offset = (wo - line.slope * wt) / w;
    }
  return line;
}

void measure(OutlineEdge& edge, const std::vector<Vector2d>& samples, const FittedLine& line, double cell)
{
  constexpr double near = 0.03; // metres: farther off is another surface
  const double piece = std::max(0.05, 2 * cell), length = edge.length();
  std::vector<bool> pieces(static_cast<std::size_t>(length / piece) + 1, false);
  std::vector<double> deviations;
  double sum = 0;
  for (const Vector2d& s : samples) {
    const double r = std::abs(s.y() - line.offset - line.slope * s.x());
    if (r > near)
      continue;
    pieces[static_cast<std::size_t>(s.x() / piece)] = true;
    deviations.push_back(r);
    sum += r * r;
  }
  edge.seen =
      deviations.size() > 3 && 2 * std::count(pieces.begin(), pieces.end(), true) > std::ptrdiff_t(pieces.size()) - 1;
  if (!edge.seen)
    return;
  edge.rms = std::sqrt(sum / deviations.size());
  edge.ninth = rankedValue(deviations, 9 * deviations.size() / 10);
  edge.worst = rankedValue(deviations, 19 * deviations.size() / 20);
}

/// @param along direction that the line has to have; none: as the samples say
void fitEdge(OutlineEdge& edge, const PlanePoints& points, const OutlineOptions& options,
             const std::optional<Vector2d>& along = {})
{
  const Vector2d d = (edge.to - edge.from).normalized(), right = -leftOf(d);
  const std::vector<Vector2d> samples = samplesBeside(edge, points, options.cell);
  FittedLine line{options.cell, 0};
  if (along) {
    line.slope = along->dot(right) / along->dot(d);
    line.offset -= line.slope * edge.length() / 2;
  }
  if (!samples.empty())
    line = fitLine(samples, line, options, !along);
  measure(edge, samples, line, options.cell);
  if (!edge.seen)
    line = {options.cell / 2, 0}; // the end of what was seen
  edge.direction = (d + line.slope * right).normalized();
  const double middle = edge.length() / 2;
  edge.point = edge.from + middle * d + (line.offset + line.slope * middle) * right;
}

/// Degrees, 0 up to 90.
double angleOf(const Vector2d& d)
{
  const double angle = std::fmod(std::atan2(d.y(), d.x()) * degrees_per_radian + 360, 90);
  return angle;
}

/// Signed, from one to the other direction modulo 90 degrees.
double turnTo(double from, double to) { return std::remainder(to - from, 90); }

/// Whether a turn about its middle moves the ends of an edge by no more than the tolerance.
bool mayTurn(const OutlineEdge& edge, double degrees, double tolerance)
{
  return std::abs(std::sin(degrees / degrees_per_radian)) * edge.length() / 2 <= tolerance;
}

/// Where the lines of two edges meet; none if they are nearly parallel.
std::optional<Vector2d> meeting(const OutlineEdge& a, const OutlineEdge& b)
{
  const double sine = crossed(a.direction, b.direction);
  if (std::abs(sine) < 0.2)
    return {};
  return Vector2d(a.point + crossed(b.point - a.point, b.direction) / sine * a.direction);
}

Vector2d onLine(const OutlineEdge& edge, const Vector2d& p)
{
  return edge.point + edge.direction.dot(p - edge.point) * edge.direction;
}

/// Whether `b` goes on along the line of `a`.
bool continues(const OutlineEdge& a, const OutlineEdge& b, double tolerance)
{
  return a.seen == b.seen && a.direction.dot(b.direction) > 0.999 &&
         (onLine(a, b.point) - b.point).norm() <= tolerance &&
         (onLine(a, b.to) - onLine(b, b.to)).norm() <= 2 * tolerance;
}

/// Its neighbours go on to its middle.
void erase(std::vector<OutlineEdge>& edges, std::size_t k)
{
  const std::size_t n = edges.size();
  edges[(k + n - 1) % n].to = edges[(k + 1) % n].from = (edges[k].from + edges[k].to) / 2;
  edges.erase(edges.begin() + static_cast<std::ptrdiff_t>(k));
}

/// Takes away what cuts a corner: an edge as short as a few cells whose neighbours meet there.
void dropCutCorners(std::vector<OutlineEdge>& edges, double cell)
{
  const double shortest = 3.5 * cell;
  for (std::size_t k = 0; k < edges.size() && edges.size() > 3;) {
    const std::size_t n = edges.size();
    const OutlineEdge &before = edges[(k + n - 1) % n], &after = edges[(k + 1) % n];
    const auto corner = meeting(before, after);
    const Vector2d middle = (edges[k].from + edges[k].to) / 2;
    if (edges[k].length() < shortest && before.length() >= shortest && corner &&
        (*corner - middle).norm() < 2 * shortest)
      erase(edges, k);
    else
      ++k;
  }
}

/// Corner points between an edge and the next one: one, or two where a step joins parallel walls.
std::vector<Vector2d> corners(const OutlineEdge& a, const OutlineEdge& b, const OutlineOptions& options)
{
  const Vector2d bend = (a.to + b.from) / 2;
  const double reach = 6 * options.cell + 2 * (a.to - b.from).norm();
  if (const auto corner = meeting(a, b); corner && (*corner - bend).norm() < reach)
    return {*corner};
  const Vector2d p = onLine(a, bend), q = onLine(b, bend);
  if ((p - q).norm() <= 2 * options.tolerance)
    return {(p + q) / 2};
  return {p, q};
}
} // namespace

std::vector<OutlineEdge> fitEdges(const Polyline& contour, const PlanePoints& samples, const OutlineOptions& options)
{
  const std::vector<Vector2d> ends = simplified(contour, 1.6 * options.cell);
  std::vector<OutlineEdge> edges;
  for (std::size_t k = 0; k < ends.size() && ends.size() > 2; ++k) {
    OutlineEdge edge;
    edge.from = ends[k];
    edge.to = ends[(k + 1) % ends.size()];
    fitEdge(edge, samples, options);
    edges.push_back(edge);
  }
  return edges;
}

std::vector<double> mainDirections(const std::vector<OutlineEdge>& edges, double tolerance)
{
  constexpr double least_length = 0.5; // metres of an edge whose direction counts
  std::vector<OutlineEdge> rest;
  for (const OutlineEdge& edge : edges)
    if (edge.seen && edge.length() >= least_length)
      rest.push_back(edge);
  std::stable_sort(rest.begin(), rest.end(),
                   [](const OutlineEdge& a, const OutlineEdge& b) { return a.length() > b.length(); });
  std::vector<std::pair<double, double>> found; // length, degrees
  while (!rest.empty()) {
    const double first = angleOf(rest.front().direction);
    double length = 0, weight = 0, turn = 0;
    std::vector<OutlineEdge> others;
    for (const OutlineEdge& edge : rest) {
      const double offset = turnTo(first, angleOf(edge.direction)), l = edge.length();
      if (!mayTurn(edge, offset, tolerance)) {
        others.push_back(edge);
        continue;
      }
      length += l;
      weight += l * l * l; // a line's direction is known that well
      turn += l * l * l * offset;
    }
    found.emplace_back(length, std::fmod(first + turn / weight + 90, 90));
    rest = others;
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<double> directions;
  for (const auto& [length, degrees] : found)
    directions.push_back(degrees);
  return directions;
}

namespace {
/// Turns an edge to the first main direction that it may have.
void straighten(OutlineEdge& edge, const std::vector<double>& directions, const PlanePoints& samples,
                const OutlineOptions& options)
{
  for (const double main : directions) {
    const double turn = turnTo(angleOf(edge.direction), main);
    if (!edge.seen || !mayTurn(edge, turn, options.tolerance))
      continue;
    fitEdge(edge, samples, options, Eigen::Rotation2Dd(turn / degrees_per_radian) * edge.direction);
    return;
  }
}

/// Where each edge ends and the next one begins.
std::vector<std::vector<Vector2d>> bendsOf(const std::vector<OutlineEdge>& edges, const OutlineOptions& options)
{
  std::vector<std::vector<Vector2d>> bends;
  for (std::size_t k = 0; k < edges.size(); ++k)
    bends.push_back(corners(edges[k], edges[(k + 1) % edges.size()], options));
  return bends;
}

/// Takes away edges that would run backwards, since their neighbours meet before them.
void dropReversed(std::vector<OutlineEdge>& edges, const OutlineOptions& options)
{
  for (std::size_t k = 0; k < edges.size() && edges.size() > 3;) {
    const auto bends = bendsOf(edges, options);
    const Vector2d run = bends[k].front() - bends[(k + edges.size() - 1) % edges.size()].back();
    if (run.dot(edges[k].direction) > 1e-6) {
      ++k;
      continue;
    }
    erase(edges, k);
    k = 0;
  }
}

/// Makes one edge of neighbours on one line.
void mergeEdges(std::vector<OutlineEdge>& edges, const std::vector<double>& directions, const PlanePoints& samples,
                const OutlineOptions& options)
{
  for (std::size_t k = 0; k < edges.size() && edges.size() > 3;) {
    const std::size_t next = (k + 1) % edges.size();
    if (!continues(edges[k], edges[next], options.tolerance)) {
      ++k;
      continue;
    }
    edges[k].to = edges[next].to;
    fitEdge(edges[k], samples, options);
    straighten(edges[k], directions, samples, options);
    edges.erase(edges.begin() + static_cast<std::ptrdiff_t>(next));
    k = next == 0 ? edges.size() : k;
  }
}

double distanceTo(const std::vector<OutlineEdge>& edges, const Vector2d& p)
{
  double least = std::numeric_limits<double>::infinity();
  for (const OutlineEdge& edge : edges) {
    const Vector2d d = edge.to - edge.from;
    const double t = d.squaredNorm() > 0 ? std::clamp(d.dot(p - edge.from) / d.squaredNorm(), 0.0, 1.0) : 0;
    least = std::min(least, (edge.from + t * d - p).norm());
  }
  return least;
}

/// Edges between two walls, on the lines of those walls; none if that moves them by more than a wall is thick.
std::optional<std::vector<OutlineEdge>> continued(const OutlineEdge& before, const std::vector<OutlineEdge>& between,
                                                  const OutlineEdge& after, const OutlineOptions& options)
{
  const auto piece = [](const OutlineEdge& wall, const Vector2d& from, const Vector2d& to) {
    return OutlineEdge{from, to, wall.point, wall.direction};
  };
  const Vector2d from = onLine(before, before.to), to = onLine(after, after.from);
  std::vector<OutlineEdge> line;
  if (const auto corner = meeting(before, after))
    line = {piece(before, from, *corner), piece(after, *corner, to)};
  else if ((onLine(before, to) - to).norm() <= 2 * options.tolerance)
    line = {piece(before, from, to)};
  const auto far = [&](const OutlineEdge& edge, const std::vector<OutlineEdge>& others) {
    return std::max(distanceTo(others, edge.from), distanceTo(others, edge.to)) > options.wall;
  };
  const auto inside = [&](const OutlineEdge& edge, const OutlineEdge& wall) { // then the wall is what lies behind
    return edge.seen && edge.direction.dot(wall.direction) > 0.9 &&
           leftOf(wall.direction).dot(edge.point - wall.point) > 2 * options.tolerance;
  };
  const auto moves = [&](const OutlineEdge& e) { return far(e, line) || inside(e, before) || inside(e, after); };
  if (line.empty() || std::any_of(between.begin(), between.end(), moves) ||
      std::any_of(line.begin(), line.end(), [&](const OutlineEdge& e) { return far(e, between); }))
    return {};
  const auto is_short = [&](const OutlineEdge& e) { return (e.to - e.from).dot(e.direction) < options.wall / 2; };
  line.erase(std::remove_if(line.begin(), line.end(), is_short), line.end());
  return line;
}

/// Walls go on where nothing was seen, and where a step to what lies behind them has sides that nobody saw: there the
/// other face of the wall shows through a gap.
void continueWalls(std::vector<OutlineEdge>& edges, const OutlineOptions& options)
{
  const auto is_wall = [&](const OutlineEdge& edge) { return edge.seen && edge.length() >= options.wall / 2; };
  std::rotate(edges.begin(), std::find_if(edges.begin(), edges.end(), is_wall), edges.end());
  const std::size_t n = edges.size();
  std::vector<OutlineEdge> whole;
  for (std::size_t k = 0, next = 1; k < n; k = next++) {
    whole.push_back(edges[k]);
    if (!is_wall(edges[k]) || next == n || is_wall(edges[next]))
      continue;
    for (std::size_t end = n; end > next; --end) { // the farthest wall that this one goes on to
      if (!is_wall(edges[end % n]) || is_wall(edges[end - 1]))
        continue;
      if (const auto line = continued(edges[k], {edges.begin() + next, edges.begin() + end}, edges[end % n], options)) {
        whole.insert(whole.end(), line->begin(), line->end());
        next = end;
      }
    }
  }
  if (whole.size() > 2)
    edges = whole;
}
} // namespace

std::vector<PlanWall> joinEdges(std::vector<OutlineEdge> edges, const std::vector<double>& directions,
                                const PlanePoints& samples, const OutlineOptions& options)
{
  dropCutCorners(edges, options.cell);
  for (OutlineEdge& edge : edges)
    straighten(edge, directions, samples, options);
  mergeEdges(edges, directions, samples, options);
  continueWalls(edges, options);
  dropReversed(edges, options);
  mergeEdges(edges, directions, samples, options);
  const auto bends = bendsOf(edges, options);
  std::vector<PlanWall> walls;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const OutlineEdge& edge = edges[k];
    const bool straight = edge.seen && edge.ninth <= options.tolerance;
    walls.push_back({bends[(k + edges.size() - 1) % edges.size()].back(),
                     bends[k].front(),
                     straight,
                     edge.seen,
                     edge.rms,
                     edge.worst,
                     {}});
    if (bends[k].size() > 1) // a step
      walls.push_back({bends[k].front(), bends[k].back(), false, false, 0, 0, {}});
  }
  return walls;
}
} // namespace fresco::plan
