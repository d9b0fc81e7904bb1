// SPDX-License-Identifier: MIT
// The data of a self-contained page, in place of a door.

import type { Review } from '../contract/door.js';
import type { Backing } from '../page.js';
import type { Store } from '../model/store.js';
import { asDescribed } from './places.js';
import { completed } from './planner.js';

function bytesOf(base64: string): ArrayBuffer {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes.buffer;
}

export function openReview(review: Review, store: Store): Backing {
  const refuse = (): Promise<never> => Promise.reject(new Error('A review cannot do that.'));
  return {
    sources: {
      part: () => Promise.resolve(undefined),
      mesh: (digest) => {
        const base64 = review.meshes[digest];
        return base64 === undefined ? Promise.reject(new Error('This file lacks a mesh.')) : Promise.resolve(bytesOf(base64));
      },
      triangles: (indices) =>
        Promise.resolve(
          Object.fromEntries(indices.flatMap((index) => (review.triangles[index] ? [[String(index), review.triangles[index]]] : []))),
        ),
    },
    request: review.request,
    facts: { fields: [], exports: [], status: undefined },
    plan: () => undefined,
    sceneFault: () => undefined,
    cancelPlan: () => undefined,
    watchPath: () => undefined,
    review: refuse,
    exported: refuse,
    sceneEditor: undefined,
    start: () => {
      store.set({
        connection: 'review',
        isReadOnly: true,
        scene: asDescribed(review.scene),
        request: review.request,
        answer: completed(review.answer),
        before: review.before?.segments ?? [],
        compared: review.compared && { ...review.compared, other: completed(review.compared.other) },
      });
    },
  };
}
