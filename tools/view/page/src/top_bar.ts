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

/** Buttons for the two answers that are compared; the one that is shown is pressed. Hidden where there is one answer alone. */
function makeAnswerSwitch(store: Store, actions: Actions): HTMLElement {
  const group = document.createElement('div');
  group.className = 'answers';
  group.setAttribute('role', 'group');
  group.setAttribute('aria-label', 'Answer that is shown');
  const update = (): void => {
    const { compared } = store.now;
    group.hidden = !compared;
    if (!compared) return;
    if (group.childElementCount === 0) {
      for (const name of [compared.otherName, compared.name]) {
        const show = (): void => {
          if (store.now.compared?.name !== name) actions.showOther();
        };
        const button = makeIconlessButton(name, `Show the answer: ${name} (M)`, show);
        button.dataset['name'] = name;
        group.append(button);
      }
    }
    for (const button of group.querySelectorAll('button')) {
      button.setAttribute('aria-pressed', String(button.dataset['name'] === compared.name));
    }
  };
  store.listen((now, before) => {
    if (now.compared !== before.compared) update();
  });
  update();
  return group;
}

function sentence({ connection, message, isPending, answer, unplanned, compared }: State): { text: string; kind: string } {
  if (connection === 'lost' || connection === 'connecting') return { text: message || 'Connecting to camway …', kind: 'lost' };
  if (message) return { text: message, kind: isPending ? 'busy' : unplanned ? 'invalid' : 'note' };
  if (unplanned) return { text: unplanned, kind: 'invalid' };
  if (!answer) return { text: isPending ? 'Planning …' : 'Walk to a place and press K for each keyframe, or open a request.', kind: 'note' };
  return { text: compared ? `${compared.name}: ${answer.message}` : answer.message, kind: answer.status };
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
  tools.append(makeAnswerSwitch(store, actions), open, save, review, ...more);
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
