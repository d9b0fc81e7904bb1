// SPDX-License-Identifier: MIT
// The tool bar of the view: the commands that have a picture.

import type { Command } from './commands.js';
import type { Store } from './model/store.js';

/** Pictures of 20 by 20, drawn in the colour of text. */
const kIcons: Record<string, string> = {
  add: 'M3 13V5h3l1.5-2h5L14 5h3v8M10 10v7M6.5 13.5h7',
  insert: 'M2 15C6 15 6 5 10 5s4 10 8 10M10 2l3 3-3 3-3-3z',
  delete: 'M4 5h12M8 5V3h4v2M6 5l.7 12h6.6L14 5M9 8v6M11 8v6',
  move: 'M10 2v16M2 10h16M7.500 4.500 10 2l2.500 2.500M7.500 15.500 10 18l2.500-2.500M4.500 7.500 2 10l2.500 2.500M15.500 7.500 18 10l-2.500 2.500',
  turn: 'M16 10a6 6 0 1 1-2-4.500M14.500 1.500V6H10',
  home: 'M2 14c4-8 6-8 8-4s4 4 8-4M2 14h.01M18 6h.01',
  fit: 'M3 7V3h4M13 3h4v4M17 13v4h-4M7 17H3v-4M8 10h4M10 8v4',
  scene: 'M3 17V9l7-6 7 6v8zM8 17v-5h4v5',
  walk: 'M11 3.500a1 1 0 1 0 .01 0M7 18l2-5-1-5 3-1 2 3 2 1M9 13l3 2v3M6 10l2-2',
  camera: 'M2 6h10v8H2zM12 9l6-3v8l-6-3',
  section: 'M3 16V9h14v7zM1 9h18M6 9V5h8v4',
  box: 'M10 2l7 4v8l-7 4-7-4V6zM3 6l7 4 7-4M10 10v8',
  ball: 'M10 3a7 7 0 1 0 .01 0M3 10c3 3 11 3 14 0',
};

const kSvg = 'http://www.w3.org/2000/svg';

export function makeIcon(name: string): SVGElement {
  const svg = document.createElementNS(kSvg, 'svg');
  svg.setAttribute('viewBox', '0 0 20 20');
  svg.setAttribute('aria-hidden', 'true');
  const path = document.createElementNS(kSvg, 'path');
  path.setAttribute('d', kIcons[name] ?? '');
  svg.append(path);
  return svg;
}

export function makeToolbar(host: HTMLElement, commands: readonly Command[], store: Store): void {
  host.className = 'toolbar';
  host.setAttribute('role', 'toolbar');
  host.setAttribute('aria-label', 'Tools');
  const buttons = commands
    .filter(({ icon }) => icon !== undefined)
    .map((command) => {
      const button = document.createElement('button');
      button.type = 'button';
      button.title = `${command.name} (${command.shown ?? command.keys[0] ?? ''})`;
      button.setAttribute('aria-label', command.name);
      button.dataset['command'] = command.icon ?? '';
      button.append(makeIcon(command.icon ?? ''));
      button.addEventListener('click', () => {
        command.run();
        update();
      });
      return { button, command };
    });
  let group = '';
  for (const { button, command } of buttons) {
    if (group && group !== command.group) host.append(document.createElement('hr'));
    group = command.group;
    host.append(button);
  }
  const update = (): void => {
    for (const { button, command } of buttons) {
      if (command.isOn) button.setAttribute('aria-pressed', String(command.isOn()));
      button.disabled = store.now.connection === 'review' && !command.isViewing;
      if (command.group === 'Scene') button.disabled ||= store.now.isReadOnly;
    }
  };
  store.listen(update);
  window.addEventListener('keyup', update);
  host.addEventListener('mouseenter', update);
  update();
}
