// SPDX-License-Identifier: MIT
// The answer's findings in the scene: witnesses of collisions with their triangles, and the closed surface or cage
// that proves that there is no path.

import {
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  Group,
  GreaterDepth,
  Matrix4,
  Mesh,
  ShaderMaterial,
  Vector3,
} from 'three';
import type { IUniform, Vector4 } from 'three';
import type { Answer } from '../contract/answer.js';
import type { Vec3 } from '../contract/request.js';
import type { Triangle } from '../door/places.js';
import { kPalette } from '../model/palette.js';
import { toQuaternion } from './frame.js';
import type { Frame } from './frame.js';
import { Markers } from './markers.js';
import type { Marker } from './markers.js';
import { rgbOf, TubeBuilder, Tubes } from './tubes.js';
import type { TubeUniforms } from './tubes.js';

export type TriangleSource = (indices: readonly number[]) => Promise<Record<string, Triangle>>;

/** The surface of a proof can have all triangles of a scene; more than that are not asked for. */
const kMostTriangles = 50_000;
const kMostWitnesses = 500;

const kCollision = rgbOf(kPalette.collision);
const kProof = rgbOf(kPalette.infeasible);

const kVertexShader = /* glsl */ `
attribute vec3 focus;
varying vec3 vPlace;
varying vec3 vFocus;
void main() {
  vPlace = (modelMatrix * vec4(position, 1.0)).xyz;
  vFocus = focus;
  gl_Position = projectionMatrix * viewMatrix * vec4(vPlace, 1.0);
}`;

const kFragmentShader = /* glsl */ `
uniform vec4 uSection;
uniform vec3 uColour;
uniform float uOpacity;
uniform float uFades;
uniform float uHasBox;
uniform mat4 uToBox;
uniform vec3 uBoxHalf;
varying vec3 vPlace;
varying vec3 vFocus;
void main() {
  if (dot(uSection.xyz, vPlace) > uSection.w) discard;
  if (uHasBox > 0.5 && any(greaterThan(abs((uToBox * vec4(vPlace, 1.0)).xyz), uBoxHalf))) discard;
  // A wall of two triangles is lit around the witness, and only tinged elsewhere.
  float far = uFades * smoothstep(0.1, 0.8, distance(vPlace, vFocus));
  gl_FragColor = vec4(uColour, uOpacity * mix(1.0, 0.22, far));
}`;

/** The faces of a cage are drawn within that distance of its box: its triangles may be whole floors. */
const kCageMargin_m = 0.02;

interface Lit3 {
  corners: Triangle;
  focus: Vec3;
}

class Lit extends Group {
  private readonly parts: Mesh<BufferGeometry, ShaderMaterial>[];
  private readonly hasBox = { value: 0 };
  private readonly toBox = { value: new Matrix4() };
  private readonly boxHalf = { value: new Vector3() };

  constructor(colour: typeof kCollision, opacity: number, fades: boolean, section: IUniform<Vector4>) {
    super();
    this.parts = [opacity, 0.35 * opacity].map((share, i) => {
      const material = new ShaderMaterial({
        uniforms: {
          uSection: section,
          uColour: { value: new Vector3(...colour) },
          uOpacity: { value: share },
          uFades: { value: fades ? 1 : 0 },
          uHasBox: this.hasBox,
          uToBox: this.toBox,
          uBoxHalf: this.boxHalf,
        },
        vertexShader: kVertexShader,
        fragmentShader: kFragmentShader,
        transparent: true,
        side: DoubleSide,
        depthWrite: false,
        polygonOffset: true, // it lies on surfaces of the scene, and shall be seen
        polygonOffsetFactor: -1,
        polygonOffsetUnits: -2,
      });
      if (i === 1) material.depthFunc = GreaterDepth;
      const mesh = new Mesh(new BufferGeometry(), material);
      mesh.renderOrder = 12 - i;
      mesh.frustumCulled = false;
      this.add(mesh);
      return mesh;
    });
  }

  show(triangles: readonly Lit3[], frame: Frame): void {
    const geometry = new BufferGeometry();
    const corners = triangles.flatMap((triangle) => triangle.corners.flatMap((corner) => frame.toLocal(corner).toArray()));
    const focuses = triangles.flatMap(({ focus }) => [0, 1, 2].flatMap(() => frame.toLocal(focus).toArray()));
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(corners), 3));
    geometry.setAttribute('focus', new BufferAttribute(new Float32Array(focuses), 3));
    this.parts[0]?.geometry.dispose();
    for (const part of this.parts) part.geometry = geometry;
    this.visible = triangles.length > 0;
  }

  /** Draws what is in a box alone; `undefined` draws everything. */
  within(cage: Cage | undefined, frame: Frame): void {
    this.hasBox.value = cage?.min && cage.max ? 1 : 0;
    if (!cage?.min || !cage.max) return;
    const [min, max] = [new Vector3(...(cage.min as Vec3)), new Vector3(...(cage.max as Vec3))];
    const turn = toQuaternion(cage.orientation ?? [1, 0, 0, 0]);
    const middle = min.clone().add(max).multiplyScalar(0.5).applyQuaternion(turn);
    const pose = new Matrix4().compose(frame.toLocal(middle.toArray()), turn, new Vector3(1, 1, 1));
    this.toBox.value.copy(pose).invert();
    this.boxHalf.value.copy(max).sub(min).multiplyScalar(0.5).addScalar(kCageMargin_m);
  }
}

export class FindingsView {
  readonly group = new Group();
  private readonly markers = new Markers(70);
  private readonly witnesses: Lit;
  private readonly proof: Lit;
  private readonly lines: Tubes;
  private asked = 0;
  private fetches = 0;

  constructor(shared: TubeUniforms, section: IUniform<Vector4>, private readonly onChange: () => void) {
    this.witnesses = new Lit(kCollision, 0.85, true, section);
    this.proof = new Lit(kProof, 0.5, false, section);
    this.lines = new Tubes(shared, 15);
    this.group.add(this.witnesses, this.proof, this.lines, this.markers);
  }

  /** Whether all triangles are there that were asked for. */
  get isComplete(): boolean {
    return this.fetches === 0;
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
    const cage = answer?.infeasibility?.cage as Cage | undefined;
    if (cage) addCage(lines, cage, frame);
    this.proof.within(cage, frame);
    this.lines.show(lines);
    const touched = [...new Set(collisions.map(({ witness }) => witness.triangle))].filter((index) => index >= 0);
    const closed = (answer?.infeasibility?.triangles ?? proofTriangles(answer)).slice(0, kMostTriangles);
    this.witnesses.visible = false;
    this.proof.visible = false;
    if (!source || touched.length + closed.length === 0) return;
    ++this.fetches;
    try {
      const triangles = await source([...new Set([...touched, ...closed])]);
      if (asked !== this.asked) return;
      const lit = (index: number, focus: Vec3): Lit3[] => {
        const corners = triangles[index];
        return corners ? [{ corners, focus }] : [];
      };
      this.witnesses.show(collisions.flatMap(({ witness }) => lit(witness.triangle, witness.point)), frame);
      this.proof.show(closed.flatMap((index) => lit(index, [0, 0, 0])), frame);
      this.onChange();
    } catch {
      // The marks of the witnesses are there, and the next answer asks again.
    } finally {
      --this.fetches;
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
