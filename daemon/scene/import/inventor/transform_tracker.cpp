// SPDX-License-Identifier: MIT
#include "daemon/scene/import/inventor/transform_tracker.h"

#include <Inventor/SbMatrix.h>
#include <Inventor/VRMLnodes/SoVRMLTransform.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/misc/SoState.h>
#include <Inventor/nodes/SoArray.h>
#include <Inventor/nodes/SoMatrixTransform.h>
#include <Inventor/nodes/SoMultipleCopy.h>
#include <Inventor/nodes/SoResetTransform.h>
#include <Inventor/nodes/SoRotation.h>
#include <Inventor/nodes/SoRotationXYZ.h>
#include <Inventor/nodes/SoScale.h>
#include <Inventor/nodes/SoTransform.h>
#include <Inventor/nodes/SoTransformSeparator.h>
#include <Inventor/nodes/SoTranslation.h>

#include <algorithm>
#include <cmath>

#include "daemon/scene/import/inventor/placement.h"

namespace camway::scene::inventor {
namespace {

using import_process::Magnitudes;
using import_process::TransformChain;

/// Products of matrices in a step whose result alone is known.
constexpr double kUnknownProducts = 4.0;

Magnitudes of_move(const SbVec3f& move) {
  SbMatrix matrix;
  matrix.setTranslate(move);
  return magnitudes_of(matrix);
}

Magnitudes of_rotation(const SbRotation& rotation) {
  SbMatrix matrix;
  matrix.setRotate(rotation);
  return magnitudes_of(matrix);
}

Magnitudes of_scale(const SbVec3f& scale) {
  SbMatrix matrix;
  matrix.setScale(scale);
  return magnitudes_of(matrix);
}

/// A transform of seven factors. Their product alone would hide that a far centre cancels.
TransformChain with_factors(const TransformChain& chain, const SbVec3f& translation,
                            const SbRotation& rotation, const SbVec3f& scale,
                            const SbRotation& orientation, const SbVec3f& center) {
  return chain.then(of_move(translation))
      .then(of_move(center))
      .then(of_rotation(rotation))
      .then(of_rotation(orientation))
      .then(of_scale(scale))
      .then(of_rotation(orientation.inverse()))
      .then(of_move(center));
}

/// The matrix of a node that is one matrix. Returns false for others.
bool take_plain(const SoNode& node, Magnitudes& result) {
  if (node.isOfType(SoTranslation::getClassTypeId())) {
    result = of_move(static_cast<const SoTranslation&>(node).translation.getValue());
  } else if (node.isOfType(SoRotation::getClassTypeId())) {
    result = of_rotation(static_cast<const SoRotation&>(node).rotation.getValue());
  } else if (node.isOfType(SoRotationXYZ::getClassTypeId())) {
    result = of_rotation(static_cast<const SoRotationXYZ&>(node).getRotation());
  } else if (node.isOfType(SoScale::getClassTypeId())) {
    result = of_scale(static_cast<const SoScale&>(node).scaleFactor.getValue());
  } else if (node.isOfType(SoMatrixTransform::getClassTypeId())) {
    result = magnitudes_of(static_cast<const SoMatrixTransform&>(node).matrix.getValue());
  } else {
    return false;
  }
  return true;
}

/// The farthest copy of an array.
Magnitudes of_array(const SoArray& array) {
  SbVec3f farthest(0.0F, 0.0F, 0.0F);
  const auto add = [&](const SbVec3f& step, short count) {
    for (int k = 0; k < 3; ++k) farthest[k] += std::abs(step[k]) * static_cast<float>(count);
  };
  add(array.separation1.getValue(), array.numElements1.getValue());
  add(array.separation2.getValue(), array.numElements2.getValue());
  add(array.separation3.getValue(), array.numElements3.getValue());
  return of_move(farthest);
}

Magnitudes of_copies(const SoMultipleCopy& copies) {
  Magnitudes largest{};
  for (int i = 0; i < copies.matrix.getNum(); ++i) {
    const Magnitudes each = magnitudes_of(copies.matrix[i]);
    for (std::size_t row = 0; row < 4; ++row) {
      for (std::size_t column = 0; column < 4; ++column) {
        largest[row][column] = std::max(largest[row][column], each[row][column]);
      }
    }
  }
  return largest;
}

}  // namespace

const TransformChain& TransformTracker::chain() const {
  return entries_.empty() ? identity_ : entries_.back().chain;
}

void TransformTracker::set(int depth, const TransformChain& chain) {
  if (entries_.empty() || entries_.back().depth < depth) {
    entries_.push_back({depth, chain});
  } else {
    entries_.back() = {depth, chain};
  }
}

void TransformTracker::enter(SoCallbackAction& action, const SoNode& node) {
  const int depth = action.getState()->getDepth();
  while (!entries_.empty() && entries_.back().depth > depth) entries_.pop_back();
  // These transform what is inside them, one level deeper.
  if (node.isOfType(SoVRMLTransform::getClassTypeId())) {
    const auto& t = static_cast<const SoVRMLTransform&>(node);
    set(depth + 1,
        with_factors(chain(), t.translation.getValue(), t.rotation.getValue(), t.scale.getValue(),
                     t.scaleOrientation.getValue(), t.center.getValue()));
  } else if (node.isOfType(SoArray::getClassTypeId())) {
    set(depth + 1, chain().then(of_array(static_cast<const SoArray&>(node))));
  } else if (node.isOfType(SoMultipleCopy::getClassTypeId())) {
    set(depth + 1, chain().then(of_copies(static_cast<const SoMultipleCopy&>(node))));
  } else if (node.isOfType(SoTransformSeparator::getClassTypeId())) {
    saved_.push_back(chain());
  }
}

void TransformTracker::leave(SoCallbackAction& action, const SoNode& node) {
  const int depth = action.getState()->getDepth();
  if (node.isOfType(SoTransformSeparator::getClassTypeId())) {
    if (saved_.empty()) return;
    while (!entries_.empty() && entries_.back().depth > depth) entries_.pop_back();
    set(depth, saved_.back());
    saved_.pop_back();
    return;
  }
  if (!node.isOfType(SoTransformation::getClassTypeId())) return;
  if (node.isOfType(SoTransform::getClassTypeId())) {
    const auto& t = static_cast<const SoTransform&>(node);
    set(depth,
        with_factors(chain(), t.translation.getValue(), t.rotation.getValue(),
                     t.scaleFactor.getValue(), t.scaleOrientation.getValue(), t.center.getValue()));
  } else if (Magnitudes plain; take_plain(node, plain)) {
    set(depth, chain().then(plain));
  } else {
    set(depth, chain().at_least(magnitudes_of(action.getModelMatrix()), kUnknownProducts));
  }
}

}  // namespace camway::scene::inventor
