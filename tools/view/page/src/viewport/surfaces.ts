// SPDX-License-Identifier: MIT
// The look of the scene's surfaces: flat, by derivatives, like a clay model, cut off above the section plane. Where the
// section opens a closed solid, the inside is one plain tone, as in a drawing.

import { DoubleSide, ShaderMaterial, Vector3, Vector4 } from 'three';
import type { IUniform } from 'three';
import type { Rgb } from './tubes.js';

/** Values that all surfaces share: a change of one is a change of all. */
export interface SurfaceLook {
  readonly up: IUniform<Vector3>;
  /** Normal and distance of the section plane: what is beyond it is not drawn. The normal is 0 without a section. */
  readonly section: IUniform<Vector4>;
  readonly surface: IUniform<Vector3>;
  readonly cut: IUniform<Vector3>;
  readonly edge: IUniform<Vector3>;
  readonly edgeOpacity: IUniform<number>;
}

export function makeSurfaceLook(): SurfaceLook {
  return {
    up: { value: new Vector3(0, 1, 0) },
    section: { value: new Vector4(0, 0, 0, 0) },
    surface: { value: new Vector3(0.9, 0.9, 0.9) },
    cut: { value: new Vector3(0.4, 0.4, 0.4) },
    edge: { value: new Vector3(0.2, 0.2, 0.2) },
    edgeOpacity: { value: 0.5 },
  };
}

const kVertexShader = /* glsl */ `
varying vec3 vPlace;
varying vec3 vEyeward;
void main() {
  vec4 place = modelMatrix * vec4(position, 1.0);
  vPlace = place.xyz;
  vEyeward = cameraPosition - place.xyz;
  gl_Position = projectionMatrix * viewMatrix * place;
}`;

const kFragmentShader = /* glsl */ `
uniform vec3 uUp;
uniform vec4 uSection;
uniform vec3 uSurface;
uniform vec3 uCut;
uniform vec3 uTint;
uniform float uTinted;
uniform float uIsSolid;
varying vec3 vPlace;
varying vec3 vEyeward;
void main() {
  if (dot(uSection.xyz, vPlace) > uSection.w) discard;
  bool isCut = uIsSolid > 0.5 && !gl_FrontFacing && dot(uSection.xyz, uSection.xyz) > 0.5;
  vec3 base = mix(uSurface, uTint, uTinted);
  if (isCut) {
    gl_FragColor = vec4(mix(uCut, uTint, uTinted * 0.5), 1.0);
    return;
  }
  // From the eye rather than from the place: differences of small numbers, so no noise far from the origin.
  vec3 n = normalize(cross(dFdx(vEyeward), dFdy(vEyeward)));
  vec3 eye = normalize(vEyeward);
  n *= sign(dot(n, eye));
  vec3 side = uUp.yzx;
  float light = 0.70 + 0.17 * dot(n, uUp) + 0.07 * abs(dot(n, side)) + 0.10 * dot(n, eye);
  gl_FragColor = vec4(base * min(light, 1.0), 1.0);
}`;

/** Edges that are a few pixels long would cover the surfaces of a dense scene, so they fade. */
const kEdgeVertexShader = /* glsl */ `
uniform float uViewHeight;
attribute float span; // length of the edge
varying vec3 vPlace;
varying float vShare;
void main() {
  vec4 place = modelMatrix * vec4(position, 1.0);
  vPlace = place.xyz;
  gl_Position = projectionMatrix * viewMatrix * place;
  float pixels = 0.5 * uViewHeight * projectionMatrix[1][1] * span / max(gl_Position.w, 1e-6);
  vShare = clamp(pixels / 9.0, 0.06, 1.0);
}`;

const kEdgeFragmentShader = /* glsl */ `
uniform vec4 uSection;
uniform vec3 uEdge;
uniform float uEdgeOpacity;
varying vec3 vPlace;
varying float vShare;
void main() {
  if (dot(uSection.xyz, vPlace) > uSection.w) discard;
  gl_FragColor = vec4(uEdge, uEdgeOpacity * vShare);
}`;

/** A material for one object: its tint is its own, the rest is shared. */
export function makeSurfaceMaterial(look: SurfaceLook, isSolid: boolean): ShaderMaterial {
  return new ShaderMaterial({
    uniforms: {
      uUp: look.up,
      uSection: look.section,
      uSurface: look.surface,
      uCut: look.cut,
      uTint: { value: new Vector3() },
      uTinted: { value: 0 },
      uIsSolid: { value: isSolid ? 1 : 0 },
    },
    vertexShader: kVertexShader,
    fragmentShader: kFragmentShader,
    side: DoubleSide,
    polygonOffset: true, // edges lie on the surfaces, and shall be seen
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
}

export function tint(material: ShaderMaterial, colour: Rgb | undefined, share = 0.55): void {
  const { uTint, uTinted } = material.uniforms;
  if (!uTint || !uTinted) return;
  if (colour) (uTint.value as Vector3).set(...colour);
  uTinted.value = colour ? share : 0;
}

export function makeEdgeMaterial(look: SurfaceLook, viewHeight: IUniform<number>): ShaderMaterial {
  return new ShaderMaterial({
    uniforms: { uViewHeight: viewHeight, uSection: look.section, uEdge: look.edge, uEdgeOpacity: look.edgeOpacity },
    vertexShader: kEdgeVertexShader,
    fragmentShader: kEdgeFragmentShader,
    transparent: true,
    depthWrite: false,
  });
}
