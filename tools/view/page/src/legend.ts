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

/** A path without a proof has an entry where it must be told from another one alone. */
type Kind = keyof typeof kNames | 'unproved';

type Shown = Pick<State, 'answer' | 'before'> & Partial<Pick<State, 'compared'>>;

/** The name of what is drawn; paths of answers that are compared have the names of these. */
export function nameOf(kind: Kind, compared: State['compared']): string {
  if (kind === 'unproved') return `${compared?.name ?? kNames.after}, not proved`;
  if (kind === 'after' && compared) return compared.name;
  return kind === 'before' && compared ? compared.otherName : kNames[kind];
}

function entry(kind: Kind, name: string): HTMLElement {
  const item = document.createElement('li');
  item.dataset['kind'] = kind;
  item.append(document.createElement('i'), name);
  return item;
}

/** What is to be seen for an answer, so that the legend names no more. */
export function kindsIn({ answer, before, compared }: Shown): Kind[] {
  if (!answer) return before.length > 0 ? ['before'] : [];
  const kinds: Kind[] = [];
  const hasPath = answer.segments.length > 0;
  const hasProfile = (answer.clearance_profile?.length ?? 0) > 0;
  if (hasPath && answer.certificate?.certified && !hasProfile) kinds.push('after');
  if (hasPath && !answer.certificate?.certified && !hasProfile && compared) kinds.push('unproved');
  const isCorrected = hasPath && (answer.corrections ?? []).some(({ kind }) => kind !== 'none');
  const hasBeside = compared ? compared.other.segments.length > 0 : before.length > 0 && (isCorrected || !hasPath);
  if (hasBeside) kinds.push('before');
  if (isCorrected) kinds.push('corrected');
  const besideCollisions = compared ? compared.other.remaining_collisions : answer.collisions;
  if (besideCollisions.length + answer.remaining_collisions.length > 0) kinds.push('collision');
  if (hasPath && answer.keyframes.some(({ origin }) => origin === 'inserted')) kinds.push('inserted');
  if (answer.infeasibility) kinds.push('infeasible');
  return kinds;
}

export function makeLegend(host: HTMLElement, store: Store): void {
  host.className = 'legend';
  host.setAttribute('aria-label', 'Legend');
  const title = document.createElement('span');
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
    const { answer, compared } = store.now;
    const kinds = kindsIn(store.now);
    clearance.hidden = !answer?.clearance_profile?.length;
    host.hidden = clearance.hidden && kinds.length === 0;
    title.textContent = compared ? `certified clearance, ${compared.name}` : 'certified clearance';
    const names = kinds.map((kind) => nameOf(kind, compared));
    if (names.join() === shown) return;
    shown = names.join();
    list.replaceChildren(...kinds.map((kind, i) => entry(kind, names[i] as string)));
  };
  store.listen((now, before) => {
    if (now.answer !== before.answer || now.before !== before.before) update();
  });
  update();
}
