// SPDX-License-Identifier: MIT
#include "tools/lcm_types/message_reader.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <map>
#include <utility>

#include "daemon/base/big_endian.h"

namespace camway::tools {
namespace {

constexpr std::size_t kFingerprintBytes = 8;
/// Deepest nesting of structs to accept: a deeper type holds itself.
constexpr int kDeepest = 64;
/// Most elements of arrays, those of outer dimensions included, that a message may have: some for
/// each byte, and as many that take no bytes. Only arrays of empty structs have more, and would be
/// read for ever.
constexpr double kElementsPerByte = 4.0;
constexpr double kEmptyElements = 1e6;

/// Bytes of a number on the wire; 0 for a string.
std::size_t bytes_of(std::string_view primitive) {
  if (primitive == "int64_t" || primitive == "double") return 8;
  if (primitive == "int32_t" || primitive == "float") return 4;
  if (primitive == "int16_t") return 2;
  return primitive == "string" ? 0 : 1;
}

const LcmMember* member_of(const LcmStruct& type, std::string_view name) {
  const auto found =
      std::ranges::find_if(type.members, [&](const LcmMember& m) { return m.name == name; });
  return found == type.members.end() ? nullptr : &*found;
}

std::string members_text(const LcmStruct& type) {
  std::string text;
  for (const LcmMember& member : type.members) text += (text.empty() ? "" : ", ") + member.name;
  return text;
}

/// "pos[2]": a name and its indices.
std::optional<LcmSelector::Step> step_from(std::string_view text) {
  LcmSelector::Step step;
  const std::size_t bracket = std::min(text.find('['), text.size());
  step.name = text.substr(0, bracket);
  text.remove_prefix(bracket);
  while (!text.empty()) {
    const std::size_t close = text.find(']');
    if (text.front() != '[' || close == std::string_view::npos) return std::nullopt;
    const std::string_view digits = text.substr(1, close - 1);
    std::uint64_t index = 0;
    const auto read = std::from_chars(digits.begin(), digits.end(), index);
    if (read.ec != std::errc{} || read.ptr != digits.end()) return std::nullopt;
    step.indices.emplace_back(index);
    text.remove_prefix(close + 1);
  }
  return step;
}

/// The place that a text names in a struct, and the type of what is there.
struct Place {
  std::vector<LcmSelector::Step> steps;
  std::string type;
};

base::Result<Place> place_in(const LcmTypes& types, const std::string& type,
                             std::string_view text) {
  Place place{{}, type};
  const auto fail = [&](const std::string& reason) {
    return base::Failure{"'" + std::string(text) + "': " + reason};
  };
  for (std::string_view rest = text;;) {
    const std::size_t dot = std::min(rest.find('.'), rest.size());
    std::optional<LcmSelector::Step> step = step_from(rest.substr(0, dot));
    if (!step) return fail("an index is a whole number in brackets, as in pose[0]");
    if (is_lcm_primitive(place.type)) return fail("'" + step->name + "' stands behind a number");
    const auto found = types.find(place.type);
    if (found == types.end()) return fail("no file defines the struct '" + place.type + "'");
    const LcmMember* const member = member_of(found->second, step->name);
    if (member == nullptr) {
      return fail("'" + place.type + "' has no member '" + step->name + "'; it has " +
                  members_text(found->second));
    }
    if (step->indices.size() > member->sizes.size()) {
      return fail("'" + step->name + "' is no array of so many dimensions");
    }
    place.type = member->type;
    place.steps.push_back(*std::move(step));
    if (dot == rest.size()) return place;
    rest.remove_prefix(dot + 1);
  }
}

/// A selector in a walk through a message: the steps that are to come.
struct Wanted {
  std::size_t selector = 0;
  std::span<const LcmSelector::Step> steps;
};

/// A walk through one message.
class Walk {
 public:
  Walk(const LcmTypes& types, std::span<const std::uint8_t> bytes, std::size_t selectors)
      : types_(types),
        left_(bytes),
        elements_left_(kElementsPerByte * static_cast<double>(bytes.size()) + kEmptyElements),
        numbers_(selectors) {}

  bool read_struct(const LcmStruct& type, const std::vector<Wanted>& wanted, int depth) {
    if (depth > kDeepest) return fail("structs are nested too deeply");
    std::map<std::string_view, double> counts;
    for (const LcmMember& member : type.members) {
      std::vector<Wanted> inside;
      for (const Wanted& want : wanted) {
        if (!want.steps.empty() && want.steps.front().name == member.name) inside.push_back(want);
      }
      if (!read_dimension(member, 0, inside, counts, depth)) return false;
      if (member.sizes.empty()) counts[member.name] = last_number_;
    }
    return true;
  }

  [[nodiscard]] std::size_t bytes_left() const { return left_.size(); }
  std::vector<std::vector<double>>& numbers() { return numbers_; }
  [[nodiscard]] const std::string& fault() const { return fault_; }

 private:
  using Counts = std::map<std::string_view, double>;

  /// Reads the elements of `member`, from the size with the number `dimension` on.
  bool read_dimension(const LcmMember& member, std::size_t dimension,
                      const std::vector<Wanted>& wanted, const Counts& counts, int depth) {
    if (dimension == member.sizes.size()) return read_element(member, wanted, depth);
    const std::optional<std::uint64_t> count = count_of(member, dimension, counts);
    if (!count) return false;
    if (wanted.empty() && dimension + 1 == member.sizes.size() && bytes_of(member.type) > 0 &&
        is_lcm_primitive(member.type)) {
      return skip(member, *count * bytes_of(member.type));
    }
    for (std::uint64_t i = 0; i < *count; ++i) {
      std::vector<Wanted> inside;
      for (const Wanted& want : wanted) {
        const auto& indices = want.steps.front().indices;
        if (dimension >= indices.size() || !indices[dimension] || *indices[dimension] == i) {
          inside.push_back(want);
        }
      }
      if (!read_dimension(member, dimension + 1, inside, counts, depth)) return false;
    }
    return true;
  }

  std::optional<std::uint64_t> count_of(const LcmMember& member, std::size_t dimension,
                                        const Counts& counts) {
    const LcmSize& size = member.sizes[dimension];
    double count = -1.0;
    if (const auto* number = std::get_if<std::uint64_t>(&size)) {
      count = static_cast<double>(*number);
    } else if (const auto found = counts.find(std::get<std::string>(size)); found != counts.end()) {
      count = found->second;
    }
    if (!(count >= 0.0 && count <= elements_left_)) {
      fail("'" + member.name + "' has more elements than bytes are left, or fewer than none");
      return std::nullopt;
    }
    elements_left_ -= count;
    return static_cast<std::uint64_t>(count);
  }

  bool read_element(const LcmMember& member, const std::vector<Wanted>& wanted, int depth) {
    if (member.type == "string") {
      std::uint64_t length = 0;
      return take(member, 4, length) && skip(member, length);
    }
    if (is_lcm_primitive(member.type)) return read_number(member, wanted);
    std::vector<Wanted> inside = wanted;
    for (Wanted& want : inside) want.steps = want.steps.subspan(1);
    return read_struct(types_.at(member.type), inside, depth + 1);
  }

  bool read_number(const LcmMember& member, const std::vector<Wanted>& wanted) {
    std::uint64_t bits = 0;
    if (!take(member, bytes_of(member.type), bits)) return false;
    last_number_ = number_from(member.type, bits);
    for (const Wanted& want : wanted) numbers_[want.selector].push_back(last_number_);
    return true;
  }

  static double number_from(std::string_view type, std::uint64_t bits) {
    if (type == "double") return std::bit_cast<double>(bits);
    if (type == "float") return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    if (type == "int64_t") return static_cast<double>(static_cast<std::int64_t>(bits));
    if (type == "int32_t") return static_cast<std::int32_t>(bits);
    if (type == "int16_t") return static_cast<std::int16_t>(bits);
    if (type == "int8_t") return static_cast<std::int8_t>(bits);
    return static_cast<double>(bits);  // byte, boolean
  }

  bool take(const LcmMember& member, std::size_t bytes, std::uint64_t& value) {
    if (bytes > left_.size()) return fail("the message breaks off in '" + member.name + "'");
    value = base::big_endian(left_.first(bytes));
    left_ = left_.subspan(bytes);
    return true;
  }

  bool skip(const LcmMember& member, std::uint64_t bytes) {
    if (bytes > left_.size()) return fail("the message breaks off in '" + member.name + "'");
    left_ = left_.subspan(bytes);
    return true;
  }

  bool fail(std::string reason) {
    if (fault_.empty()) fault_ = std::move(reason);
    return false;
  }

  const LcmTypes& types_;
  std::span<const std::uint8_t> left_;
  double elements_left_;
  std::vector<std::vector<double>> numbers_;
  double last_number_ = 0.0;
  std::string fault_;
};

}  // namespace

base::Result<LcmSelector> LcmSelector::make(const LcmTypes& types, const std::string& type,
                                            std::string_view text) {
  auto place = place_in(types, type, text);
  if (!place) return base::Failure{std::move(place.error)};
  const std::string& end = place->type;
  if (!is_lcm_primitive(end) || end == "string") {
    const auto found = types.find(end);
    return base::Failure{"'" + std::string(text) + "': is a " + end + ", not numbers" +
                         (found == types.end() ? "" : "; it has " + members_text(found->second))};
  }
  LcmSelector selector;
  selector.steps_ = std::move(place->steps);
  selector.is_whole_ = end != "double" && end != "float";
  return selector;
}

std::vector<std::string> lcm_number_members(const LcmTypes& types, const std::string& type,
                                            std::string_view text) {
  const auto place = place_in(types, type, text);
  const auto found = place ? types.find(place->type) : types.end();
  if (found == types.end()) return {};
  std::vector<std::string> names;
  for (const LcmMember& member : found->second.members) {
    if (!member.sizes.empty() || !is_lcm_primitive(member.type) || member.type == "string") {
      return {};
    }
    names.push_back(member.name);
  }
  return names;
}

base::Result<LcmMessageReader> LcmMessageReader::make(const LcmTypes& types,
                                                      const std::string& type) {
  LcmMessageReader reader;
  const auto fingerprint = lcm_fingerprint(types, type);
  if (!fingerprint) return base::Failure{fingerprint.error};
  reader.types_ = &types;
  reader.type_ = &types.find(type)->second;
  reader.fingerprint_ = *fingerprint;
  return reader;
}

base::Result<std::vector<std::vector<double>>> LcmMessageReader::read(
    std::span<const std::uint8_t> message, std::span<const LcmSelector> selectors) const {
  if (lcm_fingerprint_of(message) != fingerprint_) {
    return base::Failure{"the message is no '" + type_->name + "'"};
  }
  Walk walk(*types_, message.subspan(kFingerprintBytes), selectors.size());
  std::vector<Wanted> wanted;
  for (std::size_t i = 0; i < selectors.size(); ++i) wanted.push_back({i, selectors[i].steps()});
  if (!walk.read_struct(*type_, wanted, 0)) return base::Failure{walk.fault()};
  if (walk.bytes_left() > 0) {
    return base::Failure{"the message has " + std::to_string(walk.bytes_left()) +
                         " bytes behind its end"};
  }
  return std::move(walk.numbers());
}

std::optional<std::uint64_t> lcm_fingerprint_of(std::span<const std::uint8_t> message) {
  if (message.size() < kFingerprintBytes) return std::nullopt;
  return base::big_endian(message.first(kFingerprintBytes));
}

}  // namespace camway::tools
