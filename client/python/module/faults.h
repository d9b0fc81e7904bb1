// SPDX-License-Identifier: MIT
#pragma once

#include <camway/status.h>
#include <pybind11/pybind11.h>

#include <exception>
#include <string>
#include <utility>

namespace camway::python {

/// A value of Python that cannot be converted. Becomes a TypeError or a ValueError whose text names
/// the member: "keyframes[3].position_m: must be 3 numbers".
class ConversionFault : public std::exception {
 public:
  enum class Kind { kType, kValue };
  ConversionFault(Kind kind, std::string reason) : kind_(kind), text_(": " + std::move(reason)) {}

  /// Returns this fault as one in a member, "position_m", or an item, "[3]", of what is converted.
  [[nodiscard]] ConversionFault within(const std::string& part) const {
    ConversionFault fault = *this;
    fault.text_ = part + (names_member() ? "." : "") + text_;
    return fault;
  }
  /// Returns whether the text begins with the name of a member.
  [[nodiscard]] bool names_member() const { return text_[0] != ':' && text_[0] != '['; }

  [[nodiscard]] Kind kind() const { return kind_; }
  [[nodiscard]] const char* what() const noexcept override { return text_.c_str(); }

 private:
  Kind kind_;
  std::string text_;
};

/// A call that failed, with the status and the text of C++. Becomes the exception of that status.
struct Failed {
  Status status = Status::kInvalid;
  std::string text;
};

/// Sets up how the two become exceptions of Python. `errors`: the module `camway._errors`.
void register_faults(const pybind11::module_& errors);

}  // namespace camway::python
