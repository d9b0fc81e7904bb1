// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "daemon/motion/path/path.h"
#include "tools/cameras/camera_track.h"
#include "tools/cameras/track_thinning.h"

namespace camway::tools {

/// Few keys of a path for programs that play cubic Hermite splines between keys
/// (`Playback::kCubic`). Keys are on the path, and tangents are the derivatives of the path: of the
/// position, and of the orientation's unit quaternion, from either side where the path has a kink.
/// Quaternions follow the path without a jump to the other side of the sphere, however far it turns
/// between two keys. A value type.
class SparseKeys {
 public:
  /// Keys are chosen from `kCandidatesPerFrame` times in each frame, and the joins of the path.
  /// Begins with the joins. Requires a path and 0 < fps.
  SparseKeys(const motion::Path& path, double fps);

  /// Adds the worst time of each interval between keys until what is played is within the tolerance
  /// of the path at all candidates, and then drops each key that is not needed for that. Need not
  /// find the fewest keys.
  void keep_within(const ThinningTolerance& tolerance);

  /// As `keep_within`, with keys on frames alone, up to the last one that is not after the end of
  /// the path; those that `add_near` adds later are on frames, too, as long as there are some
  /// between. Returns whether frames suffice; else the keys are as before.
  bool keep_frames_within(const ThinningTolerance& tolerance);

  /// Returns whether all keys are on frames, which count from the begin of the path, so that a file
  /// of them has a rate.
  [[nodiscard]] bool are_on_frames() const;

  /// Adds a key in the middle of each interval between keys that meets the stretch. Returns whether
  /// there was a time to add.
  bool add_near(double begin_s, double end_s);

  /// Returns the keys with their tangents.
  [[nodiscard]] CameraTrack track() const;

  /// The largest differences of a track from the path, at the candidates up to the last key. The
  /// times of the track are those of the path less `offset_s`.
  struct Difference {
    double position_m = 0.0;
    double turn_rad = 0.0;
  };
  [[nodiscard]] Difference difference(const CameraTrack& track, double offset_s) const;

  static constexpr double kCandidatesPerFrame = 4.0;

 private:
  struct Candidate {
    TrackKey key;
    KeyTangents tangents;
    bool is_on_frame = false;
  };
  /// A key interval, as indices of candidates, and what is played of it.
  [[nodiscard]] CameraTrack interval(std::size_t begin, std::size_t end) const;
  /// The worst candidate within a key interval; nothing if none is off by more than the tolerance.
  [[nodiscard]] std::optional<std::size_t> worst_in(std::size_t begin, std::size_t end,
                                                    const ThinningTolerance& tolerance) const;
  /// The candidate on a frame that is nearest to `wanted` within a key interval; nothing if none
  /// is.
  [[nodiscard]] std::optional<std::size_t> frame_near(std::size_t wanted, std::size_t begin,
                                                      std::size_t end) const;
  void mark_frames(double fps);
  void drop_needless(const ThinningTolerance& tolerance);
  void add_candidate(const motion::Path& path, double time_s);

  std::vector<Candidate> candidates_;  ///< in order of time
  std::vector<std::size_t> kept_;      ///< indices of candidates, increasing
  bool prefers_frames_ = false;
};

}  // namespace camway::tools
