// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "tools/cameras/formats/camera_format.h"

namespace camway::tools {

/// Comparison of the lens of a written file with the fields of view that were proved.
struct WrittenLens {
  std::string fault;   ///< why it may not be used: it shows more than was proved; empty if not so
  std::string remark;  ///< what it leaves open or shows less of; empty if it says all
};

/// Compares the lens of a file that was written with `options`, and was read back, with that of the
/// options. Says nothing where these have no lens.
WrittenLens written_lens(const CameraTrack& read, const CameraFormat& format,
                         const CameraWriteOptions& options);

}  // namespace camway::tools
