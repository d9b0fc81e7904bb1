// SPDX-License-Identifier: MIT
// Reads the meshes of the door: GLB with one primitive of triangles, POSITION and indices, with or without
// EXT_meshopt_compression and KHR_mesh_quantization. Other files of that format are none of the page's business.

import { MeshoptDecoder } from 'meshoptimizer/decoder';

/** A mesh in its object's frame, less `center`: small numbers, so that 32 bits are enough far from the origin. */
export interface DisplayMesh {
  readonly positions: Float32Array;
  readonly indices: Uint32Array;
  readonly center: readonly [number, number, number];
  /** Triangles of the object; more than are shown if the mesh is simplified, which errs by `error_m`. */
  readonly triangles: number;
  readonly error_m: number;
}

interface View {
  buffer: number;
  byteOffset?: number;
  byteLength: number;
  byteStride?: number;
  extensions?: { EXT_meshopt_compression?: Compressed };
}

interface Compressed {
  byteOffset?: number;
  byteLength: number;
  byteStride: number;
  count: number;
  mode: string;
  filter?: string;
}

interface Accessor {
  bufferView: number;
  byteOffset?: number;
  componentType: number;
  normalized?: boolean;
  count: number;
}

interface Gltf {
  asset: { extras?: { triangles?: number; shown?: number; error_m?: number } };
  nodes: { mesh?: number; translation?: [number, number, number]; scale?: [number, number, number] }[];
  meshes: { primitives: { attributes: { POSITION: number }; indices: number }[] }[];
  accessors: Accessor[];
  bufferViews: View[];
}

type Numbers = Int8Array | Uint8Array | Int16Array | Uint16Array | Uint32Array | Float32Array;
type NumbersOf = new (buffer: ArrayBuffer, offset: number, length: number) => Numbers;

const kMagic = 0x46546c67;
const kHeaderBytes = 12;
const kChunkHeaderBytes = 8;

const kComponents: Record<number, { make: NumbersOf; bytes: number; largest: number }> = {
  5120: { make: Int8Array, bytes: 1, largest: 127 },
  5121: { make: Uint8Array, bytes: 1, largest: 255 },
  5122: { make: Int16Array, bytes: 2, largest: 32767 },
  5123: { make: Uint16Array, bytes: 2, largest: 65535 },
  5125: { make: Uint32Array, bytes: 4, largest: 0 },
  5126: { make: Float32Array, bytes: 4, largest: 0 },
};

function bad(what: string): never {
  throw new Error(`a mesh of the scene cannot be shown: ${what}`);
}

function readChunks(file: ArrayBuffer): { json: Gltf; body: Uint8Array } {
  const view = new DataView(file);
  if (file.byteLength < kHeaderBytes + kChunkHeaderBytes || view.getUint32(0, true) !== kMagic) bad('it is no GLB');
  const jsonBytes = view.getUint32(kHeaderBytes, true);
  const jsonBegin = kHeaderBytes + kChunkHeaderBytes;
  const text = new TextDecoder().decode(new Uint8Array(file, jsonBegin, jsonBytes));
  const bodyBegin = jsonBegin + jsonBytes + kChunkHeaderBytes;
  return {
    json: JSON.parse(text) as Gltf,
    body: bodyBegin <= file.byteLength ? new Uint8Array(file, bodyBegin) : new Uint8Array(0),
  };
}

/** The bytes of a view, decoded, and the bytes from one element to the next if the view says so. */
function viewBytes(view: View, body: Uint8Array): { bytes: Uint8Array; stride: number | undefined } {
  const packed = view.extensions?.EXT_meshopt_compression;
  if (!packed) {
    const begin = view.byteOffset ?? 0;
    return { bytes: body.slice(begin, begin + view.byteLength), stride: view.byteStride };
  }
  const begin = packed.byteOffset ?? 0;
  const source = body.subarray(begin, begin + packed.byteLength);
  const bytes = new Uint8Array(packed.count * packed.byteStride);
  MeshoptDecoder.decodeGltfBuffer(bytes, packed.count, packed.byteStride, source, packed.mode, packed.filter);
  return { bytes, stride: packed.byteStride };
}

function readAccessor(gltf: Gltf, index: number, width: number, body: Uint8Array) {
  const accessor = gltf.accessors[index] ?? bad('an accessor is missing');
  const view = gltf.bufferViews[accessor.bufferView] ?? bad('a view is missing');
  const component = kComponents[accessor.componentType] ?? bad('its numbers are of an unknown kind');
  const { bytes, stride } = viewBytes(view, body);
  const step = (stride ?? width * component.bytes) / component.bytes;
  const begin = accessor.byteOffset ?? 0;
  const length = accessor.count === 0 ? 0 : (accessor.count - 1) * step + width;
  const buffer = bytes.buffer as ArrayBuffer;
  if (begin + length * component.bytes > buffer.byteLength) bad('it is cut short');
  const unit = accessor.normalized && component.largest > 0 ? 1 / component.largest : 1;
  return { numbers: new component.make(buffer, begin, length), step, count: accessor.count, unit };
}

function readPositions(gltf: Gltf, index: number, body: Uint8Array, scale: readonly number[]): Float32Array {
  const { numbers, step, count, unit } = readAccessor(gltf, index, 3, body);
  const positions = new Float32Array(3 * count);
  for (let axis = 0; axis < 3; ++axis) {
    const factor = unit * (scale[axis] ?? 1);
    for (let i = 0; i < count; ++i) positions[3 * i + axis] = (numbers[i * step + axis] ?? 0) * factor;
  }
  return positions;
}

/** Reads a mesh. Throws Error with a sentence for people. */
export async function readGlb(file: ArrayBuffer): Promise<DisplayMesh> {
  await MeshoptDecoder.ready;
  const { json, body } = readChunks(file);
  const node = json.nodes.find((candidate) => candidate.mesh !== undefined) ?? bad('it has no mesh');
  const primitive = json.meshes[node.mesh ?? 0]?.primitives[0] ?? bad('it has no triangles');
  const positions = readPositions(json, primitive.attributes.POSITION, body, node.scale ?? [1, 1, 1]);
  const { numbers, count } = readAccessor(json, primitive.indices, 1, body);
  const indices = numbers instanceof Uint32Array ? numbers : Uint32Array.from(numbers);
  const extras = json.asset.extras;
  return {
    positions,
    indices,
    center: node.translation ?? [0, 0, 0],
    triangles: extras?.triangles ?? count / 3,
    error_m: extras?.error_m ?? 0,
  };
}
