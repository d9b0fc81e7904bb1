// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "daemon/scene/import/common/transform_chain.h"

class SoCallbackAction;
class SoNode;

namespace camway::scene::inventor {

/// Follows a traversal of Coin's and keeps the chain of transforms that Coin multiplies in single
/// precision, for the bound of its rounding.
class TransformTracker {
 public:
  /// Called before and after each node of the traversal.
  void enter(SoCallbackAction& action, const SoNode& node);
  void leave(SoCallbackAction& action, const SoNode& node);

  /// The chain of the node that was entered last.
  [[nodiscard]] const import_process::TransformChain& chain() const;

 private:
  struct Entry {
    int depth = 0;  ///< of Coin's state when the chain began to hold
    import_process::TransformChain chain;
  };
  void set(int depth, const import_process::TransformChain& chain);

  std::vector<Entry> entries_;
  std::vector<import_process::TransformChain> saved_;  ///< of TransformSeparator nodes
  import_process::TransformChain identity_;
};

}  // namespace camway::scene::inventor
