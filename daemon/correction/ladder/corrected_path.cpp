// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/corrected_path.h"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <memory>
#include <utility>

#include "daemon/motion/path/bezier.h"

namespace camway::correction {

using motion::CubicPath;
using motion::CubicPiece;

namespace {

std::shared_ptr<const motion::KnotPlaces> places_for(const Problem& part,
                                                     const motion::TimeOrigin& origin,
                                                     double ball_radius_m) {
  motion::KnotPlaces places{origin, {part.path.begin_s()}, 0.0};
  double size_m = 0.0;
  for (const motion::CubicPiece& piece : part.path.pieces) {
    places.taken_s.push_back(piece.t1_s);
    size_m = std::max(size_m, piece.position[3].cwiseAbs().maxCoeff());
  }
  const double leg_s = part.leg_end_s() - part.leg_begin_s();
  const double chord_m =
      (part.path.at(part.leg_end_s()).position - part.path.at(part.leg_begin_s()).position).norm();
  // If the camera only turns, corrections move it by about its own size.
  places.same_s = motion::least_piece_s(leg_s, std::max(chord_m, ball_radius_m), size_m);
  // Knots are keyframes of the answer, which a request must be able to hold.
  places.same_s = std::max(places.same_s,
                           motion::kTimesBetweenKeyframes * origin.resolution_s(part.path.end_s()));
  return std::make_shared<const motion::KnotPlaces>(std::move(places));
}

/// The part of `original` from `begin_s` to `end_s`, which are knots of `path`: it joins the
/// pieces of `path` before and after bit for bit.
CubicPath cut(const CubicPath& original, const CubicPath& path, double begin_s, double end_s) {
  CubicPath part = original.around(begin_s, end_s);
  for (CubicPiece& piece : part.pieces) {
    const double duration_s = piece.t1_s - piece.t0_s;
    const double u0 = std::max(0.0, (begin_s - piece.t0_s) / duration_s);
    const double u1 = piece.t1_s <= end_s ? 1.0 : (end_s - piece.t0_s) / duration_s;
    piece = {std::max(piece.t0_s, begin_s), std::min(piece.t1_s, end_s),
             motion::bezier::sub_curve(piece.position, u0, u1),
             motion::bezier::sub_curve(piece.image, u0, u1)};
  }
  for (const CubicPiece& piece : path.pieces) {
    if (piece.t1_s == begin_s) {
      part.pieces.front().position[0] = piece.position[3];
      part.pieces.front().image[0] = piece.image[3];
    }
    if (piece.t0_s == end_s) {
      part.pieces.back().position[3] = piece.position[0];
      part.pieces.back().image[3] = piece.image[0];
    }
  }
  return part;
}

}  // namespace

CorrectedPath::CorrectedPath(const CubicPath& interpolated,
                             const std::vector<motion::Keyframe>& keyframes,
                             const CorrectionLimits& limits, const base::Deadline& deadline)
    : interpolated_(interpolated),
      limits_(limits),
      whole_deadline_(deadline),
      deadline_(deadline),
      path_(interpolated) {
  for (const motion::Keyframe& keyframe : keyframes) keyframes_s_.push_back(keyframe.time_s);
  leave_time_for_the_rest();
}

void CorrectedPath::leave_time_for_the_rest() {
  const auto pieces = static_cast<double>(path_.pieces.size());
  deadline_ = whole_deadline_.sooner_by_s(limits_.rest_s_per_piece * pieces);
}

Problem CorrectedPath::part_about(std::size_t leg, const motion::TimeOrigin& origin,
                                  double ball_radius_m) const {
  const std::size_t first = leg == 0 ? 0 : leg - 1;
  const std::size_t last = std::min(leg + 2, keyframes_s_.size() - 1);
  Problem part;
  part.path = path_.around(keyframes_s_[first], keyframes_s_[last]);
  part.original = interpolated_.around(keyframes_s_[first], keyframes_s_[last]);
  part.keyframes_s.assign(keyframes_s_.begin() + static_cast<std::ptrdiff_t>(first),
                          keyframes_s_.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  part.leg = leg - first;
  part.has_path_begin = first == 0;
  part.has_path_end = last + 1 == keyframes_s_.size();
  part.interval = {keyframes_s_[leg], keyframes_s_[leg + 1]};
  part.places = places_for(part, origin, ball_radius_m);
  return part;
}

bool CorrectedPath::fits(const Candidate& candidate) const {
  return count_with(candidate) <= static_cast<std::size_t>(limits_.max_inserted_keyframes);
}

bool CorrectedPath::take(const Candidate& candidate) {
  if (!fits(candidate)) return false;
  path_.replace(candidate.path);
  const auto [begin_s, end_s] = range_of(candidate);
  add_changed({begin_s, end_s, turns(candidate.rows)});
  leave_time_for_the_rest();
  return true;
}

void CorrectedPath::add_changed(ChangedPart part) {
  std::erase_if(changed_, [&](const ChangedPart& known) {
    if (known.end_s <= part.begin_s || known.begin_s >= part.end_s) return false;
    part = {std::min(part.begin_s, known.begin_s), std::max(part.end_s, known.end_s),
            part.turns || known.turns};
    return true;
  });
  changed_.insert(std::ranges::upper_bound(changed_, part.begin_s, {}, &ChangedPart::begin_s),
                  part);
}

ChangedPart CorrectedPath::widened(const ChangedPart& part, double share) const {
  const double beside_s = share * (part.end_s - part.begin_s);
  ChangedPart wide = part;
  wide.begin_s = std::max(interpolated_.begin_s(), part.begin_s - beside_s);
  wide.end_s = std::min(interpolated_.end_s(), part.end_s + beside_s);
  for (const ChangedPart& other : changed_) {
    if (other.end_s <= part.begin_s) wide.begin_s = std::max(wide.begin_s, other.end_s);
    if (other.begin_s >= part.end_s) wide.end_s = std::min(wide.end_s, other.begin_s);
  }
  return wide;
}

Problem CorrectedPath::restored(const ChangedPart& part, const motion::TimeOrigin& origin,
                                double ball_radius_m) const {
  const auto after_begin = std::ranges::upper_bound(keyframes_s_, part.begin_s);
  const auto first = std::max(after_begin, keyframes_s_.begin() + 1) - 1;
  const auto last =
      std::min(std::ranges::lower_bound(keyframes_s_, part.end_s), keyframes_s_.end() - 1);
  Problem problem;
  problem.path = path_.around(*first, *last);
  problem.original = interpolated_.around(*first, *last);
  problem.keyframes_s.assign(first, last + 1);
  problem.has_path_begin = first == keyframes_s_.begin();
  problem.has_path_end = last + 1 == keyframes_s_.end();
  problem.interval = {part.begin_s, part.end_s};
  problem.places = places_for(problem, origin, ball_radius_m);

  // From the changed part before to the one after, or to keyframes.
  double begin_s = *first;
  double end_s = *last;
  const auto here = std::ranges::lower_bound(changed_, part.begin_s, {}, &ChangedPart::begin_s);
  if (here != changed_.begin()) begin_s = std::max(begin_s, std::prev(here)->end_s);
  if (here + 1 != changed_.end()) end_s = std::min(end_s, (here + 1)->begin_s);
  problem.path.replace(cut(problem.original, problem.path, begin_s, end_s));
  return problem;
}

bool CorrectedPath::take_instead(const ChangedPart& part, const Candidate& candidate) {
  std::erase_if(changed_, [&](const ChangedPart& known) { return known.begin_s == part.begin_s; });
  if (take(candidate)) return true;
  add_changed(part);
  return false;
}

void CorrectedPath::restore(std::size_t first_keyframe, std::size_t last_keyframe) {
  const double begin_s = keyframes_s_[first_keyframe];
  const double end_s = keyframes_s_[last_keyframe];
  const auto is_within = [&](const ChangedPart& part) {
    return begin_s <= part.begin_s && part.end_s <= end_s;
  };
  assert(std::ranges::all_of(changed_, [&](const ChangedPart& part) {
    return is_within(part) || part.end_s <= begin_s || end_s <= part.begin_s;
  }));
  path_.replace(interpolated_.around(begin_s, end_s));
  std::erase_if(changed_, is_within);
  leave_time_for_the_rest();
}

void CorrectedPath::adopt(CorrectedPath&& other) {
  path_ = std::move(other.path_);
  changed_ = std::move(other.changed_);
  leave_time_for_the_rest();
}

void CorrectedPath::count_refused(const Candidate& candidate) {
  refused_keyframes_ += count_with(candidate) - count_inserted();
}

std::size_t CorrectedPath::count_inserted() const {
  return path_.pieces.size() + 1 - keyframes_s_.size();
}

// The inserted keyframes of the path with the candidate.
std::size_t CorrectedPath::count_with(const Candidate& candidate) const {
  const CubicPath& part = candidate.path;
  return count_inserted() + part.pieces.size() -
         path_.around(part.begin_s(), part.end_s()).pieces.size();
}

std::vector<double> CorrectedPath::inserted_s() const {
  std::vector<double> knots_s;
  for (const motion::CubicPiece& piece : path_.pieces) knots_s.push_back(piece.t0_s);
  std::vector<double> known_s;
  for (const motion::CubicPiece& piece : interpolated_.pieces) known_s.push_back(piece.t0_s);
  std::vector<double> inserted_s;
  std::ranges::set_difference(knots_s, known_s, std::back_inserter(inserted_s));
  return inserted_s;
}

std::optional<std::size_t> CorrectedPath::needed_keyframes() const {
  if (refused_keyframes_ == 0) return std::nullopt;
  return count_inserted() + refused_keyframes_;
}

std::pair<double, double> CorrectedPath::range_of(const Candidate& candidate) const {
  double begin_s = interpolated_.end_s();
  double end_s = interpolated_.begin_s();
  for (const motion::BumpRow& row : candidate.rows) {
    begin_s = std::min(begin_s, row.begin_s());
    end_s = std::max(end_s, row.end_s());
  }
  return {std::max(begin_s, interpolated_.begin_s()), std::min(end_s, interpolated_.end_s())};
}

void CorrectedPath::mark_legs(double begin_s, double end_s, std::vector<bool>& legs) const {
  const auto after_begin = std::ranges::upper_bound(keyframes_s_, begin_s);
  auto leg = static_cast<std::size_t>(after_begin - keyframes_s_.begin());
  for (leg -= leg > 0 ? 1 : 0; leg < legs.size() && keyframes_s_[leg] < end_s; ++leg) {
    legs[leg] = true;
  }
}

}  // namespace camway::correction
