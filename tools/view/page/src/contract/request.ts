// SPDX-License-Identifier: MIT
// The request file of docs/requests.md. Lengths are metres, times seconds, quaternions w, x, y, z.

export type Vec3 = [number, number, number];
export type Quat = [number, number, number, number];

export interface Keyframe {
  position: Vec3;
  orientation: Quat;
  time?: number;
  image?: Quat;
  origin?: 'given' | 'inserted';
  repaired?: boolean;
}

export interface Camera {
  fov_x_deg: number;
  fov_y_deg: number;
  near: number;
}

/** The options of a plan. The page edits them by the field table of the door, so they have no types here. */
export type Options = Record<string, unknown>;

export interface PlanRequest {
  scene?: string;
  camera?: Camera;
  body?: Record<string, unknown>;
  keyframes: Keyframe[];
  frame?: unknown;
  options?: Options;
  [other: string]: unknown;
}
