// SPDX-License-Identifier: MIT
#include "tools/lcm_types/type_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <utility>

namespace camway::tools {
namespace {

constexpr std::array<std::string_view, 9> kPrimitives = {
    "int8_t", "int16_t", "int32_t", "int64_t", "float", "double", "string", "boolean", "byte"};

bool is_word_char(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
}

/// A word or a sign of the text.
struct Token {
  std::string_view text;
  std::size_t line = 1;
};

/// Cuts a text into words and signs, without comments.
class Tokens {
 public:
  explicit Tokens(std::string_view text) : text_(text) { advance(); }

  [[nodiscard]] const Token& now() const { return now_; }
  [[nodiscard]] bool is_at_end() const { return now_.text.empty(); }
  Token take() {
    const Token taken = now_;
    advance();
    return taken;
  }
  bool take_if(std::string_view text) {
    if (now_.text != text) return false;
    advance();
    return true;
  }

 private:
  void advance() {
    skip_blanks();
    now_.line = line_;
    std::size_t length = text_.empty() ? 0 : 1;
    if (length > 0 && is_word_char(text_.front())) {
      length =
          static_cast<std::size_t>(std::ranges::find_if_not(text_, is_word_char) - text_.begin());
    }
    now_.text = text_.substr(0, length);
    text_.remove_prefix(length);
  }
  void skip_blanks() {
    for (;;) {
      if (text_.starts_with("//")) {
        drop(std::min(text_.find('\n'), text_.size()));
      } else if (text_.starts_with("/*")) {
        const std::size_t end = text_.find("*/", 2);
        drop(end == std::string_view::npos ? text_.size() : end + 2);
      } else if (!text_.empty() && std::isspace(static_cast<unsigned char>(text_.front())) != 0) {
        drop(1);
      } else {
        return;
      }
    }
  }
  void drop(std::size_t count) {
    line_ += static_cast<std::size_t>(std::ranges::count(text_.substr(0, count), '\n'));
    text_.remove_prefix(count);
  }

  std::string_view text_;
  std::size_t line_ = 1;
  Token now_;
};

/// Reads the structs of one file.
class TypeFileReader {
 public:
  TypeFileReader(std::string_view text, LcmTypes& types) : tokens_(text), types_(types) {}

  std::string read() {
    while (fault_.empty() && !tokens_.is_at_end()) {
      if (tokens_.take_if("package")) {
        package_ = name();
        expect(";");
      } else if (tokens_.take_if("struct")) {
        read_struct();
      } else {
        fail("expected 'package' or 'struct'");
      }
    }
    return std::move(fault_);
  }

 private:
  void read_struct() {
    LcmStruct result;
    result.name = qualified(name());
    expect("{");
    while (fault_.empty() && !tokens_.take_if("}")) {
      if (tokens_.take_if("const")) {
        skip_constants();
      } else {
        read_members(result);
      }
    }
    tokens_.take_if(";");
    if (fault_.empty()) types_.insert_or_assign(result.name, std::move(result));
  }

  void skip_constants() {
    while (!tokens_.is_at_end() && tokens_.now().text != ";") tokens_.take();
    expect(";");
  }

  /// "double x, y, z[3];"
  void read_members(LcmStruct& result) {
    std::string type = name();
    if (!is_lcm_primitive(type)) type = qualified(std::move(type));
    do {
      LcmMember member{type, name(), {}, {}};
      while (fault_.empty() && tokens_.take_if("[")) {
        read_size(result, member);
        expect("]");
      }
      result.members.push_back(std::move(member));
    } while (fault_.empty() && tokens_.take_if(","));
    expect(";");
  }

  void read_size(const LcmStruct& before, LcmMember& member) {
    const std::string text(tokens_.now().text);
    std::uint64_t number = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool is_number = read.ec == std::errc{} && read.ptr == text.data() + text.size();
    const bool is_member =
        std::ranges::any_of(before.members, [&](const LcmMember& m) { return m.name == text; });
    if (!is_number && !is_member) {
      return fail("the size '" + text + "' is neither a number nor a member before it");
    }
    tokens_.take();
    member.written.push_back(text);
    member.sizes.push_back(is_number ? LcmSize{number} : LcmSize{text});
  }

  std::string name() {
    const Token& token = tokens_.now();
    if (token.text.empty() || !is_word_char(token.text.front())) {
      fail("expected a name");
      return "";
    }
    return std::string(tokens_.take().text);
  }

  std::string qualified(std::string name) const {
    if (package_.empty() || name.find('.') != std::string::npos) return name;
    return package_ + "." + name;
  }

  void expect(std::string_view text) {
    if (fault_.empty() && !tokens_.take_if(text)) fail("expected '" + std::string(text) + "'");
  }

  void fail(const std::string& reason) {
    if (!fault_.empty()) return;
    const Token& token = tokens_.now();
    fault_ = "line " + std::to_string(token.line) + ": " + reason +
             (token.text.empty() ? ", not the end of the file"
                                 : ", not '" + std::string(token.text) + "'");
  }

  Tokens tokens_;
  LcmTypes& types_;
  std::string package_;
  std::string fault_;
};

/// LCM's hash: each character is added to the value before, which is shifted by a byte. The shift
/// to the right is arithmetic: it repeats the sign.
class Hash {
 public:
  void add(std::uint8_t byte) {
    const auto drawn = static_cast<std::uint64_t>(static_cast<std::int64_t>(value_) >> 55);
    value_ = ((value_ << 8U) ^ drawn) + byte;
  }
  void add(std::string_view text) {
    add(static_cast<std::uint8_t>(text.size()));
    for (const char c : text) add(static_cast<std::uint8_t>(c));
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0x12345678;
};

/// The hash of a struct's own members, without those of structs in it.
std::uint64_t own_hash(const LcmStruct& type) {
  Hash hash;
  for (const LcmMember& member : type.members) {
    hash.add(member.name);
    if (is_lcm_primitive(member.type)) hash.add(member.type);
    hash.add(static_cast<std::uint8_t>(member.sizes.size()));
    for (std::size_t i = 0; i < member.sizes.size(); ++i) {
      hash.add(static_cast<std::uint8_t>(std::holds_alternative<std::string>(member.sizes[i])));
      hash.add(member.written[i]);
    }
  }
  return hash.value();
}

/// Most structs that a struct may hold, each counted as often as it occurs. Types in use have tens.
constexpr std::size_t kMostNestedStructs = 10'000;

/// A walk through a struct and all structs in it.
class Fingerprint {
 public:
  explicit Fingerprint(const LcmTypes& types) : types_(types) {}

  /// A struct that holds itself, also through others, adds nothing there.
  base::Result<std::uint64_t> of(std::string_view name) {
    if (std::ranges::find(above_, name) != above_.end()) return std::uint64_t{0};
    const auto found = types_.find(name);
    if (found == types_.end()) {
      return base::Failure{"no file defines the struct '" + std::string(name) + "'"};
    }
    if (++visited_ > kMostNestedStructs) {
      return base::Failure{"'" + std::string(name) + "' is nested too often"};
    }
    std::uint64_t hash = own_hash(found->second);
    above_.push_back(found->first);
    for (const LcmMember& member : found->second.members) {
      if (is_lcm_primitive(member.type)) continue;
      const auto nested = of(member.type);
      if (!nested) return nested;
      hash += *nested;
    }
    above_.pop_back();
    return (hash << 1U) + (hash >> 63U);
  }

 private:
  const LcmTypes& types_;
  std::vector<std::string_view> above_;
  std::size_t visited_ = 0;
};

}  // namespace

bool is_lcm_primitive(std::string_view type) {
  return std::ranges::find(kPrimitives, type) != kPrimitives.end();
}

std::string read_lcm_types(std::string_view text, LcmTypes& types) {
  return TypeFileReader(text, types).read();
}

base::Result<std::uint64_t> lcm_fingerprint(const LcmTypes& types, std::string_view name) {
  return Fingerprint(types).of(name);
}

}  // namespace camway::tools
