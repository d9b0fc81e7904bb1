// SPDX-License-Identifier: MIT
#include "daemon/scene/import/unigrafix/unigrafix_model.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace camway::scene::unigrafix {

std::uint32_t Definition::vertex(std::string_view name, const std::string& place) {
  if (const auto found = names_.find(name); found != names_.end()) return found->second;
  const auto index = static_cast<std::uint32_t>(vertices_.size());
  vertices_.push_back({});
  names_.emplace(name, index);
  missing_.emplace(index, place);
  return index;
}

bool Definition::define_vertex(std::string_view name, const Point& point) {
  const std::uint32_t index = vertex(name, "");
  vertices_[index] = point;
  return missing_.erase(index) == 1;
}

void Definition::add_face(const std::vector<std::uint32_t>& corners,
                          const std::vector<std::size_t>& ends) {
  faces_.push_back(
      {static_cast<std::uint32_t>(corners.size()), static_cast<std::uint32_t>(ends.size())});
  corners_.insert(corners_.end(), corners.begin(), corners.end());
  ends_.insert(ends_.end(), ends.begin(), ends.end());
}

void Definition::add_use(Use use) {
  if (!use.definition->has_content()) return;
  depth_ = std::max(depth_, use.definition->depth() + 1);
  std::uint64_t size = 0;
  if (__builtin_mul_overflow(use.definition->size(), use.count, &size) ||
      __builtin_add_overflow(size_, size, &size_)) {
    size_ = std::numeric_limits<std::uint64_t>::max();
  }
  uses_.push_back(std::move(use));
}

Definition* Definition::begin_definition(std::string_view name) {
  const auto [made, is_new] = definitions_.try_emplace(std::string(name));
  if (!is_new) return nullptr;
  made->second = std::make_unique<Definition>(this);
  return made->second.get();
}

const Definition* Definition::find(std::string_view name) const {
  for (const Definition* scope = this; scope != nullptr; scope = scope->outer_) {
    const auto found = scope->definitions_.find(name);
    if (found != scope->definitions_.end() && found->second->is_complete_) {
      return found->second.get();
    }
  }
  return nullptr;
}

std::string Definition::complete() {
  if (!missing_.empty()) {
    const auto& [index, place] = *missing_.begin();
    const auto name = std::ranges::find(names_, index, &Names::value_type::second);
    return place + ": there is no vertex '" + name->first + "'";
  }
  names_.clear();
  if (__builtin_add_overflow(size_, vertices_.size() + faces_.size(), &size_)) {
    size_ = std::numeric_limits<std::uint64_t>::max();
  }
  has_content_ = !faces_.empty() || lines_ > 0 || !uses_.empty();
  is_complete_ = true;
  return "";
}

}  // namespace camway::scene::unigrafix
