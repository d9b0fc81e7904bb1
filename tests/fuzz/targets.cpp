// SPDX-License-Identifier: MIT
#include "tests/fuzz/targets.h"

#include <algorithm>
#include <array>

namespace camway::testing {

std::span<const FuzzTarget> fuzz_targets() {
  static const std::array all{
      kWireTarget,         kEnvelopeTarget,     kMeshTarget,         kRequestJsonTarget,
      kResponseJsonTarget, kPathJsonTarget,     kSessionTarget,      kImportRecordTarget,
      kMapFileTarget,      kCacheFileTarget,    kChangeRecordTarget, kLogMessageTarget,
      kStreamAnswerTarget, kSourceRecordTarget, kConfigTarget,       kKeyFileTarget,
      kFleetTarget,        kFleetPartsTarget,   kUnigrafixTarget,    kPointsTarget,
      kBezierTarget,       kCameraFileTarget,   kDoorMessageTarget,  kSentMeshTarget,
      kPackTarget,
#ifdef CAMWAY_WITH_INVENTOR
      kInventorFileTarget,
#endif
  };
  return all;
}

const FuzzTarget* fuzz_target(std::string_view name) {
  const std::span<const FuzzTarget> all = fuzz_targets();
  const auto found = std::ranges::find(all, name, &FuzzTarget::name);
  return found == all.end() ? nullptr : &*found;
}

}  // namespace camway::testing
