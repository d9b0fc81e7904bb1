// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "daemon/base/result.h"
#include "daemon/scene/import/record/record_layout.h"

namespace camway::scene::point_readers {

/// Reads a cloud of the Point Cloud Library (PCD 0.5 to 0.7): text, binary, and binary compressed
/// by LZF, with fields in any order. Only x, y and z are looked at. Values are taken as they are;
/// the viewpoint is not applied. A file whose points are not as many as its header says is refused,
/// with its line or byte.
base::Result<import_record::Record> read_pcd(std::string_view bytes);

}  // namespace camway::scene::point_readers
