// SPDX-License-Identifier: MIT
// Joins the reviews of a report into pages, as `camway draw` writes them.

import type { Review } from '../contract/door.js';
import type { ShelvedMeshes, ShelvedPage, ShelvedReview, ShelvedScenes } from '../contract/report.js';

/** JSON that can stand in an element of HTML: nothing in it begins a tag. */
export function jsonForHtml(value: unknown): string {
  return JSON.stringify(value).replaceAll('<', '\\u003c');
}

export class Shelf {
  private meshes: ShelvedMeshes | undefined;

  /** `textOf` returns the text of the element with an id; undefined if there is none. */
  constructor(private readonly textOf: (id: string) => string | undefined) {}

  /** The review of a request; undefined if the report holds none. */
  review(number: string): Review | undefined {
    const shelved = this.part<ShelvedReview>(`review-${number}`);
    const scene = shelved && this.part<ShelvedScenes>('review-scenes')?.[shelved.scene];
    if (!scene) return undefined;
    this.meshes ??= this.part<ShelvedMeshes>('review-meshes') ?? {};
    const meshes: Record<string, string> = {};
    for (const { digest, mesh_digest } of scene.objects) {
      const mesh = this.meshes[mesh_digest ?? digest];
      if (mesh !== undefined) meshes[digest] = mesh;
    }
    return { ...shelved, scene, meshes };
  }

  /** The page that shows the review of a request, as one file of HTML; undefined if the report holds none. */
  page(number: string): string | undefined {
    const review = this.review(number);
    const page = this.part<ShelvedPage>('review-page');
    return review && page && page[0] + jsonForHtml(review) + page[1];
  }

  private part<Part>(id: string): Part | undefined {
    const text = this.textOf(id);
    return text === undefined ? undefined : (JSON.parse(text) as Part);
  }
}
