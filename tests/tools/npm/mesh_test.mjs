// SPDX-License-Identifier: MIT
// Meshes that `camway view` sends to pages, as the decoder of meshoptimizer and the validator of the Khronos
// Group find them: what they show is the scene, within the error that they state.
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import test, {after} from 'node:test';

import {load, scenes} from './camway.mjs';

const validator = load('gltf-validator');
const {MeshoptDecoder} = load('meshoptimizer');
await MeshoptDecoder.ready;

const kExtension = 'EXT_meshopt_compression';
const scene = path.join(scenes, 'office.obj');

const door = spawn(process.env.CAMWAY, ['view', '--scene', scene], {stdio: ['ignore', 'pipe', 'inherit']});
after(() => door.kill());
const url = new URL(await new Promise(line => door.stdout.once('data', bytes => line(`${bytes}`.trim()))));
const headers = {authorization: `Bearer ${url.searchParams.get('token')}`};

const {objects} = await (await fetch(`${url.origin}/v1/scenes/office`, {headers})).json();
const response = await fetch(`${url.origin}/v1/scenes/office/meshes/${objects[0].digest}`, {headers});
const file = Buffer.from(await response.arrayBuffer());

/// The document and the buffer of a .glb.
function parse(bytes) {
  assert.equal(bytes.subarray(0, 4).toString(), 'glTF');
  const length = bytes.readUInt32LE(12);
  return {root: JSON.parse(bytes.subarray(20, 20 + length)), buffer: bytes.subarray(28 + length)};
}

/// The contents of the buffer views, decompressed.
function views({root, buffer}) {
  return root.bufferViews.map(view => {
    const {byteOffset, byteLength, byteStride, count, mode} = view.extensions[kExtension];
    const content = new Uint8Array(count * byteStride);
    MeshoptDecoder.decodeGltfBuffer(content, count, byteStride,
                                    buffer.subarray(byteOffset, byteOffset + byteLength), mode);
    return content;
  });
}

/// The same file without compression, for the validator, which does not know it.
function plain(glb) {
  const root = structuredClone(glb.root);
  const contents = views(glb);
  const bytes = Buffer.alloc(root.buffers[1].byteLength);
  root.bufferViews.forEach((view, i) => {
    bytes.set(contents[i], view.byteOffset);
    delete view.extensions;
    view.buffer = 0;
  });
  const uri = `data:application/octet-stream;base64,${bytes.toString('base64')}`;
  root.buffers = [{byteLength: bytes.length, uri}];
  for (const list of ['extensionsUsed', 'extensionsRequired']) {
    root[list] = root[list].filter(name => name !== kExtension);
  }
  return JSON.stringify(root);
}

/// The triangles of a file, in metres.
function triangles_of(glb) {
  const [positions, indices] = views(glb);
  const {translation, scale} = glb.root.nodes[0];
  const steps = new Int16Array(positions.buffer);
  const point = i => [0, 1, 2].map(axis => translation[axis] + scale[axis] * steps[4 * i + axis] / 32767);
  const list = new Uint16Array(indices.buffer);
  return Array.from({length: list.length / 3}, (_, i) => [0, 1, 2].map(corner => point(list[3 * i + corner])));
}

/// The triangles of a scene that the generator made.
function triangles_in(obj) {
  const vertices = [];
  const triangles = [];
  for (const line of obj.split('\n')) {
    const [kind, ...words] = line.trim().split(/\s+/);
    if (kind === 'v') vertices.push(words.map(Number));
    if (kind === 'f') triangles.push(words.map(word => vertices[parseInt(word, 10) - 1]));
  }
  return triangles;
}

const middle = corners => [0, 1, 2].map(axis => (corners[0][axis] + corners[1][axis] + corners[2][axis]) / 3);
const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);

/// The distance of the corners of two triangles with the same sense.
const apart = (a, b) => Math.min(...[0, 1, 2].map(
    first => Math.max(...[0, 1, 2].map(i => distance(a[i], b[(i + first) % 3])))));

test('the mesh is that of the scene', () => {
  const glb = parse(file);
  const {triangles, shown, error_m} = glb.root.asset.extras;
  const expected = triangles_in(fs.readFileSync(scene, 'utf8'));
  const found = triangles_of(glb);
  assert.deepEqual([triangles, shown, found.length], Array(3).fill(expected.length));
  // Buckets of a centimetre, of which each triangle is found in its own or in a neighbour.
  const kBucket_m = 0.01;
  const buckets = new Map();
  const cell = corners => middle(corners).map(x => Math.floor(x / kBucket_m));
  for (const corners of expected) {
    const key = cell(corners).join();
    buckets.set(key, [...(buckets.get(key) ?? []), corners]);
  }
  let largest_m = 0;
  for (const corners of found) {
    const [x, y, z] = cell(corners);
    let least_m = Infinity;
    let best;
    for (const dx of [-1, 0, 1]) for (const dy of [-1, 0, 1]) for (const dz of [-1, 0, 1]) {
      for (const each of buckets.get([x + dx, y + dy, z + dz].join()) ?? []) {
        const d = apart(corners, each);
        if (d < least_m) [least_m, best] = [d, each];
      }
    }
    assert.ok(least_m <= error_m, `${least_m} m for ${corners}`);
    largest_m = Math.max(largest_m, least_m);
    const key = cell(best).join();
    buckets.set(key, buckets.get(key).filter(each => each !== best));
  }
  assert.ok(largest_m > error_m / 3, 'the error is not stated too large either');
});

test('the validator has nothing to say', async () => {
  const report = await validator.validateString(plain(parse(file)), {maxIssues: 0});
  assert.deepEqual(report.issues.messages, []);
  assert.equal(report.info.totalTriangleCount, parse(file).root.asset.extras.shown);
});

test('a fault is found', async () => {
  const glb = parse(file);
  glb.root.accessors[0].max[0] -= 1;
  const report = await validator.validateString(plain(glb), {maxIssues: 0});
  assert.ok(report.issues.numErrors > 0);
});

test('it is small', () => assert.ok(file.length <= 100_000, `${file.length} bytes`));
