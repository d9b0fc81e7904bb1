// SPDX-License-Identifier: MIT
// The body at the cursor: the near quadrilateral with its pyramid, or another body; beside it, dashed, where the path
// before would have it.

import { DoubleSide, Group, Mesh, ShaderMaterial, Vector3 } from 'three';
import type { BufferGeometry } from 'three';
import type { PlanRequest } from '../contract/request.js';
import type { Pose } from '../model/actions.js';
import { kPalette } from '../model/palette.js';
import { addPyramid, bodyGeometries, kDefaultCamera, pictureCorners, pyramidLength } from './bodies.js';
import { toQuaternion } from './frame.js';
import type { Frame } from './frame.js';
import { rgbOf, TubeBuilder, Tubes } from './tubes.js';
import type { Rgb, TubeUniforms } from './tubes.js';

const kVertexShader = /* glsl */ `
varying vec3 vEyeward;
void main() {
  vec4 place = modelMatrix * vec4(position, 1.0);
  vEyeward = cameraPosition - place.xyz;
  gl_Position = projectionMatrix * viewMatrix * place;
}`;

const kFragmentShader = /* glsl */ `
uniform vec3 uColour;
uniform float uOpacity;
varying vec3 vEyeward;
void main() {
  vec3 n = normalize(cross(dFdx(vEyeward), dFdy(vEyeward)));
  float light = 0.7 + 0.3 * abs(dot(n, normalize(vEyeward)));
  gl_FragColor = vec4(uColour * light, uOpacity);
}`;

export function makeGlassMaterial(colour: Rgb, opacity: number): ShaderMaterial {
  return new ShaderMaterial({
    uniforms: { uColour: { value: new Vector3(...colour) }, uOpacity: { value: opacity } },
    vertexShader: kVertexShader,
    fragmentShader: kFragmentShader,
    transparent: true,
    side: DoubleSide,
    depthWrite: false,
  });
}

const kBefore = rgbOf(kPalette.before);
const kSamePlace_m = 2e-4;

export class CursorView {
  readonly group = new Group();
  private readonly lines: Tubes;
  private readonly bodies = new Group();
  private readonly material = makeGlassMaterial([0, 0, 0], 0.5);
  private shown: PlanRequest | undefined;

  constructor(shared: TubeUniforms) {
    this.lines = new Tubes(shared, 40);
    this.bodies.renderOrder = 55;
    this.group.add(this.bodies, this.lines);
  }

  show(
    request: PlanRequest | undefined,
    pose: Pose | undefined,
    before: Pose | undefined,
    frame: Frame,
    pathSize_m: number,
    colour: Rgb,
    nearScale: number,
  ): void {
    this.group.visible = request !== undefined && pose !== undefined;
    if (!request || !pose) return;
    if (request.body !== this.shown?.body || request.camera !== this.shown?.camera) this.rebuild(request);
    this.shown = request;
    (this.material.uniforms['uColour']?.value as Vector3).set(...colour);
    this.bodies.position.copy(frame.toLocal(pose.position));
    this.bodies.quaternion.copy(toQuaternion(pose.orientation));
    this.bodies.scale.setScalar(request.body ? 1 : nearScale);
    const lines = new TubeBuilder();
    const camera = { ...(request.camera ?? kDefaultCamera) };
    camera.near *= nearScale;
    const length_m = 1.8 * pyramidLength(camera, pathSize_m);
    const add = (at: Pose, tone: Rgb, isDashed: boolean): void => {
      const eye = frame.toLocal(at.position);
      const turn = toQuaternion(at.orientation);
      addPyramid(lines, camera, eye, turn, length_m, tone, { radius_m: 0, least_px: isDashed ? 1.3 : 2, isDashed });
      const near = pictureCorners(camera, eye, turn, camera.near);
      if (!request.body) lines.closed(near, tone, { radius_m: 0, least_px: 2.4 });
    };
    add(pose, colour, false);
    if (before && frame.toLocal(before.position).distanceTo(this.bodies.position) > kSamePlace_m) add(before, kBefore, true);
    this.lines.show(lines);
  }

  private rebuild(request: PlanRequest): void {
    for (const child of [...this.bodies.children]) {
      (child as Mesh<BufferGeometry>).geometry.dispose();
      child.removeFromParent();
    }
    for (const geometry of bodyGeometries(request)) {
      const mesh = new Mesh(geometry, this.material);
      mesh.renderOrder = 55;
      this.bodies.add(mesh);
    }
  }
}
