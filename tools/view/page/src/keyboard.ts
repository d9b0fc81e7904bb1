// SPDX-License-Identifier: MIT
// The keys of the page. Fields that take text keep their keys, and so do buttons and sliders theirs.

import type { Command } from './commands.js';
import type { Store } from './model/store.js';
import type { Viewport } from './viewport/viewport.js';

const kWalkKeys: Record<string, [right: number, forward: number, up: number]> = {
  KeyW: [0, 1, 0],
  KeyS: [0, -1, 0],
  KeyA: [-1, 0, 0],
  KeyD: [1, 0, 0],
  KeyE: [0, 0, 1],
  KeyQ: [0, 0, -1],
};

export const kWalkHelp = 'W A S D, Q E';

/** Keys that elements use themselves, by the role or the tag of the element; with Alt, sliders use none. */
function isTakenBy(element: Element | null, { key, altKey }: KeyboardEvent): boolean {
  if (!element || element === document.body) return false;
  const tag = element.tagName;
  if (tag === 'TEXTAREA' || tag === 'SELECT') return true;
  const isRange = element instanceof HTMLInputElement && ['range', 'checkbox', 'radio', 'button'].includes(element.type);
  if (tag === 'INPUT' && !isRange) return true;
  const moves = ['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown', 'Home', 'End', 'PageUp', 'PageDown'];
  if ((isRange || element.getAttribute('role') === 'slider') && !altKey && moves.includes(key)) return true;
  return (tag === 'BUTTON' || tag === 'SUMMARY' || tag === 'A' || isRange) && (key === ' ' || key === 'Enter');
}

function nameOf(event: KeyboardEvent): string {
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  // Shift is part of a sign such as ?, and is named only with letters and named keys.
  const isShifted = event.shiftKey && (event.key.length > 1 || /[a-z]/.test(key));
  return `${event.ctrlKey || event.metaKey ? 'Ctrl+' : ''}${event.altKey ? 'Alt+' : ''}${isShifted ? 'Shift+' : ''}${key}`;
}

export function listenToKeys(commands: readonly Command[], store: Store, viewport: Viewport): void {
  const byKey = new Map(commands.flatMap((command) => command.keys.map((key) => [key, command] as const)));
  const held = new Set<string>();
  const move = (): void => {
    const heading = { right: 0, forward: 0, up: 0 };
    for (const code of held) {
      const [right, forward, up] = kWalkKeys[code] ?? [0, 0, 0];
      heading.right += right;
      heading.forward += forward;
      heading.up += up;
    }
    viewport.navigation.setHeading(heading);
  };
  const release = (): void => {
    held.clear();
    move();
    viewport.editing.letGo();
  };
  window.addEventListener('keydown', (event) => {
    viewport.speedUp = event.shiftKey;
    if (!event.repeat) viewport.editing.letGo();
    if (event.defaultPrevented || isTakenBy(document.activeElement, event)) return;
    if (event.code in kWalkKeys && !event.ctrlKey && !event.metaKey && !event.altKey) {
      held.add(event.code);
      move();
      return;
    }
    const command = byKey.get(nameOf(event));
    if (!command || (store.now.connection === 'review' && !command.isViewing)) return;
    event.preventDefault();
    if (/^[0-9]$/.test(event.key)) viewport.section.pickStorey(Number(event.key));
    else command.run(event.repeat);
  });
  window.addEventListener('keyup', (event) => {
    viewport.speedUp = event.shiftKey;
    if (held.delete(event.code)) move();
    viewport.editing.letGo();
  });
  window.addEventListener('blur', release);
}
