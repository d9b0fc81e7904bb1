// SPDX-License-Identifier: MIT
// The edges that make a shape readable: those where the surface bends or ends.

const kSharpestFlatCosine = Math.cos((25 * Math.PI) / 180);

/**
 * Ids for vertices by place: vertices of a flat-shaded mesh are often repeated for each face. Returns the smallest
 * index of the vertices at the same place.
 */
function weld(positions: Float32Array): Uint32Array {
  const count = positions.length / 3;
  const size = 2 ** Math.ceil(Math.log2(Math.max(2 * count, 2)));
  const table = new Int32Array(size).fill(-1);
  const bits = new Uint32Array(positions.buffer, positions.byteOffset, positions.length);
  const ids = new Uint32Array(count);
  for (let i = 0; i < count; ++i) {
    const x = bits[3 * i] ?? 0;
    const y = bits[3 * i + 1] ?? 0;
    const z = bits[3 * i + 2] ?? 0;
    let slot = (Math.imul(x, 73856093) ^ Math.imul(y, 19349663) ^ Math.imul(z, 83492791)) >>> 0;
    slot = (slot ^ (slot >>> 15)) & (size - 1);
    for (;;) {
      const other = table[slot] ?? -1;
      if (other < 0) {
        table[slot] = i;
        ids[i] = i;
        break;
      }
      if (bits[3 * other] === x && bits[3 * other + 1] === y && bits[3 * other + 2] === z) {
        ids[i] = other;
        break;
      }
      slot = (slot + 1) & (size - 1);
    }
  }
  return ids;
}

function faceNormals(positions: Float32Array, indices: Uint32Array): Float32Array {
  const normals = new Float32Array(indices.length);
  const at = (corner: number, axis: number): number => positions[3 * (indices[corner] ?? 0) + axis] ?? 0;
  for (let f = 0; f < indices.length; f += 3) {
    const ux = at(f + 1, 0) - at(f, 0);
    const uy = at(f + 1, 1) - at(f, 1);
    const uz = at(f + 1, 2) - at(f, 2);
    const vx = at(f + 2, 0) - at(f, 0);
    const vy = at(f + 2, 1) - at(f, 1);
    const vz = at(f + 2, 2) - at(f, 2);
    const nx = uy * vz - uz * vy;
    const ny = uz * vx - ux * vz;
    const nz = ux * vy - uy * vx;
    const length = Math.hypot(nx, ny, nz) || 1;
    normals[f] = nx / length;
    normals[f + 1] = ny / length;
    normals[f + 2] = nz / length;
  }
  return normals;
}

/** End points of the sharp and open edges, 6 numbers each. */
export function sharpEdges(positions: Float32Array, indices: Uint32Array): Float32Array {
  const ids = weld(positions);
  const normals = faceNormals(positions, indices);
  const vertexCount = ids.length;
  // The first face of each edge, in a table with open addressing; -2 once a second face was seen.
  const size = 2 ** Math.ceil(Math.log2(Math.max(2 * indices.length, 2)));
  const keys = new Float64Array(size).fill(-1);
  const faces = new Int32Array(size);
  const ends: number[] = [];
  const slots = new Int32Array(indices.length);
  let slotCount = 0;
  for (let corner = 0; corner < indices.length; ++corner) {
    const face = corner - (corner % 3);
    const a = ids[indices[corner] ?? 0] ?? 0;
    const b = ids[indices[face + ((corner - face + 1) % 3)] ?? 0] ?? 0;
    if (a === b) continue;
    const low = Math.min(a, b);
    const high = Math.max(a, b);
    const key = low * vertexCount + high;
    let slot = (Math.imul(low, 73856093) ^ Math.imul(high, 19349663)) >>> 0;
    slot = (slot ^ (slot >>> 15)) & (size - 1);
    while (keys[slot] !== -1 && keys[slot] !== key) slot = (slot + 1) & (size - 1);
    if (keys[slot] === -1) {
      keys[slot] = key;
      faces[slot] = face;
      slots[slotCount++] = slot;
      continue;
    }
    const other = faces[slot] ?? 0;
    if (other < 0) continue;
    const cosine =
      (normals[face] ?? 0) * (normals[other] ?? 0) +
      (normals[face + 1] ?? 0) * (normals[other + 1] ?? 0) +
      (normals[face + 2] ?? 0) * (normals[other + 2] ?? 0);
    faces[slot] = -2;
    if (cosine < kSharpestFlatCosine) ends.push(low, high);
  }
  for (let i = 0; i < slotCount; ++i) {
    const slot = slots[i] ?? 0;
    if ((faces[slot] ?? 0) < 0) continue; // it has two faces
    const key = keys[slot] ?? 0;
    ends.push(Math.floor(key / vertexCount), key % vertexCount);
  }
  const lines = new Float32Array(3 * ends.length);
  ends.forEach((vertex, i) => lines.set(positions.subarray(3 * vertex, 3 * vertex + 3), 3 * i));
  return lines;
}
