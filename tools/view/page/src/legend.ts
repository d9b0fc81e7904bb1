// SPDX-License-Identifier: MIT
// The legend of the view: the colours of clearance, and the lines that there are now.

import { clearanceColour, kComfortableClearance_m, kNames } from './model/palette.js';
import type { State, Store } from './model/store.js';

const kSteps = 24;

function clearanceBar(): HTMLElement {
  const bar = document.createElement('div');
  bar.className = 'ramp';
  for (let i = 0; i < kSteps; ++i) {
    const step = document.createElement('i');
    const [r, g, b] = clearanceColour((i / (kSteps - 1)) * kComfortableClearance_m).map((x) => Math.round(255 * x));
    step.style.backgroundColor = `rgb(${r} ${g} ${b})`;
    bar.append(step);
  }
  return bar;
}

function entry(kind: keyof typeof kNames): HTMLElement {
  const item = document.createElement('li');
  item.dataset['kind'] = kind;
  item.append(document.createElement('i'), kNames[kind]);
  return item;
}

/** What is to be seen for an answer, so that the legend names no more. */
export function kindsIn({ answer, before }: Pick<State, 'answer' | 'before'>): (keyof typeof kNames)[] {
  if (!answer) return before.length > 0 ? ['before'] : [];
  const kinds: (keyof typeof kNames)[] = [];
  if (answer.segments.length > 0 && answer.certificate?.certified && !answer.clearance_profile?.length) kinds.push('after');
  const hasPath = answer.segments.length > 0;
  const isCorrected = hasPath && (answer.corrections ?? []).some(({ kind }) => kind !== 'none');
  if (before.length > 0 && (isCorrected || !hasPath)) kinds.push('before');
  if (isCorrected) kinds.push('corrected');
  if (answer.collisions.length + answer.remaining_collisions.length > 0) kinds.push('collision');
  if (hasPath && answer.keyframes.some(({ origin }) => origin === 'inserted')) kinds.push('inserted');
  if (answer.infeasibility) kinds.push('infeasible');
  return kinds;
}

export function makeLegend(host: HTMLElement, store: Store): void {
  host.className = 'legend';
  host.setAttribute('aria-label', 'Legend');
  const title = document.createElement('span');
  title.textContent = 'certified clearance';
  const ends = document.createElement('div');
  ends.className = 'ends';
  for (const text of ['0', `${kComfortableClearance_m} m`]) {
    const end = document.createElement('span');
    end.textContent = text;
    ends.append(end);
  }
  const clearance = document.createElement('div');
  clearance.append(title, clearanceBar(), ends);
  const list = document.createElement('ul');
  host.append(list, clearance);
  let shown = '';
  const update = (): void => {
    const kinds = kindsIn(store.now);
    clearance.hidden = !store.now.answer?.clearance_profile?.length;
    host.hidden = clearance.hidden && kinds.length === 0;
    if (kinds.join() === shown) return;
    shown = kinds.join();
    list.replaceChildren(...kinds.map(entry));
  };
  store.listen((now, before) => {
    if (now.answer !== before.answer || now.before !== before.before) update();
  });
  update();
}
