// SPDX-License-Identifier: MIT
// The answer of docs/answers.md.

import type { Keyframe, Quat, Vec3 } from './request.js';

export type Status = 'ok' | 'partial' | 'infeasible' | 'timeout' | 'invalid' | 'internal_error';

/** Bezier curves: 4 points for the position, 7 four-vectors for the orientation, which is divided by its length. */
export interface Segment {
  t0: number;
  t1: number;
  position: Vec3[];
  orientation: Quat[];
}

export interface Witness {
  time: number;
  object: string;
  triangle: number;
  feature: string;
  depth_m: number;
  point: Vec3;
}

export interface Collision {
  t_begin: number;
  t_end: number;
  witness: Witness;
}

export interface Correction {
  t_begin: number;
  t_end: number;
  kind: 'move' | 'turn' | 'go_round' | 'shrink' | 'none';
  changed: [number, number];
  moved_m: number;
  turned_deg: number;
  largest_shift_deg: number;
  mean_shift_deg: number;
  tried?: Record<string, number>;
}

export interface KeyframeFault {
  keyframe: number;
  depth_m?: number;
  free_pose?: { position: Vec3; orientation: Quat };
  [other: string]: unknown;
}

export interface Infeasibility {
  keyframe_inside: number;
  keyframe_outside: number;
  triangles: number[];
  cage?: Record<string, unknown>;
  [other: string]: unknown;
}

/** Certified clearance of a stretch of the path; `clearance_m` is a lower bound. */
export interface ClearanceStretch {
  t_begin: number;
  t_end: number;
  clearance_m: number;
}

export interface Answer {
  status: Status;
  message: string;
  scene_digest?: string;
  segments: Segment[];
  keyframes: Keyframe[];
  collisions: Collision[];
  remaining_collisions: Collision[];
  certificate?: { certified: boolean; clearance_lower_bound: number };
  corrections?: Correction[];
  keyframe_faults?: KeyframeFault[];
  infeasibility?: Infeasibility;
  measures?: { before: Record<string, number>; after: Record<string, number> };
  slowed?: { t_begin: number; t_end: number; given: [number, number] }[];
  clearance_profile?: ClearanceStretch[];
  bounds?: { min?: (number | null)[]; max?: (number | null)[] };
  keyframe?: number;
  viewing_distance_m?: number;
  near_scale?: number;
  time_scale?: number;
  warnings?: string[];
  timing_ms?: Record<string, number>;
  [other: string]: unknown;
}
