// SPDX-License-Identifier: MIT
// The overlay that lists the keys.

import type { Command } from './commands.js';
import { kWalkHelp } from './keyboard.js';

const kMouse: readonly (readonly [string, string])[] = [
  ['Drag', 'Orbit; in a walk, look around'],
  ['Right drag', 'Shift the view'],
  ['Wheel', 'Nearer and farther; in a walk, forward and back'],
  ['Double click', 'Orbit about that point'],
  ['Click', 'Select a keyframe or an object'],
  ['Drag a keyframe', 'Move it level; with Shift, along the surfaces'],
  [kWalkHelp, 'Move the view; with Shift, faster'],
];

export class Help {
  private readonly dialog = document.createElement('dialog');

  constructor(host: HTMLElement, commands: readonly Command[]) {
    this.dialog.className = 'help';
    this.dialog.setAttribute('aria-label', 'Keys and mouse');
    const close = document.createElement('button');
    close.type = 'button';
    close.textContent = 'Close';
    close.addEventListener('click', () => this.dialog.close());
    const title = document.createElement('h2');
    title.textContent = 'Keys and mouse';
    const head = document.createElement('header');
    head.append(title, close);
    const columns = document.createElement('div');
    columns.className = 'columns';
    columns.append(section('Mouse and moving', kMouse));
    for (const group of new Set(commands.map((command) => command.group))) {
      const rows = commands
        .filter((command) => command.group === group)
        .flatMap(({ shown, name }) => (shown === undefined ? [] : [[shown, name] as const]));
      columns.append(section(group, rows));
    }
    this.dialog.append(head, columns);
    host.append(this.dialog);
  }

  toggle(): void {
    if (this.dialog.open) this.dialog.close();
    else this.dialog.showModal();
  }
}

function section(name: string, rows: readonly (readonly [string, string])[]): HTMLElement {
  const element = document.createElement('section');
  const title = document.createElement('h3');
  title.textContent = name;
  const list = document.createElement('dl');
  for (const [keys, text] of rows) {
    const term = document.createElement('dt');
    const key = document.createElement('kbd');
    key.textContent = keys;
    term.append(key);
    const description = document.createElement('dd');
    description.textContent = text;
    list.append(term, description);
  }
  element.append(title, list);
  return element;
}
