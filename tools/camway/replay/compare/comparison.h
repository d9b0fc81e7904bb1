// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "tools/camway/replay/compare/verdict.h"
#include "tools/camway/replay/session.h"

namespace camway::tools {

/// A request with the two answers that were compared, and the verdict on them.
struct ComparedRequest : Judgement {
  const RecordedRequest* recorded = nullptr;  ///< its `answer` is the earlier one
  std::optional<RecordedAnswer> now;
  bool scene_changed = false;  ///< whether the answers are of scenes with different triangles
  /// Whether it was not planned, as its scene is damaged in the recording.
  bool scene_is_damaged = false;
};

/// Verdicts that make a comparison fail.
using Failing = std::vector<Verdict>;
inline const Failing kFailing{Verdict::kWorse, Verdict::kDifferent, Verdict::kRegressed};

std::size_t count(const std::vector<ComparedRequest>& compared, Verdict verdict);

/// Whether a request has one of the verdicts that fail.
bool has_failed(const std::vector<ComparedRequest>& compared, const Failing& failing);

/// Returns the indices of the requests whose answers differ, the worst verdicts first.
std::vector<std::size_t> worst_first(const std::vector<ComparedRequest>& compared);

/// Compares the recorded answers of two logs, in the order of `then`, and after these the requests
/// that only `now` has. Requests belong together by client and id; of those that remain, by their
/// content, in order. Takes the answers of `now`. Both sessions must outlive the result.
std::vector<ComparedRequest> compare(const Session& then, Session& now,
                                     const Thresholds& thresholds);

/// Returns the pair of answers as `judge` takes it; sets `scene_changed`.
AnswerPair answers_of(ComparedRequest& compared);

}  // namespace camway::tools
