// SPDX-License-Identifier: MIT
// The moving thing: the near quadrilateral of a camera with the pyramid of its picture, or another body.

import { BoxGeometry, BufferAttribute, BufferGeometry, SphereGeometry, Vector3 } from 'three';
import type { Quaternion } from 'three';
import { ConvexGeometry } from 'three/addons/geometries/ConvexGeometry.js';
import type { Camera, PlanRequest, Vec3 } from '../contract/request.js';
import type { Rgb, TubeBuilder, TubeStyle } from './tubes.js';

export const kDefaultCamera: Camera = { fov_x_deg: 80, fov_y_deg: 60, near: 0.1 };

/** Half of the width and height of a camera's picture at the distance 1. */
export function pictureHalf(camera: Camera): [number, number] {
  const half = (angle_deg: number): number => Math.tan((angle_deg * Math.PI) / 360);
  return [half(camera.fov_x_deg), half(camera.fov_y_deg)];
}

/** Corners of the picture at a distance, in the world; corner 0 is upper right, the others counter-clockwise. */
export function pictureCorners(camera: Camera, position: Vector3, orientation: Quaternion, distance_m: number): Vector3[] {
  const [x, y] = pictureHalf(camera);
  const signs: [number, number][] = [[1, 1], [-1, 1], [-1, -1], [1, -1]];
  return signs.map(([sx, sy]) =>
    new Vector3(sx * x, sy * y, -1).multiplyScalar(distance_m).applyQuaternion(orientation).add(position),
  );
}

/** The pyramid from the eye to the picture at a distance, with a mark on its upper side. */
export function addPyramid(
  builder: TubeBuilder,
  camera: Camera,
  position: Vector3,
  orientation: Quaternion,
  distance_m: number,
  colour: Rgb,
  style: TubeStyle,
): void {
  const corners = pictureCorners(camera, position, orientation, distance_m);
  for (const corner of corners) builder.segment(position, corner, colour, style);
  builder.closed(corners, colour, style);
  const [right, left] = corners as [Vector3, Vector3];
  const up = new Vector3(0, 1, 0).applyQuaternion(orientation);
  const middle = left.clone().lerp(right, 0.5);
  const tip = middle.clone().addScaledVector(up, 0.18 * left.distanceTo(right));
  builder.segment(left.clone().lerp(right, 0.35), tip, colour, style);
  builder.segment(tip, left.clone().lerp(right, 0.65), colour, style);
}

interface BodyMember {
  type?: string;
  size?: Vec3;
  radius_m?: number;
  radius?: number;
  center?: Vec3;
  points?: Vec3[];
  pieces?: Vec3[][];
  vertices?: Vec3[];
  triangles?: Vec3[];
}

function meshOf(vertices: readonly Vec3[], triangles: readonly Vec3[]): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(vertices.flat()), 3));
  geometry.setIndex(triangles.flat());
  return geometry;
}

function hullOf(points: readonly Vec3[]): BufferGeometry {
  return new ConvexGeometry(points.map((p) => new Vector3(...p)));
}

function quadrilateral(camera: Camera): BufferGeometry {
  const [x, y] = pictureHalf(camera).map((half) => half * camera.near) as [number, number];
  const z = -camera.near;
  return meshOf([[x, y, z], [-x, y, z], [-x, -y, z], [x, -y, z]], [[0, 1, 2], [0, 2, 3]]);
}

/** The surfaces of a request's body in the camera's frame; empty if they are in a file that the page has not. */
export function bodyGeometries(request: PlanRequest): BufferGeometry[] {
  const body = request.body as BodyMember | undefined;
  const center = new Vector3(...(body?.center ?? [0, 0, 0]));
  const moved = (geometry: BufferGeometry): BufferGeometry => geometry.translate(center.x, center.y, center.z);
  if (!body) return [quadrilateral(request.camera ?? kDefaultCamera)];
  switch (body.type) {
    case 'box':
      return body.size ? [moved(new BoxGeometry(...body.size))] : [];
    case 'sphere':
      return [moved(new SphereGeometry(body.radius_m ?? body.radius ?? 0, 24, 16))];
    case 'convex':
      return (body.pieces ?? [body.points ?? []]).filter((points) => points.length >= 4).map(hullOf);
    default:
      return body.vertices && body.triangles ? [meshOf(body.vertices, body.triangles)] : [];
  }
}

/** The length at which pyramids of keyframes are drawn: to be seen, and not to fill rooms. */
export function pyramidLength(camera: Camera, pathSize_m: number): number {
  return Math.max(2 * camera.near, Math.min(Math.max(0.07 * pathSize_m, 0.25), 1));
}
