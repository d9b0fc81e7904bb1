// SPDX-License-Identifier: MIT
// The bar at the top: the scene, one sentence on what goes on, and files.

import type { Actions } from './model/actions.js';
import { isAnswered } from './model/store.js';
import type { State, Store } from './model/store.js';

export function makeIconlessButton(text: string, title: string, run: () => void): HTMLButtonElement {
  const button = document.createElement('button');
  button.type = 'button';
  button.textContent = text;
  button.title = title;
  button.setAttribute('aria-label', title);
  button.addEventListener('click', run);
  return button;
}

function sentence({ connection, message, isPending, answer, unplanned }: State): { text: string; kind: string } {
  if (connection === 'lost' || connection === 'connecting') return { text: message || 'Connecting to camway …', kind: 'lost' };
  if (message) return { text: message, kind: isPending ? 'busy' : unplanned ? 'invalid' : 'note' };
  if (unplanned) return { text: unplanned, kind: 'invalid' };
  if (!answer) return { text: isPending ? 'Planning …' : 'Walk to a place and press K for each keyframe, or open a request.', kind: 'note' };
  return { text: answer.message, kind: answer.status };
}

export function makeTopBar(
  tools: HTMLElement,
  message: HTMLElement,
  sceneName: HTMLElement,
  store: Store,
  actions: Actions,
  more: readonly HTMLButtonElement[],
): void {
  const open = makeIconlessButton('Open', 'Open a request (Ctrl O)', () => actions.open());
  const save = makeIconlessButton('Save', 'Save the request (Ctrl S)', () => actions.save());
  const review = makeIconlessButton('Review file', 'Save one HTML file that shows this plan without a server', () => actions.saveReview());
  tools.append(open, save, review, ...more);
  const update = (): void => {
    const { text, kind } = sentence(store.now);
    message.textContent = text;
    message.title = text;
    message.dataset['kind'] = kind;
    const { scene, connection } = store.now;
    sceneName.textContent = scene ? scene.scene.name : '';
    document.title = scene ? `${scene.scene.name} – Camway` : 'Camway';
    document.documentElement.dataset['connection'] = connection;
    open.hidden = connection === 'review';
    review.hidden = connection === 'review';
    review.disabled = !isAnswered(store.now) || !store.now.answer?.segments.length;
  };
  store.listen(update);
  update();
}
