// SPDX-License-Identifier: MIT
// What the answer says about the scene: witnesses of collisions with their triangles, and the closed surface or cage
// that proves that there is no path.

import { BufferAttribute, BufferGeometry, Group, GreaterDepth, Mesh, Vector3 } from 'three';
import type { IUniform } from 'three';
import type { Answer } from '../contract/answer.js';
import type { Triangle } from '../door/places.js';
import { kPalette } from '../model/palette.js';
import { makeGlassMaterial } from './cursor_view.js';
import { toQuaternion } from './frame.js';
import type { Frame } from './frame.js';
import { Markers } from './markers.js';
import type { Marker } from './markers.js';
import { rgbOf, TubeBuilder, Tubes } from './tubes.js';

export type TriangleSource = (indices: readonly number[]) => Promise<Record<string, Triangle>>;

/** The surface of a proof can have all triangles of a scene; more than that are not asked for. */
const kMostTriangles = 50_000;
const kMostWitnesses = 500;

const kCollision = rgbOf(kPalette.collision);
const kProof = rgbOf(kPalette.infeasible);

class Lit extends Group {
  private readonly parts: Mesh<BufferGeometry>[];

  constructor(colour: typeof kCollision, opacity: number) {
    super();
    this.parts = [opacity, 0.4 * opacity].map((share, i) => {
      const material = makeGlassMaterial(colour, share);
      material.polygonOffset = true;
      material.polygonOffsetFactor = -1;
      material.polygonOffsetUnits = -2;
      if (i === 1) material.depthFunc = GreaterDepth;
      const mesh = new Mesh(new BufferGeometry(), material);
      mesh.renderOrder = 12 - i;
      mesh.frustumCulled = false;
      this.add(mesh);
      return mesh;
    });
  }

  show(triangles: readonly Triangle[], frame: Frame): void {
    const geometry = new BufferGeometry();
    const numbers = triangles.flatMap((corners) => corners.flatMap((corner) => frame.toLocal(corner).toArray()));
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(numbers), 3));
    this.parts[0]?.geometry.dispose();
    for (const part of this.parts) part.geometry = geometry;
    this.visible = triangles.length > 0;
  }
}

export class FindingsView {
  readonly group = new Group();
  private readonly markers = new Markers(70);
  private readonly witnesses = new Lit(kCollision, 0.85);
  private readonly proof = new Lit(kProof, 0.45);
  private readonly lines: Tubes;
  private asked = 0;

  constructor(viewHeight: IUniform<number>, private readonly onChange: () => void) {
    this.lines = new Tubes(viewHeight, 15);
    this.group.add(this.witnesses, this.proof, this.lines, this.markers);
  }

  setLook(rim: [number, number, number], pixelRatio: number): void {
    this.markers.setLook(rim, pixelRatio);
  }

  /** `source` is asked for the triangles; drafts do without. */
  async show(answer: Answer | undefined, frame: Frame, source: TriangleSource | undefined): Promise<void> {
    const asked = ++this.asked;
    const collisions = [...(answer?.remaining_collisions ?? []), ...(answer?.collisions ?? [])].slice(0, kMostWitnesses);
    this.markers.show(
      collisions.map(({ witness }): Marker => ({
        position: frame.toLocal(witness.point),
        colour: kCollision,
        shape: 'cross',
        size_px: 13,
      })),
    );
    const lines = new TubeBuilder();
    if (answer?.infeasibility?.cage) addCage(lines, answer.infeasibility.cage, frame);
    this.lines.show(lines);
    const touched = [...new Set(collisions.map(({ witness }) => witness.triangle))].filter((index) => index >= 0);
    const closed = (answer?.infeasibility?.triangles ?? proofTriangles(answer)).slice(0, kMostTriangles);
    this.witnesses.visible = false;
    this.proof.visible = false;
    if (!source || touched.length + closed.length === 0) return;
    try {
      const triangles = await source([...new Set([...touched, ...closed])]);
      if (asked !== this.asked) return;
      const found = (indices: readonly number[]): Triangle[] =>
        indices.map((index) => triangles[index]).filter((triangle) => triangle !== undefined);
      this.witnesses.show(found(touched), frame);
      this.proof.show(found(closed), frame);
      this.onChange();
    } catch {
      // The marks of the witnesses are there, and the next answer asks again.
    }
  }
}

/** The triangles of a cage stand in it, those of a closed surface beside it. */
function proofTriangles(answer: Answer | undefined): number[] {
  const cage = answer?.infeasibility?.cage as { triangles?: number[] } | undefined;
  return cage?.triangles ?? [];
}

interface Cage {
  min?: number[];
  max?: number[];
  orientation?: number[];
}

function addCage(lines: TubeBuilder, { min, max, orientation }: Cage, frame: Frame): void {
  if (!min || !max) return;
  const turn = toQuaternion(orientation ?? [1, 0, 0, 0]);
  const corner = (bits: number): Vector3 => {
    const at = [0, 1, 2].map((axis) => ((bits >> axis) & 1 ? max : min)[axis] ?? 0);
    return frame.toLocal(new Vector3(...(at as [number, number, number])).applyQuaternion(turn).toArray());
  };
  for (let bits = 0; bits < 8; ++bits) {
    for (let axis = 0; axis < 3; ++axis) {
      if ((bits >> axis) & 1) continue;
      lines.segment(corner(bits), corner(bits | (1 << axis)), kProof, { radius_m: 0, least_px: 2.5 });
    }
  }
}
