// SPDX-License-Identifier: MIT
// Lines with a thickness: tubes of a radius in metres, which are never thinner than some pixels. All lines of a view
// are one geometry. Where something of the scene hides a tube, it is drawn faintly.

import {
  BufferAttribute,
  BufferGeometry,
  GreaterDepth,
  Group,
  Mesh,
  ShaderMaterial,
  Vector3,
} from 'three';
import type { IUniform } from 'three';

export type Rgb = readonly [number, number, number];

export function rgbOf(hex: string): Rgb {
  const value = Number.parseInt(hex.slice(1), 16);
  return [(value >> 16) / 255, ((value >> 8) & 255) / 255, (value & 255) / 255];
}

/** What all tubes of a view share. */
export interface TubeUniforms {
  /** Height of the picture in CSS pixels. */
  readonly viewHeight: IUniform<number>;
  /** Nearer than that, tubes fade away: somebody who walks along a path would see nothing else. */
  readonly fade_m: IUniform<number>;
}

const kSides = 7;
const kHiddenOpacity = 0.28;

const kVertexShader = /* glsl */ `
uniform float uViewHeight;
attribute vec3 around;
attribute vec3 colour;
attribute vec4 style; // radius, least pixels, way along the line, dashed
varying vec3 vColour;
varying vec3 vNormal;
varying float vAlong;
varying float vDashed;
varying float vDepth;
void main() {
  vec4 centre = modelViewMatrix * vec4(position, 1.0);
  float pixel = 2.0 * max(-centre.z, 1e-6) / (projectionMatrix[1][1] * uViewHeight);
  float radius = max(style.x, 0.5 * style.y * pixel);
  vec3 normal = normalize(normalMatrix * around);
  centre.xyz += normal * radius;
  vColour = colour;
  vNormal = normal;
  // A dash and its gap take some 14 pixels; powers of two, so that dashes stand still while the view moves.
  vAlong = style.z / exp2(ceil(log2(14.0 * pixel)));
  vDashed = style.w;
  vDepth = -centre.z;
  gl_Position = projectionMatrix * centre;
}`;

const kFragmentShader = /* glsl */ `
uniform float uOpacity;
uniform float uFade;
varying float vDepth;
varying vec3 vColour;
varying vec3 vNormal;
varying float vAlong;
varying float vDashed;
void main() {
  float near = smoothstep(0.5 * uFade, uFade, vDepth);
  if (near < 0.02) discard;
  if (vDashed > 0.5 && fract(vAlong) > 0.55) discard;
  float light = 0.80 + 0.20 * abs(normalize(vNormal).z);
  gl_FragColor = vec4(vColour * light, uOpacity * near);
}`;

export interface TubeStyle {
  radius_m: number;
  /** The tube is never thinner on the screen. */
  least_px: number;
  isDashed?: boolean;
}

/** Collects lines and makes one geometry of them. */
export class TubeBuilder {
  private readonly positions: number[] = [];
  private readonly around: number[] = [];
  private readonly colours: number[] = [];
  private readonly styles: number[] = [];
  private readonly indices: number[] = [];

  get isEmpty(): boolean {
    return this.indices.length === 0;
  }

  segment(a: Vector3, b: Vector3, colour: Rgb, style: TubeStyle): void {
    this.line([a, b], () => colour, style);
  }

  closed(points: readonly Vector3[], colour: Rgb, style: TubeStyle): void {
    points.forEach((point, i) => {
      const next = points[(i + 1) % points.length];
      if (next) this.segment(point, next, colour, style);
    });
  }

  /** A line through points; `colourOf` gives the colour at each of them. */
  line(points: readonly Vector3[], colourOf: (index: number) => Rgb, style: TubeStyle): void {
    const path = points.filter((p, i) => i === 0 || !p.equals(points[i - 1] as Vector3));
    if (path.length < 2) return;
    const kept = points.map((_, i) => i).filter((i) => i === 0 || !(points[i] as Vector3).equals(points[i - 1] as Vector3));
    const normal = new Vector3();
    let way_m = 0;
    path.forEach((point, i) => {
      const tangent = (path[i + 1] ?? point).clone().sub(path[i - 1] ?? point).normalize();
      if (i > 0) way_m += point.distanceTo(path[i - 1] as Vector3);
      // The normal is carried along, so that the tube does not twist.
      normal.addScaledVector(tangent, -normal.dot(tangent));
      if (normal.lengthSq() < 1e-6) normal.copy(anyNormal(tangent));
      normal.normalize();
      this.ring(point, normal, tangent, colourOf(kept[i] ?? 0), style, way_m, i > 0);
    });
  }

  private ring(
    centre: Vector3,
    normal: Vector3,
    tangent: Vector3,
    colour: Rgb,
    style: TubeStyle,
    way_m: number,
    isJoined: boolean,
  ): void {
    const first = this.positions.length / 3;
    const other = tangent.clone().cross(normal);
    for (let side = 0; side < kSides; ++side) {
      const angle = (2 * Math.PI * side) / kSides;
      const c = Math.cos(angle);
      const s = Math.sin(angle);
      this.positions.push(centre.x, centre.y, centre.z);
      this.around.push(c * normal.x + s * other.x, c * normal.y + s * other.y, c * normal.z + s * other.z);
      this.colours.push(...colour);
      this.styles.push(style.radius_m, style.least_px, way_m, style.isDashed ? 1 : 0);
      if (!isJoined) continue;
      const next = (side + 1) % kSides;
      const a = first - kSides + side;
      const b = first - kSides + next;
      this.indices.push(a, b, first + side, b, first + next, first + side);
    }
  }

  build(): BufferGeometry {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(this.positions), 3));
    geometry.setAttribute('around', new BufferAttribute(new Float32Array(this.around), 3));
    geometry.setAttribute('colour', new BufferAttribute(new Float32Array(this.colours), 3));
    geometry.setAttribute('style', new BufferAttribute(new Float32Array(this.styles), 4));
    geometry.setIndex(this.indices);
    return geometry;
  }
}

function anyNormal(tangent: Vector3): Vector3 {
  const axis = Math.abs(tangent.y) < 0.9 ? new Vector3(0, 1, 0) : new Vector3(1, 0, 0);
  return axis.cross(tangent).normalize();
}

/** What is drawn for a `TubeBuilder`; its lines are replaced as a whole. */
export class Tubes extends Group {
  private readonly visiblePart: Mesh<BufferGeometry, ShaderMaterial>;
  private readonly hiddenPart: Mesh<BufferGeometry, ShaderMaterial>;

  constructor(shared: TubeUniforms, order: number, opacity = 1) {
    super();
    const material = (opacityHere: number): ShaderMaterial =>
      new ShaderMaterial({
        uniforms: { uViewHeight: shared.viewHeight, uFade: shared.fade_m, uOpacity: { value: opacityHere } },
        vertexShader: kVertexShader,
        fragmentShader: kFragmentShader,
        transparent: true, // drawn after the scene, whose depth tells what is hidden
        depthWrite: opacityHere === 1,
      });
    this.visiblePart = new Mesh(new BufferGeometry(), material(opacity));
    this.hiddenPart = new Mesh(this.visiblePart.geometry, material(opacity * kHiddenOpacity));
    this.hiddenPart.material.depthFunc = GreaterDepth;
    this.hiddenPart.material.depthWrite = false;
    this.visiblePart.renderOrder = order + 10;
    this.hiddenPart.renderOrder = order;
    for (const part of [this.visiblePart, this.hiddenPart]) {
      part.frustumCulled = false; // the thickness is known on the screen alone
      this.add(part);
    }
  }

  show(builder: TubeBuilder): void {
    this.visiblePart.geometry.dispose();
    const geometry = builder.build();
    this.visiblePart.geometry = geometry;
    this.hiddenPart.geometry = geometry;
    this.visible = !builder.isEmpty;
  }
}
