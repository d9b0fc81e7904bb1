// SPDX-License-Identifier: MIT
//
// Elements of the page. Text is always text: nothing here or elsewhere in the panels parses HTML.

export interface Attributes {
  class?: string;
  text?: string;
  title?: string;
  [name: string]: string | undefined;
}

type Child = Node | string | undefined;

/** Makes an element. `text` is its text, other attributes are set by their names. */
export function make<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[Tag] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined) continue;
    if (name === 'text') element.textContent = value;
    else element.setAttribute(name, value);
  }
  for (const child of children) if (child !== undefined) element.append(child);
  return element;
}

export function makeButton(text: string, pressed: () => void, attributes: Attributes = {}): HTMLButtonElement {
  const button = make('button', { type: 'button', text, ...attributes });
  button.addEventListener('click', pressed);
  return button;
}

/** A button whose face is a symbol: its name is for screen readers and shown as a tooltip. */
export function makeIconButton(symbol: string, name: string, pressed: () => void): HTMLButtonElement {
  return makeButton(symbol, pressed, { class: 'cw-icon', title: name, 'aria-label': name });
}

let numbers = 0;

/** An id that no other element of the page has, for labels and descriptions. */
export function uniqueId(): string {
  return `cw-${++numbers}`;
}

/** Sets text where it differs, so that screen readers and selections are left in peace. */
export function setText(element: HTMLElement, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}

/** Calls `run` once in the next frame, however often it is asked. */
export function oncePerFrame(run: () => void): () => void {
  let isAsked = false;
  return () => {
    if (isAsked) return;
    isAsked = true;
    requestAnimationFrame(() => {
      isAsked = false;
      run();
    });
  };
}
