// SPDX-License-Identifier: MIT
import type { Answer, Collision, Correction, KeyframeFault } from '../contract/answer.js';
import type { Actions } from '../model/actions.js';
import { lowerBoundText, numberText, timeText, withUnit } from '../model/format.js';
import { acceptingKey, distanceText, freePoses } from '../model/free_pose.js';
import { beginOf } from '../model/path.js';
import { pathOf } from '../model/stops.js';
import type { State, Store } from '../model/store.js';
import { timesOnPath } from '../model/times.js';
import {
  certificateWords,
  correctionText,
  faultText,
  infeasibilityWords,
  measureRows,
  otherChanges,
  shutInWords,
  statusWords,
} from './answer_words.js';
import { make, makeButton } from './dom.js';
import { renderKeepingFocus, whileVisible } from './render.js';

/** Rows of a list that are shown at first. */
const kMostRows = 50;

/** Makes the panel that says what the answer is and why. */
export function makeAnswerPanel(host: HTMLElement, store: Store, actions: Actions): void {
  whileVisible(host, store, isChanged, (now) => renderKeepingFocus(host, contentOf(now, actions)));
}

function isChanged(now: State, before: State): boolean {
  return (
    now.answer !== before.answer ||
    now.unplanned !== before.unplanned ||
    now.isPending !== before.isPending ||
    now.isDraft !== before.isDraft ||
    now.connection !== before.connection ||
    now.before !== before.before
  );
}

function contentOf(state: State, actions: Actions): Node[] {
  const answer = state.answer;
  if (!answer && state.unplanned) return [unplannedHead(state.unplanned)];
  if (!answer) {
    const text = state.request ? 'Not planned yet.' : 'Open a request, or add keyframes: walk to a view and insert it.';
    return [make('p', { class: 'cw-empty', text })];
  }
  return [
    headOf(state, answer),
    ...faultsOf(state, answer.keyframe_faults ?? [], actions),
    ...infeasibilityOf(state, answer, actions),
    ...collisionsOf(state, answer, actions),
    ...measuresOf(answer),
    ...sentencesOf('Also changed', otherChanges(answer)),
    ...sentencesOf('Warnings', answer.warnings ?? []),
  ];
}

function badgeOf(status: string, symbol: string, title: string, note?: string): HTMLElement {
  return make(
    'div',
    { class: 'cw-badge', 'data-status': status },
    make('span', { class: 'cw-badge-symbol', text: symbol, 'aria-hidden': 'true' }),
    make('strong', { text: title }),
    note ? make('span', { class: 'cw-draft', text: note }) : undefined,
  );
}

/** Of a request that has no answer. */
function unplannedHead(reason: string): HTMLElement {
  return make('section', { 'aria-label': 'Status' }, badgeOf('invalid', '!', 'Not planned'), text(sentence(reason)));
}

function headOf(state: State, answer: Answer): HTMLElement {
  const words = statusWords(answer.status);
  const badge = badgeOf(answer.status, words.symbol, words.title, draftWords(state));
  const lines = [words.meaning, certificateWords(answer)].filter((line) => line !== undefined && line !== '');
  const isSaid = answer.status === 'ok' && answer.certificate?.certified;
  return make(
    'section',
    { 'aria-label': 'Status' },
    badge,
    ...(isSaid ? lines.slice(1) : lines).map((text) => make('p', { class: 'cw-lead', text: text as string })),
    make('p', { class: 'cw-message', text: sentence(answer.message) }),
  );
}

/** What else than its status is to be said of an answer that is not the last one. */
function draftWords({ isDraft, isPending }: State): string | undefined {
  if (isDraft) return 'draft';
  return isPending ? 'of before; planning …' : undefined;
}

function faultsOf(state: State, faults: readonly KeyframeFault[], actions: Actions): Node[] {
  if (faults.length === 0) return [];
  const poses = freePoses(state);
  const rows = faults.map((fault) => {
    const row = make('div', { class: 'cw-fault' }, make('p', { text: faultText(fault) }));
    const pose = poses.find(({ keyframe }) => keyframe === fault.keyframe);
    if (!pose) row.append(make('p', { class: 'cw-muted', text: 'No free pose was found near it.' }));
    else if (state.connection !== 'review') {
      const words = pose.isFar ? 'Accept the far free pose' : 'Accept the free pose';
      const button = makeButton(`${words} (${distanceText(pose)})`, () => actions.acceptFreePose(fault.keyframe), { title: acceptingKey(pose) });
      button.dataset['key'] = `fault ${fault.keyframe}`;
      row.append(button);
    }
    return row;
  });
  return [section('Keyframes that collide', ...rows)];
}

function infeasibilityOf(state: State, answer: Answer, actions: Actions): Node[] {
  const proof = answer.infeasibility;
  // An invalid request has a wrong keyframe, and that was said already.
  const isShutIn = answer.keyframe !== undefined && answer.status !== 'invalid';
  if (!proof) return isShutIn ? [section('Shut in', text(shutInWords(answer.keyframe as number)))] : [];
  const sentences = infeasibilityWords(proof).map(text);
  const buttons = make(
    'div',
    { class: 'cw-row' },
    keyframeButton(state, proof.keyframe_inside, 'inside', actions),
    keyframeButton(state, proof.keyframe_outside, 'outside', actions),
  );
  return [section('Why there is no path', ...sentences, buttons)];
}

function keyframeButton(state: State, index: number, word: string, actions: Actions): HTMLButtonElement {
  const button = makeButton(`Keyframe ${index}, ${word}`, () => {
    const time_s = state.request && timesOnPath(state.request, state.answer)[index];
    if (time_s !== undefined) actions.seek(time_s);
    actions.select({ keyframe: index });
    actions.showSelection();
  });
  button.dataset['key'] = `keyframe ${index}`;
  return button;
}

function collisionsOf(state: State, answer: Answer, actions: Actions): Node[] {
  const begin_s = beginOf(pathOf(state));
  const row = (collision: Collision, detail: string, key: string): HTMLElement => {
    const { object, time, depth_m } = collision.witness;
    const [from, to] = [timeText(collision.t_begin, begin_s), timeText(collision.t_end, begin_s)];
    const times = from === to ? `${from} s` : `${from}–${to} s`;
    const depth = depth_m > 0 ? `${withUnit(depth_m, 'm')} deep` : '';
    const button = makeButton('', () => actions.seek(time), { class: 'cw-item', title: 'Go there' });
    button.dataset['key'] = key;
    button.append(
      make('span', { class: 'cw-item-time', text: times }),
      make('span', { class: 'cw-item-name', text: object }),
      make('span', { class: 'cw-item-detail', text: [depth, detail].filter((words) => words !== '').join('; ') }),
    );
    return make('li', {}, button);
  };
  const corrections = answer.corrections ?? [];
  const detailOf = (collision: Collision): string => {
    const found = corrections.find((correction) => isOf(correction, collision));
    return found ? correctionText(found) : '';
  };
  const sections: Node[] = [];
  const remaining = answer.remaining_collisions ?? [];
  if (remaining.length > 0) {
    const rows = remaining.map((collision, i) => row(collision, detailOf(collision), `remaining ${i}`));
    sections.push(section(`Remaining collisions: ${remaining.length}`, listOf(rows, 'cw-remaining')));
  }
  const before = (answer.collisions ?? []).filter((collision) => !remaining.some((left) => isOf(left, collision)));
  if (before.length > 0) {
    const rows = before.map((collision, i) => row(collision, detailOf(collision), `collision ${i}`));
    const title = remaining.length > 0 ? 'Corrected collisions' : 'Collisions before';
    sections.push(section(`${title}: ${before.length}`, listOf(rows, 'cw-before')));
  }
  return sections;
}

function isOf(other: Correction | Collision, collision: Collision): boolean {
  return other.t_begin === collision.t_begin && other.t_end === collision.t_end;
}

function listOf(rows: readonly HTMLElement[], name: string): HTMLElement {
  const list = make('ol', { class: `cw-list ${name}` }, ...rows.slice(0, kMostRows));
  const more = rows.length - kMostRows;
  if (more <= 0) return list;
  const button = makeButton(`Show ${more} more`, () => {
    button.remove();
    list.append(...rows.slice(kMostRows));
  });
  return make('div', {}, list, button);
}

function measuresOf(answer: Answer): Node[] {
  const rows = measureRows(answer);
  if (rows.length === 0) return [];
  const cell = (value: number | undefined, isLowerBound: boolean): HTMLElement =>
    make('td', { text: value === undefined ? '–' : isLowerBound ? lowerBoundText(value) : numberText(value) });
  const head = make('tr', {}, make('th', { scope: 'col', text: 'Measure' }), ...['before', 'after', 'unit'].map((text) => make('th', { scope: 'col', text })));
  const body = rows.map((row) => make('tr', {}, make('th', { scope: 'row', text: row.label }), cell(row.before, row.isLowerBound), cell(row.after, row.isLowerBound), make('td', { class: 'cw-unit', text: row.unit })));
  return [section('Measures', make('table', { class: 'cw-table' }, make('thead', {}, head), make('tbody', {}, ...body)))];
}

function sentencesOf(title: string, sentences: readonly string[]): Node[] {
  return sentences.length > 0 ? [section(title, ...sentences.map((words) => text(sentence(words))))] : [];
}

function section(title: string, ...children: Node[]): HTMLElement {
  return make('section', {}, make('h3', { text: title }), ...children);
}

function text(words: string): HTMLElement {
  return make('p', { text: words });
}

/** A message of Camway, which has no capital letter and no full stop, as a sentence. */
function sentence(message: string): string {
  const first = message.charAt(0);
  const isName = message.includes('.') && /^[\w.[\]]+:/.test(message);
  const begun = isName ? message : first.toLocaleUpperCase() + message.slice(1);
  return /[.!?]$/.test(begun) || begun === '' ? begun : `${begun}.`;
}
