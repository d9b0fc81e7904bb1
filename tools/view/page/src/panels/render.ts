// SPDX-License-Identifier: MIT
import type { State, Store } from '../model/store.js';
import { oncePerFrame } from './dom.js';

/**
 * Replaces the content of `host`. Where the focus was on an element with a `data-key`, the new one of it has it, with
 * the text that was typed into it and is not read yet.
 */
export function renderKeepingFocus(host: HTMLElement, content: readonly Node[]): void {
  const active = document.activeElement;
  const focused = active instanceof HTMLElement && host.contains(active) ? active : undefined;
  const typed = focused && typedInto(focused);
  const top = host.scrollTop;
  host.replaceChildren(...content);
  host.scrollTop = top;
  const key = focused?.dataset['key'];
  if (key === undefined) return;
  const again = [...host.querySelectorAll<HTMLElement>('[data-key]')].find((element) => element.dataset['key'] === key);
  again?.focus({ preventScroll: true });
  if (typed && again instanceof HTMLInputElement) typeAgain(again, typed);
}

interface Typed {
  text: string;
  selection: [from: number | null, to: number | null];
}

function typedInto(element: HTMLElement): Typed | undefined {
  if (!(element instanceof HTMLInputElement) || element.type !== 'text' || element.value === element.defaultValue) return undefined;
  return { text: element.value, selection: [element.selectionStart, element.selectionEnd] };
}

/** Firefox does not tell of a text that a script has set, so that is told when the focus leaves. */
function typeAgain(input: HTMLInputElement, { text, selection }: Typed): void {
  input.value = text;
  input.setSelectionRange(...selection);
  let isRead = false;
  input.addEventListener('input', () => (isRead = false));
  input.addEventListener('change', () => (isRead = true));
  input.addEventListener('blur', () => {
    if (!isRead && input.value !== input.defaultValue) input.dispatchEvent(new Event('change'));
  });
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
