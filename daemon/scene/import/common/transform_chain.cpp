// SPDX-License-Identifier: MIT
#include "daemon/scene/import/common/transform_chain.h"

#include <algorithm>
#include <cstddef>

namespace camway::scene::import_process {

TransformChain::TransformChain() {
  for (std::size_t i = 0; i < 4; ++i) chain_[i][i] = 1.0;
}

TransformChain TransformChain::then(const Magnitudes& inner, double products) const {
  TransformChain result;
  result.products_ = products_ + products;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      double sum = 0.0;
      for (std::size_t k = 0; k < 4; ++k) sum += chain_[i][k] * inner[k][j];
      result.chain_[i][j] = sum;
    }
  }
  return result;
}

TransformChain TransformChain::at_least(const Magnitudes& whole, double products) const {
  TransformChain result = *this;
  result.products_ += products;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      result.chain_[i][j] = std::max(chain_[i][j], whole[i][j]);
    }
  }
  return result;
}

double TransformChain::rounding(const std::array<double, 3>& largest) const {
  if (products_ == 0.0) return 0.0;
  double bound = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    double size = chain_[i][3];
    for (std::size_t k = 0; k < 3; ++k) size += chain_[i][k] * largest[k];
    bound = std::max(bound, size);
  }
  const double roundoffs = 2.0 * (4.0 * products_ + (products_ + 1.0) * kReadingRoundoffs);
  return roundoffs * kFloatRoundoff * bound;
}

}  // namespace camway::scene::import_process
