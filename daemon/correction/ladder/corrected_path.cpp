// SPDX-License-Identifier: MIT
#include "daemon/correction/ladder/corrected_path.h"

#include <algorithm>
#include <iterator>
#include <memory>

namespace camway::correction {

using motion::CubicPath;

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
  return std::make_shared<const motion::KnotPlaces>(std::move(places));
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

bool CorrectedPath::take(const Candidate& candidate) {
  const auto most = static_cast<std::size_t>(limits_.max_inserted_keyframes);
  if (count_inserted() + count_added(candidate) > most) return false;
  path_.replace(candidate.path);
  leave_time_for_the_rest();
  return true;
}

void CorrectedPath::count_refused(const Candidate& candidate) {
  refused_keyframes_ += count_added(candidate);
}

std::size_t CorrectedPath::count_inserted() const {
  return path_.pieces.size() - interpolated_.pieces.size();
}

// Candidates split pieces, and join none.
std::size_t CorrectedPath::count_added(const Candidate& candidate) const {
  const CubicPath& part = candidate.path;
  return part.pieces.size() - path_.around(part.begin_s(), part.end_s()).pieces.size();
}

std::vector<double> CorrectedPath::inserted_s() const {
  std::vector<double> joints_s;
  for (const motion::CubicPiece& piece : path_.pieces) joints_s.push_back(piece.t0_s);
  std::vector<double> known_s;
  for (const motion::CubicPiece& piece : interpolated_.pieces) known_s.push_back(piece.t0_s);
  std::vector<double> inserted_s;
  std::ranges::set_difference(joints_s, known_s, std::back_inserter(inserted_s));
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
