// SPDX-License-Identifier: MIT
// The page: joins the door or the data of a review, the view, the panels and the keys.

import type { Review } from './contract/door.js';
import { kEmptyState, Store } from './model/store.js';
import { Page } from './page.js';
import { openDoor } from './door/door.js';
import { openReview } from './door/review.js';

function readReview(): Review | undefined {
  const element = document.getElementById('review');
  return element?.textContent ? (JSON.parse(element.textContent) as Review) : undefined;
}

const store = new Store(kEmptyState);
const review = readReview();
const page = new Page(store, (pageParts) => (review ? openReview(review, store) : openDoor(store, pageParts)));

/**
 * For tests, and to look at: nothing of the page uses it. `screenOf` says where a point of the world is, in CSS
 * pixels of the window; `report` is what was drawn last; `missing` names what is not drawn yet; `handleAt` says which
 * handle the mouse has at a place of the window.
 */
Object.defineProperty(window, 'camway', {
  value: Object.freeze({
    get state() {
      return store.now;
    },
    get report() {
      return page.report;
    },
    get missing() {
      return page.viewport.missing;
    },
    handleAt: (place: [number, number]) => page.viewport.handleAt(place),
    screenOf: (point: [number, number, number]) => page.viewport.screenOf(point),
  }),
});
