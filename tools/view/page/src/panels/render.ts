// SPDX-License-Identifier: MIT
import type { State, Store } from '../model/store.js';
import { oncePerFrame } from './dom.js';

/** Replaces the content of `host`. Where the focus was on an element with a `data-key`, the new one of it has it. */
export function renderKeepingFocus(host: HTMLElement, content: readonly Node[]): void {
  const active = document.activeElement;
  const key = active instanceof HTMLElement && host.contains(active) ? active.dataset['key'] : undefined;
  const top = host.scrollTop;
  host.replaceChildren(...content);
  host.scrollTop = top;
  if (key === undefined) return;
  const again = [...host.querySelectorAll<HTMLElement>('[data-key]')].find((element) => element.dataset['key'] === key);
  again?.focus({ preventScroll: true });
}

/**
 * Calls `render` now, and at most once a frame when `isChanged`; never while `host` is hidden, but as soon as it is
 * shown. So a drag does not pay for panels that nobody sees.
 */
export function whileVisible(
  host: HTMLElement,
  store: Store,
  isChanged: (now: State, before: State) => boolean,
  render: (now: State) => void,
): () => void {
  let isStale = true;
  const renderIfVisible = (): void => {
    if (!isStale || host.offsetParent === null) return;
    isStale = false;
    render(store.now);
  };
  const ask = oncePerFrame(renderIfVisible);
  const invalidate = (): void => {
    isStale = true;
    ask();
  };
  store.listen((now, before) => {
    if (isChanged(now, before)) invalidate();
  });
  new ResizeObserver(renderIfVisible).observe(host);
  renderIfVisible();
  return invalidate;
}

/** Whether the request can be edited: everywhere but in a saved review. */
export function isEditable(state: State): boolean {
  return state.connection !== 'review';
}
