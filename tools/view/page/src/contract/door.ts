// SPDX-License-Identifier: MIT
// The door's answers about scenes, fields and itself: docs/http.md.

import type { Answer, Segment } from './answer.js';
import type { PlanRequest, Quat, Vec3 } from './request.js';

export interface SceneFacts {
  name: string;
  revision: number;
  digest: string;
  triangles: number;
  bounds: { min: Vec3; max: Vec3 };
}

export interface ObjectFacts {
  name: string;
  kind: string;
  digest: string;
  /** Digest of the mesh in its own frame, which moves do not change. Absent for occupancy maps. */
  mesh_digest?: string;
  triangles: number;
  position: Vec3;
  orientation: Quat;
  bounds: { min: Vec3; max: Vec3 };
}

export interface SceneDescription {
  scene: SceneFacts;
  objects: ObjectFacts[];
  warnings?: string;
}

/** An option of a request, or a member of one that is an object, as `GET /v1/fields` lists it. */
export interface Field {
  name: string;
  type: 'number' | 'count' | 'boolean' | 'choice' | 'vector' | 'object';
  help: string;
  /** The range in words. */
  range?: string;
  least?: number;
  most?: number;
  default?: unknown;
  /** Words for what holds where the option is not set and has no default. */
  unset?: string;
  choices?: string[];
  unit?: string;
  /** Members of an object. */
  fields?: Field[];
}

/** A format of `camway export`, as `GET /v1/fields` lists it. */
export interface ExportFormat {
  name: string;
  /** The extension with its dot. */
  extension: string;
  help: string;
}

/** `GET /v1/last`: what was planned last, for a page that is opened. */
export interface LastPlan {
  request?: PlanRequest;
  answer?: Answer;
}

/** A path as interpolated, before it was corrected. */
export interface Interpolated {
  segments: Segment[];
}

/** Another answer to the request of a review, which is compared with the answer of the review. */
export interface Compared {
  /** Names of the two for people: `name` is that of the answer which is shown. */
  name: string;
  otherName: string;
  other: Answer;
}

/** What a self-contained page holds instead of a door. Meshes are GLB in base64, by digest. */
export interface Review {
  request: PlanRequest;
  answer: Answer;
  before: Interpolated;
  compared?: Compared;
  scene: SceneDescription;
  meshes: Record<string, string>;
  triangles: Record<string, [Vec3, Vec3, Vec3]>;
}
