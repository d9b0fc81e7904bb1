// SPDX-License-Identifier: MIT
// Marks of a constant size on the screen: keyframes and witnesses. Shapes differ, not only colours.

import { BufferAttribute, BufferGeometry, GreaterDepth, Group, Points, ShaderMaterial, Vector3 } from 'three';
import type { Rgb } from './tubes.js';

export type Shape = 'disc' | 'diamond' | 'cross' | 'ring';

const kShapes: Record<Shape, number> = { disc: 0, diamond: 1, cross: 2, ring: 3 };

export interface Marker {
  position: Vector3;
  colour: Rgb;
  shape: Shape;
  size_px: number;
}

const kVertexShader = /* glsl */ `
uniform float uPixelRatio;
attribute vec3 colour;
attribute vec2 style; // shape, size
varying vec3 vColour;
varying float vShape;
varying float vSize;
void main() {
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_PointSize = (style.y + 2.0) * uPixelRatio;
  vColour = colour;
  vShape = style.x;
  vSize = style.y + 2.0;
}`;

const kFragmentShader = /* glsl */ `
uniform vec3 uRim;
uniform float uOpacity;
varying vec3 vColour;
varying float vShape;
varying float vSize;
void main() {
  vec2 p = (gl_PointCoord - 0.5) * vSize; // pixels
  float half_px = 0.5 * vSize - 1.0;
  float d; // distance from the shape's outline in pixels, below 0 within
  if (vShape < 0.5) d = length(p) - half_px;
  else if (vShape < 1.5) d = (abs(p.x) + abs(p.y) - half_px) * 0.7071;
  else if (vShape < 2.5) {
    vec2 q = vec2(p.x + p.y, p.x - p.y) * 0.7071;
    d = max(min(abs(q.x), abs(q.y)) - 1.6, length(p) - half_px);
  } else d = abs(length(p) - half_px + 1.5) - 1.2;
  if (d > 1.0) discard;
  vec3 c = mix(vColour, uRim, smoothstep(-1.5, -0.5, d));
  gl_FragColor = vec4(c, uOpacity * (1.0 - smoothstep(0.3, 1.0, d)));
}`;

export class Markers extends Group {
  private readonly parts: Points<BufferGeometry, ShaderMaterial>[];
  private readonly rim = { value: new Vector3(1, 1, 1) };
  private readonly pixelRatio = { value: 1 };

  /** Marks behind surfaces are drawn with `hiddenOpacity`. */
  constructor(order: number, hiddenOpacity = 0.35) {
    super();
    this.parts = [hiddenOpacity, 1].map((opacity) => {
      const material = new ShaderMaterial({
        uniforms: { uRim: this.rim, uPixelRatio: this.pixelRatio, uOpacity: { value: opacity } },
        vertexShader: kVertexShader,
        fragmentShader: kFragmentShader,
        transparent: true,
        depthWrite: false,
      });
      if (opacity < 1) material.depthFunc = GreaterDepth;
      const points = new Points(new BufferGeometry(), material);
      points.frustumCulled = false;
      points.renderOrder = order + (opacity < 1 ? 0 : 10);
      this.add(points);
      return points;
    });
  }

  setLook(rim: Rgb, pixelRatio: number): void {
    this.rim.value.set(...rim);
    this.pixelRatio.value = pixelRatio;
  }

  show(markers: readonly Marker[]): void {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(markers.flatMap((m) => m.position.toArray())), 3));
    geometry.setAttribute('colour', new BufferAttribute(new Float32Array(markers.flatMap((m) => [...m.colour])), 3));
    geometry.setAttribute('style', new BufferAttribute(new Float32Array(markers.flatMap((m) => [kShapes[m.shape], m.size_px])), 2));
    this.parts[0]?.geometry.dispose();
    for (const part of this.parts) part.geometry = geometry;
    this.visible = markers.length > 0;
  }
}
