// SPDX-License-Identifier: MIT
#pragma once

// To be written with the octree: the list of moving-body triangles beside it.
