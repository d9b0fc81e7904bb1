// SPDX-License-Identifier: MIT
// The script of a report of `camway replay`: sorts its table, and shows requests in 3D.

import { makeSortable } from './order.js';
import { Shelf } from './shelf.js';
import { Viewer } from './viewer.js';

function hasWebGl(): boolean {
  return document.createElement('canvas').getContext('webgl2') !== null;
}

/** The buttons of the table, one for each request that can be shown, in the order of the rows. */
function rowButtons(): HTMLButtonElement[] {
  return [...document.querySelectorAll<HTMLButtonElement>('tbody button[data-review]')];
}

function wordsOf(number: string): { title: string; reason: string } {
  const row = rowButtons().find(({ dataset }) => dataset['review'] === number)?.closest('tr');
  return { title: row?.dataset['title'] ?? '', reason: row?.cells[row.cells.length - 1]?.textContent ?? '' };
}

for (const table of document.querySelectorAll('table')) makeSortable(table);

const buttons = document.querySelectorAll<HTMLButtonElement>('button[data-review]');
if (buttons.length > 0 && hasWebGl()) {
  const shelf = new Shelf((id) => document.getElementById(id)?.textContent ?? undefined);
  const numbers = (): string[] => rowButtons().map(({ dataset }) => dataset['review'] ?? '');
  const viewer = new Viewer(shelf, numbers, wordsOf);
  for (const button of buttons) button.addEventListener('click', () => viewer.show(button.dataset['review'] ?? ''));
} else {
  for (const button of buttons) button.disabled = true;
  document.getElementById('no-webgl')?.removeAttribute('hidden');
}
