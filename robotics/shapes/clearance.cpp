// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/shapes/clearance.hpp"

#include <algorithm>
#include <numbers>

namespace hirosco::robotics {
namespace {

/// Postures that are looked at for what is near by construction.
constexpr std::size_t postures = 200;
/// Who is built no farther apart than this is no pair that can be told apart.
constexpr double nothing_between_m = 1e-3;

constexpr std::array carried_names{"the tool", "the payload"};

/// From 0 to 1, evenly spread for each base (van der Corput): the same postures at each start.
[[nodiscard]] double spread(std::size_t i, std::size_t base) noexcept {
  double number = 0, digit = 1;
  for (; i > 0; i /= base) number += (digit /= static_cast<double>(base)) * static_cast<double>(i % base);
  return number;
}

/// The `i`th posture that is looked at, from 1, within the joints' ranges.
void take_posture(const Model& model, std::size_t i, JointVector& position) {
  constexpr std::array<std::size_t, max_joints> bases{2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53};
  for (std::size_t joint = 0; joint < model.joints().size(); ++joint) {
    const JointLimits& limits = model.joints()[joint].limits;
    const double lower = limits.lower.value_or(-std::numbers::pi), upper = limits.upper.value_or(std::numbers::pi);
    position[static_cast<Eigen::Index>(joint)] = lower + (upper - lower) * spread(i, bases[joint]);
  }
}

/// Are all joints between two bodies such that they can be at 0?
[[nodiscard]] bool may_be_zero(const Model& model, std::size_t one, std::size_t other) {
  const auto bodies = model.bodies();
  while (one != other) {
    // What carries stands before what is carried.
    std::size_t& farther = one > other ? one : other;
    const auto& limits = model.joints()[static_cast<std::size_t>(bodies[farther].coordinate)].limits;
    if (limits.lower.value_or(0) > 0 || limits.upper.value_or(0) < 0) return false;
    farther = bodies[farther].parent;
  }
  return true;
}

}  // namespace

Clearance::Clearance(const Model& model, std::span<const LinkHull> hulls, std::optional<FrameId> tip)
    : dynamics_{model, Base::Fixed}, tip_{tip} {
  state_.qd = JointVector::Zero(model.joint_count());
  add_links(model, hulls);
  add_carried(model);
  const auto joined = [&](std::size_t one, std::size_t other) {
    return one == other || model.bodies()[one].parent == other || model.bodies()[other].parent == one;
  };
  const auto name_of = [&](std::size_t i) -> std::string {
    return i < links_ ? model.frame(bodies_[i].frame).name : carried_names[i - links_];
  };
  const auto add_pairs = [&](std::size_t from, std::size_t end) {
    for (std::size_t i = 0; i < links_; ++i)
      for (std::size_t j = std::max(i + 1, from); j < end; ++j)
        if (!joined(bodies_[i].body, bodies_[j].body)) add_pair(i, j, name_of(i) + " and " + name_of(j));
  };
  add_pairs(0, links_);
  link_pairs_ = pairs_.size();
  add_pairs(links_, moved_);
  moved_pairs_ = pairs_.size();
  learn_construction(model, hulls);
  bodies_.resize(moved_ + most_volumes);
  for (std::size_t volume = moved_; volume < bodies_.size(); ++volume) bodies_[volume].solids.resize(1);
  for (std::size_t i = 0; i < moved_; ++i)
    for (std::size_t volume = moved_; volume < bodies_.size(); ++volume)
      if (bodies_[i].body != 0) add_pair(i, volume, name_of(i) + " and a volume to keep out of");
  keep_out({});
}

void Clearance::add_links(const Model& model, std::span<const LinkHull> hulls) {
  for (const LinkHull& each : hulls) {
    const auto frame = model.find_frame(each.link);
    if (!frame || each.hull.corners() == 0) continue;
    auto found = std::ranges::find(bodies_, frame->index, [](const Body& body) { return body.frame.index; });
    if (found == bodies_.end()) {
      found = bodies_.emplace(bodies_.end());
      found->frame = *frame;
      found->body = model.frame(*frame).body;
    }
    found->solids.push_back({each.hull, ball_around({&each.hull, 1})});
  }
  for (Body& body : bodies_) {
    std::vector<RoundedHull> all;
    for (const Solid& solid : body.solids) all.push_back(solid.hull);
    body.ball = ball_around(all);
  }
  links_ = moved_ = bodies_.size();
}

/// As points where the tip is: how near that is built to a link is how near whatever begins there may come.
void Clearance::add_carried(const Model& model) {
  if (!tip_) return;
  moved_ = links_ + most_carried;
  bodies_.resize(moved_);
  for (Body& body : std::span{bodies_}.subspan(links_)) {
    body.frame = *tip_;
    body.body = model.frame(*tip_).body;
    body.solids.resize(1);
    body.solids[0].hull = RoundedHull{std::array{Vector3{Vector3::Zero()}}, 0};
  }
}

void Clearance::carry(Carried which, const Vector3& to, double radius_m) noexcept {
  if (!tip_) return;
  Body& body = bodies_[links_ + static_cast<std::size_t>(which)];
  Solid& solid = body.solids[0];
  const double length_m = to.norm();
  // Its rear cap ends at the tip's origin: behind that is the arm's own wrist, and nothing that the tip carries.
  const Vector3 from = to * (length_m > radius_m ? radius_m / length_m : 1);
  solid.hull =
      length_m > 0 ? RoundedHull{std::array{from, to}, radius_m} : RoundedHull{std::array{Vector3{Vector3::Zero()}}, 0};
  body.ball = solid.ball = ball_around({&solid.hull, 1});
  limit_pairs();
}

/// What is carried begins as a point, and such a point is nothing.
bool Clearance::counts(std::size_t body) const noexcept {
  return body < links_ || bodies_[body].solids[0].hull.corners() > 1;
}

/// How far behind the tip's origin it reaches, who is rounder than long.
double Clearance::behind_m(std::size_t body) const noexcept {
  if (body < links_) return 0;
  const RoundedHull& hull = bodies_[body].solids[0].hull;
  return hull.radius_m() - hull.corner(0).norm();
}

void Clearance::limit_pairs() noexcept {
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    LookedAt& pair = pairs_[i];
    if (i >= moved_pairs_) {
      const bool is_there = counts(pair.one) && bodies_[pair.other].solids[0].hull.radius_m() > 0;
      pair.named.limit_m = is_there ? limit_m_ : 0;
    } else {
      const double built_m = pair.named.built_m - behind_m(pair.other);
      pair.named.limit_m = counts(pair.other) && built_m >= nothing_between_m ? std::min(limit_m_, built_m / 3) : 0;
    }
  }
}

void Clearance::add_pair(std::size_t one, std::size_t other, std::string names) {
  const std::size_t searches = bodies_[one].solids.size() * bodies_[other].solids.size();
  LookedAt& pair = pairs_.emplace_back();
  pair.named.names = std::move(names);
  pair.one = one;
  pair.other = other;
  pair.axes.assign(searches, Vector3::UnitZ());
}

/// What somebody else moves is built as near as it stands: a finger that opens beside its own wrist is no neighbour by construction.
void Clearance::built_distances(const Model& model, std::span<const LinkHull> hulls, std::span<double> of_pairs) {
  const JointVector zeros = JointVector::Zero(model.joint_count());
  if (std::ranges::none_of(hulls, [](const LinkHull& each) { return each.standing.has_value(); }))
    return distances(zeros, of_pairs);
  std::vector<LinkHull> built{hulls.begin(), hulls.end()};
  for (LinkHull& each : built)
    if (each.standing) each.hull = *each.standing, each.standing.reset();
  Clearance{model, built, tip_}.distances(zeros, of_pairs);
}

void Clearance::learn_construction(const Model& model, std::span<const LinkHull> hulls) {
  std::vector<double> apart(pairs_.size());
  JointVector position = JointVector::Zero(model.joint_count());
  for (LookedAt& pair : pairs_) pair.named.built_m = 0;
  for (std::size_t i = 1; i <= postures; ++i) {
    take_posture(model, i, position);
    distances(position, apart);
    for (std::size_t k = 0; k < pairs_.size(); ++k)
      pairs_[k].named.built_m = std::max(pairs_[k].named.built_m, apart[k]);
  }
  built_distances(model, hulls, apart);
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    LookedAt& pair = pairs_[k];
    if (may_be_zero(model, bodies_[pair.one].body, bodies_[pair.other].body))
      pair.named.built_m = std::min(pair.named.built_m, apart[k]);
  }
}

void Clearance::set_limit(double limit_m) noexcept {
  limit_m_ = limit_m;
  limit_pairs();
}

void Clearance::keep_out(std::span<const Capsule> volumes) noexcept {
  for (std::size_t i = 0; i < most_volumes; ++i) {
    const Capsule capsule = i < volumes.size() ? volumes[i] : Capsule{};
    Body& body = bodies_[moved_ + i];
    body.solids[0].hull = RoundedHull{std::array{capsule.from, capsule.to}, capsule.radius_m};
    body.ball = body.solids[0].ball = ball_around({&body.solids[0].hull, 1});
    body.centre = body.solids[0].centre = body.ball.centre;
  }
  limit_pairs();
}

void Clearance::place(const JointVector& position) noexcept {
  state_.q = position;
  dynamics_.update(state_);
  for (Body& body : std::span{bodies_}.first(moved_)) {
    body.pose = dynamics_.frame_pose(body.frame);
    body.centre = body.pose * body.ball.centre;
    for (Solid& solid : body.solids) solid.centre = body.pose * solid.ball.centre;
  }
}

double Clearance::apart_m(LookedAt& pair, double enough_m) noexcept {
  const Body &one = bodies_[pair.one], &other = bodies_[pair.other];
  const auto between = [](const Vector3& from, const Ball& ball, const Vector3& to, const Ball& second) {
    return (from - to).norm() - ball.radius_m - second.radius_m;
  };
  if (const double far = between(one.centre, one.ball, other.centre, other.ball); far >= enough_m) return far;
  double least = HUGE_VAL;
  std::size_t search = 0;
  for (const Solid& its : one.solids)
    for (const Solid& others : other.solids) {
      Vector3& axis = pair.axes[search++];
      const double enough = std::min(enough_m, least);
      double far = between(its.centre, its.ball, others.centre, others.ball);
      if (far < enough) far = distance_m({its.hull, one.pose}, {others.hull, other.pose}, enough, axis);
      least = std::min(least, far);
    }
  return least;
}

Clearance::Nearest Clearance::nearest(const JointVector& position) noexcept {
  place(position);
  Nearest found;
  const auto look = [&](std::size_t i) {
    LookedAt& pair = pairs_[i];
    if (pair.named.limit_m < limit_m_ || limit_m_ <= 0) return;
    const double far = apart_m(pair, found.distance_m);
    if (far >= found.distance_m) return;
    found = {far, pair.named.names.c_str()};
    nearest_ = i;
  };
  const std::size_t first = nearest_;
  if (first < pairs_.size()) look(first);
  for (std::size_t i = 0; i < pairs_.size(); ++i)
    if (i != first) look(i);
  return found;
}

Clearance::Nearest Clearance::nearer(const JointVector& now, const JointVector& then, double by_m) noexcept {
  place(then);
  bool any = false;
  for (LookedAt& pair : pairs_) {
    const double limit_m = pair.named.limit_m;
    pair.then_m = limit_m > 0 ? apart_m(pair, limit_m) : HUGE_VAL;
    any = any || pair.then_m < limit_m;
  }
  Nearest found;
  if (!any) return found;
  place(now);
  for (LookedAt& pair : pairs_) {
    if (pair.then_m >= pair.named.limit_m || pair.then_m >= found.distance_m) continue;
    const double nearer_m = pair.then_m + std::min(by_m, pair.named.limit_m / 2);
    if (apart_m(pair, nearer_m) < nearer_m) continue;
    found = {pair.then_m, pair.named.names.c_str()};
  }
  return found;
}

Clearance::Nearest Clearance::too_near(const JointVector& position) noexcept {
  place(position);
  Nearest found;
  for (LookedAt& pair : pairs_) {
    const double enough_m = std::min(pair.named.limit_m, found.distance_m);
    if (pair.named.limit_m <= 0) continue;
    if (const double far = apart_m(pair, enough_m); far < enough_m) found = {far, pair.named.names.c_str()};
  }
  return found;
}

void Clearance::distances(const JointVector& position, std::span<double> of_pairs) noexcept {
  place(position);
  for (std::size_t i = 0; i < std::min(of_pairs.size(), pairs_.size()); ++i) of_pairs[i] = apart_m(pairs_[i], HUGE_VAL);
}

}  // namespace hirosco::robotics
