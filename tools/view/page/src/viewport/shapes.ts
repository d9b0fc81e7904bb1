// SPDX-License-Identifier: MIT
// A mesh of the door with what is made of it once, shared by all objects of its digest.

import { BufferAttribute, BufferGeometry, Vector3 } from 'three';
import { MeshBVH } from 'three-mesh-bvh';
import { sharpEdges } from './edges.js';
import { readGlb } from './glb.js';

/** Larger meshes are shown without their edges, whose search would take a second and whose lines fill the picture. */
const kMostTrianglesWithEdges = 600_000;

export interface Shape {
  readonly geometry: BufferGeometry;
  readonly center: Vector3;
  /** Triangles shown, and those of the object. */
  readonly shown: number;
  readonly triangles: number;
  readonly error_m: number;
  /** Whether it encloses a volume with its faces outwards, as far as that can be told cheaply. */
  readonly isSolid: boolean;
  edges: BufferGeometry | undefined;
  hasEdges: boolean;
}

function enclosedVolume(positions: Float32Array, indices: Uint32Array): number {
  let volume = 0;
  for (let i = 0; i < indices.length; i += 3) {
    const a = 3 * (indices[i] ?? 0);
    const b = 3 * (indices[i + 1] ?? 0);
    const c = 3 * (indices[i + 2] ?? 0);
    const [ax, ay, az] = [positions[a] ?? 0, positions[a + 1] ?? 0, positions[a + 2] ?? 0];
    const [bx, by, bz] = [positions[b] ?? 0, positions[b + 1] ?? 0, positions[b + 2] ?? 0];
    const [cx, cy, cz] = [positions[c] ?? 0, positions[c + 1] ?? 0, positions[c + 2] ?? 0];
    volume += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
  }
  return volume / 6;
}

export async function readShape(file: ArrayBuffer): Promise<Shape> {
  const mesh = await readGlb(file);
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(mesh.positions, 3));
  geometry.setIndex(new BufferAttribute(mesh.indices, 1));
  geometry.computeBoundingSphere();
  geometry.computeBoundingBox();
  return {
    geometry,
    center: new Vector3(...mesh.center),
    shown: mesh.indices.length / 3,
    triangles: mesh.triangles,
    error_m: mesh.error_m,
    isSolid: enclosedVolume(mesh.positions, mesh.indices) > 0,
    edges: undefined,
    hasEdges: mesh.indices.length / 3 <= kMostTrianglesWithEdges,
  };
}

/** Makes the edges, if there are none yet: some 100 ns per triangle. */
export function makeEdges(shape: Shape): BufferGeometry | undefined {
  if (shape.edges || !shape.hasEdges) return shape.edges;
  const positions = shape.geometry.getAttribute('position').array as Float32Array;
  const indices = shape.geometry.getIndex()?.array as Uint32Array;
  shape.edges = new BufferGeometry();
  const ends = sharpEdges(positions, indices);
  const spans = new Float32Array(ends.length / 3);
  for (let i = 0; i < spans.length; i += 2) {
    const at = (k: number): number => (ends[3 * i + k] ?? 0) - (ends[3 * i + 3 + k] ?? 0);
    spans.fill(Math.hypot(at(0), at(1), at(2)), i, i + 2);
  }
  shape.edges.setAttribute('position', new BufferAttribute(ends, 3));
  shape.edges.setAttribute('span', new BufferAttribute(spans, 1));
  return shape.edges;
}

/** Makes the tree for rays, if there is none yet: some microseconds per triangle, so at the first need. */
export function makeTree(shape: Shape): void {
  if (!shape.geometry.boundsTree) shape.geometry.boundsTree = new MeshBVH(shape.geometry);
}

export function disposeShape(shape: Shape): void {
  shape.geometry.dispose();
  shape.edges?.dispose();
}
