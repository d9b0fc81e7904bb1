// SPDX-License-Identifier: MIT
// The places of the door over HTTP; the browser's cookie holds the token.

import type { Answer, Collision, Segment } from '../contract/answer.js';
import type { ExportFormat, Field, LastPlan, ObjectFacts, SceneDescription, SceneFacts } from '../contract/door.js';
import type { PlanRequest, Vec3 } from '../contract/request.js';
import { DoorError } from './socket.js';

export type Triangle = [Vec3, Vec3, Vec3];

async function fetchPlace(place: string, body?: unknown, method = body === undefined ? 'GET' : 'POST'): Promise<Response> {
  const response = await fetch(place, {
    method,
    ...(body === undefined ? {} : { body: JSON.stringify(body) }),
  });
  if (response.ok) return response;
  let sentence = `${method} ${place}: ${response.status}`;
  try {
    sentence = ((await response.json()) as { error?: string }).error ?? sentence;
  } catch {
    // The status is all that there is.
  }
  throw new DoorError(sentence, response.status);
}

async function fetchJson<T>(place: string, body?: unknown, method?: string): Promise<T> {
  return (await (await fetchPlace(place, body, method)).json()) as T;
}

interface BoundsInMetres {
  bounds_min_m?: Vec3;
  bounds_max_m?: Vec3;
}

/** Facts with `bounds`, as the page has them; the door calls their corners `bounds_min_m` and `bounds_max_m`. */
function withBounds<T extends SceneFacts | ObjectFacts>(facts: T & BoundsInMetres): T {
  if (facts.bounds) return facts;
  return { ...facts, bounds: { min: facts.bounds_min_m ?? [0, 0, 0], max: facts.bounds_max_m ?? [0, 0, 0] } };
}

export async function listScenes(): Promise<SceneFacts[]> {
  const { scenes } = await fetchJson<{ scenes: SceneFacts[] }>('/v1/scenes');
  return scenes.map(withBounds);
}

const scenePlace = (scene: string): string => `/v1/scenes/${encodeURIComponent(scene)}`;

/** The description of a scene as the door sends it, with `bounds`. */
export function asDescribed(description: SceneDescription): SceneDescription {
  return { ...description, scene: withBounds(description.scene), objects: description.objects.map(withBounds) };
}

export async function describeScene(scene: string): Promise<SceneDescription> {
  return asDescribed(await fetchJson<SceneDescription>(scenePlace(scene)));
}

export async function fetchMesh(scene: string, digest: string): Promise<ArrayBuffer> {
  return (await fetchPlace(`${scenePlace(scene)}/meshes/${digest}`)).arrayBuffer();
}

/** Triangles of the scene by index, in the world; unknown ones are left out. */
export async function fetchTriangles(scene: string, indices: readonly number[]): Promise<Record<string, Triangle>> {
  const place = `${scenePlace(scene)}/triangles`;
  return (await fetchJson<{ triangles: Record<string, Triangle> }>(place, { indices })).triangles;
}

export async function interpolate(request: PlanRequest): Promise<Segment[]> {
  return (await fetchJson<{ segments: Segment[] }>('/v1/interpolate', request)).segments;
}

export interface DoorFields {
  fields: Field[];
  exports: ExportFormat[];
}

export async function fetchFields(): Promise<DoorFields> {
  const { fields, exports = [] } = await fetchJson<{ fields: Field[]; exports?: ExportFormat[] }>('/v1/fields');
  return { fields, exports };
}

export function fetchLast(): Promise<LastPlan> {
  return fetchJson<LastPlan>('/v1/last');
}

/**
 * The name that the scene's file gives to what is within `reach_m` of a point; undefined if nothing is. Asked as the
 * check of a ball that rests there, since its witness has the name.
 */
export async function fetchPart(scene: string, point: Vec3, reach_m: number): Promise<string | undefined> {
  const orientation = [1, 0, 0, 0];
  const body = { type: 'sphere', radius_m: reach_m };
  const request = { scene, body, keyframes: [0, 1].map((time) => ({ time, position: point, orientation })) };
  const segment = { t0: 0, t1: 1, position: Array.from({ length: 4 }, () => point), orientation: Array.from({ length: 7 }, () => orientation) };
  const { collisions } = await fetchJson<{ collisions?: Collision[] }>('/v1/check', { request, path: { segments: [segment] } });
  return collisions?.[0]?.witness.object;
}

export interface DoorStatus {
  read_only?: boolean;
  backend?: { planner?: string; scene?: string; [other: string]: unknown };
}

export function fetchStatus(): Promise<DoorStatus> {
  return fetchJson<DoorStatus>('/v1/status');
}

export interface NewObject {
  name: string;
  form: Record<string, unknown>;
  position?: Vec3;
}

export async function addObject(scene: string, object: NewObject): Promise<void> {
  await fetchPlace(`${scenePlace(scene)}/objects`, object);
}

export async function moveObject(scene: string, object: string, pose: { position?: Vec3; orientation?: number[] }): Promise<void> {
  await fetchPlace(`${scenePlace(scene)}/objects/${encodeURIComponent(object)}`, pose, 'PATCH');
}

export async function removeObject(scene: string, object: string): Promise<void> {
  await fetchPlace(`${scenePlace(scene)}/objects/${encodeURIComponent(object)}`, undefined, 'DELETE');
}

export async function fetchReview(request: PlanRequest, answer: Answer): Promise<Blob> {
  return (await fetchPlace('/v1/review', { request, answer })).blob();
}

export async function fetchExport(format: ExportFormat, request: PlanRequest, answer: Answer): Promise<Blob> {
  return (await fetchPlace(`/v1/export?format=${encodeURIComponent(format.name)}`, { request, answer })).blob();
}
