// SPDX-License-Identifier: MIT
// The parts of reviews in a report of `camway replay`, each in an element of JSON: tools/view/review/review_shelf.h.

import type { Review, SceneDescription } from './door.js';

/** The element `review-NUMBER`: a review without what it shares with others. */
export interface ShelvedReview extends Omit<Review, 'scene' | 'meshes'> {
  /** Index in `ShelvedScenes`. */
  scene: number;
}

/** The element `review-scenes`. */
export type ShelvedScenes = SceneDescription[];

/** The element `review-meshes`: by `mesh_digest` of an object, or by its `digest` where it has no other one. */
export type ShelvedMeshes = Record<string, string>;

/** The element `review-page`: the page of a review before its data and after it. */
export type ShelvedPage = [begin: string, end: string];
