// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/scene/import/readers/included_file.h"
#include "daemon/scene/import/unigrafix/statement_scanner.h"
#include "daemon/scene/import/unigrafix/unigrafix_model.h"

namespace camway::scene::unigrafix {

using scene::IncludedFile;
using scene::OpenInclude;

/// Counts of statements for the notes of a report.
struct ParseCounts {
  std::uint64_t includes = 0;
  std::uint64_t lights_and_cameras = 0;
  std::uint64_t matrices_without_offset = 0;  ///< whose rows and columns cannot be told apart
};

/// Parses the UniGrafix language (Couch 1994, "Berkeley UNIGRAFIX 3.1 - Data Structure and
/// Language") into `scene`. Not thread-safe.
///
/// A matrix (-M3, -M4) multiplies points as rows from the left, unless its numbers say otherwise:
/// the offset of -M4 is in the last row or the last column, whichever the other one leaves. Angles
/// are in degrees. Vertices may be used before they are defined, definitions not.
class UnigrafixParser {
 public:
  UnigrafixParser(Definition& scene, const OpenInclude& open_include);

  /// Returns why the file is refused, with the line; empty if it is not.
  std::string parse(std::string_view text);
  [[nodiscard]] const ParseCounts& counts() const { return counts_; }

 private:
  using Fault = std::string;  ///< empty if there is none

  Fault parse_file(std::string_view text, const std::string& file);
  Fault parse_statement(StatementScanner& words);
  Fault parse_vertex(StatementScanner& words);
  Fault parse_face_or_wire(StatementScanner& words, bool is_face);
  Fault parse_contours(StatementScanner& words, std::vector<std::uint32_t>& corners,
                       std::vector<std::size_t>& ends);
  Fault parse_use(StatementScanner& words, bool is_array);
  Fault parse_map(StatementScanner& words, std::string_view end, PlacementMap& map);
  Fault parse_transform(StatementScanner& words, PlacementMap& map);
  Fault parse_definition(StatementScanner& words);
  Fault end_definition(StatementScanner& words);
  Fault parse_include(StatementScanner& words);
  Fault skip_text(StatementScanner& words);
  static Fault skip_statement(StatementScanner& words);
  static void parse_preprocessor_line(StatementScanner& words, std::string_view first_word);

  Definition& scene_;
  const OpenInclude& open_include_;
  ParseCounts counts_;
  std::vector<Definition*> open_;  ///< definitions that have begun, the scene first
  std::vector<std::string> files_;
};

}  // namespace camway::scene::unigrafix
