// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/base/result.h"
#include "daemon/scene/import/record/import_report.h"
#include "daemon/scene/log/byte_stream.h"
#include "daemon/scene/mesh/mesh.h"

/// The parts of a record that are no occupancy map. All numbers come back bit for bit.
namespace camway::scene {

void put_mesh(ByteWriter& writer, const Mesh& mesh);
/// Fails if the bytes are no mesh, or one whose objects do not cover its triangles. Triangles are
/// those of an import, or if `may_lack_area` those of any shape (`mesh_check.h`).
base::Result<Mesh> get_mesh(ByteReader& reader, bool may_lack_area);

/// Whether the bytes of the report end with the error of smooth surfaces, which is left out if it
/// is 0.
bool has_surface_error(const ImportReport& report);
void put_report(ByteWriter& writer, const ImportReport& report);
/// Returns nothing, and makes the reader fail, if no import could have made the report.
std::optional<ImportReport> get_report(ByteReader& reader, bool with_surface_error);

}  // namespace camway::scene
