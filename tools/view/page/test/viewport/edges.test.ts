// SPDX-License-Identifier: MIT
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { sharpEdges } from '../../src/viewport/edges.js';

/** A unit cube of 12 triangles whose corners are shared, or repeated for each triangle. */
function cube(isShared: boolean): [Float32Array, Uint32Array] {
  const corners = Array.from({ length: 8 }, (_, i) => [i & 1, (i >> 1) & 1, i >> 2]);
  const faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] as const;
  const indices = faces.flatMap(([a, b, c, d]) => [a, b, c, a, c, d]);
  if (isShared) return [new Float32Array(corners.flat()), new Uint32Array(indices)];
  return [new Float32Array(indices.flatMap((i) => corners[i] ?? [])), new Uint32Array(indices.map((_, i) => i))];
}

function lengths(ends: Float32Array): number[] {
  return Array.from({ length: ends.length / 6 }, (_, i) => {
    const at = (k: number): number => ends[6 * i + k] ?? 0;
    return Math.hypot(at(0) - at(3), at(1) - at(4), at(2) - at(5));
  });
}

for (const isShared of [true, false]) {
  test(`a cube has its 12 edges and no diagonals, with corners ${isShared ? 'shared' : 'repeated'}`, () => {
    assert.deepEqual(lengths(sharpEdges(...cube(isShared))), new Array(12).fill(1));
  });
}

test('an open border is an edge, and so is none within a plane', () => {
  const square = new Float32Array([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]);
  assert.deepEqual(lengths(sharpEdges(square, new Uint32Array([0, 1, 2, 0, 2, 3]))), [1, 1, 1, 1]);
});

test('triangles without area, and no triangles, do no harm', () => {
  assert.equal(sharpEdges(new Float32Array(9), new Uint32Array([0, 1, 2])).length, 0);
  assert.equal(sharpEdges(new Float32Array(), new Uint32Array()).length, 0);
});
